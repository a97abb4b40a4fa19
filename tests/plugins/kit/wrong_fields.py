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


class ForceOfAnother(Exact):  # type: ignore[misc]
    """The force alone is larger than that of the contact."""

    def tangential_force(self, problem: wl.Problem) -> Any:
        return super().tangential_force(problem) * (1.0 + 1e-12)


class CrossingAside(Exact):  # type: ignore[misc]
    """The slip crosses a value a thousandth of the patch aside."""

    def crossings(self, problem: wl.Problem, variable: wl.FieldVariable, value: Any) -> Any:
        found = super().crossings(problem, variable, value)
        return found if found is None else found + 2e-3 * problem.half_width[..., None]


class TooMuchExcess(Exact):  # type: ignore[misc]
    """The energy above a threshold is too large by 1e-4."""

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        return super().excess_dissipation(problem, threshold) * (1.0 + 1e-4)


class ExcessOfCompiledLoopDiffers(Exact):  # type: ignore[misc]
    """A little more energy above a threshold where loops are compiled."""

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        return super().excess_dissipation(problem, threshold) * (1.0 + 1e-6 * wl.accelerated(problem.size))


CAUGHT: dict[Any, str] = {
    SlipsBeforeTheZone: "what_sticks_does_not_slip",
    ForceOfAnother: "forces_alone_are_those_of_the_contact",
    CrossingAside: "closed_forms_are_those_of_the_fields",
    TooMuchExcess: "closed_forms_are_those_of_the_fields",
    ExcessOfCompiledLoopDiffers: "acceleration_does_not_matter",
}
"""The check that must catch each."""
