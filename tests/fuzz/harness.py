"""Runs cases, says what is wrong with them, and makes what was found smaller."""

from __future__ import annotations

import contextlib
import io
import os
import random
import re
import signal
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any, NoReturn, Protocol, cast

import wearlaw as wl

Files = Mapping[str, bytes]
"""A case: the contents of its files by their names."""

HANG_S = 4.0
"""Seconds of a processor after which a case counts as hanging."""

"""Characters of the longest line of a message that a reader bears, and how many lines: some list 20 problems."""

SHRINK_S = 3.0
"""Seconds spent on making a finding smaller."""

OURS = re.compile(r".*[/\\](wearlaw\w*[/\\].*\.py)")
"""Files of wearlaw and its plugins, wherever they are installed."""


class Target(Protocol):
    """A module of this package that fuzzes one part of wearlaw."""

    def seeds(self) -> Iterator[Files]:
        """Yield valid cases, to begin with."""

    def draw(self, random: random.Random) -> Files:
        """Return a random case."""

    def run(self) -> None:
        """Use the files in the working folder; raise `Broken` if what comes out cannot be true."""


def target(module: ModuleType) -> Target:
    """Return a module as a target."""
    return cast("Target", module)


class Broken(Exception):  # noqa: N818
    """A result that cannot be true, in a few words that are the same for each case that shows it."""


class Hang(BaseException):
    """A case takes too long."""


@dataclass(frozen=True)
class Finding:
    """What is wrong with a case.

    Attributes
    ----------
    kind : str
        An exception's type, or what is wrong in words.
    place : str
        The function of wearlaw that raised or warned.
    details : str
        A traceback or a message.
    """

    kind: str
    place: str
    details: str

    @property
    def key(self) -> tuple[str, str]:
        """Kind and place; cases of equal keys are one finding."""
        return self.kind, self.place


def check(true: object, what: str) -> None:
    """Raise `Broken` unless a result is as it must be."""
    if not true:
        raise Broken(what)


def finding(of: Target, files: Files, valid: bool = False) -> Finding | None:
    """Run a case in an empty folder, and return what is wrong, if anything is; with a valid case, an error is too."""
    home = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for name, content in files.items():
                Path(name).parent.mkdir(parents=True, exist_ok=True)
                Path(name).write_bytes(content)
            return _judged(of, valid) or _left_behind(Path())
        finally:
            os.chdir(home)


def _judged(of: Target, valid: bool) -> Finding | None:
    found: list[Finding] = []

    def heed(message: Warning | str, category: type[Warning], filename: str, lineno: int, *_: Any, **__: Any) -> None:
        if not issubclass(category, wl.WearlawWarning):
            stack = traceback.extract_stack()[:-1]
            text = warnings.formatwarning(message, category, filename, lineno)
            found.append(Finding(category.__name__, _innermost(stack), text + "".join(traceback.format_list(stack))))

    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("always")
        warnings.showwarning = heed  # `catch_warnings` puts it back
        try:
            with _limited():
                of.run()
        except wl.WearlawError as error:
            if valid:
                return Finding(type(error).__name__, _place(error), "".join(traceback.format_exception(error)))
            failed = error.__cause__ or error.__context__
            if isinstance(error, wl.ModelError) and failed and not isinstance(failed, wl.WearlawError):  # that ships
                details = "".join(traceback.format_exception(error))
                return Finding(f"ModelError after {type(failed).__name__}", _place(failed), details)
        except KeyboardInterrupt:
            raise
        except Broken as broken:
            return Finding(f"result: {broken}", "", "".join(traceback.format_exception(broken)))
        except BaseException as error:
            return Finding(type(error).__name__, _place(error), "".join(traceback.format_exception(error)))
    return found[0] if found else None


def _left_behind(folder: Path) -> Finding | None:
    """Return what a case leaves half done in its folder."""
    left = [path.name for path in folder.rglob("*") if path.name.endswith(".partial") or path.name.startswith(".out")]
    return Finding("file left half written", "", ", ".join(left)) if left else None


def _place(error: BaseException) -> str:
    """Return the innermost function of wearlaw in a traceback."""
    return _innermost(traceback.extract_tb(error.__traceback__))


def _innermost(frames: Sequence[traceback.FrameSummary]) -> str:
    found = ((OURS.fullmatch(one.filename), one.name) for one in reversed(frames))
    return next((f"{path[1]}:{name}" for path, name in found if path), "")


@contextlib.contextmanager
def _limited() -> Iterator[None]:
    """Raise `Hang` after some seconds of the processor, where the system has such a clock."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def hang(*_: int | FrameType | None) -> NoReturn:
        raise Hang(f"more than {HANG_S:g} s of the processor")

    before = signal.signal(signal.SIGVTALRM, hang)
    signal.setitimer(signal.ITIMER_VIRTUAL, HANG_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def smaller(of: Target, files: Files, found: Finding, seconds: float = SHRINK_S) -> Files:
    """Leave out parts of the files, as long as what was found stays and the time lasts."""
    end, kept = time.process_time() + seconds, dict(files)

    def still(tried: Files) -> bool:
        again = finding(of, tried)
        return again is not None and again.key == found.key

    for name in files:
        size = len(kept[name]) // 2
        while size and time.process_time() < end:
            start = 0
            while start < len(kept[name]) and time.process_time() < end:
                tried = {**kept, name: kept[name][:start] + kept[name][start + size :]}
                if still(tried):
                    kept = tried
                else:
                    start += size
            size //= 2
    return kept


def fuzz(name: str, of: Target, seed: int, more: Callable[[], bool]) -> Iterator[tuple[int, Files, Finding | None]]:
    """Yield seed, files and finding of one case after another, as long as `more` says so."""
    while more():
        files = of.draw(random.Random(f"{name} {seed}"))
        yield seed, files, finding(of, files)
        seed += 1
