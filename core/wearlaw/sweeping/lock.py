"""A lock on a file, so that two processes do not write the same results."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import IO

from wearlaw.errors import OutputError

if sys.platform == "win32":
    import msvcrt

    PLACE = 2**30
    """Byte that stands for the file, far behind its end: Windows lets nobody else read a locked byte."""

    def _locked(file: IO[bytes]) -> bool:
        file.seek(PLACE)
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        return True

else:
    import fcntl

    def _locked(file: IO[bytes]) -> bool:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            return False
        except OSError:  # this file system has no locks
            pass
        return True


def open_locked(path: Path, create: bool = False) -> IO[bytes]:
    """Return a file, open for reading and appending, that no other process can open in this way.

    The lock ends as the file is closed or the process ends, even if it is killed. On a network it is as good as the
    file system: NFS locks between machines unless it is mounted with `nolock` or `local_lock`. Where a file system has
    no locks, the file is opened without one.

    Parameters
    ----------
    path : Path
    create : bool
        Whether to create the file if it does not exist.

    Raises
    ------
    OutputError
        If another process has the file, or it is no file.
    OSError
        If the file cannot be opened.
    """
    if os.path.lexists(path) and not path.is_file():
        raise OutputError(f"'{path}' is not a file; remove it")
    file = path.open("a+b" if create else "r+b")
    if not _locked(file):
        file.close()
        raise OutputError(f"'{path}' is in use by another run that is still going on; wait until it has ended")
    if not _is_still_there(path, file):
        file.close()
        raise OutputError(f"'{path}' was in use by another run, which has just ended; try again")
    return file


def _is_still_there(path: Path, file: IO[bytes]) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False
