"""Checks that results do not depend on the units of parameters and conditions.

A value converted to another unit and back has four rounding errors of half of EPS, from two factors and two products.
A step of `STEP` in each value gives the condition number, and with it the effect on the result.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, TypeAlias

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Geometry
from wearlaw.errors import WearlawError
from wearlaw.models.contact_model import ContactModel, Model
from wearlaw.models.law import Law
from wearlaw.models.stage import Stage
from wearlaw.pipeline.pipeline import Rig
from wearlaw.testing.examples import SAME, assert_close
from wearlaw.testing.problems import TWIN_DISC, WHEEL_RAIL
from wearlaw.testing.rig_checks import values_of, varied
from wearlaw.testing.sampling import EPS, random_contacts, with_problem
from wearlaw.testing.shapes import SHAPES, of_stage
from wearlaw.units.quantities import Q
from wearlaw.units.registry import application_registry

CONVERTED = 2.0 * EPS
"""Relative error of a value that was converted to another unit and back."""

STEP = 1e-6
"""Relative step for the condition number."""

POINTS = 64
"""Operating points at which results are compared."""

Values = Mapping[str, Array]


def units_of_parameters_do_not_matter(model: Model) -> None:
    """The result is the same if each parameter is given in base units instead of its own unit."""
    registry = application_registry()
    given = {name: value for name, value in model if isinstance(value, pint.Quantity)}
    converted = {
        name: Q(value.to_base_units().magnitude, str(value.to_base_units().units))
        for name, value in given.items()
        if value.units != registry.Quantity(1, value.units).to_base_units().units
    }
    due = _computed(model)
    allowed = SAME * np.abs(due)
    for name in converted:
        steps = (_computed(other) for other in _near(model, name, given[name]))
        allowed = allowed + CONVERTED / STEP * sum(np.abs(step - due) for step in steps)
    found = _computed(model.model_copy(update=converted))
    assert_close(found, due, "the result with parameters in base units", 0.0, allowed)


def _near(model: Model, name: str, value: Any) -> Iterator[Model]:
    """Yield the model with a parameter one step up and one step down, if those values are valid."""
    for factor in (1.0 - STEP, 1.0 + STEP):
        try:
            yield model.model_copy(update={name: value * factor})
        except WearlawError:  # another parameter bounds it
            continue


def _computed(model: Model) -> Array:
    if isinstance(model, Rig):
        return _made(model, dict(model.example))
    if isinstance(model, Law):
        return model.rate(random_contacts(POINTS, law=model), model.numbers)
    if isinstance(model, Stage):
        return np.stack([staged.solve(problem).tangential_force for staged, problem in of_stage(model, POINTS)])
    assert isinstance(model, ContactModel)
    return np.stack(
        [model.solve(shape.random(POINTS)).tangential_force for shape in SHAPES if shape.geometry in model.geometries()]
    )


def units_of_conditions_do_not_matter(model: Model) -> None:
    """The same operating points, given in other units, have the same result: N and kN, Pa and MPa, ratio and %.

    A contact model sees them through a rig, a wear law through `Contact.from_arrays`.
    """
    if isinstance(model, Rig):
        _compare_conditions(model)
        return
    if isinstance(model, Law):
        _compare(_contacts(), lambda given: _rate(model, given), OF_CONTACTS)
        return
    if isinstance(model, Stage):  # it sees the same problem whatever the units
        return
    assert isinstance(model, ContactModel)
    for rig, loads, creepages in (given for geometry, given in GIVEN.items() if geometry in model.geometries()):
        random = np.random.default_rng(7)
        rolling = {name: random.integers(-2000, 2000, POINTS) * step for name, step in creepages.items()}
        for load, (low, high) in loads.items():
            values = {load: np.rint(random.uniform(low, high, POINTS)), **rolling}
            _compare(values, partial(_solved, rig | model), OF_CONDITIONS)


def _made(rig: Rig, given: Mapping[str, Any]) -> Array:
    """Return the numbers of the problem that a rig makes, one after the other."""
    return np.concatenate([np.ravel(value) for value in values_of(rig.checked_problem(given)).values()])


def _compare_conditions(rig: Rig) -> None:
    """Compare the problem of the example in SI with that in its own units, or in hundredths of SI units.

    A coefficient, which the example gives as a plain number, is compared in percent.
    """
    quantities = {
        name: value if isinstance(value, pint.Quantity) else Q(value, "")
        for name, value in varied(rig).items()
        if not isinstance(value, int)
    }
    in_si = {name: value.to_base_units() for name, value in quantities.items()}
    values = {name: value.magnitude * np.ones(1) for name, value in in_si.items()}
    units = {}
    for name, value in in_si.items():
        si, own = str(value.units), str(quantities[name].units)
        units[name] = si, own if own != si else f"percent * {si}"
    _compare(values, lambda given: _made(rig, {**rig.example, **given}), units)


def _solved(pipeline: Any, given: dict[str, Any]) -> Array:
    solution = pipeline(**given, friction_coefficient=0.46)
    return np.stack([solution.tangential_force.m_as("N"), solution.mean_slip.m_as("")])


def _rate(law: Law, given: dict[str, Any]) -> Array:
    return law.rate(with_problem(Contact.from_arrays(**given), law), law.numbers)


def _contacts() -> Values:
    """Return random contacts of one node, with whole numbers where a value is large."""
    contact = random_contacts(POINTS)
    names = ("pressure", "traction", "slip", "area", "rolling_speed", "density")
    return {name: np.rint(value) if (value := getattr(contact, name)).max() > 1e3 else value for name in names}


def _compare(values: Values, computed: Callable[[dict[str, Any]], Array], units: Mapping[str, tuple[str, str]]) -> None:
    """Compare the results of the same values in SI and in the customary units."""

    def given(changed: str = "", factor: float = 1.0) -> dict[str, Any]:
        return {name: Q(value * (factor if name == changed else 1.0), units[name][0]) for name, value in values.items()}

    due = computed(given())
    allowed = SAME * np.abs(due)
    for name in values:
        steps = (computed(given(name, factor)) for factor in (1.0 - STEP, 1.0 + STEP))
        allowed = allowed + CONVERTED / STEP * sum(np.abs(step - due) for step in steps)
    other = {name: Q(value.to(units[name][1]).magnitude, units[name][1]) for name, value in given().items()}
    in_words = ", ".join(units[name][1] or "-" for name in values)
    assert_close(computed(other), due, f"the result of values in {in_words} in place of SI", 0.0, allowed)


OF_CONDITIONS = {
    "normal_force": ("N", "kN"),
    "normal_force_per_width": ("N/m", "N/mm"),
    "max_pressure": ("Pa", "MPa"),
    "creepage": ("", "%"),
    "longitudinal_creepage": ("", "%"),
    "lateral_creepage": ("", "%"),
    "spin": ("1/m", "1/mm"),
}
"""Conditions with their SI units and others."""

Given: TypeAlias = tuple[Rig, dict[str, tuple[float, float]], dict[str, float]]

GIVEN: dict[Geometry, Given] = {
    "line": (
        TWIN_DISC,
        {"normal_force": (1e2, 9e3), "normal_force_per_width": (1e4, 9e5), "max_pressure": (1e8, 1.5e9)},
        {"creepage": 1e-4},
    ),
    "ellipse": (
        WHEEL_RAIL,
        {"normal_force": (1e4, 9e4), "max_pressure": (1e8, 1e9)},
        {"longitudinal_creepage": 1e-5, "lateral_creepage": 1e-5, "spin": 1e-3},
    ),
}
"""For each geometry a rig, loads from low to high in SI, and steps of creepages."""

OF_CONTACTS = {
    "pressure": ("Pa", "MPa"),
    "traction": ("Pa", "N/mm^2"),
    "slip": ("", "%"),
    "area": ("m^2", "mm^2"),
    "rolling_speed": ("m/s", "km/h"),
    "density": ("kg/m^3", "g/cm^3"),
}
"""Values of a contact with their SI units and others."""

CHECKS = (units_of_parameters_do_not_matter, units_of_conditions_do_not_matter)
