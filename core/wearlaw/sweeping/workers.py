"""Evaluating blocks in other processes: on this machine, and on a cluster of dask.distributed.

Worker processes on this machine are kept for later sweeps. They are separate programs: `multiprocessing` would run the
user's script again in each of them. If one dies, only the block that it was evaluating is lost.
"""

from __future__ import annotations

import atexit
import functools
import os
import pickle
import queue
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from threading import Event, Thread
from typing import IO, Any, BinaryIO, TypeAlias

from wearlaw.arrays.array import Array
from wearlaw.errors import ModelError, SweepError, described
from wearlaw.sweeping.evaluation import BlockRecord, Job, evaluated
from wearlaw.sweeping.points import Block, Points

ATTEMPTS = 3
"""Attempts to evaluate a block whose worker dies."""

START = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN);"  # the parent process handles Ctrl-C
START += " import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer);"
START += " from wearlaw.sweeping.workers import serve; serve()"

PIPE = 2**20
"""Size of the pipes on Linux, in bytes; in smaller ones the processes wait for each other more often."""

Into: TypeAlias = Callable[[Block], list[Array]]
"""Returns the arrays for the outputs of a block."""

Done: TypeAlias = tuple[Block, BlockRecord, list[str]]
"""An evaluated block, its record, and messages about workers that died on it."""

AHEAD = 4
"""Blocks submitted for each thread of the cluster, so that none waits for work."""

CHECKED_S = 1.0
"""Seconds between two counts of the workers."""


class _DeathError(Exception):
    """The worker process ended instead of answering."""


class _Worker:
    """A process that runs `serve`."""

    def __init__(self) -> None:
        command = [sys.executable, "-c", START]
        with _ctrl_c_held_back():
            try:
                self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, pipesize=PIPE)
            except PermissionError:  # the user's limit for pipes is used up
                self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._greeted = False

    def evaluate(self, task: bytes, into: list[Array]) -> BlockRecord | Exception:
        """Return the record of a block, with its outputs in their places, or the exception that it raised."""
        try:
            if not self._greeted:
                self._send(sys.path)
                self._greeted = True
            self._send(task)
            answer: BlockRecord | Exception = pickle.load(_given(self._process.stdout))
            if isinstance(answer, BlockRecord):
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

    def kill(self) -> None:
        """End the process, also while another thread waits for its answer."""
        self._process.kill()

    def close(self) -> None:
        """End the process and close its pipes."""
        self.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(OSError):  # a rest that the process did not read
                _given(pipe).close()


@contextmanager
def _ctrl_c_held_back() -> Iterator[None]:
    """Let a process that starts here inherit that Ctrl-C waits: it reaches all processes of a terminal."""
    if not hasattr(signal, "pthread_sigmask"):  # on Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _given(pipe: IO[bytes] | None) -> IO[bytes]:
    assert pipe is not None
    return pipe


_idle: queue.SimpleQueue[_Worker] = queue.SimpleQueue()
"""Idle worker processes."""


def in_processes(
    workers: int, job: bytes, store: str | None, points: Points, blocks: Iterable[Block], into: Into
) -> Generator[Done, None, None]:
    """Evaluate blocks in worker processes and yield them as they finish, in any order.

    Nobody waits for the blocks in work if the sweep is interrupted: their processes are killed.
    """
    team = _Team()

    def evaluate(block: Block) -> Done:
        task = pickle.dumps((job, block, points.part(block.slices), store))
        return team.evaluated(block, task, into(block))

    with ThreadPoolExecutor(workers) as threads:
        try:
            futures: list[Future[Done]] = [threads.submit(evaluate, block) for block in blocks]
            for future in as_completed(futures):
                yield future.result()
        except Exception:
            raise
        except BaseException:
            team.disband()
            raise
        finally:
            threads.shutdown(cancel_futures=True)


class _Team:
    """The workers that evaluate blocks of one sweep."""

    def __init__(self) -> None:
        self._busy: set[_Worker] = set()
        self._disbanded = Event()

    def evaluated(self, block: Block, task: bytes, into: list[Array]) -> Done:
        """Return a block that one of the workers has evaluated."""
        deaths: list[str] = []
        while len(deaths) < ATTEMPTS and not self._disbanded.is_set():
            worker = _worker()
            self._busy.add(worker)
            if self._disbanded.is_set():  # after `disband` has seen who is busy
                worker.kill()
            try:
                answer = worker.evaluate(task, into)
            except _DeathError as death:
                worker.close()
                deaths.append(f"a worker process died ({death}) at block {block.number}, which is evaluated again")
                continue
            finally:
                self._busy.discard(worker)
            _idle.put(worker)
            if isinstance(answer, Exception):
                raise answer
            return block, answer, deaths
        raise SweepError(
            f"block {block.number} was given up, since the worker processes died in all {ATTEMPTS} attempts to evaluate"
            " it; does it need more memory than there is?"
        )

    def disband(self) -> None:
        """Kill the workers that are busy."""
        self._disbanded.set()
        for worker in list(self._busy):
            worker.kill()


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


