"""What an unfinished run of a case has done: a folder with the results of its blocks, until the run is finished."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np

from wearlaw.errors import OutputError
from wearlaw.sweeping.evaluation import Job, Seen
from wearlaw.sweeping.journal import Journal, Run, check_same, run_of, write_whole
from wearlaw.sweeping.points import Points
from wearlaw.sweeping.targets import Arrays, Memory

RUN, JOURNAL = "run.json", "journal"


class Checkpoint:
    """A folder for what is done so far; there is none as long as nothing takes more than one block.

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
    """

    def __init__(self, folder: Path, run: Run, resume: bool) -> None:
        self.folder = folder
        self._run: Run = json.loads(json.dumps(run))
        if not folder.exists():
            return
        if not (folder / RUN).is_file():
            raise OutputError(f"output: '{folder}' is in the way, and holds no unfinished run; remove or rename it")
        if not resume:
            raise OutputError(
                f"output: '{folder}' holds what an interrupted run has done; go on with it by --resume, or remove it"
            )
        check_same(folder, self._before(), self._run)

    def target(self, key: str, job: Job, points: Points) -> Arrays:
        """Return where the results go of what has the name `key` in the run."""
        if len(points.blocks()) == 1:
            return Memory(job, points)
        if not (self.folder / RUN).exists():
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self.folder / RUN, json.dumps(self._run))
        return Files(job, points, self.folder / key)

    def _before(self) -> Run:
        """Return what the folder holds a part of."""
        try:
            run: Run = json.loads((self.folder / RUN).read_bytes())
        except ValueError:
            path = self.folder / RUN
            raise OutputError(
                f"output: '{path}' is no record of a run; remove '{self.folder}' and begin anew"
            ) from None
        return run

    def remove(self) -> None:
        """Remove the folder, since the results are elsewhere."""
        shutil.rmtree(self.folder, ignore_errors=True)


class Files(Arrays):
    """Results in files that memory maps show, and a journal of what is done."""

    def __init__(self, job: Job, points: Points, folder: Path) -> None:
        super().__init__(job, points)
        path, run = folder / JOURNAL, run_of(job, points)
        known = path.is_file()
        folder.mkdir(parents=True, exist_ok=True)
        self.arrays = {
            name: np.lib.format.open_memmap(
                folder / f"{name}.npy", mode="r+" if known else "w+", dtype=np.float64, shape=(points.size,)
            )
            for name in job.units
        }
        self._journal = Journal.resume(path, run, folder) if known else Journal.begin(path, run)
        self.done = dict(self._journal.done)

    def add(self, number: int, seen: Seen) -> None:
        """Take note that a block is done, also on disk."""
        super().add(number, seen)
        self._journal.add(number, seen)

    def close(self) -> None:
        """Leave the files as they are."""
        self._journal.close()
