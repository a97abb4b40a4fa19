"""What an unfinished run of a case has done: a folder with the results of its blocks, until the run is finished."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter

from wearlaw.errors import OutputError
from wearlaw.sweeping.evaluation import Job
from wearlaw.sweeping.journal import Journal, Run, check_same, run_of, write_whole
from wearlaw.sweeping.points import Points
from wearlaw.sweeping.targets import ITEM, Arrays, Memory, damage

RUN, JOURNAL = "run.json", "journal"


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


class Files(Arrays):
    """Results in files that memory maps show, and a journal of what is done.

    A file holds the numbers of one output and nothing else, so that damage to a part of it leaves the rest of use.

    Raises
    ------
    OutputError
        If the files cannot be written, or the journal is damaged or that of another run.
    """

    def __init__(self, job: Job, points: Points, folder: Path) -> None:
        super().__init__(job, points)
        path, run = folder / JOURNAL, run_of(job, points)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            known = path.exists()
            journal = Journal.resume(path, run, folder, self._sync) if known else Journal.begin(path, run, self._sync)
            self._maps = {name: self._mapped(folder / f"{name}.f64") for name in job.units}
        except OutputError:
            raise
        except OSError as error:
            where = error.filename or folder
            raise OutputError(
                f"output: what is done cannot be kept in '{where}': {error.strerror or error};"
                f" remove '{folder}' to begin it anew"
            ) from None
        self.arrays = dict(self._maps)
        self._take_over(journal)

    def _mapped(self, path: Path) -> np.memmap[Any, Any]:
        """Return the map of a file, which is made or brought to its length if need be."""
        path.touch()
        os.truncate(path, self.points.size * ITEM)
        return np.memmap(path, dtype=np.float64, mode="r+", shape=(self.points.size,))

    def _sync(self, _: list[int]) -> None:
        for one in self._maps.values():
            one.flush()
