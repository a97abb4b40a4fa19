"""Wear by the energy of friction, against Tγ/A, and where it jumps against Carter's contact."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests import reference
from tests.plugins.laws import around, contact_of
from tests.strategies import EPS
from wearlaw import Q

MILD, SEVERE = 5e-9, 15e-9
"""Coefficients in kg/J, made up."""

TWO = {"mass_per_energy": "5 ug/J", "severe_mass_per_energy": "15 ug/J"}
IN_SI = {"energy_limit": "N/m^2", "power_limit": "W/m^2"}
FRICTION = 0.4
ON_DISCS: dict[str, Any] = {"max_pressure": Q(1200, "MPa"), "friction_coefficient": FRICTION}


def energy(mass_per_energy: Any = "5 ug/J", **fields: Any) -> Any:
    return wl.wear_law("energy", mass_per_energy=mass_per_energy, **fields)


def discs(**fields: Any) -> Any:
    return wl.TwinDisc.suros(**fields)


def rail() -> Any:
    return wl.WheelRail(
        wheel_radius=Q(460, "mm"), rail_head_radius=Q(300, "mm"), rolling_speed=Q(30, "m/s"), material=wl.steel()
    )


@pytest.mark.validates(
    "wear-laws",
    "`energy` without a limit: its coefficient times Tγ/A, in every contact model on a line",
    source="the definition of Tγ, the energy dissipated per distance rolled",
    held_to="{within:g}, relative",
    within=1e-13,
)
@pytest.mark.parametrize("name", ["global", "exact", "fastsim"])
def test_without_a_limit_it_is_the_energy_of_the_patch(name: str, within: float) -> None:
    found = (discs() | wl.contact_model(name) | energy())(creepage=Q([0.01, 0.3, 1.0, 10.0], "%"), **ON_DISCS)
    expected = MILD * (found.wear_index / found.patch_area).m_as("N/m^2")
    assert found.wear_rate.m_as("kg/m/m^2") == pytest.approx(expected, rel=within)


def carter_mean(creepage: float, limit: float, problem: wl.Problem) -> float:
    """Return the mean of c q s over Carter's patch, with c = MILD below a limit of q s [N/m²] and SEVERE above."""
    load, radius, modulus = (
        float(x) for x in (problem.normal_force_per_width, problem.relative_radius, problem.effective_modulus)
    )
    solution = reference.exact(reference.Point(load, radius, modulus, FRICTION, creepage))

    crossings = solution.density_crossings(limit)
    excess = solution.mean(lambda v: np.maximum(solution.density(v) - limit, 0.0), crossings)
    severe = excess + limit * 0.5 * float(np.ptp(crossings or [0.0]))
    return MILD * solution.mean(solution.density) + (SEVERE - MILD) * severe


@pytest.mark.validates(
    "wear-laws",
    "`energy` that jumps within Carter's patch, from partial to full slip, at a limit in power and in energy",
    source="q s of Carter 1926, by tanh-sinh quadrature between the points where it passes the limit",
    held_to="{within:g}, relative",
    within=1e-12,  # the roots of both sides are known to some roundings, and the rate is finite beside the jump
)
@pytest.mark.parametrize("limit", [0.05, 0.5, 2.0, 4.0, 30.0])
@pytest.mark.parametrize("percent", [0.1, 0.6, 1.0, 1.5, 10.0])
def test_the_jump_is_integrated_to_rounding(percent: float, limit: float, within: float) -> None:
    contact = discs() | wl.contact_model("exact")
    speed = float(contact(creepage=Q(percent, "%"), **ON_DISCS).contact.rolling_speed)
    for law in (
        energy(**TWO, energy_limit=Q(limit, "N/mm^2")),
        energy(**TWO, power_limit=Q(limit * speed, "W/mm^2")),
    ):
        found = (contact | law)(creepage=Q(percent, "%"), **ON_DISCS)
        expected = carter_mean(1e-2 * percent, limit * 1e6, found.contact.problem)
        assert found.wear_rate.m_as("kg/m/m^2") == pytest.approx(expected, rel=within)
        assert found.wear_rate_error.m <= within * found.wear_rate.m


