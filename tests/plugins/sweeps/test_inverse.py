"""The creepage of a given traction, against the inverted closed forms of Carter and of the parabola."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import ModelError

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


@settings(max_examples=50)
@given(
    share=st.floats(1e-6, 1.0 - 1e-6),
    static=st.floats(0.05, 0.8),
    ratio=st.floats(0.05, 0.9),
    decay=st.floats(0.01, 100.0),
    speed=st.floats(0.5, 30.0),
    speed_of=st.sampled_from(["mean", "disc_1"]),
    sign=st.sampled_from([-1.0, 1.0]),
)
def test_the_first_creepage_is_found_where_friction_falls(
    share: float, static: float, ratio: float, decay: float, speed: float, speed_of: Any, sign: float
) -> None:
    rig = wl.TwinDisc.suros(rolling_speed=Q(speed, "m/s"), speed_of=speed_of)
    friction = wl.FallingFriction(static_coefficient=static, limit_ratio=ratio, decay=Q(decay, "s/m"))
    load: Any = {"normal_force_per_width": Q(741.43, "kN/m"), "friction_coefficient": friction}
    half_width = float(rig.problem(creepage="1 %", **load).half_width)

    def traction(creepage: Any) -> Any:
        """Return T/N by Carter and Polach: μ d (2 - d) with d = ξR/(μa), at most 1."""
        kept = speed if speed_of == "mean" else speed / (1.0 + 0.5 * sign * creepage)
        falling = static * ((1.0 - ratio) * np.exp(-decay * kept * creepage) + ratio)
        d = np.minimum(creepage * 11.75e-3 / (falling * half_width), 1.0)
        return falling * d * (2.0 - d)

    scan = np.geomspace(1e-6, 1.0, 20001)
    greatest = traction(scan).max()
    wanted = share * greatest
    creepage = plain(wl.creepage_for(rig | wl.contact_model("exact"), traction_coefficient=sign * wanted, **load))
    found = sign * creepage
    # The traction is not steeper than the creepage, ratio by ratio, but for the fall of μ: some V B ξ.
    roundings = 256 * (1.0 + decay * speed * found)
    assert traction(found) == pytest.approx(wanted, rel=roundings * EPS)
    assert traction(np.geomspace(1e-6 * found, found * (1.0 - 1e-9), 4001)).max() <= wanted
    with pytest.raises(wl.ConditionsError, match=r"no creepage transmits") as error:
        wl.creepage_for(rig | wl.contact_model("exact"), traction_coefficient=sign * 1.01 * greatest, **load)
    (stated,) = re.findall(r"(?:it stays below|the greatest is) (\d\S+\d)", str(error.value))
    # Six digits; samples that are 0.07 % apart miss a peak by the square of that, times the curvature.
    assert float(stated) == pytest.approx(greatest, rel=1e-5)


def test_a_model_whose_force_is_no_number_is_named() -> None:
    class Nowhere(wl.ContactModel):
        name = "nowhere"
        source = "a test"

        def solve_line(self, problem: wl.Problem) -> wl.Contact:
            return wl.contact_model("global").solve(problem)

        def tangential_force(self, problem: wl.Problem) -> wl.Array:
            return problem.creepage * np.nan

    contact = RIG | Nowhere()
    with pytest.raises(ModelError, match="'nowhere' gave a longitudinal force that is not finite"):
        wl.creepage_for(contact, traction_coefficient=0.3, **LOAD)
    with pytest.raises(ModelError, match="'nowhere' gave a longitudinal force that is not finite"):
        contact(creepage="1 %", **LOAD)
