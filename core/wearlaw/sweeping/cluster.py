"""Blocks on a cluster of dask.distributed."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterable
from typing import Any

from wearlaw.arrays.array import Array
from wearlaw.errors import ModelError, SweepError, described
from wearlaw.sweeping.evaluation import Seen
from wearlaw.sweeping.points import Block, Points
from wearlaw.sweeping.processes import Done, Into
from wearlaw.sweeping.worker import evaluated, job_of

AHEAD = 4
"""Blocks that are handed out for each thread of the cluster, so that none waits for work."""

CHECKED_S = 1.0
"""Time from one count of the workers to the next."""


def on_cluster(
    client: Any, job: bytes, store: str | None, points: Points, blocks: Iterable[Block], into: Into
) -> Generator[Done, None, None]:
    """Evaluate blocks on a cluster and give each one that is done, in any order.

    A task of the cluster is a block with the few values that its conditions take; the operating points are laid out by
    the worker. The cluster itself tries a block again whose worker died, as often as its setting
    `distributed.scheduler.allowed-failures` says.
    """
    import distributed

    members = _Members(client)
    left = iter(blocks)
    pending: dict[Any, Block] = {}
    waiting: Any = distributed.as_completed([])  # type: ignore[no-untyped-call]

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


def _evaluate(job: bytes, block: Block, part: Points, store: str | None) -> tuple[list[Array], Seen]:
    try:
        outputs, seen = evaluated(job_of(job), block, part, store)
    except Exception:
        raise
    except BaseException as error:  # a model's SystemExit would end the worker
        raise ModelError(described(error)) from None
    return list(outputs.values()), seen


def _result(future: Any, block: Block) -> tuple[list[Array], Seen]:
    from distributed import KilledWorker

    try:
        found: tuple[list[Array], Seen] = future.result()
    except KilledWorker as error:
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
        """How many threads they have, or 1 where there are no workers yet."""
        return max(1, sum(self._known.values()))

    def left(self, at_once: bool) -> list[str]:
        """Return a warning about lost workers, or nothing if they were counted a moment ago."""
        if not at_once and time.monotonic() < self._checked + CHECKED_S:
            return []
        before, self._known, self._checked = self._known, self._client.nthreads(), time.monotonic()
        gone = sorted(set(before) - set(self._known))
        return [f"worker {address} left the cluster, and its blocks are evaluated again" for address in gone]
