"""The store of a life: a part for the start, and one for each finished step."""

from __future__ import annotations

import json
import os
import warnings
from dataclasses import asdict
from typing import Any

import numpy as np

import wearlaw as wl
from wearlaw_life._line import Line, Wear
from wearlaw_life._state import Plan, State
from wearlaw_sweeps.folder import Parts
from wearlaw_sweeps.provenance import provenance_of


class Store:
    """Finished steps in a folder. A step that is missing or damaged ends what is kept: the life goes on from there."""

    def __init__(
        self, path: str | os.PathLike[str], resume: bool, predict: wl.Pipeline[...], line: Line, plan: Plan
    ) -> None:
        settings = {"life": json.loads(json.dumps(asdict(plan)))}
        self._parts = Parts(path, provenance_of(line.job, line.points) | settings, resume, "life")
        self._kind = type(getattr(predict.rig, plan.body))
        self.states: list[State] = []
        while self._parts.resumed and (state := self._read(len(self.states))) is not None:
            self.states.append(state)
        if self.states:
            text = f"{len(self.states) - 1} steps are kept in {wl.shown(path)}; the life goes on from there"
            warnings.warn(text, wl.ResumeWarning, stacklevel=4)

    def add(self, number: int, state: State) -> None:
        """Write the start or a finished step."""
        arrays: dict[str, Any] = {
            f"profile_{side}": np.frombuffer(one.model_dump_json().encode(), dtype=np.uint8)
            for side, one in enumerate(state.profiles)
        }
        if state.wear is not None:
            arrays |= state.wear._asdict()
        self._parts.add(number, arrays, {"row": state.row, "step": state.step, "change": state.change})

    def _read(self, number: int) -> State | None:
        part = self._parts[number]
        if part is None:
            return None
        arrays = part.arrays
        texts = (values.tobytes() for name, values in arrays.items() if name.startswith("profile"))
        profiles = tuple(self._kind.model_validate_json(text) for text in texts)
        wear = Wear(arrays["depth"], arrays["mass"]) if "depth" in arrays else None
        return State(profiles, wear=wear, **part.record)

    def close(self) -> None:
        """Let other processes write the folder."""
        self._parts.close()
