"""Whether there is room for the results of a sweep."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from wearlaw.errors import InputError

GIB = 2.0**30


def check_memory(size: int, advice: str) -> None:
    """Refuse what does not fit into memory, where it is known how much there is.

    Raises
    ------
    InputError
        With the size that is needed.
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
        With the size that is needed.
    """
    nearest = next(parent for parent in (path.absolute(), *path.absolute().parents) if parent.exists())
    there = shutil.disk_usage(nearest).free
    if size > there:
        raise InputError(
            f"the results need {size / GIB:.3g} GiB on disk, but '{nearest}' has {there / GIB:.3g} GiB free;"
            " choose another disk, fewer outputs or fewer points"
        )


def available_memory() -> int | None:
    """Return the memory that can still be used, in bytes, or None where the system does not say."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration):
        pass
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None
