"""Lateral forces on wheelsets: equilibrium, Nadal's limit, symmetry, and displacements that give their forces back."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Iterator
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.brute_force import positions
from tests.plugins.wheelset.wheelsets import borne, on_round_heads, through, wheelset
from wearlaw import Array, Q
from wearlaw_models.rigs.wheelset.guidance import BORNE  # private: the accuracy that a search ends at
from wearlaw_models.rigs.wheelset.rows import rows as lay  # private: rows are laid otherwise
from wearlaw_models.rigs.wheelset.stand import BALANCED  # private: the accuracy that a search ends at

# Rows stay while a wheel moves by up to 50 µm along its rail. Over a relative curvature of 1/13 mm that is 0.1 µm of
# the approach, of 50 µm on a flange, whose power of 1.5 the force is: a share of the load of a wheel.
LAID = 3e-3

PAIR = wheelset(rolling_speed="20 m/s") | wl.contact_model("strip_theory")
RESULTS = ["lateral_displacement", "guiding_force", "wheel_load", "derailment_quotient"]

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")


def si(result: wl.Prediction, name: str) -> Array:
    """Return a result of the wheels, (points, sides), in SI."""
    return np.asarray(result.sel(patch=1)[name].to_base_units().magnitude)


def drawn(count: int) -> dict[str, Array]:
    """Return forces, loads, yaws and friction in SI, for which strips have a balance."""
    draw = np.random.default_rng(3)
    return {
        "lateral_force": draw.uniform(-40e3, 40e3, count),
        "vertical_load_left": draw.uniform(40e3, 80e3, count),
        "vertical_load_right": draw.uniform(40e3, 80e3, count),
        "yaw": draw.uniform(-8e-3, 8e-3, count),
        "friction_coefficient": draw.uniform(0.1, 0.4, count),
        "curvature": draw.uniform(-1.0 / 400.0, 1.0 / 400.0, count),
    }


def guided(given: dict[str, Array], **more: Any) -> wl.Prediction:
    """Return the contact under conditions in SI."""
    units = {"yaw": "rad", "friction_coefficient": ""}
    conditions = {name: Q(value, units.get(name, "N")) for name, value in given.items() if name != "curvature"}
    return PAIR(**conditions, curve_radius=Q(1.0 / given["curvature"], "m"), **more)


GIVEN = drawn(12)

needs_numba = pytest.mark.skipif(not find_spec("numba"), reason="the loops are compiled by numba")


@pytest.fixture(scope="module", params=[False, pytest.param(True, marks=needs_numba)])
def found(request: pytest.FixtureRequest) -> Iterator[wl.Prediction]:
    """Return the contact under the drawn conditions, by NumPy and by compiled loops."""
    wl.accelerate(request.param)
    yield guided(GIVEN)
    wl.accelerate(None)


def test_forces_on_the_rails_balance_those_on_the_wheelset(found: wl.Prediction) -> None:
    # From the patches alone, whose forces the balance does not share with the results.
    vertical, lateral = borne(found.problem, found.lateral_force.to("N").magnitude)
    loads = np.stack([GIVEN["vertical_load_left"], GIVEN["vertical_load_right"]], axis=-1)
    axle = loads.sum(axis=-1)
    assert (np.abs(lateral.sum(axis=-1) - GIVEN["lateral_force"]) < 1.01 * BORNE * axle).all()
    np.testing.assert_allclose(vertical, loads, rtol=2.0 * BALANCED)
    # Sums of patches in another order, of forces up to three times the load.
    np.testing.assert_allclose(si(found, "guiding_force"), lateral, atol=1e-9 * axle.max())
    np.testing.assert_allclose(si(found, "wheel_load"), vertical, rtol=1e-9)
    np.testing.assert_allclose(si(found, "derailment_quotient"), lateral / vertical, atol=1e-8)


def test_displacements_found_give_the_forces_back(found: wl.Prediction) -> None:
    place = si(found, "lateral_displacement")[:, 0]
    rest = {name: value for name, value in GIVEN.items() if name != "lateral_force"}
    again = guided(rest, lateral_displacement=Q(place, "m"))
    axle = GIVEN["vertical_load_left"] + GIVEN["vertical_load_right"]
    off = np.abs(si(again, "guiding_force").sum(axis=-1) - GIVEN["lateral_force"])
    assert (off < (BORNE + 0.5 * LAID) * axle).all()


def test_forces_of_displacements_give_the_displacements_back() -> None:
    # Where the sum grows all the way from the middle, only one displacement bears a force.
    place = np.array([-6.3e-3, -5.5e-3, -3e-3, 0.5e-3, 5.2e-3, 6.0e-3, 6.2e-3, 6.3e-3])
    common: dict[str, Any] = {
        "vertical_load": "60 kN",
        "friction_coefficient": 0.3,
        "yaw": Q(5.0 * np.sign(place), "mrad"),
    }
    at = PAIR(lateral_displacement=Q(place, "m"), **common)
    force = si(at, "guiding_force").sum(axis=-1)
    back = si(PAIR(lateral_force=Q(force, "N"), **common), "lateral_displacement")[:, 0]
    # The force that may be left over, over the stiffness there, which is least on the tread.
    ahead = PAIR(lateral_displacement=Q(place + 1e-6, "m"), **common)
    stiffness = (si(ahead, "guiding_force").sum(axis=-1) - force) / 1e-6
    assert (stiffness > 0.0).all()
    assert (np.abs(back - place) < (BORNE * 120e3 + LAID * 60e3) / stiffness).all()


def test_a_force_to_the_right_moves_the_right_flange_to_its_rail() -> None:
    found = PAIR(lateral_force="20 kN", yaw="5 mrad", vertical_load="60 kN", friction_coefficient=0.3)
    force, quotient = si(found, "guiding_force"), si(found, "derailment_quotient")
    assert si(found, "lateral_displacement")[1] > 6e-3
    assert force[1] > 20e3 > 0.0 > force[0]  # the yaw makes the left wheel push its rail to the left
    assert quotient == pytest.approx(force / 60e3, rel=1e-6)


def test_a_search_begins_on_the_side_of_the_force_where_treads_are_crowned() -> None:
    """Rigid wheels on crowned treads bear the less lateral force, the farther out they stand; worn ones become so."""
    y = np.linspace(-60e-3, 60e-3, 241)
    rig = on_round_heads(through(y, -0.05 * y - y**2 / 6.0, "wheel"), 0.3)
    left, right = rig._play.begin(np.array([-1e-3, 1e-3]))  # private: the place where a search begins
    assert left == pytest.approx(-right)
    assert right > 1e-3


def test_strongly_crowned_treads_bear_no_lateral_force_and_say_so() -> None:
    """Rigid wheels do not stand in the middle of the track; displaced ones have results all the same."""
    y = np.linspace(-60e-3, 60e-3, 241)
    rig = on_round_heads(through(y, -0.05 * y - y**2 / 3.0, "wheel"), 0.3)
    predict = rig | wl.contact_model("strip_theory")
    given: Any = {"vertical_load": "60 kN", "friction_coefficient": 0.3}
    pushed = predict(lateral_force=Q([0.0, 1.0], "kN"), **given)
    assert "the greatest lateral force is" in pushed.problem.status[1, 0, 0]  # type: ignore[attr-defined]
    assert np.isnan(si(pushed, "wheel_load")[1]).all()
    displaced = predict(lateral_displacement=Q([-0.3, 0.0, 0.3], "mm"), **given)
    np.testing.assert_allclose(si(displaced, "wheel_load"), 60e3, rtol=2.0 * BALANCED)


def test_loads_that_nowhere_balance_have_no_greatest_force(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wearlaw_models.rigs.wheelset.guidance.ROUGH", -1.0)  # private: no model lacks a balance
    with pytest.raises(wl.ConditionsError, match="have no balance"):
        PAIR(lateral_force="20 kN", vertical_load="60 kN", friction_coefficient=0.3)


def test_a_search_does_not_depend_on_those_beside_it() -> None:
    given: Any = {"vertical_load": "60 kN", "friction_coefficient": 0.3}
    wanted = np.array([0.0, 2e3, 4e3, 20e3])
    together = PAIR(lateral_force=Q(wanted, "N"), **given)
    for number, force in enumerate(wanted):
        alone = PAIR(lateral_force=Q(force, "N"), **given)
        for name in RESULTS:
            np.testing.assert_allclose(si(alone, name), si(together, name)[number], rtol=1e-9, atol=1e-12)


def test_layings_of_rows_that_differ_leave_no_force_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where flanks are worn, rows that are laid anew bear other forces, here by the overlap of a micrometre."""
    number = itertools.count()

    def differing(*arguments: Any) -> Any:
        rows = lay(*arguments)
        deeper = 1e-6 if next(number) % 2 else -1e-6
        return replace(rows, overlap=rows.overlap + np.where(np.abs(rows.place.angle) > 0.5, deeper, 0.0))

    monkeypatch.setattr("wearlaw_models.rigs.wheelset.stand.rows", differing)  # private: as above
    force = np.array([20e3, 40e3, 60e3])
    r = PAIR(lateral_force=Q(force, "N"), vertical_load="60 kN", friction_coefficient=0.3)
    np.testing.assert_allclose(si(r, "guiding_force").sum(axis=-1), force, rtol=0, atol=BORNE * 120e3)


