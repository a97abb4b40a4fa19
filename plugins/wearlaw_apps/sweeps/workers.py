"""Evaluating the blocks of a sweep: in this process, in others on this machine (loky), or on a cluster (dask)."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import json
import os
import pickle
import signal
import sys
import time
from collections import deque
from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, as_completed, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict
from threading import Thread
from typing import Any, TypeAlias, TypeVar

from wearlaw.errors import ModelError, SweepError, WorkerWarning, described, warn
from wearlaw_apps.sweeps.evaluation import BlockRecord, Job, Outputs, evaluate
from wearlaw_apps.sweeps.points import Block, Points

T = TypeVar("T")
R = TypeVar("R")

Evaluated: TypeAlias = Generator[tuple[Block, Outputs, BlockRecord], None, None]
"""Finished blocks, in any order, with their outputs ({} if they are in a store) and records."""

RECORDS = "blocks/record"
"""Array with the record of each finished block. It is in a group of its own, which xarray leaves alone."""

AHEAD = 2
"""Blocks submitted for each worker, so that none waits for work."""

IDLE_S = 300
"""Seconds after which a worker process without work ends; loky warns of one that ends just as it is given work."""

PARENT_S = 1.0
"""Seconds between looks at whether the parent of a worker process is there."""

KEEPS = {-3: 2**25, -1: 2**26}
"""Options of glibc, M_MMAP_THRESHOLD and M_TRIM_THRESHOLD [bytes], with the greatest values that it chooses itself."""

DEATHS = 3
"""Deaths of worker processes at which a sweep is given up."""


def here(
    job: Job, store: str | None, points: Points, blocks: list[Block], on_block: Callable[[int], None]
) -> Evaluated:
    """Evaluate blocks in this process, with progress also within a block."""
    for block in blocks:
        yield block, *_evaluated(job, block, points.part(block.slices), store, on_block)


def _evaluated(
    job: Job, block: Block, part: Points, store: str | None, on_block: Callable[[int], None] | None = None
) -> tuple[Outputs, BlockRecord]:
    """Evaluate a block; with a store, write it there and return no outputs."""
    outputs, record = evaluate(job, part, on_block)
    if store is None:
        return outputs, record
    _write(store, block, outputs, record)
    return {}, record


def _write(store: str, block: Block, outputs: Outputs, record: BlockRecord) -> None:
    """Write a block; its record comes last, since it says that the block is finished."""
    import zarr

    for name, values in outputs.items():
        array: Any = zarr.open_array(store, path=name, mode="r+", zarr_format=3).with_config(
            {"write_empty_chunks": True}
        )  # NaN is a result
        array[(*block.slices, ...)] = values.reshape(block.shape + values.shape[1:])
    zarr.open_array(store, path=RECORDS, mode="r+", zarr_format=3)[block.number] = json.dumps(asdict(record))


def _evaluated_elsewhere(job: bytes, block: Block, part: Points, store: str | None) -> tuple[Outputs, BlockRecord]:
    """Evaluate a block in another process."""
    _keep_memory()
    try:
        return _evaluated(_unpickled(job), block, part, store)
    except Exception:
        raise
    except BaseException as error:  # a model's SystemExit must not end the worker, or this program
        raise ModelError(described(error)) from None


@functools.cache
def _keep_memory() -> None:
    """Let the C library keep the memory that arrays leave.

    dask sets a variable by which its workers, and processes that start beside it, give all memory back at once. Models
    with nodes take four times as long then.
    """
    if "MALLOC_TRIM_THRESHOLD_" in os.environ and sys.platform == "linux":
        with contextlib.suppress(AttributeError):  # another C library
            for option, size in KEEPS.items():
                ctypes.CDLL(None).mallopt(option, size)


@functools.lru_cache(maxsize=8)
def _unpickled(job: bytes) -> Job:
    """Unpickle the job of a sweep, once for all of its blocks."""
    unpickled: Job = pickle.loads(job)
    return unpickled


def in_processes(workers: int, job: bytes, store: str | None, points: Points, blocks: Iterable[Block]) -> Evaluated:
    """Evaluate blocks in worker processes, which later sweeps use too."""
    waiting, deaths = deque(blocks), 0
    while waiting:
        pool = _pool(workers)
        try:
            yield from _in_pool(pool, lambda: workers, job, store, points, waiting)
        except BrokenProcessPool:
            deaths += 1
            if deaths == DEATHS:
                raise SweepError(
                    f"the sweep was given up, since worker processes died {DEATHS} times; does it need more memory than"
                    " there is?"
                ) from None
            warn("a worker process died; its blocks are evaluated again", WorkerWarning)
        except BaseException:  # nobody waits for the blocks in work
            pool.shutdown(kill_workers=True)
            raise


def each_in_processes(workers: int, task: Callable[[T], R], items: Sequence[T]) -> Generator[tuple[int, R], None, None]:
    """Yield the number of each item with what a task returns for it, as they finish in worker processes."""
    pool = _pool(workers)
    pending = {pool.submit(task, item): number for number, item in enumerate(items)}
    try:
        for future in as_completed(pending):
            yield pending[future], future.result()
    except BaseException as error:  # nobody waits for the others
        pool.shutdown(kill_workers=True)
        if isinstance(error, BrokenProcessPool):
            raise SweepError("a worker process died; does it need more memory than there is?") from None
        raise


def _pool(workers: int) -> Any:
    """Return the executor of worker processes."""
    import loky

    return loky.get_reusable_executor(workers, timeout=IDLE_S, initializer=_obey, initargs=(os.getpid(),))


def _obey(parent: int) -> None:
    """Leave Ctrl-C to the parent process, and end with it even if it is killed."""
    _keep_memory()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: int) -> None:
    """End this process once another one is its parent, at once and whatever its main thread waits for."""
    while os.getppid() == parent:  # in Windows for ever, as the number stays when the parent is gone
        time.sleep(PARENT_S)
    os._exit(1)


def on_cluster(client: Any, job: bytes, store: str | None, points: Points, blocks: Iterable[Block]) -> Evaluated:
    """Evaluate blocks on a cluster of dask.distributed.

    If a worker dies, the cluster tries its block again, as often as the setting
    `distributed.scheduler.allowed-failures` allows.
    """
    killed = sys.modules["distributed"].KilledWorker  # the client comes from there
    pool = client.get_executor(pure=False)
    try:
        yield from _in_pool(pool, lambda: sum(client.nthreads().values()), job, store, points, deque(blocks))
    except killed as error:
        raise SweepError(f"a block was given up by the cluster, since its workers died: {error}") from None
    finally:
        pool.shutdown(wait=False)  # nobody waits for the blocks in work


def _in_pool(
    pool: Any, workers: Callable[[], int], job: bytes, store: str | None, points: Points, waiting: deque[Block]
) -> Evaluated:
    """Evaluate blocks in the workers of an executor; if it fails, those that are not finished wait again.

    A task is a block with the values along its dimensions; the worker expands them to operating points.
    """
    pending: dict[Future[tuple[Outputs, BlockRecord]], Block] = {}
    try:
        while waiting or pending:
            ahead = AHEAD * max(1, workers())
            while waiting and len(pending) < ahead:
                part = points.part(waiting[0].slices)
                future = pool.submit(_evaluated_elsewhere, job, waiting[0], part, store)
                pending[future] = waiting.popleft()
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                outputs, record = future.result()
                yield pending.pop(future), outputs, record
    finally:
        waiting.extendleft(reversed(pending.values()))
