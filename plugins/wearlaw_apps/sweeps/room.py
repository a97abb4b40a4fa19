"""Whether results fit into memory and on the disk, and errors if they cannot be written."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from errno import EDQUOT, ENOSPC
from pathlib import Path

from wearlaw.errors import InputError, OutputError, shown

GIB = 2.0**30


@contextmanager
def writing_to(store: object) -> Iterator[None]:
    """Raise an `OutputError` if the system keeps a sweep from writing to its store; None is no store."""
    try:
        yield
    except (OutputError, ConnectionError):
        raise
    except OSError as error:
        if store is None or error.errno is None:  # no error of a file, but a timeout of a cluster
            raise
        advice = (
            "make room, and add resume=True to go on" if error.errno in (ENOSPC, EDQUOT) else "choose another folder"
        )
        raise OutputError(f"store: cannot write to {shown(store)}: {error.strerror}; {advice}") from None


def check_memory(size: int, advice: str) -> None:
    """Raise an error if results do not fit into memory, if its size is known.

    Raises
    ------
    InputError
        If they do not; the message says how much they need.
    """
    there = available_memory()
    if there is not None and size > there:
        raise InputError(
            f"the results need {size / GIB:.3g} GiB of memory, but {there / GIB:.3g} GiB are free; {advice}"
        )


def check_disk(size: int, path: Path) -> None:
    """Raise an error if the results do not fit on the disk.

    Raises
    ------
    InputError
        If they do not; the message says how much they need.
    """
    nearest = next(parent for parent in (path.absolute(), *path.absolute().parents) if parent.exists())
    there = shutil.disk_usage(nearest).free
    if size > there:
        raise InputError(
            f"the results need {size / GIB:.3g} GiB on disk, but {shown(nearest)} has {there / GIB:.3g} GiB free;"
            " choose another disk, fewer outputs or fewer points"
        )


def available_memory() -> int | None:
    """Return the available memory in bytes, or None if the system does not say."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration):
        pass
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None
