"""The normal problem of wheels: Hertz, brute force in space, and what holds for any pressure of half-spaces."""

from __future__ import annotations

import warnings
from itertools import islice
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.wheelset.brute_force import TURNS, compared, positions
from tests.plugins.wheelset.test_roll import STEEL, service
from tests.plugins.wheelset.wheelsets import R0, cone, on_round_heads, wheelset
from wearlaw import Array, Q
from wearlaw_models.rigs.wheelset.pressure import SLACK  # private: the accuracy that a search ends at

FASTSIM = wl.contact_model("fastsim")
PRESSURE, AREA, MISPLACED = 0.01, 0.03, 0.03
"""Errors of the grid: of the maximum pressure, of the area, and the share of the force that it puts elsewhere.

Rows lie sixteen to the width of the overlap, and elements four to half of the length of the patch. By the errors of
Hertz's ellipses below, of second order, that is 0.4 % of the force and 1 % of the pressure. Half of a row is missing or
too much at either end: 0.6 % of the force of a patch with eleven rows, and two humps have four ends.
"""
SETTINGS = settings(max_examples=8)
places = {
    "displacement": st.floats(-6.2e-3, 6.2e-3),
    "yaw": st.floats(-20e-3, 20e-3),
    "load": st.floats(5e3, 120e3),
    "worn": st.booleans(),
}


def worn_pair() -> wl.Wheelset:
    """Return wheels and rails worn by bells of up to 0.6 mm, which leave two humps."""
    s = np.arange(-60.0, 60.0, 0.1)
    wheel, rail = wl.Profile.s1002(), wl.Profile.uic60()
    inside = [(s > 1e3 * one.curve.s[0]) & (s < 1e3 * one.curve.s[-1]) for one in (wheel, rail)]
    tread = 0.6 * np.exp(-(((s - 2.0) / 9.0) ** 2)) + 0.4 * np.exp(-(((s + 38.0) / 6.0) ** 2))
    head = 0.3 * np.exp(-(((s + 1.0) / 8.0) ** 2))
    return wheelset(
        wheel=wheel.worn(Q(s[inside[0]], "mm"), Q(tread[inside[0]], "mm")),
        rail=rail.worn(Q(s[inside[1]], "mm"), Q(head[inside[1]], "mm")),
    )


PAIRS = {False: wheelset(), True: worn_pair()}


def posed(pair: wl.Wheelset, displacement: Any, yaw: Any, load: Any, friction: float = 1e-12, **more: Any) -> Any:
    """Return the balanced problem of a wheelset in SI, by default without creep forces."""
    conditions = {
        "lateral_displacement": Q(displacement, "m"), "yaw": Q(yaw, "rad"), "vertical_load": Q(load, "N"),
        "friction_coefficient": friction,
    }  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return (pair | FASTSIM).posed(conditions | more)


# --------------------------------------------------------------------------------------------------------------- Hertz


@pytest.mark.validates(
    "wheelset",
    "Cylinders on round heads with yaw up to 50 mrad, 5 to 100 kN: maximum pressure and area",
    source="Hertz, closed form",
    held_to="{pressure:.0%}, {area:.0%}",
    pressure=PRESSURE,
    area=AREA,
)
@SETTINGS
@given(head=st.sampled_from([0.05, 0.08, 0.3, 1.0]), yaw=st.floats(-0.05, 0.05), load=st.floats(5e3, 100e3))
@example(head=0.3, yaw=0.0, load=80e3)
def test_cylinders_on_round_heads_are_pressed_as_by_hertz(
    head: float, yaw: float, load: float, pressure: float, area: float
) -> None:
    pair = on_round_heads(cone(1e-9), head)
    problem = posed(pair, 0.0, yaw, load, roll="0 mrad")
    cos, sin = np.cos(yaw), np.sin(yaw)
    form = np.array([[cos * cos, cos * sin], [cos * sin, sin * sin]]) / (2.0 * R0) + np.diag([0.0, 0.5 / head])
    low, high = np.linalg.eigvalsh(form)
    force = np.array(load)
    a, b = wl.hertz_ellipse.semi_axes(force, np.array(low), np.array(high), pair._elastic.modulus)
    assert problem.max_pressure[:, 0] == pytest.approx(float(wl.hertz_ellipse.max_pressure(force, a, b)), rel=pressure)
    assert problem.strips.area[:, 0].sum(axis=-1) == pytest.approx(np.pi * a * b, rel=area)
    assert problem.wheel_load[:, 0] == pytest.approx(load, rel=1e-6)  # as the loads balance


# --------------------------------------------------------------------------------------------------------- brute force


