"""Evaluating the sweeps of a case, with a folder that keeps what is done until the run is finished."""

from __future__ import annotations

import json
import os
import shutil
import warnings
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path

from pydantic import TypeAdapter

from wearlaw.arrays.array import Array
from wearlaw.errors import OutputError, RangeWarning
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.variables import UNITS
from wearlaw.sweeping.evaluation import Job
from wearlaw.sweeping.journal import Run, check_same, write_whole
from wearlaw.sweeping.points import Points
from wearlaw.sweeping.storage import Arrays, Files, Memory, damage
from wearlaw.sweeping.sweep import check_importable, run

RUN = "run.json"


class Checkpoint:
    """A folder of finished blocks, made once a sweep has more than one.

    Parameters
    ----------
    folder : Path
        Where it is.
    run : dict
        What is run, as JSON holds it.
    resume : bool
        Whether to go on with what the folder holds, if there is one.

    Raises
    ------
    OutputError
        If there is one that is not to be resumed, or that is of another run or spoilt.

    Attributes
    ----------
    exists : bool
        Whether there is a folder of this run.
    listed, damaged : int
        How many blocks an interrupted run has left, and how many of them are damaged and computed again.
    """

    def __init__(self, folder: Path, run: Run, resume: bool) -> None:
        self.folder = folder
        self.listed = self.damaged = 0
        self._run: Run = json.loads(json.dumps(run))
        self.exists = os.path.lexists(folder)
        if not self.exists:
            return
        if not (folder / RUN).is_file():
            raise OutputError(f"output: '{folder}' is in the way, and holds no unfinished run; remove or rename it")
        if not resume:
            raise OutputError(
                f"output: '{folder}' holds what an interrupted run has done, or one that is still at work;"
                " go on with it by --resume, remove it, or choose another folder with -o"
            )
        check_same(folder, self._before(), self._run)

    def target(self, key: str, job: Job, points: Points) -> Arrays:
        """Return where the results go of what has the name `key` in the run."""
        if len(points.blocks()) == 1:
            return Memory(job, points)
        if not self.exists:
            self._make()
        files = Files(job, points, self.folder / key)
        self.listed += files.listed
        self.damaged += files.damaged
        return files

    def _make(self) -> None:
        """Make the folder, which no other run may have made meanwhile."""
        try:
            self.folder.parent.mkdir(parents=True, exist_ok=True)
            self.folder.mkdir()
            self.exists = True
            write_whole(self.folder / RUN, json.dumps(self._run))
        except FileExistsError:
            raise OutputError(
                f"output: '{self.folder}' was made by another run meanwhile; choose another folder with -o"
            ) from None
        except OSError as error:
            raise OutputError(
                f"output: cannot write to '{self.folder}': {error.strerror or error}; choose another folder with -o"
            ) from None

    def notes(self) -> list[str]:
        """Return what is to be said of damage to what was done."""
        return [damage(self.damaged, self.listed, self.folder)] if self.damaged else []

    def _before(self) -> Run:
        """Return what the folder holds a part of."""
        try:
            run = TypeAdapter(Run).validate_json((self.folder / RUN).read_bytes())
        except (OSError, ValueError):
            path = self.folder / RUN
            raise OutputError(
                f"output: '{path}' is no record of a run; remove '{self.folder}' and begin anew"
            ) from None
        return run

    def remove(self) -> None:
        """Remove the folder, since the results are elsewhere."""
        if self.exists:
            shutil.rmtree(self.folder, ignore_errors=True)


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
            for note in run(target, self._on_block, workers):
                warnings.warn(note, RangeWarning, stacklevel=2)
        return {name: values.reshape(points.shape) for name, values in target.arrays.items()}
