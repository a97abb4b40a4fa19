"""The check that compiled loops and NumPy give the same results."""

from __future__ import annotations

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.arrays.kernels import accelerate
from wearlaw.errors import InputError
from wearlaw.models.contact_model import ContactModel, Model
from wearlaw.models.law import Law
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw_kit.examples import SAME, SUM, assert_close
from wearlaw_kit.reduced import random_lines
from wearlaw_kit.sampling import random_contacts
from wearlaw_kit.shapes import SHAPES

POINTS = 12
"""Operating points."""


def acceleration_does_not_matter(model: Model) -> None:
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


def _results(model: Model) -> list[tuple[str, Array, Array]]:
    """Return results by name, each with the size that its rounding is relative to."""
    if isinstance(model, Law):
        rate = model.rate(random_contacts(POINTS, law=model), model.numbers)
        return [("the rate", rate, np.zeros_like(rate))]
    assert isinstance(model, ContactModel)
    found: list[tuple[str, Array, Array]] = []
    for shape in SHAPES:
        if shape.geometry in model.geometries():
            problem = shape.random(POINTS)
            contact, alone = model.solve(problem), shape.forces_alone(model, problem)
            for name, size in shape.sizes(problem, contact.forces).items():
                found += [(f"the {name} force", getattr(of, name), size) for of in (contact.forces, alone)]
            power = shape.size_of_power(problem, contact.forces)
            found += [("the energy", contact.cell_wear_index, power), ("the mean slip", contact.mean_slip, 0.0 * power)]
    if isinstance(model, LineContactModel):
        problem = random_lines(POINTS)
        force = model.tangential_force_per_width(problem)
        excess = model.excess_dissipation(problem, 1e6)
        found += [] if excess is None else [("the energy above a threshold", excess, force * problem.creepage)]
    return found


CHECKS = (acceleration_does_not_matter,)
