"""The settings of a life, and the state after each of its steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from wearlaw import Array
from wearlaw_life._line import Wear

if TYPE_CHECKING:
    from wearlaw_wheelset import Profile


@dataclass(frozen=True)
class Plan:
    """The settings of a life, in SI; see `wear_out`."""

    body: str
    over: float
    depth_step: float
    smoothing: float
    spacing: float
    conicity_step: float
    each: bool
    until: Mapping[str, float]

    @property
    def along(self) -> str:
        """What the life is counted in."""
        return "passages" if self.body == "rail" else "distance"

    def of_profiles(self, values: Array) -> Array:
        """Return values of both sides for each profile: as they are, or their mean."""
        return values if self.each else values.mean(axis=0, keepdims=True)


class State(NamedTuple):
    """The profiles after a step, and what the next step extrapolates.

    Attributes
    ----------
    profiles : tuple of Profile
        One for both sides, or those of the left and the right side.
    row : dict of str to float
        The measures in SI.
    wear : Wear or None
        The wear at the beginning of the step; None at the start.
    step : float
        Distance of the step [m], or passages.
    change : float
        Change of the conicity in the step.
    """

    profiles: tuple[Profile, ...]
    row: dict[str, float]
    wear: Wear | None = None
    step: float = 0.0
    change: float = 0.0
