"""What some of wearlaw needs beside its dependencies: a missing package is an error that names its extra."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from wearlaw.errors import WearlawError

EXTRA_OF = {
    "wearlaw_tables": "sweeps",
    "wearlaw_sweeps": "sweeps",
    "wearlaw_fits": "fits",
    "wearlaw_output": "fits",
    "wearlaw_contact_files": "fits",
    "wearlaw_studies": "studies",
    "wearlaw_life": "studies",
    "wearlaw_explore": "explore",
}
"""The extra that holds what an application needs; `fits` holds `sweeps`, `studies` holds both, and `explore` all."""


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
    with needed_for(use, EXTRA_OF.get(place.partition(".")[0])):
        return getattr(import_module(place), name)
