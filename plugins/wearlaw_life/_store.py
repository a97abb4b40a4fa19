"""The store of a life: one group of zarr, with a group for each finished step."""

from __future__ import annotations

import json
import os
import shutil
import warnings
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, Self

import filelock
import numpy as np
import zarr
from zarr.codecs import Crc32cCodec

import wearlaw as wl
from wearlaw_life._line import Line, Wear
from wearlaw_life._state import Plan, State
from wearlaw_sweeps.provenance import check_same, provenance_of

PROVENANCE = "provenance"
"""Attribute of the group with what determines the life."""


class Store:
    """Finished steps in a folder, of which one process at a time is the writer.

    Every array has a checksum. A step that is missing or damaged ends what is kept: the life goes on from there.

    Raises
    ------
    OutputError
        If the folder holds anything but this life, or holds it and `resume` is false, or another process writes it.
    """

    def __init__(
        self, path: str | os.PathLike[str], resume: bool, predict: wl.Pipeline[...], line: Line, plan: Plan
    ) -> None:
        self.path, self._kind = Path(path), type(getattr(predict.rig, plan.body))
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._lock = filelock.FileLock(f"{self.path.absolute()}.lock", blocking=False)
        now = provenance_of(line.job, line.points)
        now["life"] = json.loads(json.dumps(asdict(plan)))
        try:
            self._lock.acquire()
        except filelock.Timeout:
            raise wl.OutputError(
                f"store: {wl.shown(path)} is being written by another process; wait for its end"
            ) from None
        try:
            self._begin(resume, now)
        except BaseException:
            self._unlock()
            raise

    def _begin(self, resume: bool, now: dict[str, Any]) -> None:
        self._kept: list[State] = []
        if not self.path.exists() or not any(self.path.iterdir()):
            zarr.create_group(str(self.path), zarr_format=3, attributes={PROVENANCE: json.dumps(now)})
            return
        try:
            before = json.loads(str(zarr.open_group(str(self.path), mode="r").attrs[PROVENANCE]))
            before["life"]
        except (OSError, ValueError, KeyError, TypeError):
            raise wl.OutputError(
                f"store: {wl.shown(self.path)} is not empty, and holds no life; choose another folder"
            ) from None
        if not resume:
            raise wl.OutputError(
                f"store: {wl.shown(self.path)} holds a life; add resume=True, choose another folder, or remove it"
            )
        check_same(self.path, before, now)
        while (state := self._read(len(self._kept))) is not None:
            self._kept.append(state)
        for later in self.path.glob("step_*"):
            if int(later.name[5:]) >= len(self._kept):
                shutil.rmtree(later)
        if self._kept:
            text = f"{len(self._kept) - 1} steps are kept in {wl.shown(self.path)}; the life goes on from there"
            warnings.warn(text, wl.ResumeWarning, stacklevel=5)

    def states(self) -> list[State]:
        """Return the start and the finished steps."""
        return list(self._kept)

    def add(self, state: State) -> None:
        """Write the start or a finished step; its record comes last."""
        group = zarr.open_group(str(self.path), mode="r+").create_group(self._name(len(self._kept)))
        arrays: dict[str, Any] = {
            f"profile_{side}": np.frombuffer(one.model_dump_json().encode(), dtype=np.uint8)
            for side, one in enumerate(state.profiles)
        }
        if state.wear is not None:
            arrays |= {"depth": state.wear.depth, "mass": state.wear.mass}
        for name, values in arrays.items():
            array = group.create_array(name, shape=values.shape, dtype=values.dtype, compressors=Crc32cCodec())
            array[...] = values
        group.attrs["record"] = json.dumps(
            {"row": state.row, "step": state.step, "change": state.change, "arrays": list(arrays)}
        )
        self._kept.append(state)

    @staticmethod
    def _name(number: int) -> str:
        return f"step_{number:05d}"

    def _read(self, number: int) -> State | None:
        """Return a step, or None if it is missing or damaged."""
        try:
            group: Any = zarr.open_group(str(self.path), path=self._name(number), mode="r")
            record = json.loads(str(group.attrs["record"]))
            found = {name: np.asarray(group[name][...]) for name in record["arrays"]}
        except (OSError, ValueError, KeyError):
            return None
        texts = (values.tobytes() for name, values in found.items() if name.startswith("profile"))
        profiles = tuple(self._kind.model_validate_json(text) for text in texts)
        wear = Wear(found["depth"], found["mass"]) if "depth" in found else None
        return State(profiles, record["row"], wear, record["step"], record["change"])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._unlock()

    def _unlock(self) -> None:
        with suppress(OSError):  # Windows keeps a file in use, and removes it afterwards
            Path(self._lock.lock_file).unlink()
        self._lock.release()
