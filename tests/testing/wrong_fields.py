"""Contact models whose optional methods do not follow from their fields, made from Carter's."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import wearlaw as wl

Exact: Any = type(wl.contact_model("exact"))


class SlipsBeforeTheZone(Exact):  # type: ignore[misc]
    """Slips a little, and for a millionth of the zone, in front of it."""

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields: wl.LineFields = super().fields(problem, nodes)
        length = self.slip_length(problem)
        in_front = (nodes.from_trailing > length) & (nodes.from_trailing < (1.0 + 1e-6) * length)
        return dataclasses.replace(fields, slip=np.where(in_front, 1e-9 * problem.creepage, fields.slip))


class SlipZoneBeyondThePatch(Exact):  # type: ignore[misc]
    """In full slip, the slip zone is longer than the patch by 1e-12."""

    def slip_length(self, problem: wl.Problem) -> Any:
        length = super().slip_length(problem)
        return np.where(length < 2.0 * problem.half_width, length, length * (1.0 + 1e-12))


class ForceOfAnother(Exact):  # type: ignore[misc]
    """The force alone is larger than that of the contact."""

    def tangential_force(self, problem: wl.Problem) -> Any:
        return super().tangential_force(problem) * (1.0 + 1e-12)


class CrossingAside(Exact):  # type: ignore[misc]
    """The slip crosses a value a billionth of the patch aside."""

    def crossings(self, problem: wl.Problem, variable: wl.FieldVariable, value: Any) -> Any:
        found = super().crossings(problem, variable, value)
        return found if found is None else found + 2e-9 * problem.half_width[..., None]


class OneCrossingOfTwo(Exact):  # type: ignore[misc]
    """The pressure crosses a value at the trailing edge only."""

    def crossings(self, problem: wl.Problem, variable: wl.FieldVariable, value: Any) -> Any:
        found = super().crossings(problem, variable, value)
        return found if found is None else found[..., :1]


class TooMuchExcess(Exact):  # type: ignore[misc]
    """The energy above a threshold is too large by 1e-9."""

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        return super().excess_dissipation(problem, threshold) * (1.0 + 1e-9)


class NegativeExcess(Exact):  # type: ignore[misc]
    """The energy above what is never reached is less than nothing."""

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        found = super().excess_dissipation(problem, threshold)
        return np.where(found == 0.0, -1e-30, found)


def _arrays(excess: Any) -> Any:
    return excess


@wl.kernel(_arrays)
def nearly(excess: float) -> float:
    """Return a little more than its arrays."""
    return excess * (1.0 + 1e-9)


class KernelOfExcessDiffers(Exact):  # type: ignore[misc]
    """The formula of a kernel for one point is not that of its arrays."""

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        return nearly(super().excess_dissipation(problem, threshold))


CAUGHT: dict[Any, str] = {
    SlipsBeforeTheZone: "slip_lies_in_the_slip_zone",
    SlipZoneBeyondThePatch: "slip_lies_in_the_slip_zone",
    ForceOfAnother: "forces_alone_are_those_of_the_contact",
    CrossingAside: "crossings_are_where_the_fields_cross",
    OneCrossingOfTwo: "crossings_are_where_the_fields_cross",
    TooMuchExcess: "excess_dissipation_is_that_of_the_fields",
    NegativeExcess: "excess_dissipation_is_that_of_the_fields",
    KernelOfExcessDiffers: "acceleration_does_not_matter",
}
"""The check that must catch each."""
