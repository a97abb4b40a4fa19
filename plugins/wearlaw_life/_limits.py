"""Limits of measures, which end a life."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw.units.registry import unit_in_si
from wearlaw_life._life import SIDES, name_and_unit

NEAR = 1e-9
"""Share of the way to a limit at which it counts as reached."""


class Limits:
    """Values of measures that end a life: the distance, and those that the user gives.

    Parameters
    ----------
    until : mapping
        As in `wear_out`. A measure that each side has for itself ends the life with the first side.
    over : float
        The distance, in the unit of its column.
    start : mapping of str to float
        The measures at the start by their columns, with the distance first.

    Attributes
    ----------
    ends : dict of str to float
        The limits by their columns, in the units there.

    Raises
    ------
    InputError
        If these profiles lack a measure.
    """

    def __init__(self, until: Mapping[str, wl.QuantityLike | float], over: float, start: Mapping[str, float]) -> None:
        along, *others = start
        there = {name_and_unit(column)[0]: column for column in others if math.isfinite(start[column])}
        self._start = start
        self.ends: dict[str, float] = {}
        for name, limit in until.items():
            names = [name] if name in there else [f"{name}{side}" for side in SIDES[2] if f"{name}{side}" in there]
            if not names:
                raise wl.InputError(f"until: this profile has no {wl.shown(name)}; it has {', '.join(there)}")
            unit, what = name_and_unit(there[names[0]])[1], f"until: {name}"
            value = wl.Unit(unit).si(limit, what) / unit_in_si(unit) if unit else wl.coefficient(limit, what)
            self.ends |= {there[one]: float(value) for one in names}
        self.ends[along] = over

    def _way(self, row: Mapping[str, float]) -> Array:
        """Return the shares of the ways from the start to each limit."""
        start = self._start
        return np.array([(row[one] - start[one]) / (end - start[one]) for one, end in self.ends.items()])

    def reached(self, row: Mapping[str, float]) -> str:
        """Return the measure that is at its limit, "over" for the distance, "" if the life goes on."""
        *names, _ = map(name_and_unit, self.ends)
        for (name, _), way in zip([*names, ("over", "")], self._way(row), strict=True):
            if way >= 1.0 - NEAR:
                return name
        return ""

    def share(self, before: Mapping[str, float], after: Mapping[str, float]) -> float:
        """Return the share of a step at which the first measure reaches its limit, one if none does."""
        old, new = self._way(before), self._way(after)
        return float(((1.0 - old) / (new - old))[new > 1.0].min(initial=1.0))
