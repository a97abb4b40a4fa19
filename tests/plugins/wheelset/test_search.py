"""Where wheels touch their rails: closed forms, a search over the wheel's surface in space, and symmetries."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import scipy
import xarray
from hypothesis import example, given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.wheelset.brute_force import worn
from tests.plugins.wheelset.wheelsets import (
    R0,
    Body,
    cone,
    gap,
    hollow,
    least_gap,
    middle_of_head,
    on_round_heads,
    standing,
    wheelset,
)
from wearlaw import Array, Q
from wearlaw_models.rigs.wheelset.search_loops import (  # private: the accuracy that a search ends at
    ROLL_ACCURACY,
    ROUNDING,
)

SIDE = np.array([-1.0, 1.0])
STANDARD = wheelset()
PRINTED_STEPS = 1.2e-7 + 3.7e-8
"""Sum of the steps that the printed formulas of S1002 leave [m]."""
LEVEL = 4.0 * ROLL_ACCURACY
"""Accuracy of a roll [rad]: the least gaps may differ by 2 ROLL_ACCURACY, on levers of about 0.75 m a side and more."""


def si(data: xarray.Dataset, name: str) -> Array:
    """Return a variable in SI."""
    unit = {"mm": 1e-3, "mrad": 1e-3, "deg": np.pi / 180.0, "1/m": 1.0}[data[name].attrs["units"]]
    return np.asarray(data[name].values * unit)


def first(pair: wl.Wheelset, displacement: Any, yaw: Any = 0.0) -> xarray.Dataset:
    """Return the first patches at displacements [m] and a yaw [rad], without warnings of climbing."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)
        data: xarray.Dataset = pair.geometry(lateral_displacement=Q(displacement, "m"), yaw=Q(yaw, "rad")).dataset
        return data.sel(patch=1)


# ----------------------------------------------------------------------------------------------------- closed forms


@pytest.mark.validates(
    "wheelset",
    "Contact point, roll, radius and angle of cones on round rail heads",
    source="closed form",
    held_to="{metres:g} m and rad",
    metres=2e-10,
)
@pytest.mark.filterwarnings("ignore:the tread has a conicity of 0.2:wearlaw.UnusualWarning")
@pytest.mark.parametrize(("conicity", "head"), [(0.025, 0.08), (0.025, 0.3), (0.05, 0.08), (0.05, 0.3), (0.2, 0.08)])
def test_cones_touch_round_heads_where_the_closed_form_says(conicity: float, head: float, metres: float) -> None:
    # In the axes of the wheelset, the middles of the heads are on lines parallel to the cones, at the distance of the
    # head's radius. The distance of these middles and its tilt, the roll, give their places (p, H - γ p), (-q, H - γ q)
    # and the displacement.
    pair, rail, hypotenuse = on_round_heads(cone(conicity), head), middle_of_head(head), np.hypot(1.0, conicity)
    height = R0 + conicity * 0.75 + head * hypotenuse
    roll = np.array([-1e-3, -1e-4, 0.0, 2e-4, 7e-4])[:, None] * min(1.0, 20.0 * conicity)
    displacement = -np.sin(roll) * (rail * np.cos(roll) * hypotenuse**2 / conicity - height)
    middle = rail * np.cos(roll) + SIDE * rail * np.sin(roll) / conicity
    on_wheel = middle - head * conicity / hypotenuse
    angle = SIDE * roll - np.arctan(conicity)
    found = first(pair, displacement[:, 0])
    # A slope is known to ROUNDING, on heads of up to 0.3 m; a roll to LEVEL, which moves p by its share of rail/γ.
    bound = 10.0 * head * ROUNDING + LEVEL * rail / conicity
    assert bound < metres
    assert si(found, "roll") == pytest.approx(roll[:, 0], rel=0.0, abs=LEVEL)
    assert si(found, "contact_angle") == pytest.approx(SIDE * angle, rel=0.0, abs=metres)
    assert si(found, "y") == pytest.approx(SIDE * (rail + head * np.sin(angle)), rel=0.0, abs=metres)
    assert si(found, "z") == pytest.approx(head * (1.0 - np.cos(angle)), rel=0.0, abs=metres)
    assert si(found, "wheel_y") == pytest.approx(on_wheel - 0.75, rel=0.0, abs=metres)
    assert si(found, "rolling_radius") == pytest.approx(R0 - conicity * (on_wheel - 0.75), rel=0.0, abs=metres)