def test_mirrored_forces_have_mirrored_results(found: wl.Prediction) -> None:
    other = dict(GIVEN)
    for name in ("lateral_force", "yaw", "curvature"):
        other[name] = -GIVEN[name]
    other["vertical_load_left"], other["vertical_load_right"] = (
        GIVEN["vertical_load_right"],
        GIVEN["vertical_load_left"],
    )
    mirrored = guided(other)
    axle = (GIVEN["vertical_load_left"] + GIVEN["vertical_load_right"])[:, None]
    assert (np.abs(si(mirrored, "guiding_force")[:, ::-1] + si(found, "guiding_force")) < 4.0 * BORNE * axle).all()
    np.testing.assert_allclose(si(mirrored, "wheel_load")[:, ::-1], si(found, "wheel_load"), rtol=2.0 * BALANCED)


# --------------------------------------------------------------------------------------------------------- the flange


def plane_flange() -> wl.Profile:
    """Return a wheel with a tread at 1:40 and a flange that is straight at 70 deg between arcs of 14 and 10 mm."""
    low, steep = np.arctan(0.025), np.radians(70.0)
    step, y, z = 0.1e-3, [60e-3], [-1.5e-3]
    turns = [
        np.full(900, low),  # the tread, over 90 mm
        np.arange(low, steep, step / 14e-3),
        np.full(80, steep),  # the flank, over 8 mm
        np.arange(steep, 0.0, -step / 10e-3),
    ]
    for angle in np.concatenate(turns):
        y.append(y[-1] - step * np.cos(angle))
        z.append(z[-1] + step * np.sin(angle))
    return through(np.array(y[::-1]), np.array(z[::-1]), "wheel")


