"""Where the results of a sweep go: what takes them, and those that stay in memory."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.sweeping.evaluation import Job, Seen, checksum
from wearlaw.sweeping.journal import Journal, Run, run_of
from wearlaw.sweeping.points import Block, Points
from wearlaw.sweeping.space import check_memory

if TYPE_CHECKING:
    import xarray

ITEM = np.dtype(np.float64).itemsize


class Target(ABC):
    """What takes the results of the blocks of a sweep.

    Attributes
    ----------
    store : str or None
        Where those who evaluate blocks write the outputs themselves; None if they hand them back.
    done : dict of int to Seen
        What was seen of each block that is done, by its number.
    listed, damaged : int
        How many blocks an interrupted sweep has left, and how many of them are damaged, so that they are not done.
    """

    store: str | None = None

    def __init__(self, job: Job, points: Points) -> None:
        self.job = job
        self.points = points
        self.done: dict[int, Seen] = {}
        self.listed = self.damaged = 0
        self._journal: Journal | None = None

    @abstractmethod
    def places(self, block: Block) -> list[Array]:
        """Return where the outputs of a block go that are handed back, (points,) each, in the order of the job."""

    def add(self, number: int, seen: Seen) -> None:
        """Take note that a block is done, also in the journal if there is one."""
        self.done[number] = seen
        if self._journal is not None:
            self._journal.add(number, seen)

    def close(self) -> None:
        """Leave what there is as it is."""
        if self._journal is not None:
            self._journal.close()

    def _take_over(self, journal: Journal) -> None:
        """Keep a journal, and count the blocks it lists as done where their results are still those computed."""
        self._journal = journal
        blocks = {block.number: block for block in self.points.blocks()}
        for number, seen in journal.done.items():
            if number in blocks and checksum(seen, self._kept(blocks[number])) == seen.checksum:
                self.done[number] = seen
        self.listed = len(journal.done)
        self.damaged = self.listed - len(self.done)

    @abstractmethod
    def _kept(self, block: Block) -> list[Array]:
        """Return the outputs of a block as they are on disk, or nothing where they cannot be read."""

    @property
    def size(self) -> int:
        """How many bytes the outputs take."""
        return self.points.size * len(self.job.units) * ITEM


class Arrays(Target):
    """Results in arrays of this process.

    Attributes
    ----------
    arrays : dict of str to ndarray, (points,)
        The outputs by name.
    """

    arrays: dict[str, Array]

    def places(self, block: Block) -> list[Array]:
        """Return where the outputs of a block go."""
        return [array[block.flat] for array in self.arrays.values()]

    _kept = places


class Memory(Arrays):
    """Results in memory."""

    def __init__(self, job: Job, points: Points) -> None:
        super().__init__(job, points)
        check_memory(self.size, 'give a folder for them, store="..."')
        self.arrays = {name: np.empty(points.size) for name in job.units}

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Return the results with their labels."""
        found = self.points.dataset(self.arrays, self.job.units)
        return found.assign_attrs(attributes(run_of(self.job, self.points), notes))


def damage(damaged: int, listed: int, where: Path) -> str:
    """Return what is said of blocks that are damaged on disk."""
    return f"{damaged} of the {listed} blocks kept in '{where}' were damaged, and are computed again"


COMPLETE, INCOMPLETE = "complete", "incomplete"
"""What the attribute "status" of results says."""


def attributes(run: Run, notes: Sequence[str]) -> dict[str, str]:
    """Return the attributes of finished results: where they come from, and what a reader must know."""
    return {"status": COMPLETE, "provenance": json.dumps(run), "notes": "\n".join(notes)}