@pytest.mark.filterwarnings("ignore:the tread has a conicity of 0.2:wearlaw.UnusualWarning")
@pytest.mark.parametrize(("conicity", "head"), [(0.025, 0.3), (0.05, 0.08), (0.2, 0.08)])
def test_cones_have_the_conicity_of_the_closed_form(conicity: float, head: float) -> None:
    # From the middles of the heads above, Δr = -2 Y sin ρ and u = -sin ρ (Y cos ρ (1 + γ²)/γ - H), so that Δr/2u is
    # γ/(cos ρ (1 + γ²) - γ H/Y): that of the cones, but for the roll, which lifts them over the heads.
    pair, rail = on_round_heads(cone(conicity), head), middle_of_head(head)
    height = R0 + conicity * 0.75 + head * np.hypot(1.0, conicity)
    expected = conicity / (1.0 + conicity**2 - conicity * height / rail)
    roll = 3e-3 * conicity / (rail - conicity * height)
    # 1 - cos ρ at the largest roll; the wave's integrals take differences of r to LEVEL γ of 2γ u, at u down to 1 µm.
    found = float(pair.equivalent_conicity(amplitude="3 mm").magnitude)
    assert found == pytest.approx(expected, rel=roll**2 + 1e-8)


def hollow_on_round(conicity: float, tread: float, head: float) -> wl.Wheelset:
    """Return a wheelset that touches the rails at its taping lines in the middle of the track."""
    base = middle_of_head(head) - head * np.sin(np.arctan(conicity))
    return on_round_heads(hollow(conicity, tread), head, base)


def linkage(displacement: float, conicity: float, tread: float, head: float) -> tuple[float, Array, Array]:
    """Return the roll, and the places of contact (y, z) in outward coordinates, of hollow treads on round heads.

    The middles of the arcs of a wheel and its rail are a fixed distance apart, tread - head, so that the wheelset is
    the coupler of a linkage with four bars.
    """
    angle, rail = np.arctan(conicity), middle_of_head(head)
    middle = np.array([rail + (tread - head) * np.sin(angle), R0 + tread * np.cos(angle)])

    def raised(roll: float, side: float) -> tuple[float, float, float]:
        """Return the height of the axle, and where the middle of the tread's arc is below the middle of the head."""
        cos, sin = np.cos(roll), side * np.sin(roll)
        across = middle[0] * cos - middle[1] * sin + side * displacement - rail
        down = np.sqrt((tread - head) ** 2 - across**2)
        return head + down - (middle[0] * sin + middle[1] * cos), across, down

    roll = scipy.optimize.brentq(lambda x: raised(x, 1.0)[0] - raised(x, -1.0)[0], -0.02, 0.02, xtol=1e-16)
    place = np.array([raised(roll, side)[1:] for side in (-1.0, 1.0)]) * head / (tread - head)
    return float(roll), rail - place[:, 0], head - place[:, 1]


@pytest.mark.validates(
    "wheelset",
    "Contact point and roll of hollow treads on round rail heads",
    source="linkage of four bars through the middles of the arcs",
    held_to="{metres:g} m and rad",
    metres=1e-10,
)
@pytest.mark.parametrize(("conicity", "tread", "head"), [(0.05, 0.5, 0.3), (0.1, 0.36, 0.3), (0.05, 0.12, 0.08)])
def test_hollow_treads_on_round_heads_are_a_linkage(conicity: float, tread: float, head: float, metres: float) -> None:
    pair = hollow_on_round(conicity, tread, head)
    displacement = np.array([-2e-3, -0.7e-3, 0.0, 0.3e-3, 1.5e-3])
    found = first(pair, displacement)
    expected = [linkage(u, conicity, tread, head) for u in displacement]
    # The contact point runs by 1/(1 - head/tread) and less of what the wheel does, here up to 6 times; slopes known to
    # ROUNDING fix it to tread · head/(tread - head) times that.
    lever = tread / (tread - head)
    assert (head * ROUNDING + LEVEL) * lever < metres
    assert si(found, "roll") == pytest.approx(np.array([roll for roll, _, _ in expected]), rel=0.0, abs=lever * LEVEL)
    assert SIDE * si(found, "y") == pytest.approx(np.array([y for _, y, _ in expected]), rel=0.0, abs=metres)
    assert si(found, "z") == pytest.approx(np.array([z for _, _, z in expected]), rel=0.0, abs=metres)
    # Splines through points of arcs, h apart, know the curvature to h²/R³, and to 12 times the rounding of y over h².
    radius, angle = si(found, "rolling_radius"), si(found, "contact_angle")
    for name, arc, apart in (("wheel_curvature", -tread, 120e-3 / 2400), ("rail_curvature", head, 90e-3 / 1600)):
        spline = (apart / arc) ** 2 + 12.0 * np.finfo(float).eps * 60e-3 * abs(arc) / apart**2
        assert si(found, name) == pytest.approx(1.0 / arc, rel=spline)
    of_profile = angle - si(found, "roll")[:, None]
    assert si(found, "rolling_curvature") == pytest.approx(np.cos(of_profile) / radius, rel=1e-12)