@pytest.mark.validates(
    "wheelset",
    "Y/Q of a plane flange of 70° in full lateral slip without spin",
    source="M. J. Nadal, Locomotives a vapeur, Paris 1908",
    held_to="{share:g}",
    share=0.01,
)
@pytest.mark.parametrize(("friction", "limit"), [(0.3, 1.342), (0.1, 2.077)])
@pytest.mark.parametrize("patch", ["strips", "ellipse"])
def test_a_plane_flange_has_the_quotient_of_nadal(patch: Any, friction: float, limit: float, share: float) -> None:
    rig = wheelset(wheel=plane_flange(), patch=patch, rolling_speed="20 m/s")
    contact = rig | wl.contact_model("strip_theory")
    places = rig.geometry(lateral_displacement=Q(np.arange(10.0, 14.0, 0.05), "mm"), roll="0 mrad").dataset
    g = places.sel(side="right", patch=1)
    flank = g.isel(lateral_displacement=int(np.flatnonzero(np.abs(g.contact_angle.values + 70.0) < 0.02)[10]))
    # A wheelset that moves to the left slides down its right flange at 5 % of V over cos 70°; the spin of sin 70°/r
    # adds 2/m times the 2 mm of the patch, a thirtieth. The speed of rotation lets the flange roll.
    found = contact(
        lateral_displacement=Q(float(flank.lateral_displacement), "mm"), vertical_load="10 kN",
        roll="0 mrad", friction_coefficient=friction, lateral_velocity="-1 m/s",
        angular_speed=Q(20.0 / (1e-3 * float(flank.rolling_radius)), "rad/s"),
    )  # fmt: skip
    right = found.sel(side="right", patch=1)
    assert not np.asarray(found.problem.exists)[1, 1:].any()
    assert abs(right.longitudinal_force / right.normal_force).to("").magnitude < 0.05 * friction
    assert right["derailment_quotient"].magnitude == pytest.approx(limit, rel=share)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_force_that_no_flange_bears_is_warned_of_with_the_greatest_one(sign: float) -> None:
    common: dict[str, Any] = {"yaw": Q(5.0 * sign, "mrad"), "vertical_load": "60 kN", "friction_coefficient": 0.3}
    every = PAIR(lateral_displacement=Q(sign * np.arange(6.3, 6.7, 0.02), "mm"), **common)
    greatest = 1e-3 * np.abs(si(every, "guiding_force").sum(axis=-1)).max()
    with pytest.warns(wl.RangeWarning, match=r"1 of 2 positions have no result.* -?110 kN: the greatest") as caught:
        found = PAIR(lateral_force=Q(sign * np.array([20.0, 110.0]), "kN"), **common)
    said = next(str(one.message) for one in caught if "no result" in str(one.message))
    assert ("right" if sign > 0.0 else "left") + " wheel climbs" in said
    # Displacements 0.1 mm apart miss the top of a sum that falls by 1 % over 0.05 mm on either side of it.
    assert abs(float(said.split("force is ")[1].split(" kN")[0])) == pytest.approx(greatest, rel=0.02)
    assert np.isnan(si(found, "guiding_force")[1]).all()
    assert np.isfinite(si(found, "guiding_force")[0]).all()


