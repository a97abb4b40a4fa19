"""Evaluating the sweeps of a case."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path

from wearlaw.arrays import Array
from wearlaw.errors import ResumeWarning
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.variables import outcome_units
from wearlaw.units.variables import UNITS
from wearlaw_sweeps.evaluation import Job
from wearlaw_sweeps.points import Points
from wearlaw_sweeps.sweep import check_importable, kept, run, target_of


class Evaluator:
    """Evaluates pipelines at points.

    Parameters
    ----------
    on_block : callable
        Called with the number of evaluations just done.
    workers : int
        Number of processes.
    folder : Path, optional
        Folder for the stores of sweeps of more than one block.
    resume : bool
        Whether to go on with the stores there.
    """

    def __init__(self, on_block: Callable[[int], None], workers: int, folder: Path | None, resume: bool) -> None:
        self._on_block = on_block
        self._workers = workers
        self._folder = folder
        self._resume = resume
        self._kept = self._blocks = 0

    def __call__(
        self,
        key: str,
        pipeline: Pipeline[...],
        points: Points,
        outputs: Sequence[str],
        dims: Mapping[str, tuple[str | int, ...]] | None = None,
    ) -> dict[str, Array]:
        """Return outputs in their usual units and in the shape of the points; `key` names the sweep.

        The usual units are those of the outcomes of the laws, and of `variables.UNITS`. `dims` are the rig's own axes,
        which follow those of the points.
        """
        units = {**UNITS, **outcome_units(pipeline.laws)}
        job = Job(pipeline, {name: units[name] for name in outputs}, dims or {})
        blocks = len(points.blocks())
        workers = min(self._workers, blocks)
        check_importable(pipeline, workers)
        store = self._folder / f"{key}.zarr" if self._folder is not None and blocks > 1 else None
        with closing(target_of(job, points, store, self._resume)) as target:
            if self._resume and store is not None:
                self._kept += len(target.done)
                self._blocks += blocks
            for warning in run(target, self._on_block, workers):
                warnings.warn(warning, stacklevel=2)
            return target.arrays()

    def warn_if_resumed(self) -> None:
        """Warn if only a part of the blocks of a resumed run was there."""
        if self._folder is not None and 0 < self._kept < self._blocks:
            warnings.warn(kept(self._kept, self._blocks, self._folder), ResumeWarning, stacklevel=3)