@pytest.mark.validates(
    "wear-laws",
    "`energy` that jumps within an ellipse in full slip: the mean in closed form, on 10 to 160 strips",
    source="q s is ξ μ (2N/(πab)) (1 - r²), so that wear is severe inside of an ellipse of the same shape",
    held_to="{times:g} times `wear_rate_error`, which falls from {coarse:g} to {fine:g} of the rate at most",
    times=1.5,
    coarse=0.12,
    fine=0.01,
)
@pytest.mark.parametrize("limit", ["energy_limit", "power_limit"])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_the_jump_within_an_ellipse_is_known_to_the_stated_error(
    limit: str, share: float, times: float, coarse: float, fine: float
) -> None:
    # Kalker's simplified theory at a creepage of a hundred times that of full slip: it slips by ξ to a hundredth,
    # which differs in sign from the leading to the trailing half.
    at: Any = {"normal_force": Q(20, "kN"), "longitudinal_creepage": Q(50, "%"), "friction_coefficient": 0.3}
    problem = rail().problem(**at)
    peak = 0.5 * 0.3 * 2.0 * 20e3 / (math.pi * float(problem.a) * float(problem.b))
    law = energy(**TWO, **{limit: Q(share * peak * (30.0 if limit == "power_limit" else 1.0), IN_SI[limit])})
    # ∫ c w dA/A = ∫ c peak (1 - u) du with u = r² from 0 to 1; severe up to 1 - share
    severe = 1.0 - share
    expected = peak * (0.5 * MILD + (SEVERE - MILD) * (severe - 0.5 * severe**2))
    for strips, most in ((10, coarse), (40, 0.05), (160, fine)):
        # The error falls by steps, as strips enter the severe zone; from two refinements it is known to half of it.
        found = (rail() | wl.contact_model("fastsim", strips=strips) | law)(**at)
        rate, error = found.wear_rate.m_as("kg/m/m^2"), found.wear_rate_error.m_as("kg/m/m^2")
        assert abs(rate - expected) <= times * error
        assert error <= most * rate


def test_the_limit_belongs_to_severe_wear_and_is_the_only_jump() -> None:
    law = energy(**TWO, energy_limit="10 N/mm^2")
    assert law.breakpoints(law.numbers) == law.jumps(law.numbers) == {"wear_index_density": (10e6,)}
    below, at = law.checked_rate(contact_of(traction=around(10e6), slip=1.0))
    assert at / below == pytest.approx(3.0, rel=8 * EPS)
    law = energy(**TWO, power_limit="10 W/mm^2")
    assert law.jumps(law.numbers) == {"frictional_power_density": (10e6,)}
    below, at = law.checked_rate(contact_of(traction=around(10e6), slip=1.0))
    assert at / below == pytest.approx(3.0, rel=8 * EPS)


def test_equal_coefficients_make_no_jump_and_no_limit_no_branch() -> None:
    law = energy(severe_mass_per_energy="5 ug/J", power_limit="4 W/mm^2")
    assert law.jumps(law.numbers) == {}
    assert law.ramps(law.numbers) is None
    law = energy()
    assert law.breakpoints(law.numbers) == law.jumps(law.numbers) == {}
    assert law.ramps(law.numbers) == ((0.0, pytest.approx(5e-9)),)
    assert law.numbers == {"mass_per_energy": pytest.approx(5e-9)}


def test_units_of_print_are_taken_as_they_stand() -> None:
    assert energy("5.3 ug/m/N") == energy("5.3 ug/J")
    law = energy(**TWO, power_limit="4 N/mm/s")
    assert law.numbers["power_limit"] == pytest.approx(4e3, rel=4 * EPS)  # a thousandth of 4 W/mm²


def test_a_record_of_the_tests_survives_a_round_trip() -> None:
    tests = wl.Calibration(
        contact_model="global",
        scale="patch",
        materials="steel A on steel B",
        stated_range=(("frictional_power_density", "0 W/mm^2", "10 W/mm^2"),),
        source="test 7 of the lab",
    )
    law = energy(**TWO, power_limit="4 W/mm^2", fitted_for=tests)
    assert energy(**law.model_dump(mode="json")) == law
    assert law.valid_range == {"frictional_power_density": (0.0, 1e7)}
    with pytest.warns(wl.CalibrationWarning, match="'energy' were fitted for patch means"):
        discs() | wl.contact_model("exact") | law
    assert energy().calibration is None


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, r"energy: mass_per_energy: is missing"),
        ({"mass_per_energy": 5e-9}, r"mass_per_energy: got the bare number 5e-09, which has no unit"),
        ({"mass_per_energy": "1e-13 m^3/J"}, r"mass_per_energy: .*does not have the dimension of 'ug/J'"),
        (TWO, r"severe_mass_per_energy needs the limit at which it begins: power_limit or energy_limit"),
        ({"mass_per_energy": "5 ug/J", "power_limit": "4 W/mm^2"}, r"power_limit needs severe_mass_per_energy"),
        ({"mass_per_energy": "5 ug/J", "energy_limit": "4 N/mm^2"}, r"energy_limit needs severe_mass_per_energy"),
        ({**TWO, "power_limit": "4 W/mm^2", "energy_limit": "4 N/mm^2"}, r"give one limit, .* not both"),
        ({**TWO, "power_limit": "4 N/mm^2"}, r"power_limit: .*does not have the dimension of 'W/mm\^2'"),
        (
            {**TWO, "severe_mass_per_energy": "4 ug/J", "power_limit": "4 W/mm^2"},
            r"must not be below mass_per_energy = 5\.000",
        ),
        ({**TWO, "power_limt": "4 W/mm^2"}, r"unknown field; did you mean 'power_limit'"),
    ],
)
def test_a_wrong_value_is_one_clear_error(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=message):
        wl.wear_law("energy", **fields)