@pytest.fixture(scope="module")
def worn() -> wl.Wheelset:
    """A wheelset with a worn flange."""
    new = wl.Profile.s1002()
    arc = np.arange(new.curve.s[0], new.curve.s[-1], 0.2e-3)
    depth = 0.48 * np.exp(-(((new.curve.at(arc)[0] + 37e-3) / 5e-3) ** 2))
    return wheelset(wheel=new.worn(Q(1e3 * arc, "mm"), Q(depth, "mm")), rolling_speed="20 m/s")


def sum_of_forces(pipeline: wl.Pipeline[...], displacement: Any) -> Any:
    """Return ∑ Y at lateral displacements [mm] in a curve [kN]."""
    at = pipeline(
        lateral_displacement=Q(displacement, "mm"), vertical_load="80 kN", friction_coefficient=0.3,
        curve_radius="400 m",
    )  # fmt: skip
    return 1e-3 * si(at, "guiding_force").sum(axis=-1)


def test_a_worn_flange_takes_its_load_without_a_jump(worn: wl.Wheelset) -> None:
    # Of the two balances on it, one has twice the lateral force: a third of the steps changed it by 80 kN.
    sums = sum_of_forces(worn | wl.contact_model("fastsim"), np.arange(6.78, 6.805, 0.0025))
    assert (np.abs(np.diff(sums)) < 8.0).all()


def test_a_wheel_that_slides_along_its_flank_has_a_result(worn: wl.Wheelset) -> None:
    # Near the greatest force, rows that were laid again before the loads had a balance went to and fro.
    assert np.isfinite(sum_of_forces(worn | wl.contact_model("strip_theory"), np.arange(6.84, 6.945, 0.01))).all()


# -------------------------------------------------------------------------------------------------------- their places


