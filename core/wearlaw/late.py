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
    """Say how to install a package that is missing, while this context lasts; without an extra the error stays.

    A package that is there may still fail to import, because it is too old, or lacks a package or library of its own.
    """
    try:
        yield
    except ImportError as error:
        chain = (error, error.__cause__, error.__context__)  # pandas names what it misses in its text alone
        cause = next((one for one in chain if isinstance(one, ImportError) and one.name), error)
        if extra is None or (cause.name or "").startswith("wearlaw"):
            raise
        what = f"needs {cause.name}" if isinstance(cause, ModuleNotFoundError) else f"cannot be loaded: {error}"
        message = f'{use} {what}; install it with: python -m pip install "wearlaw[{extra}]"'
        raise MissingPackageError(message, name=cause.name) from error


def load(place: str, name: str, use: str) -> Any:
    """Return a name from a module, such as that of a command, whose application may need an extra."""
    with needed_for(use, extra_of(place)):
        return getattr(import_module(place), name)
