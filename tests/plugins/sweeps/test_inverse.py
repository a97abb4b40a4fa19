"""The creepage of a given traction, against the inverted closed forms of Carter and of the parabola."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q

RIG = wl.TwinDisc.suros()
LOAD: Any = {"normal_force_per_width": Q(741.43, "kN/m"), "friction_coefficient": 0.46}
SATURATION = 0.46 * float(RIG.problem(creepage="1 %", **LOAD).half_width) / 11.75e-3

SHARES = st.floats(1e-9, 0.999)


def plain(quantity: Any) -> Any:
    return quantity.to("").magnitude


@pytest.mark.validates(
    "line-contact",
    "`creepage_for` inverts Carter's force",
    source="the quadratic solved by hand",
    held_to="{roundings} ε over the root of what T lacks of μN",
    roundings=64,
)
@given(share=SHARES)
def test_exact_inverts_carter(share: float, roundings: int) -> None:
    found = plain(wl.creepage_for(RIG | wl.contact_model("exact"), traction_coefficient=0.46 * share, **LOAD))
    # T/μN = d (2 - d). The root is as exact as T, whose error grows by dξ/dT · T/ξ <= 1/√(1 - share).
    due = share / (1.0 + np.sqrt(1.0 - share)) * SATURATION
    assert found == pytest.approx(due, rel=roundings * EPS / np.sqrt(1.0 - share))


@pytest.mark.validates(
    "line-contact",
    "`creepage_for` inverts FASTSIM's force",
    source="the cubic solved by hand",
    held_to="{roundings} ε over what T lacks of μN, to the power ⅔",
    roundings=64,
)
@given(share=SHARES)
def test_fastsim_inverts_the_cube(share: float, roundings: int) -> None:
    found = plain(wl.creepage_for(RIG | wl.contact_model("fastsim"), traction_coefficient=0.46 * share, **LOAD))
    # T/μN = 1 - (1-d)³, saturated at 1.5 times Carter's creepage.
    due = -np.expm1(np.log1p(-share) / 3.0) * 1.5 * SATURATION
    assert found == pytest.approx(due, rel=roundings * EPS / (1.0 - share) ** (2 / 3))


@pytest.mark.parametrize("name", ["exact", "fastsim", "global"])
def test_the_force_at_the_creepage_is_the_force_that_was_asked_for(name: str) -> None:
    contact = RIG | wl.contact_model(name)
    force = Q(np.array([[-3000.0, -10.0, 0.0], [1e-6, 500.0, 3300.0]]), "N")
    creepage = wl.creepage_for(contact, tangential_force=force, **LOAD)
    assert creepage.shape == (2, 3)
    back = contact(creepage=creepage, **LOAD).tangential_force
    assert back.to("N").magnitude == pytest.approx(force.magnitude, rel=1e-13)
    assert np.array_equal(np.sign(creepage.magnitude), np.sign(force.magnitude))


def test_conditions_and_tractions_broadcast() -> None:
    contact = RIG | wl.contact_model("exact")
    found = wl.creepage_for(
        contact,
        traction_coefficient=[0.1, 0.2],
        max_pressure=Q([[1000.0], [1500.0], [2000.0]], "MPa"),
        friction_coefficient=0.3,
    )
    one = wl.creepage_for(contact, traction_coefficient=0.2, max_pressure="1500 MPa", friction_coefficient=0.3)
    assert found.shape == (3, 2)
    assert plain(found)[1, 1] == pytest.approx(plain(one), rel=64 * EPS)


@pytest.mark.parametrize("traction", [0.46, 0.5, -0.46])
def test_full_slip_has_no_single_creepage(traction: float) -> None:
    with pytest.raises(wl.ConditionsError, match=r"no creepage transmits .* 'exact' it stays below 0\.46"):
        wl.creepage_for(RIG | wl.contact_model("exact"), traction_coefficient=traction, **LOAD)


def test_the_first_traction_that_is_too_large_is_named() -> None:
    with pytest.raises(wl.ConditionsError, match=r"0\.6 at index \[1, 0\]"):
        wl.creepage_for(RIG | wl.contact_model("exact"), traction_coefficient=[[0.1, 0.2], [0.6, 0.7]], **LOAD)


def test_a_model_that_never_saturates_says_how_far_it_comes() -> None:
    contact = RIG | wl.contact_model("fastsim", bound="elliptic")
    assert plain(wl.creepage_for(contact, traction_coefficient=0.4599, **LOAD)) > 0.02
    with pytest.raises(wl.ConditionsError, match=r"stays below 0\.46"):
        wl.creepage_for(contact, traction_coefficient=0.46, **LOAD)


@pytest.mark.parametrize(
    "given",
    [{}, {"traction_coefficient": 0.1, "tangential_force": Q(1, "N")}],
)
def test_exactly_one_traction_is_needed(given: Any) -> None:
    with pytest.raises(wl.ConditionsError, match="give either tangential_force or traction_coefficient"):
        wl.creepage_for(RIG | wl.contact_model("exact"), **given, **LOAD)


def test_shapes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(wl.ConditionsError, match="do not broadcast"):
        wl.creepage_for(
            RIG | wl.contact_model("exact"),
            traction_coefficient=[0.1, 0.2],
            max_pressure=Q([1e3, 2e3, 3e3], "MPa"),
            friction_coefficient=0.3,
        )


def test_a_traction_that_is_no_number_is_refused() -> None:
    with pytest.raises(wl.WearlawError, match="traction_coefficient"):
        wl.creepage_for(RIG | wl.contact_model("exact"), traction_coefficient=np.nan, **LOAD)


def test_friction_that_falls_is_refused_since_two_creepages_can_transmit_one_force() -> None:
    falling = wl.FallingFriction(static_coefficient=0.5, limit_ratio=0.4, decay="6 s/m")
    conditions: Any = {"max_pressure": "1500 MPa", "friction_coefficient": falling}
    with pytest.raises(wl.ConditionsError, match=r"friction_coefficient: must be a number here"):
        wl.creepage_for(RIG | wl.contact_model("exact"), traction_coefficient=0.3, **conditions)


def test_a_model_whose_force_is_no_number_is_named() -> None:
    class Nowhere(wl.ContactModel):
        name = "nowhere"
        source = "a test"

        def solve_line(self, problem: wl.Problem) -> wl.Contact:
            return wl.contact_model("global").solve(problem)

        def tangential_force(self, problem: wl.Problem) -> wl.Array:
            return problem.creepage * np.nan

    contact = RIG | Nowhere()
    with pytest.raises(wl.ModelError, match="'nowhere' gave a longitudinal force that is not finite"):
        wl.creepage_for(contact, traction_coefficient=0.3, **LOAD)
    with pytest.raises(wl.ModelError, match="'nowhere' gave a longitudinal force that is not finite"):
        contact(creepage="1 %", **LOAD)