def serve() -> None:
    """Take blocks from standard input and answer on standard output: the worker process.

    It ends as soon as its input does, be it in the middle of a block: then the parent process is gone.
    """
    waiting: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    Thread(target=_take, args=(sys.stdin.buffer, waiting), daemon=True).start()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of a model must not mix with the answers
    while True:
        task = waiting.get()
        try:
            _answer(task, answers)
        except BrokenPipeError:
            os._exit(0)


def _take(tasks: BinaryIO, waiting: queue.SimpleQueue[bytes]) -> None:
    """Put the tasks from the parent process into a queue, and end this process with it."""
    try:
        while True:
            waiting.put(pickle.load(tasks))
    finally:
        os._exit(0)


def _answer(task: bytes, answers: BinaryIO) -> None:
    try:
        job, block, part, store = pickle.loads(task)
        outputs, seen = evaluated(_job_of(job), block, part, store)
    except BaseException as error:  # a model's SystemExit must not end the worker
        pickle.dump(_portable(error), answers)
    else:
        pickle.dump(seen, answers)
        for values in outputs.values():
            answers.write(values.data)
    answers.flush()


@functools.lru_cache(maxsize=8)
def _job_of(pickled: bytes) -> Job:
    """Unpickle the job of a sweep, once for all of its blocks."""
    job: Job = pickle.loads(pickled)
    return job


def _portable(error: BaseException) -> Exception:
    """Return the exception, or a `ModelError` if it would end the parent process or cannot be pickled."""
    try:
        pickle.loads(pickle.dumps(error))
        return error if isinstance(error, Exception) else ModelError(described(error))
    except BaseException:
        return ModelError(described(error))


def on_cluster(
    client: Any, job: bytes, store: str | None, points: Points, blocks: Iterable[Block], into: Into
) -> Generator[Done, None, None]:
    """Evaluate blocks on a cluster and yield them as they finish, in any order.

    A task of the cluster is a block with the values along its dimensions; the worker expands them to operating points.
    If a worker dies, the cluster tries its block again, as often as the setting
    `distributed.scheduler.allowed-failures` allows.
    """
    distributed = sys.modules["distributed"]  # the client comes from there
    members = _Members(client)
    left = iter(blocks)
    pending: dict[Any, Block] = {}
    waiting: Any = distributed.as_completed([])

    def hand_out() -> None:
        while len(pending) < AHEAD * members.threads and (block := next(left, None)) is not None:
            future = client.submit(_evaluate, job, block, points.part(block.slices), store, pure=False)
            pending[future] = block
            waiting.add(future)

    hand_out()
    try:
        for future in waiting:
            block = pending.pop(future)
            outputs, seen = _result(future, block)
            for place, values in zip(into(block), outputs, strict=True):
                place[:] = values
            hand_out()
            yield block, seen, members.left(at_once=not pending)
    finally:
        client.cancel(list(pending))


def _evaluate(job: bytes, block: Block, part: Points, store: str | None) -> tuple[list[Array], BlockRecord]:
    try:
        outputs, seen = evaluated(_job_of(job), block, part, store)
    except Exception:
        raise
    except BaseException as error:  # a model's SystemExit must not end the worker
        raise ModelError(described(error)) from None
    return list(outputs.values()), seen


def _result(future: Any, block: Block) -> tuple[list[Array], BlockRecord]:
    try:
        found: tuple[list[Array], BlockRecord] = future.result()
    except sys.modules["distributed"].KilledWorker as error:
        raise SweepError(f"block {block.number} was given up by the cluster, since its workers died: {error}") from None
    return found


class _Members:
    """The workers of a cluster, as they come and go."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self._known: dict[str, int] = client.nthreads()
        self._checked = time.monotonic()

    @property
    def threads(self) -> int:
        """Total number of threads, or 1 if there are no workers yet."""
        return max(1, sum(self._known.values()))

    def left(self, at_once: bool) -> list[str]:
        """Return warnings about lost workers, checked at most once per `CHECKED_S` unless `at_once`."""
        if not at_once and time.monotonic() < self._checked + CHECKED_S:
            return []
        before, self._known, self._checked = self._known, self._client.nthreads(), time.monotonic()
        lost = sorted(set(before) - set(self._known))
        return [f"worker {address} left the cluster, and its blocks are evaluated again" for address in lost]
