"""Checks that results do not depend on the units of parameters and conditions, or on how loops are compiled.

A value converted to another unit and back has four rounding errors of half of EPS, from two factors and two products.
A step of `STEP` in each value gives the condition number, and with it the effect on the result.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.arrays.kernels import accelerate
from wearlaw.errors import InputError, WearlawError
from wearlaw.models.contact_model import ContactModel, Model
from wearlaw.models.law import Law
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw.models.stage import Stage
from wearlaw.pipeline.pipeline import Rig
from wearlaw.units.quantities import Q
from wearlaw_kit.examples import EPS, SAME, SUM, assert_close
from wearlaw_kit.law_contacts import random_contacts
from wearlaw_kit.reduced import friction_limit, random_lines, sliding_power
from wearlaw_kit.rig import values_of, varied
from wearlaw_kit.rules import rule
from wearlaw_kit.shapes import SHAPES, forces_alone, of_stage

CONVERTED = 2.0 * EPS
"""Relative error of a value that was converted to another unit and back."""

STEP = 1e-6
"""Relative step for the condition number."""

POINTS = 64
"""Operating points at which results are compared."""

TOTALS = ("tangential_force", "moment_z", "wear_index", "mean_slip", "patch_area", "normal_force", "rolling_speed")
"""Totals of a contact that a stage may change."""


@rule(Rig, always=True)
def units_of_conditions_do_not_matter(rig: Rig) -> None:
    """The problem is the same if each condition is given in another unit, and a coefficient in percent."""
    quantities = {
        name: value if isinstance(value, pint.Quantity) else Q(value, "")
        for name, value in varied(rig).items()
        if not isinstance(value, int)
    }
    given = {name: value.to_base_units() for name, value in quantities.items()}
    other = {
        name: in_another_unit(given[name]) if value.units == given[name].units else given[name].to(value.units)
        for name, value in quantities.items()
    }
    _compare(lambda values: _made(rig, {**rig.example, **values}), given, other, "the problem of conditions")


@rule(Model, always=True)
def units_of_parameters_do_not_matter(model: Model) -> None:
    """The result is the same if each parameter is given in another unit: in SI, or in hundredths of SI units."""
    given = {name: value for name, value in model if isinstance(value, pint.Quantity)}
    other = {name: in_another_unit(value) for name, value in given.items()}
    _compare(lambda values: _computed(model.model_copy(update=values)), given, other, "the result with parameters")


def in_another_unit(value: Any) -> Any:
    """Return a quantity in base units, or in hundredths of them where it is in base units already."""
    base = value.to_base_units()
    unit = str(base.units) if value.units != base.units else f"percent * {base.units}" if str(base.units) else "percent"
    return Q(value.to(unit).magnitude, unit)


def _compare(
    computed: Callable[[dict[str, Any]], Array], given: Mapping[str, Any], other: Mapping[str, Any], what: str
) -> None:
    """Compare the results of the same values in two units."""
    due = computed(dict(given))
    allowed = SAME * np.abs(due)
    for name, value in given.items():
        for factor in (1.0 - STEP, 1.0 + STEP):
            try:
                step = computed({**given, name: value * factor})
            except WearlawError:  # another parameter bounds it
                continue
            allowed = allowed + CONVERTED / STEP * np.abs(step - due)
    in_units = ", ".join(f"{name} in {value.units or '-'}" for name, value in other.items())
    assert_close(computed(dict(other)), due, f"{what}, {in_units}", 0.0, allowed)


def _computed(model: Model) -> Array:
    if isinstance(model, Rig):
        return _made(model, dict(model.example))
    if isinstance(model, Law):
        return model.rate(random_contacts(POINTS, law=model), model.numbers)
    if isinstance(model, Stage):
        solved = [staged.solve(problem) for staged, problem in of_stage(model, POINTS)]
        return np.stack([getattr(contact, name) for contact in solved for name in TOTALS])
    assert isinstance(model, ContactModel)
    return np.stack(
        [model.solve(shape.draw(POINTS)).tangential_force for shape in SHAPES if shape.geometry in model.geometries()]
    )


def _made(rig: Rig, given: Mapping[str, Any]) -> Array:
    """Return the numbers of the problem that a rig makes, one after the other."""
    return np.concatenate([np.ravel(value) for value in values_of(rig.checked_problem(given)).values()])


@rule(Law, applies=lambda law: law.outcome.of != "patch")
@rule(ContactModel)
def acceleration_does_not_matter(model: Law | ContactModel) -> None:
    """Compiled loops and NumPy give the same results to rounding."""
    try:
        accelerate(True)
    except InputError:  # numba is not installed
        return
    try:
        found = _results(model)
        accelerate(False)
        for (name, value, _), (_, due, size) in zip(found, _results(model), strict=True):
            assert_close(value, due, f"{name} with compiled loops", SAME, SUM * size)
    finally:
        accelerate(None)


def _results(model: Law | ContactModel) -> list[tuple[str, Array, Array | float]]:
    """Return rates, or forces and energies, by name, each with the size that its rounding is relative to."""
    if isinstance(model, Law):
        return [("the rate", _computed(model), 0.0)]
    found: list[tuple[str, Array, Array | float]] = []
    for shape in SHAPES:
        if shape.geometry in model.geometries():
            problem = shape.draw(12)
            contact, limit = model.solve(problem), friction_limit(problem)
            found.append(("the force", contact.tangential_force, limit))
            found.append(("the force alone", forces_alone(model, problem).tangential, limit))
            found.append(("the energy", contact.cell_wear_index, limit * contact.mean_slip))
    if isinstance(model, LineContactModel):
        problem = random_lines(12)
        excess, power = model.excess_dissipation(problem, 1e6), sliding_power(problem) / problem.track_width
        found += [] if excess is None else [("the energy above a threshold", excess, power)]
    return found
