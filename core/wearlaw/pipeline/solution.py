"""The contacts of a problem and the outcomes of laws in them, as SI arrays; a part of one takes its values from it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, partial
from typing import Any

import numpy as np

from wearlaw.arrays import Array, same
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import CreepForces
from wearlaw.contact.problem import Problem
from wearlaw.errors import CalibrationWarning, InputError, warn
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.law import WEAR, Law
from wearlaw.models.reader import Solved
from wearlaw.numerics import integrate
from wearlaw.numerics.totals import Across, SlipTotals, Totals, each
from wearlaw.pipeline.composition import law_among, other_materials, remark_on_body
from wearlaw.pipeline.ranges import RangeWatch, elastic_limits, outside_range
from wearlaw.pipeline.selection import Selection
from wearlaw.units.quantities import scalar_si


class Solution:
    """The contacts of a problem, and the outcomes of laws in them.

    Arrays have the shape of the batch. What the integration did not give is computed when it is first read. The model
    includes its stages, and the totals are the outcomes of the laws or, without laws, the forces alone.
    `conditions` are those of the pipeline; `whole` is the solution that this one is a part of, and which part.
    """

    def __init__(
        self,
        problem: Problem,
        model: ContactModel,
        laws: tuple[Law, ...],
        totals: Totals,
        conditions: Mapping[str, Any] | None = None,
        whole: tuple[Solution, Selection] | None = None,
    ) -> None:
        self.problem = problem
        self.model = model
        self.laws = laws
        self.totals = totals
        self.conditions = conditions
        self.whole = whole
        self._errors: dict[int, Array] = {}

    def __eq__(self, other: object) -> bool:
        """Return whether another solution is one of the same contacts with the same models."""
        parts = self.problem, self.model, self.laws
        return isinstance(other, Solution) and same(parts, (other.problem, other.model, other.laws))

    def __hash__(self) -> int:
        return hash((self.problem.geometry, self.problem.batch_shape))

    @classmethod
    def of(
        cls,
        model: ContactModel,
        laws: tuple[Law, ...],
        problem: Problem,
        watch: RangeWatch,
        conditions: Mapping[str, Any] | None = None,
    ) -> Solution:
        """Solve the contacts of a problem, without warnings; `watch` sees the operating points."""
        if problem.exists is not None and not problem.size:
            totals = Totals.missing(problem, laws)
        else:
            totals = integrate.integrate_laws(model, laws, problem, watch.see)
        solution = cls(problem, model, laws, totals, conditions)
        for index, law in enumerate(laws):
            if law.outcome.of == "patch":
                law.check_not_negative(totals.values[index])
            else:
                law.check_not_negative(totals.values[index], partial(solution.error, index))
        return solution

    def part(self, chosen: Selection) -> Solution:
        """Return the solution at some entries along the axes; nothing is solved again."""
        totals = each(chosen.of, self.totals._replace(contact=None))
        model = self.model
        if self.totals.contact is not None:
            totals = totals._replace(contact=chosen.of_solved(self.totals.contact, self.problem))
            if isinstance(model, Solved):
                model = model.model_copy(update={"contact": totals.contact})
        return Solution(chosen.of_problem(self.problem), model, self.laws, totals, whole=(self, chosen))

    @cached_property
    def forces(self) -> CreepForces:
        """The forces and the moment."""
        return self.totals.forces or integrate.integrate_forces(self.model, self.problem)

    @property
    def force(self) -> Array:
        """Tangential force [N]: on a line with its sign, otherwise its magnitude."""
        return self.forces.longitudinal if self.problem.geometry == "line" else self.forces.tangential

    @property
    def power(self) -> Array:
        """Energy dissipated per metre rolled, Tγ [N]."""
        return self.problem.power(self.forces)

    @cached_property
    def elastic_limits(self) -> tuple[Array, Array]:
        """Maximum pressure at first yield and at the shakedown limit [Pa]."""
        return elastic_limits(self.problem, np.abs(self.force))

    @property
    def outside_range(self) -> Array:
        """1 where a point lies outside the range or the materials of a law, otherwise 0; NaN for missing patches."""
        problem, totals = self.problem, Totals(forces=self.forces, patch_area=self.patch_area)
        if not self.laws:
            self.law()  # raises
        outside = np.zeros(problem.batch_shape)
        for law in self.laws:
            outside[outside_range(problem, totals, law) | bool(other_materials(problem.bodies, law))] = 1.0
        return outside if problem.exists is None else np.where(problem.exists, outside, np.nan)

    @cached_property
    def slip(self) -> SlipTotals:
        """The slip of the patch."""
        if self.totals.slip is not None:
            return self.totals.slip
        if self.whole is not None:
            whole, chosen = self.whole
            return each(chosen.of, whole.slip)  # type: ignore[no-any-return]
        return integrate.integrate_slip(self.model, self.problem, self.totals.contact)

    @cached_property
    def patch_area(self) -> Array:
        """Area of the patch [m²]."""
        if self.totals.patch_area is not None:
            return self.totals.patch_area
        if self.laws:
            return self.problem.patch_area
        if self.whole is not None:
            whole, chosen = self.whole
            return chosen.of(whole.patch_area)
        return integrate.patch_area(self.model, self.problem)

    @cached_property
    def contact(self) -> Contact:
        """The solved contact."""
        if self.totals.contact is not None:
            return self.totals.contact.unflattened(self.problem)
        if self.whole is not None and self.problem.size == 0:  # a missing patch alone has no nodes
            whole, chosen = self.whole
            return whole.contact.mapped(chosen.of).replaced(problem=self.problem)
        if self.problem.geometry != "line" or len(self.laws) != 1:
            return integrate.solve(self.model, self.problem)
        return integrate.contact_for(self.model, self.laws[0], self.problem.flatten()).unflattened(self.problem)

    def law(self, outcome: str = WEAR, body: str | None = None) -> int:
        """Return the index of the law of an outcome, for a body if it is given."""
        return law_among(self.laws, self.model, outcome, body)

    def value(self, index: int, body: str | None = None) -> Array:
        """Return the outcome of a law; one for every body is evaluated again for a body of another material."""
        if body is None or self._holds_for(index, body):
            return self.totals.values[index]
        return integrate.integrate_laws(self.model, (self._law_of(index, body),), self.problem).values[0]

    def mass_per_distance(self, body: str | None = None) -> Array:
        """Return the mass that a body loses per metre rolled [kg/m]."""
        return self.value(self.law(body=body), body) * self.patch_area

    def section_per_distance(self, body: str) -> Array:
        """Return the area of a radial section that a body loses per distance rolled [m²/m]."""
        density = scalar_si(self.problem.body(body).material.density, "kg/m^3")
        return self.mass_per_distance(body) / (density * self.circumference(body))

    def circumference(self, body: str) -> Array:
        """Return the circumference of a body that turns [m]."""
        radius = np.asarray(self.problem.body(body).rolling_radius)
        if np.isinf(radius).any():
            fix = f'name the other body, or take wear_profile("{body}"), which is per passage'
            raise InputError(f"body: {body} makes no revolutions; {fix}")
        return 2.0 * np.pi * radius

    def error(self, index: int) -> Array:
        """Return an estimate of the numerical error of the outcome of a law."""
        if self.whole is not None:
            whole, chosen = self.whole
            return chosen.of(whole.error(index))
        if index not in self._errors:
            law = self.laws[index]
            self._errors[index] = integrate.outcome_error(self.model, law, self.problem, self.totals, index)
        return self._errors[index]

    def error_with_energy(self, index: int) -> Array:
        """Return the numerical error of an outcome and, without energy balance, that of the energy that nodes lack."""
        error, model = self.error(index), self.model
        lacks = self.laws[index].outcome.of == "area mean" and "energy_balance" in model.exemptions
        if not lacks or model.scale != "cells":
            return error
        dissipated = self.slip.cell_wear_index
        lacking = np.abs(self.power - dissipated)
        none = dissipated <= 0.0  # False for the NaN of a missing patch
        share = np.divide(lacking, dissipated, out=np.zeros_like(dissipated), where=~none)
        return error + np.where(none & (lacking > 0.0), np.inf, np.abs(self.totals.values[index]) * share)

    def across(self, index: int, body: str, strips: int | None) -> Across:
        """Return the wear and slip of a law along strips, which are NaN for missing patches."""
        kept = self.totals.across[index] if strips is None and self._holds_for(index, body) else None
        if kept is not None:
            return kept
        if self.problem.size == 0:  # a missing patch alone has no strips
            if self.whole is None:
                return Across.missing(self.problem)
            whole, chosen = self.whole
            return each(chosen.of, whole.across(index, body, strips))  # type: ignore[no-any-return]
        law = self._law_of(index, body)
        return integrate.integrate_across(self.model, law, self.problem, strips, self.totals.contact)

    def _holds_for(self, index: int, body: str) -> bool:
        """Return whether the results of a law hold for a body; warn if the law was fitted to the other one."""
        problem, law = self.problem, self.laws[index]
        worn = problem.worn_on(body)  # raises unless it is one of the bodies
        if law.body is None and (text := remark_on_body(problem.bodies, law, body)):
            warn(text, CalibrationWarning)
        return worn is problem or law.body is not None or problem.size == 0

    def _law_of(self, index: int, body: str) -> Law:
        law = self.laws[index]
        return law if law.body is not None else law.model_copy(update={"body": body})
