"""Worker processes on this machine, kept from one sweep to the next.

They are started as programs of their own and not by `multiprocessing`, which would run the user's script again in each
of them. One that dies takes nothing with it but the block that it was at.
"""

from __future__ import annotations

import atexit
import pickle
import queue
import subprocess
import sys
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from typing import IO, TypeAlias

from wearlaw.arrays.array import Array
from wearlaw.errors import SweepError
from wearlaw.sweeping.evaluation import Seen
from wearlaw.sweeping.points import Block, Points

ATTEMPTS = 3
"""How often a block is tried whose worker dies."""

START = "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer);"
START += " from wearlaw.sweeping.worker import serve; serve()"

PIPE = 2**20
"""Bytes on their way between two processes, on Linux; with fewer they wait for each other more often."""

Into: TypeAlias = Callable[[Block], list[Array]]
"""Gives the places for the outputs of a block."""

Done: TypeAlias = tuple[Block, Seen, list[str]]
"""A block that was evaluated, what was seen of it, and the deaths of workers that it took."""


class _DeathError(Exception):
    """The worker process ended where an answer was due."""


class _Worker:
    """A process that runs `wearlaw.sweeping.worker.serve`."""

    def __init__(self) -> None:
        command = [sys.executable, "-c", START]
        try:
            self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, pipesize=PIPE)
        except PermissionError:  # this user has no more room in pipes
            self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._send(sys.path)

    def evaluate(self, task: bytes, into: list[Array]) -> Seen | Exception:
        """Return what was seen of a block, once its outputs are in their places, or what it raised."""
        try:
            self._send(task)
            answer: Seen | Exception = pickle.load(_given(self._process.stdout))
            if isinstance(answer, Seen):
                for place in into:
                    self._receive(place)
        except (EOFError, OSError, pickle.UnpicklingError):
            raise _DeathError(f"exit code {self._process.wait()}") from None
        return answer

    def _send(self, what: object) -> None:
        pipe = _given(self._process.stdin)
        pickle.dump(what, pipe)
        pipe.flush()

    def _receive(self, place: Array) -> None:
        missing = place.data.cast("B")
        while missing:
            count = _given(self._process.stdout).readinto(missing)  # type: ignore[attr-defined]
            if not count:
                raise EOFError
            missing = missing[count:]

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            _given(pipe).close()


def _given(pipe: IO[bytes] | None) -> IO[bytes]:
    assert pipe is not None
    return pipe


_idle: queue.SimpleQueue[_Worker] = queue.SimpleQueue()
"""The worker processes that wait for work."""


def in_processes(
    workers: int, job: bytes, store: str | None, points: Points, blocks: Iterable[Block], into: Into
) -> Generator[Done, None, None]:
    """Evaluate blocks in worker processes and give each one that is done, in any order."""

    def evaluate(block: Block) -> Done:
        task = pickle.dumps((job, block, points.part(block.slices), store))
        return _evaluate(block, task, into(block))

    with ThreadPoolExecutor(workers) as threads:
        futures: list[Future[Done]] = [threads.submit(evaluate, block) for block in blocks]
        try:
            for future in as_completed(futures):
                yield future.result()
        finally:
            threads.shutdown(cancel_futures=True)


def _evaluate(block: Block, task: bytes, into: list[Array]) -> Done:
    deaths: list[str] = []
    while len(deaths) < ATTEMPTS:
        worker = _worker()
        try:
            answer = worker.evaluate(task, into)
        except _DeathError as death:
            worker.close()
            deaths.append(f"a worker process died ({death}) at block {block.number}, which is evaluated again")
            continue
        _idle.put(worker)
        if isinstance(answer, Exception):
            raise answer
        return block, answer, deaths
    raise SweepError(
        f"block {block.number} was given up, since the worker processes died in all {ATTEMPTS} attempts to evaluate it;"
        " does it need more memory than there is?"
    )


def _worker() -> _Worker:
    try:
        return _idle.get_nowait()
    except queue.Empty:
        return _Worker()


@atexit.register
def _close() -> None:
    while True:
        try:
            _idle.get_nowait().close()
        except queue.Empty:
            return
