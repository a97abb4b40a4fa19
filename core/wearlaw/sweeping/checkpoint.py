"""Evaluating the sweeps of a case, with a folder of finished blocks until the run is complete."""

from __future__ import annotations

import json
import os
import shutil
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path

from pydantic import TypeAdapter

from wearlaw.arrays.array import Array
from wearlaw.errors import OutputError, quoted
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.variables import outcome_units
from wearlaw.sweeping.evaluation import Job
from wearlaw.sweeping.journal import Run, check_same, write_whole
from wearlaw.sweeping.lock import HeldError, Lock
from wearlaw.sweeping.points import Points
from wearlaw.sweeping.storage import Arrays, Files, Memory, damage
from wearlaw.sweeping.sweep import check_importable, run
from wearlaw.units.variables import UNITS

RUN = "run.json"

LOCK = "lock"
"""File that is locked while a run uses the folder."""


class Checkpoint:
    """Folder of finished blocks, created once a sweep needs more than one.

    Parameters
    ----------
    folder : Path
        Path of the folder.
    run : dict
        Description of the run, as JSON.
    resume : bool
        Whether to go on from the blocks in an existing folder.

    Raises
    ------
    OutputError
        If the folder exists and is not to be resumed, belongs to another run, or is damaged.

    Attributes
    ----------
    exists : bool
        Whether the folder exists.
    listed, damaged : int
        Number of blocks that an interrupted run left, and of those among them that are damaged and computed again.
    """

    def __init__(self, folder: Path, run: Run, resume: bool) -> None:
        self.folder = folder
        self.listed = self.damaged = 0
        self._run: Run = json.loads(json.dumps(run))
        self._lock: Lock | None = None
        self.exists = os.path.lexists(folder)
        if self.exists and self._only_begun():
            shutil.rmtree(folder, ignore_errors=True)
            self.exists = os.path.lexists(folder)
        if not self.exists:
            return
        if not (folder / RUN).is_file():
            raise OutputError(
                f"output: {quoted(folder)} is in the way, and holds no unfinished run; remove or rename it"
            )
        self._hold()
        try:
            if not resume:
                raise OutputError(
                    f"output: {quoted(folder)} holds the finished blocks of an interrupted run; add --resume to go on"
                    " with it, remove it, or choose another folder with -o"
                )
            check_same(folder, self._before(), self._run)
        except BaseException:
            self.close()
            raise

    def target(self, key: str, job: Job, points: Points) -> Arrays:
        """Return the target for the results of the sweep named `key` in the run."""
        if len(points.blocks()) == 1:
            return Memory(job, points)
        if not self.exists:
            self._make()
        files = Files(job, points, self.folder / key)
        self.listed += files.listed
        self.damaged += files.damaged
        return files

    def _make(self) -> None:
        """Create the folder; raise an error if another run has created it meanwhile."""
        try:
            self.folder.parent.mkdir(parents=True, exist_ok=True)
            self.folder.mkdir()
            self.exists = True
            self._hold()
            write_whole(self.folder / RUN, json.dumps(self._run))
        except FileExistsError:
            raise OutputError(
                f"output: {quoted(self.folder)} was meanwhile created by another run; choose another folder with -o"
            ) from None
        except OSError as error:
            raise OutputError(
                f"output: cannot write to {quoted(self.folder)}: {error.strerror or error}; choose another folder with"
                " -o"
            ) from None

    def notes(self) -> list[str]:
        """Return a remark about damaged blocks, if there were any."""
        return [damage(self.damaged, self.listed, self.folder)] if self.damaged else []

    def _before(self) -> Run:
        """Return the description of the run in the folder."""
        try:
            run = TypeAdapter(Run).validate_json((self.folder / RUN).read_bytes())
        except (OSError, ValueError):
            path = self.folder / RUN
            raise OutputError(
                f"output: {quoted(path)} is not the record of a run; remove {quoted(self.folder)} to start again"
            ) from None
        return run

    def _only_begun(self) -> bool:
        """Return whether a run was killed between its first steps, before it had anything to keep."""
        if not self.folder.is_dir() or not {one.name for one in self.folder.iterdir()} <= {LOCK, f"{RUN}.partial"}:
            return False
        lock = Lock.given_up(self.folder / LOCK)
        if lock is not None:
            lock.close()
        return lock is not None

    def _hold(self) -> None:
        """Keep other runs out of the folder; raise an error if another run is using it."""
        try:
            self._lock = Lock(self.folder / LOCK)
        except HeldError:
            raise OutputError(
                f"output: {quoted(self.folder)} belongs to a run that is still going on; wait for its end, or choose"
                " another folder with -o"
            ) from None

    def close(self) -> None:
        """Let other runs use the folder."""
        if self._lock is not None:
            self._lock.close()


class Evaluator:
    """Evaluates pipelines at points.

    Parameters
    ----------
    on_block : callable
        Called with the number of evaluations just done.
    workers : int
        Number of processes.
    checkpoint : Checkpoint, optional
        Folder in which an interrupted run keeps finished blocks.
    """

    def __init__(self, on_block: Callable[[int], None], workers: int, checkpoint: Checkpoint | None) -> None:
        self._on_block = on_block
        self._workers = workers
        self._checkpoint = checkpoint

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
        workers = min(self._workers, len(points.blocks()))
        if workers > 1:
            check_importable(pipeline)
        target = self._checkpoint.target(key, job, points) if self._checkpoint else Memory(job, points)
        with closing(target):
            for warning in run(target, self._on_block, workers):
                warnings.warn(warning, stacklevel=2)
        return {name: values.reshape(points.shape + job.own_shape) for name, values in target.arrays.items()}
