"""The program `wearlaw`: Ctrl-C, SIGTERM and SIGHUP end it tidily, with one line, at any moment.

This module is outside the package, since importing that takes most of a second, in which a signal can come too.
"""

from __future__ import annotations

import _thread
import os
import signal
import sys
import time
from contextlib import suppress
from importlib import import_module
from threading import Thread, Timer
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

TIDYING_S = 5.0
"""Longest time between a signal and the end of the program, in seconds."""

TWICE_S = 0.5
"""A signal within so many seconds of the first is the same one: `timeout` and terminals send theirs twice."""

AGAIN_S = 0.01
"""Time after which an interrupt that got lost is raised again, in seconds."""

AT_ONCE = "Stopped at once; the next run with the same output says what is left of this one"


def main() -> None:
    """Run the command line; if a signal ends it, end as the signal does, so that a shell's loop stops too."""
    stop = _Stop()
    try:
        stop.listen()
        import_module("wearlaw.cli").main()
    except KeyboardInterrupt:  # before the command itself
        print("Stopped; nothing was written", file=sys.stderr)
    finally:
        stop.end_if_asked()


_main_thread = _thread.get_ident()


class _Stop:
    """What the signals ask for."""

    def __init__(self) -> None:
        self._signal: int | None = None
        self._since = 0.0
        self._lost = False
        self._over = False

    def listen(self) -> None:
        """Turn signals into `KeyboardInterrupt`, except those that the parent process had ignored, as `nohup` does."""
        sys.unraisablehook = self._raised_in_vain
        sys.excepthook = self._printed
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            number = getattr(signal, name, None)  # Windows has no SIGHUP
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._heard)

    def _heard(self, number: int, _: FrameType | None) -> None:
        if self._over:
            _end(number)
        if self._signal is None:
            self._signal, self._since = number, time.monotonic()
            Thread(target=self._end_in_time, daemon=True).start()
        elif self._lost:
            self._lost = False
        elif time.monotonic() < self._since + TWICE_S:
            return
        else:
            _say(AT_ONCE)
            _end(number)
        raise KeyboardInterrupt

    def _raised_in_vain(self, what: UnraisableHookArgs, /) -> None:
        """Raise the interrupt again if it came where Python drops exceptions, such as in `__del__`."""
        if self._signal is not None and issubclass(what.exc_type, KeyboardInterrupt):
            self._lost = True
            again = Timer(AGAIN_S, _interrupt_again, [self._signal])  # what this function raises is dropped too
            again.daemon = True
            again.start()
        else:
            sys.__unraisablehook__(what)

    def _printed(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None, /) -> None:
        """Print an exception unless it is an interrupt, which compiled code prints before it drops it."""
        if self._signal is None or not issubclass(kind, KeyboardInterrupt):
            sys.__excepthook__(kind, error, trace)

    def _end_in_time(self) -> None:
        """End the program even if something has caught the interrupt, or hangs."""
        time.sleep(TIDYING_S)
        _say(AT_ONCE)
        assert self._signal is not None
        os._exit(128 + self._signal)

    def end_if_asked(self) -> None:
        """End the program by the signal that came, or let the next one end it."""
        self._over = True
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) == self._heard:
                signal.signal(number, signal.SIG_DFL)
        if self._signal is not None:
            _end(self._signal)


def _interrupt_again(number: int) -> None:
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(_main_thread, number)  # wakes the thread if it waits
    else:  # on Windows
        _thread.interrupt_main(signal.Signals(number))


def _say(text: str) -> None:
    with suppress(OSError):  # the terminal may be gone
        os.write(2, f"\n{text}\n".encode())


def _end(number: int) -> NoReturn:
    """End this process as a signal does that nothing handles."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception):
            stream.flush()
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)
    os._exit(128 + number)  # the first process of a container does not end by a signal
