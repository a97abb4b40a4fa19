"""Locks on files, which end with the process that holds them, even if it is killed."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import IO, Self

from wearlaw.errors import OutputError, quoted

if sys.platform == "win32":
    import msvcrt

    PLACE = 2**30
    """Byte that stands for the file, far behind its end: Windows lets nobody else read a locked byte."""

    def _lock(file: IO[bytes]) -> None:
        file.seek(PLACE)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _lock(file: IO[bytes]) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


class HeldError(OutputError):
    """Another process holds the lock."""


def open_locked(path: Path, create: bool = False) -> IO[bytes]:
    """Return a file, open for reading and appending, that no other process can open in this way.

    The lock ends as the file is closed or the process ends. On a network it is as good as the file system: NFS locks
    between machines unless it is mounted with `nolock` or `local_lock`. Where a file system has no locks, the file is
    opened without one.

    Parameters
    ----------
    path : Path
    create : bool
        Whether to create the file if it does not exist.

    Raises
    ------
    HeldError
        If another process has the file.
    OutputError
        If it is no file.
    OSError
        If the file cannot be opened.
    """
    return _opened(path, create)[0]


def _opened(path: Path, create: bool) -> tuple[IO[bytes], bool]:
    """Return a locked file, and whether its file system has locks."""
    if os.path.lexists(path) and not path.is_file():
        raise OutputError(f"{quoted(path)} is not a file; remove it")
    file, works = path.open("a+b" if create else "r+b"), True
    try:
        _lock(file)
    except (BlockingIOError, PermissionError):  # the second on Windows
        file.close()
        raise HeldError(
            f"{quoted(path)} is in use by another run that is still going on; wait until it has ended"
        ) from None
    except OSError:
        works = False
    if not _is_still_there(path, file):
        file.close()
        raise HeldError(f"{quoted(path)} was in use by another run, which has just ended; try again")
    return file, works


def _is_still_there(path: Path, file: IO[bytes]) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False


class Lock:
    """A file that holds nothing but a lock, to tell a process that is still going on from one that was killed.

    Where a file system has no locks the file is removed at once, and nobody takes the process for gone.

    Parameters
    ----------
    path : Path
        The file, in a folder that exists.

    Raises
    ------
    HeldError
        If another process holds the lock.
    OSError
        If the file cannot be made.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file, works = _opened(path, create=True)
        if not works:
            self.remove()

    @classmethod
    def given_up(cls, path: Path) -> Self | None:
        """Return the lock on a file whose process is gone, or None if it is held, or there is no such file."""
        with suppress(OSError):
            lock = cls(path) if path.is_file() else None
            if path.is_file():
                return lock
        return None

    def close(self) -> None:
        """Give the lock back; the file stays."""
        self._file.close()

    def remove(self) -> None:
        """Give the lock back and remove its file."""
        self.close()
        self._path.unlink(missing_ok=True)
