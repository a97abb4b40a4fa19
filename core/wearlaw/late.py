"""What some of wearlaw needs beside its dependencies: a missing package is an error that names its extra."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from wearlaw.errors import WearlawError

EXTRAS = {
    "wearlaw_apps.tables": "sweeps",
    "wearlaw_apps.sweeps": "sweeps",
    "wearlaw_apps.output": "fits",
    "wearlaw_apps.contact_files": "fits",
    "wearlaw_apps.fits": "fits",
    "wearlaw_apps.studies": "studies",
    "wearlaw_apps.life": "studies",
    "wearlaw_apps.explore": "explore",
}
"""The extra that holds what an application needs, by the longest prefix of a module; `fits` holds `sweeps`, `studies`
holds both, and `explore` all."""


def extra_of(module: str) -> str | None:
    """Return the extra with which a module is installed, or None if it needs none."""
    while module and module not in EXTRAS:
        module = module.rpartition(".")[0]
    return EXTRAS.get(module)


class MissingPackageError(WearlawError, ModuleNotFoundError):
    """A package that an application needs is not installed."""


@contextmanager
def needed_for(use: str, extra: str | None) -> Iterator[None]:
    """Say how to install a package that is missing, while this context lasts; without an extra the error stays."""
    try:
        yield
    except ModuleNotFoundError as error:
        if extra is None or error.name is None or error.name.startswith("wearlaw"):
            raise
        message = f'{use} needs {error.name}; install it with: python -m pip install "wearlaw[{extra}]"'
        raise MissingPackageError(message, name=error.name) from error


def load(place: str, name: str, use: str) -> Any:
    """Return a name from a module, such as that of a command, whose application may need an extra."""
    with needed_for(use, extra_of(place)):
        return getattr(import_module(place), name)