@pytest.mark.parametrize("number", [1, 13])
def test_wheels_are_pressed_as_by_brute_force(number: int) -> None:
    """Two of the positions of `test_normal_positions`."""
    position = next(islice(positions(60), number, None))
    for due, off in compared(position):
        assert off is not None
        assert off.load == pytest.approx(0.0, abs=1e-6)
        if due.turn <= TURNS:
            assert (np.abs(off[:3]) <= (PRESSURE, AREA, MISPLACED)).all(), (position, off)


@pytest.mark.validates(
    "wheelset",
    "Wheels under 80 kN, from the tread over two humps to the flange: maximum pressure, N and angle on the tread,"
    " power",
    source="CONTACT (Vollebregt), half-space theory on elements of 0.4 mm, whose own error is 2 %",
    held_to="{pressure:.0%}, {force:.2%}, {milliradian:g} mrad, {power:.0%}",
    pressure=0.01,
    force=0.0005,
    milliradian=0.7,
    power=0.02,
)
def test_wheels_under_service_load_are_pressed_as_in_contact(
    pressure: float, force: float, milliradian: float, power: float
) -> None:
    expected = service()
    pair: Any = wheelset(material=STEEL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        result = (pair | FASTSIM)(
            lateral_displacement=Q(expected["displacement"], "mm"), yaw="12 mrad", vertical_load="80 kN",
            friction_coefficient=0.3, angular_speed=Q(2.0 / R0, "rad/s"), roll=Q(expected["roll"], "rad"),
        )  # fmt: skip
    problem: Any = result.problem
    assert 1e-6 * np.nanmax(problem.max_pressure[:, 1], axis=-1) == pytest.approx(expected["pmax"], rel=pressure)
    # At 5 mm the humps are 0.15 rad apart, and CONTACT's angle is that of their overlap; at 7 mm Fy bears a quarter.
    tread = expected["displacement"] < 4.0
    assert problem.normal_force[tread, 1, 0] == pytest.approx(expected["fn"][tread], rel=force)
    angle = problem.contact_angle[tread, 1, 0]
    assert 1e3 * angle == pytest.approx(1e3 * expected["delta"][tread], rel=0.0, abs=milliradian)
    found = result.wear_index.to("N").magnitude[:, 1]
    joined = expected["displacement"] == 5.0
    assert (np.abs(np.nansum(found, axis=-1) / expected["tgamma"] - 1.0) < np.where(joined, 2.0 * power, power)).all()


# ---------------------------------------------------------------------------------------------------------- properties


@SETTINGS
@given(**places)
def test_pressure_and_gap_exclude_each_other(displacement: float, yaw: float, load: float, worn: bool) -> None:
    for stand in posed(PAIRS[worn], displacement, yaw, load, 0.3).loads.stands:
        pressed = stand.pressed
        rows, now = stand.rows, pressed.now
        slack = SLACK * rows.deepest.max()
        assert (now[pressed.on] >= 0.0).all()  # pressure
        assert (now[~pressed.on] <= slack).all()  # overlap
        assert (pressed.pressure[~pressed.on] == 0.0).all()


@SETTINGS
@given(**places)
def test_loads_are_the_sums_of_rows_and_creepages_their_means(
    displacement: float, yaw: float, load: float, worn: bool
) -> None:
    problem = posed(PAIRS[worn], displacement, yaw, load, 0.3)
    strips, there = problem.strips, problem.exists
    force = strips.normal_force
    rounding = 1e-12
    assert force.sum(axis=-1)[there] == pytest.approx(problem.normal_force[there], rel=rounding)
    for name in ("longitudinal_creepage", "lateral_creepage", "spin"):
        mean = (force * getattr(strips, name)).sum(axis=-1)[there] / force.sum(axis=-1)[there]
        most = np.abs(getattr(strips, name)[there]).max()
        assert mean == pytest.approx(getattr(problem, name)[there], rel=rounding, abs=rounding * most + 1e-15), name
    assert (np.diff(strips.y[there], axis=-1)[(strips.width[there] > 0.0)[:, 1:]] > 0.0).all()


@SETTINGS
@given(**places)
def test_deeper_wheels_press_harder(displacement: float, yaw: float, load: float, worn: bool) -> None:
    loads = load * np.array([1.0, 1.02, 1.5])
    problem = posed(PAIRS[worn], displacement, yaw, loads)
    height = np.empty(loads.size)
    for stand in problem.loads.stands:  # the last one of a position counts
        height[stand.points] = stand.now[0].mean(axis=-1)
    assert (np.diff(height) > 0.0).all()


def test_rows_are_split_beside_a_groove_alone() -> None:
    # As narrow everywhere, they would be 147.
    new = wl.Profile.s1002()
    arc = np.arange(new.curve.s[0], new.curve.s[-1], 0.05e-3)
    depth = 0.01 * np.exp(-((new.curve.at(arc)[0] / 0.3e-3) ** 2))
    grooved = wheelset(wheel=new.worn(Q(1e3 * arc, "mm"), Q(depth, "mm")))
    rows = posed(grooved, 0.0, 0.0, 80e3).loads.stands[0].rows
    width = rows.width[rows.wheel == 0]
    assert width.min() < 0.2e-3 < 0.5e-3 < width.max()
    assert width.size < 75


def mirrored(array: Array) -> Array:
    """Return an array of a problem with its sides swapped."""
    return np.asarray(array)[..., ::-1, :]


@SETTINGS
@given(**places)
def test_mirrored_positions_have_mirrored_pressures(displacement: float, yaw: float, load: float, worn: bool) -> None:
    one, other = (posed(PAIRS[worn], sign * displacement, sign * yaw, load, 0.3) for sign in (1.0, -1.0))
    # Steps of the balance are the same but for the sides, whose order changes the rounding of its equations.
    for name in ("normal_force", "max_pressure", "a", "b", "longitudinal_creepage", "penetration"):
        assert mirrored(getattr(other, name)) == pytest.approx(
            np.asarray(getattr(one, name)), rel=1e-7, abs=1e-12, nan_ok=True
        ), name


@SETTINGS
@given(**places)
def test_reversed_yaws_are_pressed_alike(displacement: float, yaw: float, load: float, worn: bool) -> None:
    # Seen from behind, the wheelset yaws the other way; x is reversed, and all else stays.
    one, other = (posed(PAIRS[worn], displacement, sign * yaw, load) for sign in (1.0, -1.0))
    much = np.nan_to_num(one.normal_force) > 1e-3 * load  # smaller patches carry what the balance leaves over
    for name in ("normal_force", "max_pressure", "a", "b", "penetration"):
        assert getattr(other, name)[much] == pytest.approx(getattr(one, name)[much], rel=1e-6), name


@SETTINGS
@given(seed=st.integers(0, 1000), worn=st.booleans(), force=st.booleans())
def test_a_position_alone_is_that_in_a_batch_in_any_order(seed: int, worn: bool, force: bool) -> None:
    draw, count = np.random.default_rng(seed), 5
    values = draw.uniform(-5.5e-3, 5.5e-3, count), draw.uniform(-15e-3, 15e-3, count), draw.uniform(1e4, 9e4, count)
    friction = 0.3 if force else 1e-7
    whole = posed(PAIRS[worn], *values, friction)
    order = draw.permutation(count)
    place, yaw, load = values
    shuffled = posed(PAIRS[worn], place[order], yaw[order], load[order], friction)
    alone = posed(PAIRS[worn], place[2], yaw[2], load[2], friction)
    for name in ("normal_force", "max_pressure", "a", "b", "longitudinal_creepage", "roll"):
        due = np.asarray(getattr(whole, name))
        assert np.asarray(getattr(shuffled, name)) == pytest.approx(due[order], rel=1e-9, abs=1e-15, nan_ok=True), name
        assert np.asarray(getattr(alone, name)) == pytest.approx(due[2], rel=1e-9, abs=1e-15, nan_ok=True), name


def test_areas_grow_evenly_as_a_row_begins_to_touch() -> None:
    strips = posed(PAIRS[False], 5e-3, 0.0, np.arange(66e3, 68e3, 50.0)).strips
    steps = np.diff(np.nansum(strips.area, axis=(-2, -1))[:, 0])
    assert steps.max() < 3.0 * steps.mean()
    y, width = (array[:, 0, 0] for array in (strips.y, strips.width))  # of the patch on the left
    beside = (width[:, 1:] > 0.0) & (width[:, :-1] > 0.0)
    apart = np.diff(y) - 0.5 * (width[:, 1:] + width[:, :-1])
    assert np.abs(apart[beside]).max() < 1e-12  # the part that touches lies beside the next row


def test_ellipses_have_the_force_and_the_area_of_the_strips() -> None:
    given_: dict[str, Any] = {"lateral_displacement": Q([0.8, 3.0, 5.8], "mm"), "vertical_load": "80 kN"}
    pose = {"friction_coefficient": 1e-14, **given_}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        strips, ellipse = ((wheelset(patch=patch) | FASTSIM).posed(pose) for patch in ("strips", "ellipse"))
    assert ellipse.strips is None
    there = strips.exists
    for name in ("normal_force", "a", "b", "contact_angle"):
        assert getattr(ellipse, name)[there] == pytest.approx(getattr(strips, name)[there], rel=1e-6), name
    assert strips.strips is not None
    assert np.pi * (ellipse.a * ellipse.b)[there] == pytest.approx(strips.strips.area[there].sum(axis=-1), rel=1e-12)
    assert 2.0 * ellipse.a[there] == pytest.approx(2.0 * strips.strips.half_length.max(axis=-1)[there], rel=1e-12)
