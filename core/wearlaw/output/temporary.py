"""Temporary folders beside results, which the next run tidies up if their own run was killed."""

from __future__ import annotations

import os
import re
import secrets
import shutil
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from wearlaw.errors import OutputError, quoted
from wearlaw.sweeping.lock import HeldError, Lock

LOCK = "lock"
"""File that tells a run that is still going on from one that was killed."""


class Temporary:
    """A hidden folder for results that go to `target`, beside it or beside the first of its parents that is to be made.

    Attributes
    ----------
    path, fresh, replaced : Path
        The folder, and those in it for new results and for the earlier ones that they replace.
    """

    def __init__(self, target: Path) -> None:
        self._target = target
        self._lock: Lock | None = None
        self._name()

    def _name(self) -> None:
        self.path = _nearest(self._target) / f".{self._target.name}-{secrets.token_hex(4)}"
        self.fresh, self.replaced = self.path / "results", self.path / "replaced"

    def make(self) -> None:
        """Make the folder, and one for new results inside.

        It is a folder inside, since only the user may enter this one while it is being filled.
        """
        while True:
            self.path.mkdir(mode=0o700)
            with suppress(HeldError, FileNotFoundError):
                self._lock = Lock(self.path / LOCK)
                if self.path.is_dir():
                    break
            self._name()  # another run took the folder for one that a killed run has left
        self.fresh.mkdir()

    def remove(self) -> None:
        """Remove the folder, but not earlier contents of the target that could not be put back."""
        to_the_end(lambda: _remove(self.path, self._lock))


def to_the_end(step: Callable[[], None]) -> None:
    """Take a step that may be taken twice, and take it again if Ctrl-C interrupts it."""
    try:
        step()
    except KeyboardInterrupt:
        step()
        raise


def _nearest(target: Path) -> Path:
    return next(parent for parent in target.parents if parent.exists())


def _remove(path: Path, lock: Lock | None) -> None:
    for entry in os.scandir(path) if path.is_dir() else ():
        if entry.name not in ("replaced", LOCK):
            shutil.rmtree(entry, ignore_errors=True)
    with suppress(OSError):
        if lock is not None:
            lock.remove()
        path.rmdir()  # not empty if other files could not be put back


def tidy_up(folder: Path, target: Path) -> None:
    """Remove what killed runs have left of their temporary folders, and put earlier results back that they moved away.

    Raises
    ------
    OutputError
        If such a folder holds files that cannot be put back.
    """
    named = re.compile(re.escape(f".{target.name}-") + "[0-9a-f]{8}")
    for left in sorted(path for path in _nearest(target).iterdir() if named.fullmatch(path.name)):
        replaced, lock = left / "replaced", Lock.given_up(left / LOCK)
        with suppress(OSError):
            if lock is None:
                left.rmdir()  # if it is empty
            elif not os.path.lexists(target):
                replaced.rename(target)
        if lock is not None:
            _remove(left, lock)
        if replaced.exists() and not (left / LOCK).exists():
            raise OutputError(
                f"output: {quoted(replaced)} holds what an earlier run has moved out of {quoted(folder)} and could not"
                f" put back; move it to where it belongs, and remove {quoted(left)}"
            )


def discard(what: Path, target: Path) -> None:
    """Remove a folder beside results that is no longer needed; if that is cut off, the next run removes the rest."""
    place = Temporary(target.resolve())
    try:
        place.make()
        what.rename(place.path / "discarded")
    except OSError:
        shutil.rmtree(what, ignore_errors=True)
    finally:
        place.remove()
