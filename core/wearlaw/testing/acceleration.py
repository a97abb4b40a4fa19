"""The check that compiled kernels, NumPy and single operating points give the same results."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.arrays.kernels import accelerate
from wearlaw.contact.contact import Contact
from wearlaw.errors import InputError
from wearlaw.models.contact_model import ContactModel, Model
from wearlaw.models.law import BreakpointMap, Law, Numbers
from wearlaw.models.wear_law import WearLaw
from wearlaw.testing.examples import SAME, SUM, assert_close
from wearlaw.testing.problems import TWIN_DISC, WHEEL_RAIL
from wearlaw.testing.sampling import random_contacts, rows
from wearlaw.units.quantities import Q


class Ramps(WearLaw):
    """A law of ramps, which uses the closed form of a contact model if it has one."""

    name: ClassVar[str] = "ramps"
    source: ClassVar[str] = "the conformance kit"

    def rate(self, contact: Contact, p: Numbers) -> Array:
        """Return the sum of the ramps [kg/m/m²]."""
        w = contact.wear_index_density
        return sum((slope * np.maximum(w - threshold, 0.0) for threshold, slope in self.ramps(p)), np.zeros_like(w))

    def ramps(self, p: Numbers) -> tuple[tuple[float, float], ...]:  # noqa: ARG002
        """Return ramps with the order of magnitude of those of steel."""
        return (0.0, 5e-9), (1e7, -4e-9), (8e7, 6e-8)

    def breakpoints(self, p: Numbers) -> BreakpointMap:  # noqa: ARG002
        """Return where the ramps begin."""
        return {"wear_index_density": (1e7, 8e7)}


POINTS = 12
"""Operating points."""


def acceleration_does_not_matter(model: Model) -> None:
    """Compiled kernels, NumPy and single operating points give the same results to rounding."""
    if isinstance(model, ContactModel) and model.geometries() == ("strips",):  # no rig that ships makes such problems
        return
    try:
        accelerate(False)
        due, allowed = _results(model, slice(None))
        alone = np.stack([_results(model, point)[0] for point in range(POINTS)], axis=-1)
        assert_close(alone, due, "the result of one operating point at a time", SAME, allowed)
        try:
            accelerate(True)
        except InputError:  # numba is not installed
            return
        found, _ = _results(model, slice(None))
        assert_close(found, due, "the result with compiled kernels", SAME, allowed)
    finally:
        accelerate(None)


def _results(model: Model, part: slice | int) -> tuple[Array, Array]:
    """Return the results of a model at some of `POINTS` operating points (last axis) or at one, and their rounding."""
    if isinstance(model, Law):
        contact = random_contacts(POINTS, law=model)
        rate = (
            model.rate(contact, model.numbers)[:, 0]
            if isinstance(part, slice)
            else model.rate(rows(contact, [part]), model.numbers)[0, 0]
        )
        return rate, np.zeros_like(rate)
    assert isinstance(model, ContactModel)
    of = {"line": _of_line, "ellipse": _of_ellipse}
    found = [of[geometry](model, part) for geometry in model.geometries() if geometry in of]
    return np.concatenate([value for value, _ in found]), np.concatenate([allowed for _, allowed in found])


def _of_line(model: ContactModel, part: slice | int) -> tuple[Array, Array]:
    predict = (TWIN_DISC | model).with_law(Ramps())
    pressure, creepage = np.tile([0.3e9, 1.5e9], POINTS // 2), np.geomspace(1e-5, 0.5, POINTS)
    found = predict(max_pressure=Q(pressure[part], "Pa"), creepage=Q(creepage[part], ""), friction_coefficient=0.46)
    force, index, slip, rate = (
        getattr(found, name).to_base_units().magnitude
        for name in ("tangential_force", "wear_index", "mean_slip", "wear_rate")
    )
    density = found.wear_index_density.m_as("N/m^2")
    return np.stack([force, index, slip, rate]), SUM * np.stack([force, index, slip, STEEPEST * density])


def _of_ellipse(model: ContactModel, part: slice | int) -> tuple[Array, Array]:
    predict = (WHEEL_RAIL | model).with_law(Ramps())
    pressure, creepage = np.tile([0.3e9, 0.6e9], POINTS // 2), np.geomspace(1e-5, 0.1, POINTS)
    found = predict(
        max_pressure=Q(pressure[part], "Pa"),
        longitudinal_creepage=Q(creepage[part], ""),
        lateral_creepage=Q(-0.4 * creepage[part], ""),
        spin=Q(np.linspace(0.0, 1.0, POINTS)[part], "1/m"),
        friction_coefficient=0.4,
    )
    along, across, moment, index, slip, rate, force, dissipated, area = (
        getattr(found, name).to_base_units().magnitude
        for name in (
            "longitudinal_force",
            "lateral_force",
            "spin_moment",
            "wear_index",
            "mean_slip",
            "wear_rate",
            "tangential_force",
            "cell_wear_index",
            "patch_area",
        )
    )
    # A component is rounded as the force is, and the moment as its tractions times their levers.
    arm, power = np.sqrt(area), np.maximum(index, dissipated)
    allowed = [force, force, np.maximum(np.abs(moment), force * arm), power, slip, STEEPEST * power / area]
    return np.stack([along, across, moment, index, slip, rate]), SUM * np.stack(allowed)


STEEPEST = sum(abs(slope) for _, slope in Ramps().ramps({}))
"""Sum of the slopes of the ramps [kg/m/N]; each ramp has the rounding error of the whole dissipation."""

CHECKS = (acceleration_does_not_matter,)