def test_results_of_wheels_are_in_datasets_and_sweeps() -> None:
    common: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3}
    forces = Q(np.array([0.0, 20.0, 40.0]), "kN")
    one = PAIR(lateral_force=forces, **common).to_dataset()
    swept = wl.sweep(PAIR, lateral_force=forces, **common, outputs=RESULTS)
    assert {name: one[name].attrs["units"] for name in RESULTS} == dict(
        zip(RESULTS, ("mm", "kN", "kN", ""), strict=True)
    )
    for name in RESULTS:
        np.testing.assert_allclose(one[name].values, swept[name].values, rtol=1e-9)
    assert one.guiding_force.dims == ("lateral_force", "side", "patch")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"vertical_load": "60 kN"}, "exactly one of lateral_displacement, lateral_force"),
        ({"lateral_force": "0 kN", "lateral_displacement": "0 mm", "vertical_load": "60 kN"}, "got lateral_disp"),
        ({"lateral_force": "0 kN"}, "vertical_load_left and vertical_load_right"),
        ({"lateral_force": "0 kN", "vertical_load_left": "60 kN"}, "vertical_load_left and vertical_load_right"),
        (
            {"lateral_force": "0 kN", **{f"vertical_load{side}": "9 kN" for side in ("", "_left", "_right")}},
            "give vert",
        ),
    ],
)
def test_displacement_or_force_and_one_way_to_state_the_loads(given: dict[str, str], said: str) -> None:
    with pytest.raises(wl.ConditionsError, match=said), warnings.catch_warnings():
        PAIR(**given, friction_coefficient=0.3)


def test_bounds_of_the_speed_of_rotation_hold_no_longer_where_a_wheelset_slides(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The torque at a speed changes on the way aside: old bounds kept the speed from its balance."""
    monkeypatch.setattr("wearlaw_models.rigs.wheelset.guidance.WITHIN", 1.0)  # private: slides from the first step on
    pair = next(itertools.islice(positions(60), 38, None)).pair
    given: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3}
    found: Any = (pair | wl.contact_model("strip_theory"))(lateral_force=Q([-2.5, 2.5], "kN"), **given)
    assert (found["status"].magnitude == "balanced").all()


@pytest.mark.parametrize(
    ("seed", "number", "radius", "force"),
    [
        (54, 4, np.inf, 15.0), (54, 31, np.inf, -7.5), (54, 37, np.inf, 13.5), (54, 55, np.inf, 12.0),
        (54, 2, 500.0, 120.0 / 7.0), (102, 46, 500.0, 100.0 / 7.0),  # nothing balances where it begins to bear
    ],
)  # fmt: skip
def test_a_search_is_not_sent_away_where_a_flank_begins_to_bear(
    seed: int, number: int, radius: float, force: float
) -> None:
    """A worn flange touches there, within micrometres, and the sum of the lateral forces bends sharply."""
    pair = next(itertools.islice(positions(60, seed), number, None)).pair
    given: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3, "curve_radius": Q(radius, "m")}
    found: Any = (pair | wl.contact_model("strip_theory"))(lateral_force=Q([force], "kN"), **given)
    assert (found["status"].magnitude == "balanced").all()
    _, lateral = borne(found.problem, found.lateral_force.m_as("N"))
    assert lateral.sum(axis=1) == pytest.approx(1e3 * force, abs=BORNE * 120e3)


def test_a_wheel_beyond_an_edge_of_its_worn_flank_does_not_climb_while_it_bears_more() -> None:
    """Wear leaves the steepest place above the contact. The sum of the lateral forces still grows there."""
    new = wl.Profile.s1002()
    depth = 0.3 * np.exp(-0.5 * ((new.curve.s + 41.5e-3) / 1.2e-3) ** 2)
    rig = wheelset(wheel=new.worn(Q(1e3 * new.curve.s, "mm"), Q(depth, "mm")), rolling_speed="20 m/s")
    given: dict[str, Any] = {"yaw": "3 mrad", "vertical_load": "60 kN", "friction_coefficient": 0.3}
    found = (rig | wl.contact_model("strip_theory"))(lateral_force=Q([60.0, 66.0], "kN"), **given)
    place = np.asarray(found.problem.bodies["wheel"].profile_position)[:, 1, 0]
    steepest = rig.wheel.curve.s[int(rig.wheel.curve.angle.argmin())]
    print(f"patches at {place}, the steepest place at {steepest} m")
    assert place[0] < steepest
    problem: Any = found.problem
    assert (problem.status[:, 1, 0] == "balanced").all()
    assert not problem.climbs.any()