def test_hollow_treads_have_the_conicity_of_wickens() -> None:
    # γ0 R_w/(R_w - R_r) (e + R_r γ0)/(e - r0 γ0) for half the distance e of the contact points: A. H. Wickens,
    # Fundamentals of Rail Vehicle Dynamics (2003), for small angles: the rest is of second order in γ0 and of second
    # order in the amplitude over R_w - R_r.
    conicity, tread, head, amplitude = 0.002, 0.4, 0.3, 0.1e-3
    pair = hollow_on_round(conicity, tread, head)
    half = middle_of_head(head) - head * conicity
    expected = conicity * tread / (tread - head) * (half + head * conicity) / (half - R0 * conicity)
    second = (conicity * tread / (tread - head)) ** 2 + (amplitude / (tread - head)) ** 2
    found = float(pair.equivalent_conicity(amplitude=Q(amplitude, "m")).magnitude)
    assert found == pytest.approx(expected, rel=3.0 * second)


# --------------------------------------------------------------------------------------------------------- in space

IN_SPACE = [
    (0.189, 27.028), (-5.693, 26.919), (5.243, -5.448), (7.9, 30.0), (-7.0, 22.0), (6.15, -12.0), (0.0, 30.0),
    (4.87, 11.69), (6.2, 14.88), (3.0, 7.2),
]  # fmt: skip
"""Displacements [mm] and yaws [mrad]: on the tread, in the root, and on the flange up to 65 deg."""


@pytest.mark.validates(
    "wheelset",
    "Contact of S1002 on 60E1 with roll and yaw: the least gap between the bodies is zero, and where it is",
    source="search over the surface of the wheel in space (scipy)",
    held_to="gap {gap_metres:g} m, place {metres:g} m",
    gap_metres=1e-9,
    metres=2e-7,
)
@pytest.mark.parametrize(("displacement", "yaw"), IN_SPACE)
def test_wheels_touch_where_their_surfaces_in_space_are_nearest(
    displacement: float, yaw: float, gap_metres: float, metres: float
) -> None:
    # The gap has the rounding of z, so that its flat bottom hides the place by √(2 · 1e-16 m/κ), with a κ of 0.01/m
    # at least: 1.5e-7 m.
    found = first(STANDARD, 1e-3 * displacement, 1e-3 * yaw)
    where = standing(1e-3 * displacement, si(found, "roll"), 1e-3 * yaw, si(found, "vertical_displacement"))
    for side, name in ((-1, "left"), (1, "right")):
        least, place = least_gap(Body(STANDARD, side), *where)
        one = found.sel(side=name)
        assert abs(least) < gap_metres
        assert place == pytest.approx(np.array([si(one, axis) for axis in "xyz"]), rel=0.0, abs=metres)


@given(
    displacement=st.floats(-9e-3, 9e-3),
    yaw=st.floats(-30e-3, 30e-3),
)
@example(displacement=0.006251691881153521, yaw=0.0)
def test_wheels_never_enter_their_rails(displacement: float, yaw: float) -> None:
    found = first(STANDARD, displacement, yaw)
    where = standing(displacement, si(found, "roll"), yaw, si(found, "vertical_displacement"))
    for side in (-1, 1):
        body = Body(STANDARD, side)
        s, angle = np.arange(body.curve.s[0], body.curve.s[-1], 0.2e-3), np.linspace(-0.1, 0.1, 41)
        least = float(gap(body, s[:, None], angle, *where).min())
        # A point of the grid is within 0.1 mm and 2.5 mrad of the contact point, where the gap has curvatures along the
        # wheel of up to 1/(13 mm cos³ 70°) = 2000/m, and of r about the axle.
        # The wheel's formula has steps between its pieces, which lie between points that are searched, and in the root,
        # where the radii of wheel and rail are 13 mm, a wheel may touch beside one.
        assert -1e-9 - PRINTED_STEPS < least < 0.5 * 2000.0 * 0.1e-3**2 + 0.5 * 0.5 * 2.5e-3**2


def test_no_contact_is_lost_where_a_flank_lies_along_its_rail() -> None:
    # At 6.2519 mm the gap between flank and rail changes by 0.2 µm over 5 mm, with slopes of 1e-4 and less. Slopes read
    # between points of the rail 0.05 mm apart were off by more, and some 70 nm of displacement had no contact.
    displacement = np.arange(6.2515e-3, 6.2525e-3, 5e-9)
    data = first(STANDARD, displacement)
    assert np.isfinite(data.contact_angle.values).all()


def test_a_worn_flank_whose_lever_nearly_cancels_touches_its_rail() -> None:
    # A roll moves the flank down and across the rail: of the levers of both wheels, 0.76 m each, 12 mm are left.
    pair = wheelset(wheel=worn(wl.Profile.s1002(), (3.14, 9.1, 0.523), (-38.0, 6.0, 0.298)))
    data = first(pair, np.linspace(-6.4e-3, -6.3994e-3, 60), 2.85e-3)
    assert np.isfinite(data.contact_angle.values).all()
