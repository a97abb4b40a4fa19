"""The creepage of a given traction, against inverted closed forms and on a rail and rigs of one's own."""

from __future__ import annotations

import dataclasses
import re
from typing import Any, ClassVar

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wearlaw as wl
from tests.core.test_own_rigs import OnRail, Roller
from tests.plugins.fits.test_any_rig import FASTSIM, ON_ELLIPSE, ROLLER, WHEEL
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

        def solve_line(self, problem: wl.Problem) -> wl.Contact:
            return wl.contact_model("global").solve(problem)

        def tangential_force(self, problem: wl.Problem) -> wl.Array:
            return problem.creepage * np.nan

    contact = RIG | Nowhere()
    with pytest.raises(ModelError, match="'nowhere' gave a longitudinal force that is not finite"):
        wl.creepage_for(contact, traction_coefficient=0.3, **LOAD)
    with pytest.raises(ModelError, match="'nowhere' gave a longitudinal force that is not finite"):
        contact(creepage="1 %", **LOAD)


@pytest.mark.parametrize("model", ["fastsim", "polach", "shen_hedrick_elkins"])
def test_the_creepage_on_a_rail_transmits_the_longitudinal_force(model: str) -> None:
    contact = WHEEL | wl.contact_model(model)
    given: Any = {**ON_ELLIPSE, "lateral_creepage": Q([[0.0], [0.1]], "%"), "spin": Q([[0.0], [-0.6]], "1/m")}
    force = Q([-20.0, -1e-6, 0.0, 1.0, 23.0], "kN")
    creepage = wl.creepage_for(contact, tangential_force=force, **given)
    assert creepage.shape == (2, 5)
    assert np.array_equal(np.sign(creepage.magnitude), np.sign(np.broadcast_to(force.magnitude, (2, 5))))
    back = contact(longitudinal_creepage=creepage, **given).longitudinal_force.to("kN").magnitude
    # The logarithm of the creepage, -20 at the least, is found to some roundings, and the force to those of a sum of
    # hundreds of terms of the size of the friction force, 24 kN.
    assert back == pytest.approx(np.broadcast_to(force.magnitude, (2, 5)), rel=1e-12, abs=1e3 * EPS * 24.0)


def test_the_creepage_of_a_rig_of_ones_own_on_a_rail_is_found() -> None:
    contact: Any = OnRail() | wl.contact_model("fastsim")
    creepage = wl.creepage_for(contact, traction_coefficient=[0.1, -0.2], mass="8 t")
    back = contact(mass="8 t", longitudinal_creepage=creepage)
    assert back.longitudinal_force / Q(8e3 * 9.81, "N") == pytest.approx(np.array([0.1, -0.2]), rel=1e-12)


class Odd(wl.CreepForceModel):
    """A contact whose traction is a function of the longitudinal creepage, and not one that rises from zero."""

    name: ClassVar[str] = "odd"
    falls: bool = False

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return a force that peaks at 1 %, or one of 0.1 N at rest."""
        along = problem.longitudinal_creepage
        share = 0.02 * along / (along**2 + 1e-4) if self.falls else 0.5 + 0.5 * along
        force = problem.friction_coefficient * problem.normal_force * share
        return wl.CreepForces(longitudinal=force, lateral=0.0 * force, spin_moment=0.0 * force)


@pytest.mark.parametrize(
    ("falls", "traction", "said"),
    [
        (False, 0.1, "of 0.1: without longitudinal creepage the contact transmits more already"),
        (False, [[0.2, 0.1]], r"of 0.1 at index \[0, 1\]: without longitudinal creepage the contact transmits more"),
        (False, -0.1, "no creepage transmits a traction coefficient of 0.1"),
        (True, 0.31, "of 0.31: with contact model 'odd' the greatest is 0.3, at a creepage of 1 %; give a smaller one"),
    ],
)
def test_a_traction_of_no_creepage_is_refused(falls: bool, traction: Any, said: str) -> None:
    with pytest.raises(wl.ConditionsError, match=said):
        wl.creepage_for(WHEEL | Odd(falls=falls), traction_coefficient=traction, **ON_ELLIPSE)


def test_the_creepage_is_that_of_the_rising_branch() -> None:
    found = wl.creepage_for(WHEEL | Odd(), traction_coefficient=0.2, **ON_ELLIPSE)
    assert found.to("").magnitude == pytest.approx(1 / 3, rel=1e-12)
    # 2 x/(x² + 1) is s at (1 - √(1 - s²))/s, in percent, and again beyond 1.
    share = np.array([0.01, 2 / 3, 0.999, -2 / 3])
    found = wl.creepage_for(WHEEL | Odd(falls=True), traction_coefficient=0.3 * share, **ON_ELLIPSE)
    assert found.to("%").magnitude == pytest.approx((1.0 - np.sqrt(1.0 - share**2)) / share, rel=1e-10)


class TwoHumps(Odd):
    """A traction with a narrow first hump of 0.1 at 0.0115 %, and a second of 0.2 at 3 %."""

    name: ClassVar[str] = "two_humps"

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return the force of both humps, which are parabolas of the logarithm."""
        log = np.log(problem.longitudinal_creepage)
        humps = [
            height * np.maximum(1.0 - ((log - np.log(place)) / width) ** 2, 0.0)
            for height, place, width in ((0.1, 1.15e-4, 0.3), (0.2, 0.03, 1.0))
        ]
        force = sum(humps) * problem.normal_force
        return wl.CreepForces(longitudinal=force, lateral=0.0 * force, spin_moment=0.0 * force)


