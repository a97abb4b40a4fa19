"""Common properties of the models that give creep forces without resolving the patch."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given

import wearlaw as wl
from tests.plugins.ellipses import EPS, ellipses
from wearlaw import Array, Q
from wearlaw.errors import CompositionError

NAMES = ("linear", "polach", "shen_hedrick_elkins")
MODELS = [wl.contact_model(name) for name in NAMES]
every_model = pytest.mark.parametrize("model", MODELS, ids=NAMES)

RIG = wl.WheelRail(
    wheel_radius=Q(460, "mm"),
    rail_head_radius=Q(300, "mm"),
    wheel_profile_radius=Q(np.inf, "mm"),
    material=wl.steel(),
    rolling_speed=Q(30, "m/s"),
)
CONDITIONS: dict[str, Any] = {
    "normal_force": Q([[80.0], [100.0]], "kN"),
    "friction_coefficient": 0.3,
    "longitudinal_creepage": Q([0.0, 0.02, 0.2, 1.0], "%"),
    "lateral_creepage": Q([0.0, 0.1, -0.1, 0.0], "%"),
    "spin": Q(0.3, "1/m"),
}


def usfd(model: wl.ContactModel) -> wl.Pipeline[...]:
    with pytest.warns(wl.CalibrationWarning, match="fitted for line contacts"):
        return RIG | model | wl.wear_law("usfd")


def si(quantity: wl.Quantity, unit: str) -> Array:
    return np.asarray(quantity.to(unit).magnitude)


@pytest.mark.validates(
    "invariants",
    "Creep-force models: mirrored and reversed creepages",
    source="symmetry",
    held_to="to the bit",
)
@given(problem=ellipses())
@every_model
def test_mirrored_and_reversed_creepages_mirror_and_reverse_the_forces(
    model: wl.ContactModel, problem: wl.Problem
) -> None:
    along, across, spin = problem.longitudinal_creepage, problem.lateral_creepage, problem.spin
    found = dataclasses.astuple(model.creep_forces(problem))
    mirrored = model.creep_forces(problem.with_creepages(along, -across, -spin))
    braked = model.creep_forces(problem.with_creepages(-along, across, spin))
    assert dataclasses.astuple(mirrored) == (found[0], -found[1], -found[2], None)
    assert dataclasses.astuple(braked) == (-found[0], found[1], found[2], None)


@given(problem=ellipses())
@every_model
def test_the_contact_is_one_node_of_means(model: wl.ContactModel, problem: wl.Problem) -> None:
    contact, forces = model.solve(problem), model.creep_forces(problem)
    assert contact.pressure.shape == (1, 1)
    area = problem.patch_area
    assert contact.traction_x * area == pytest.approx(forces.longitudinal, rel=4 * EPS)
    assert contact.traction_y * area == pytest.approx(forces.lateral, rel=4 * EPS)
    assert contact.moment_z == forces.spin_moment
    assert contact.wear_index == problem.power(forces)


@every_model
def test_usfd_wears_by_the_energy_over_the_patch(model: wl.ContactModel) -> None:
    found = usfd(model)(**CONDITIONS)
    density = si(found.wear_index_density, "N/mm^2")
    assert density.shape == (2, 4)
    assert (density > 0.0).all()
    # Tassini et al. 2010, Table 3: mild up to 55/5.3 N/mm², then constant up to 77.26
    assert density.max() < 77.26
    assert si(found.wear_rate, "ug/m/mm^2") == pytest.approx(np.minimum(5.3 * density, 55.0), rel=32 * EPS)
    problem = found.problem
    energy = (
        problem.longitudinal_creepage * si(found.longitudinal_force, "N")
        + problem.lateral_creepage * si(found.lateral_force, "N")
        + problem.spin * si(found.spin_moment, "N*m")
    )
    assert si(found.wear_index, "N") == pytest.approx(energy, rel=64 * EPS)
    assert si(found.cell_wear_index, "N") == pytest.approx(energy, rel=64 * EPS)


@every_model
def test_brr_takes_the_energy_of_the_whole_patch(model: wl.ContactModel) -> None:
    found = (RIG | model | wl.wear_law("brr"))(**CONDITIONS)
    energy = si(found.wear_index, "N")
    # Tassini et al. 2010, Table 1, times πD for volume, and 7850 kg/m³: µg per metre rolled
    area = np.select([energy < 100.0, energy < 200.0], [0.25 * energy, 25.0 + 0.0 * energy], 1.19 * energy - 154.0)
    assert si(found.mass_per_distance, "ug/m") == pytest.approx(7.85 * np.pi * area, rel=32 * EPS)


@every_model
def test_the_patch_is_not_resolved(model: wl.ContactModel) -> None:
    with pytest.raises(
        CompositionError, match=r"gives means of the whole patch; .* wl.contact_model\(\"strip_theory\"\)"
    ):
        usfd(model)(**CONDITIONS).wear_profile("wheel")


@every_model
def test_a_line_contact_is_refused_with_the_models_that_solve_it(model: wl.ContactModel) -> None:
    message = (
        f"contact model '{model.name}' solves elliptic contacts only, but a TwinDisc makes line contacts; those that"
    )
    with pytest.raises(CompositionError, match=re.escape(message) + r".*exact, fastsim, global, half_space$"):
        wl.TwinDisc.suros() | model
