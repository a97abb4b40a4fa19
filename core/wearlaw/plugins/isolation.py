"""Loading the code of plugins without side effects on the process: on its output, its folder and its settings."""

from __future__ import annotations

import ctypes
import locale
import os
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread
from time import monotonic
from typing import IO, Any, NamedTuple, TextIO

import numpy as np

from wearlaw.errors import printable, shortened

PATIENCE = 2.0
"""Time after which a plugin that still loads is named on standard error [s]."""


class _State(NamedTuple):
    """A setting of the process: its name in messages, how to read and set it, and whether a change does harm."""

    name: str
    read: Callable[[], Any]
    restore: Callable[[Any], Any]
    harmful: Callable[[Any, Any], bool] = lambda before, after: bool(before != after)


def _folder() -> str | None:
    try:
        return os.getcwd()
    except OSError:  # it was removed
        return None


def _set_filters(filters: list[Any]) -> None:
    warnings.filters[:] = filters  # type: ignore[index]
    with warnings.catch_warnings():  # entering it empties the caches of the filters
        pass


def _of_all_warnings(filters: list[Any]) -> list[Any]:
    """Return the filters for all messages of all modules in Python's own categories.

    Libraries add others for messages of their own.
    """
    return [one for one in filters if one[1] is None and one[3] is None and one[2].__module__ == "builtins"]


_STATES = (
    _State("the working folder", _folder, lambda folder: None if folder is None else os.chdir(folder)),
    _State(
        "sys.path",
        lambda: list(sys.path),
        lambda entries: sys.path.__setitem__(slice(None), entries),
        lambda before, after: after[: len(before)] != before,  # nothing is hidden by an entry at the end
    ),
    _State(
        "the filters of warnings",
        lambda: list(warnings.filters),
        _set_filters,
        lambda before, after: _of_all_warnings(before) != _of_all_warnings(after),
    ),
    _State("NumPy's treatment of floating-point errors", np.geterr, lambda errors: np.seterr(**errors)),
    _State("the locale", lambda: locale.setlocale(locale.LC_ALL), lambda name: locale.setlocale(locale.LC_ALL, name)),
)


class Isolation:
    """A context in which plugins are loaded one after the other, each in the context `of` its own.

    What a plugin prints stays off standard output, its changes to settings of the process are undone, and a plugin
    that still loads after two seconds is named on standard error. Other threads that print meanwhile are not told
    apart from the plugin.
    """

    def __init__(self) -> None:
        self._loading: tuple[object, float] | None = None
        self._done = Event()
        self._output = _Output()

    def __enter__(self) -> Isolation:
        Thread(target=self._look, daemon=True).start()
        self._output.divert()
        return self

    def __exit__(self, *_: object) -> None:
        self._done.set()
        self._output.restore()

    @contextmanager
    def of(self, plugin: object, remark: Callable[[str], None]) -> Iterator[None]:
        """Undo the side effects of a plugin, and call `remark` with a sentence for each."""
        self._loading = plugin, monotonic()
        before = [state.read() for state in _STATES]
        try:
            yield
        finally:
            for state, value in zip(_STATES, before, strict=True):
                if state.harmful(value, state.read()):
                    with suppress(OSError, locale.Error):
                        state.restore(value)
                    remark(f"it changed {state.name}, which is restored")
            printed = self._output.printed()
            if printed:
                remark(f"it printed {shortened(printed)}, which is left out; standard output is for results")

    def _look(self) -> None:
        """Name the plugin that is loading for long, once."""
        named: object = None
        wait = PATIENCE
        while not self._done.wait(wait):
            wait = PATIENCE
            if self._loading is None or self._loading is named:
                continue
            plugin, since = loading = self._loading
            wait = since + PATIENCE - monotonic()
            if wait <= 0.0:
                named, wait = loading, PATIENCE
                if sys.stderr is not None:
                    print(printable(f"wearlaw is still loading {plugin}"), file=sys.stderr, flush=True)


class _Output:
    """Standard output, diverted into a file, also for subprocesses and C code."""

    def divert(self) -> None:
        try:
            self._file: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115  closed by `restore`
        except OSError:  # the disk is full; what is printed is then dropped without a remark
            self._file = open(os.devnull, "r+b")  # noqa: SIM115
        self._real: TextIO = sys.stdout
        self._aside: Any = _Aside(sys.stdout, self._file.fileno())
        self._c_code: ctypes.CDLL | None = None
        with suppress(TypeError, OSError):  # on Windows
            self._c_code = ctypes.CDLL(None)
        self._flush()
        try:
            self._saved = os.dup(1)
            os.dup2(self._file.fileno(), 1)
        except OSError:  # there is none, as in a program with windows only
            self._saved = -1
        if self._real is not None and not _is_standard_output(self._real):  # such as that of a notebook
            sys.stdout = self._aside

    def printed(self) -> str:
        """Return the start of what was printed since the last call."""
        self._flush()
        descriptor = self._file.fileno()
        if not os.fstat(descriptor).st_size:
            return ""
        os.lseek(descriptor, 0, os.SEEK_SET)
        text = os.read(descriptor, 1000).decode("utf-8", "replace").strip()
        os.lseek(descriptor, 0, os.SEEK_SET)
        os.ftruncate(descriptor, 0)
        return text

    def restore(self) -> None:
        self._flush()
        sys.stdout = self._real
        if self._saved >= 0:
            os.dup2(self._saved, 1)
            os.close(self._saved)
        self._aside.descriptor = -1
        self._file.close()

    def _flush(self) -> None:
        """Write what Python and C code have in their buffers."""
        with suppress(OSError, ValueError, AttributeError):
            sys.stdout.flush()
        if self._c_code is not None:
            self._c_code.fflush(None)


class _Aside:
    """A text stream in place of standard output; after `restore` it writes to the real one again."""

    def __init__(self, real: TextIO, descriptor: int) -> None:
        self.real, self.descriptor = real, descriptor

    def write(self, text: str) -> int:
        if self.descriptor < 0:
            return self.real.write(text)
        return os.write(self.descriptor, text.encode("utf-8", "replace"))

    def writelines(self, lines: Iterable[str]) -> None:
        self.write("".join(lines))

    def __getattr__(self, name: str) -> Any:
        return getattr(self.real, name)


def _is_standard_output(stream: TextIO) -> bool:
    try:
        return stream.fileno() == 1
    except (OSError, ValueError, AttributeError):
        return False