def test_a_first_hump_with_its_peak_between_the_samples_of_the_search_is_seen() -> None:
    share = np.array([0.5, 0.999])  # the samples about the peak, at 0.0100 and 0.0133 %, have 0.78 and 0.76 of it
    found = wl.creepage_for(WHEEL | TwoHumps(), traction_coefficient=0.1 * share, **ON_ELLIPSE)
    assert found.to("").magnitude == pytest.approx(1.15e-4 * np.exp(-0.3 * np.sqrt(1.0 - share)), rel=1e-10)


def scanned(predict: Any, creepages: Any, **conditions: Any) -> Any:
    found = predict(**{predict.rig.creepage: Q(creepages, "")}, **conditions)
    return (found.longitudinal_force / found.normal_force).to("").magnitude


@pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning")
@pytest.mark.parametrize(
    ("rig", "model", "conditions"),
    [
        (wl.TwinDisc.suros(rolling_speed="4 m/s"), "exact", {"max_pressure": "1100 MPa", "friction_coefficient": 0.4}),
        (WHEEL, "strip_theory", {"normal_force": "90 kN", "friction_coefficient": 0.4}),
        (WHEEL, "polach", {"normal_force": "90 kN", "friction_coefficient": 0.4, "lateral_creepage": "0.1 %"}),
    ],
)
def test_hot_contacts_agree_with_a_scan(rig: Any, model: str, conditions: Any) -> None:
    hot = rig | wl.contact_model(model) | wl.stage("thermal", hot_ratio=0.5, temperature_range="60 K")
    creepages = np.geomspace(1e-4, 1.0, 2001)
    traction = scanned(hot, creepages, **conditions)
    greatest = traction.max()
    assert traction[-1] < 0.9 * greatest
    wanted = greatest * np.array([0.3, 0.9, 0.9999, 1.0])
    found = wl.creepage_for(hot, traction_coefficient=wanted, **conditions).to("").magnitude
    # The stage finds μ to rounding, and the traction near its peak hardly depends on the creepage.
    assert scanned(hot, found, **conditions) == pytest.approx(wanted, rel=1e-12)
    after = np.array([np.flatnonzero(traction >= one)[0] for one in wanted])
    assert (found <= creepages[after] * (1.0 + 1e-12)).all()
    assert (found > creepages[after - 1]).all()
    with pytest.raises(wl.ConditionsError, match="the greatest is") as error:
        wl.creepage_for(hot, traction_coefficient=1.001 * greatest, **conditions)
    stated, at = map(float, re.findall(r"the greatest is (\S+), at a creepage of (\S+) %", str(error.value))[0])
    # Six digits. Samples 0.46 % apart miss the peak by less than it differs from the lower of its neighbours.
    top = traction.argmax()
    missed = greatest - traction[top - 1 : top + 2].min()
    assert greatest * (1.0 - 5e-6) <= stated <= (greatest + missed) * (1.0 + 5e-6)
    assert creepages[top - 1] <= 0.01 * at * (1.0 + 1e-3)
    assert 0.01 * at * (1.0 - 1e-3) <= creepages[top + 1]


def test_only_the_contacts_that_are_the_result_warn() -> None:
    slow = WHEEL.model_copy(update={"rolling_speed": Q(0.02, "m/s")})
    hot = slow | wl.contact_model("polach") | wl.stage("thermal", hot_ratio=0.5, temperature_range="1 K")
    with pytest.warns(wl.RangeWarning, match="2 of 2 contacts") as caught:
        wl.creepage_for(hot, traction_coefficient=[0.15, 0.17], **ON_ELLIPSE)
    assert len(caught) == 1


LIMIT = wl.Unit("%", positive=False, limit=10.0)


class Narrow(Roller):
    """A roller whose creepage stays below a tenth."""

    name: ClassVar[str] = "narrow"

    def problem(self, /, **conditions: Any) -> wl.Problem:
        """Return that of the roller, or raise an error beyond the limit."""
        LIMIT.si(conditions["creepage"], "creepage")
        return super().problem(**conditions)

    @classmethod
    def conditions(cls) -> Any:
        """Return those of the roller with a limit."""
        return {
            name: dataclasses.replace(one, unit=LIMIT) if name == "creepage" else one
            for name, one in Roller.conditions().items()
        }


def test_the_search_stays_in_the_range_of_the_rig() -> None:
    asked: Any = {"mass": "20 kg", "friction_coefficient": 0.3}
    with pytest.raises(wl.ConditionsError, match=r"stays below 0\.3 "):
        wl.creepage_for(Narrow() | wl.contact_model("exact"), traction_coefficient=0.4, **asked)


def test_full_slip_on_a_rail_has_no_creepage() -> None:
    for traction in (0.3, -0.3, 0.4):
        with pytest.raises(wl.ConditionsError, match=r"no creepage transmits .* stays below 0\.3 \(full slip\)"):
            wl.creepage_for(FASTSIM, traction_coefficient=traction, **ON_ELLIPSE)
    # What friction leaves for the longitudinal direction where the lateral creepage is as large as can be.
    with pytest.raises(wl.ConditionsError, match=r"stays below 0\.2"):
        wl.creepage_for(FASTSIM, traction_coefficient=0.25, lateral_creepage="100 %", **ON_ELLIPSE)


def test_the_creepage_that_is_found_is_not_given() -> None:
    with pytest.raises(wl.ConditionsError, match="creepage: creepage_for returns it; leave it out"):
        wl.creepage_for(ROLLER, traction_coefficient=0.1, mass="20 kg", creepage="1 %")
