"""Evaluating the sweeps of a case, on any number of processes, with a checkpoint for what takes long."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from contextlib import closing

from wearlaw.arrays.array import Array
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.variables import UNITS
from wearlaw.sweeping.checkpoint import Checkpoint
from wearlaw.sweeping.evaluation import Job
from wearlaw.sweeping.points import Points
from wearlaw.sweeping.sweep import check_importable, run
from wearlaw.sweeping.targets import Memory


class Evaluator:
    """Evaluates pipelines at points.

    Parameters
    ----------
    on_block : callable
        Called with the number of evaluations done.
    workers : int
        How many processes take part.
    checkpoint : Checkpoint, optional
        Where an interrupted run leaves what is done.
    """

    def __init__(self, on_block: Callable[[int], None], workers: int, checkpoint: Checkpoint | None) -> None:
        self._on_block = on_block
        self._workers = workers
        self._checkpoint = checkpoint

    def __call__(self, key: str, pipeline: Pipeline[...], points: Points, outputs: Sequence[str]) -> dict[str, Array]:
        """Return outputs in the units of `variables.UNITS`, of the shape of the points; `key` names them in the run."""
        job = Job(pipeline, {name: UNITS[name] for name in outputs})
        workers = min(self._workers, len(points.blocks()))
        if workers > 1:
            check_importable(pipeline)
        target = self._checkpoint.target(key, job, points) if self._checkpoint else Memory(job, points)
        with closing(target):
            for warning in run(target, self._on_block, workers):
                warnings.warn(warning, stacklevel=2)
        return {name: values.reshape(points.shape) for name, values in target.arrays.items()}
