"""The base class of contact models with closed-form fields on a line: `LineContactModel`."""

from __future__ import annotations

import dataclasses
from abc import abstractmethod
from typing import Literal, TypeAlias

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact, LineFields
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import Nodes, Zone, join
from wearlaw.models.contact_model import ContactModel

FieldVariable: TypeAlias = Literal["pressure", "traction", "slip", "wear_index_density"]
"""A variable of the nodes that depends on the fields alone."""


class LineContactModel(ContactModel):
    """Base class for contact models with closed-form fields and one slip zone, at the trailing edge.

    The wear is integrated to rounding error. The methods are only called with creepage ≥ 0; `solve` mirrors the result
    for negative creepage. Methods that return None by default are optional; they only save time.
    """

    @property
    def square_roots_at(self) -> Literal["slip_zone", "patch"]:
        """The interval with square-root behaviour of pressure, traction and slip at its ends.

        "slip_zone" suits elastic half-spaces. "patch" suits models with smooth slip up to the start of the slip zone.
        """
        return "slip_zone"

    @abstractmethod
    def slip_length(self, problem: Problem) -> Array:
        """Return the length of the slip zone, which ends at the trailing edge [m]; 0 if nothing slips."""

    @abstractmethod
    def fields(self, problem: Problem, nodes: Nodes) -> LineFields:
        """Return the fields at `nodes`; their positions have the shape (batch, nodes) or broadcast to it.

        The arrays of `problem` have a last axis of length one, and those of one operating point no axis, so that
        formulas broadcast against positions.
        """

    @abstractmethod
    def tangential_force_per_width(self, problem: Problem) -> Array:
        """Return T [N/m], of the batch shape."""

    def crossings(self, problem: Problem, variable: FieldVariable, value: Array) -> Array | None:  # noqa: ARG002
        """Return the positions in the slip zone where a variable crosses a value, or None to let wearlaw search.

        Parameters
        ----------
        problem : Problem
            With a batch of any shape.
        variable : str
            "pressure" [Pa], "traction" [Pa], "slip" [-] or "wear_index_density" [N/m²].
        value : ndarray, (batch)
            In SI.

        Returns
        -------
        ndarray, (batch, k), or None
            Distances from the trailing edge [m]; NaN, or any value beyond the slip zone, if there is no crossing.
        """
        return None

    def excess_dissipation(self, problem: Problem, threshold: float | Array) -> Array | None:  # noqa: ARG002
        """Return ∫ max(q·s - threshold, 0) dx over the patch [N/m], of the batch shape, or None if not known.

        `threshold` [N/m²] is positive, a single number or an array of the batch shape.
        """
        return None

    def tangential_force(self, problem: Problem) -> Array:
        """Return T [N] with the sign of the creepage."""
        return self._mirrored_force(problem) * problem.track_width

    def _mirrored_force(self, problem: Problem) -> Array:
        return np.copysign(self.tangential_force_per_width(problem.forward()), problem.creepage)

    def zones(self, problem: Problem) -> tuple[Zone, Zone]:
        """Return the stick zone, measured from the leading edge, and the slip zone, measured from the trailing edge."""
        over_patch, length = self.square_roots_at == "patch", self.slip_length(problem.forward())
        stick = Zone.of(problem.half_width, 2.0 * problem.half_width - length, over_patch)
        return stick, Zone.of(problem.half_width, length, over_patch)

    def at(self, problem: Problem, nodes: Nodes) -> Contact:
        """Return the contact on the given nodes, mirrored where the creepage is negative."""
        forward = problem.forward()
        fields = self.fields(forward[..., None] if forward.batch_shape else forward, nodes)
        if not (problem.creepage > 0.0).all():
            sign = np.sign(problem.creepage)[..., None]
            fields = dataclasses.replace(fields, traction=sign * fields.traction, slip=sign * fields.slip)
        force = self._mirrored_force(problem)
        return Contact.from_line(problem, fields, x=nodes.x, length=nodes.length, force_per_width=force)

    def solve_line(self, problem: Problem) -> Contact:
        """Return the contact on quadrature nodes of the stick zone and the slip zone."""
        stick, slip = self.zones(problem)
        sticks, nodes = stick.length.any(), slip.nodes()
        return self.at(problem, join(stick.nodes().reversed(), nodes) if sticks else nodes)
