"""Checks that results do not depend on the units of parameters and conditions, or on how loops are compiled."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.errors import InputError
from wearlaw.kernels import accelerate
from wearlaw.models.contact_model import ContactModel, LineContactModel, Stage
from wearlaw.models.law import Law
from wearlaw.models.model import Model
from wearlaw.models.reader import Reader
from wearlaw.pipeline.pipeline import Rig
from wearlaw.units.quantities import Q
from wearlaw_kit.examples import assert_close
from wearlaw_kit.law_contacts import random_contacts
from wearlaw_kit.reader import contact_of
from wearlaw_kit.rig import PRECISE, values_of, varied
from wearlaw_kit.rules import rule
from wearlaw_kit.shapes import LINE, of_model, of_stage

SAME_RESULT = 1e-9
"""Relative difference of results from values in two units, whose conversion rounds, or from two kinds of loops."""

POINTS = 64
"""Operating points at which results are compared."""

FEW = 12
"""Operating points for loops that are not compiled."""

TOTALS = ("tangential_force", "wear_index", "mean_slip", "patch_area", "normal_force", "rolling_speed")
"""Totals of a contact, all above zero, among them those that a stage may change."""


@rule(Rig, always=True)
def units_of_conditions_do_not_matter(rig: Rig) -> None:
    """The problem is the same if each condition is given in another unit, and a coefficient in percent."""
    quantities = {
        name: value if isinstance(value, pint.Quantity) else Q(value, "")
        for name, value in varied(rig).items()
        if not isinstance(value, int)
    }
    in_si = {name: value.to_base_units() for name, value in quantities.items()}
    other = {
        name: in_another_unit(in_si[name]) if value.units == in_si[name].units else in_si[name].to(value.units)
        for name, value in quantities.items()
    }
    _assert_same(_made(rig, other), _made(rig, in_si), "the problem of conditions", other)


@rule(Model, always=True)
def units_of_parameters_do_not_matter(model: Model) -> None:
    """The result is the same if each parameter is given in another unit: in SI, or in hundredths of SI units."""
    quantities = {name: value for name, value in model if isinstance(value, pint.Quantity)}
    other = {name: in_another_unit(value) for name, value in quantities.items()}
    _assert_same(_computed(model.model_copy(update=other)), _computed(model), "the result with parameters", other)


def in_another_unit(value: Any) -> Any:
    """Return a quantity in base units, or in hundredths of them where it is in base units already."""
    base = value.to_base_units()
    unit = str(base.units) if value.units != base.units else f"percent * {base.units}" if str(base.units) else "percent"
    return Q(value.to(unit).magnitude, unit)


def _assert_same(actual: Array, due: Array, what: str, other: Mapping[str, Any]) -> None:
    in_units = ", ".join(f"{name} in {value.units or '-'}" for name, value in other.items())
    assert_close(actual, due, f"{what}, {in_units}", SAME_RESULT)


def _computed(model: Model, points: int = POINTS) -> Array:
    if isinstance(model, Rig):
        return _made(model, {})
    if isinstance(model, Reader):
        contact = contact_of(model)
        return np.stack([getattr(contact, name) for name in TOTALS])
    if isinstance(model, Law):
        return model.rate(random_contacts(points, law=model), model.numbers)
    assert isinstance(model, ContactModel | Stage)
    models = of_stage(model, points) if isinstance(model, Stage) else of_model(model, points)
    solved = [solver.solve(problem) for solver, problem in models]
    totals = [getattr(contact, name) for contact in solved for name in TOTALS]
    if isinstance(model, LineContactModel):
        excess = model.excess_dissipation(LINE.draw(points), 1e6)
        totals += [] if excess is None else [excess]
    return np.stack(totals)


@rule(Law)
@rule(ContactModel)
def acceleration_does_not_matter(model: Law | ContactModel) -> None:
    """Compiled loops and NumPy give the same results to rounding."""
    try:
        accelerate(True)
    except InputError:  # numba is not installed
        return
    try:
        compiled = _computed(model, FEW)
        accelerate(False)
        assert_close(compiled, _computed(model, FEW), "the result with compiled loops", SAME_RESULT)
    finally:
        accelerate(None)


def _made(rig: Rig, conditions: Mapping[str, Any]) -> Array:
    """Return the numbers of the problem that a rig makes, one after the other."""
    values = values_of(rig.checked_problem({**rig.example, **conditions}))
    return np.concatenate([np.ravel(values[name]) for name in PRECISE])
