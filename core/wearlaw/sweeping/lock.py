"""Locks that end with the process that holds them, also if it is killed."""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path
from typing import IO, Self

if sys.platform == "win32":
    import msvcrt

    def _lock(file: IO[bytes]) -> None:
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _lock(file: IO[bytes]) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


class HeldError(Exception):
    """Another process holds the lock."""


class Lock:
    """A lock on a file, held until it is closed or the process ends.

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
        self._file: IO[bytes] = path.open("ab")
        try:
            _lock(self._file)
        except (BlockingIOError, PermissionError):  # the second on Windows
            self._file.close()
            raise HeldError from None
        except OSError:  # the file system knows no locks; without the file, nobody takes the process for gone
            self.remove()

    @classmethod
    def given_up(cls, path: Path) -> Self | None:
        """Return the lock on a file whose process is gone, or None if it is held, or there is no such file."""
        with suppress(HeldError, OSError):
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
