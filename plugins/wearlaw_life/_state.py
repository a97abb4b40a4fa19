"""The settings of a life, and the state after each of its steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

import wearlaw as wl
from wearlaw_life._line import Wear
from wearlaw_life._removal import Profile

Side = Literal["mean", "left", "right"]


@dataclass(frozen=True)
class Plan:
    """The settings of a life, in SI; see `wear_out`."""

    body: str
    over: float
    depth_step: float
    smoothing: float
    spacing: float
    conicity_step: float
    amplitude: float
    side: Side
    until: Mapping[str, float]
    sides: int = 1


class State(NamedTuple):
    """A profile after a step, its measures, and what the next step extrapolates.

    Attributes
    ----------
    profile : Profile
    row : dict of str to float
        The measures in SI.
    wear : Wear or None
        The wear at the beginning of the step; None at the start.
    step : float
        Distance of the step [m], or passages.
    change : float
        Change of the conicity in the step.
    pipeline : Pipeline or None
        The pipeline with the profile, if it is made already.
    """

    profile: Profile
    row: dict[str, float]
    wear: Wear | None = None
    step: float = 0.0
    change: float = 0.0
    pipeline: wl.Pipeline[...] | None = None
