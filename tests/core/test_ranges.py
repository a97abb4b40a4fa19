"""Warnings about operating points outside the range of a wear law."""

from __future__ import annotations

import dataclasses
import re
import warnings
from collections.abc import Mapping
from functools import partial
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Array, Q
from wearlaw.numerics.integrate import BLOCK, NODE_BLOCK
from wearlaw.pipeline.ranges import RangeWatch, mean_over_patch

RIG = wl.TwinDisc.suros(rolling_speed="2 m/s")
EXACT = wl.contact_model("exact")


class Stated(wl.WearLaw):
    """A law of two ramps with a range, one of whose ways to be integrated is by closed form."""

    name: ClassVar[str] = "stated"
    source: ClassVar[str] = "the tests"
    variable: str = "slip"
    low: float = 0.01
    high: float = 0.1
    declared: bool = True

    @property
    def valid_range(self) -> Mapping[str, tuple[float, float]]:
        return {self.variable: (self.low, self.high)}

    def ramps(self, p: wl.Numbers) -> tuple[tuple[float, float], ...] | None:
        return ((0.0, 1e-9), (1e6, 1e-9)) if self.declared else None

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        w = contact.wear_index_density
        return 1e-9 * (w + np.maximum(w - 1e6, 0.0))


def problem(creepage: Any, **changes: Any) -> wl.Problem:
    conditions: Any = {"max_pressure": "1500 MPa", "friction_coefficient": 0.46, **changes}
    return RIG.problem(creepage=Q(creepage, ""), **conditions)


def messages(watch: RangeWatch) -> list[str]:
    """Return the warnings of a watch."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        watch.warn(stacklevel=1)
    assert all(issubclass(each.category, wl.RangeWarning) for each in caught)
    assert all(each.filename == __file__ for each in caught)
    return [str(each.message) for each in caught]


def see(watch: RangeWatch, *blocks: Any) -> None:
    for creepage in blocks:
        part = problem(np.asarray(creepage))
        watch.see(part.size, partial(mean_over_patch, part, {"longitudinal": EXACT.tangential_force(part)}))


def test_points_outside_are_counted_over_all_blocks() -> None:
    watch = RangeWatch(Stated())
    see(watch, [0.001, 0.02, 0.2], [0.05, -0.005], [0.3], 0.05)
    assert messages(watch) == [
        "wear law 'stated' has a known range of mean slip from 1.000 % to 10.00 %; 4 of 7 operating points lie outside,"
        " as far as 30.00 %"
    ]


@pytest.mark.parametrize(
    ("blocks", "outside", "farthest"),
    [
        ([[0.05, 0.002], [0.02, 0.004]], "2 of 4 operating points lie", "0.2000 %"),
        ([[0.05, 0.2], [0.02, 0.15]], "2 of 4 operating points lie", "20.00 %"),
        ([[-0.2], [-0.05]], "1 of 2 operating points lies", "20.00 %"),
    ],
    ids=["below", "above", "negative creepage"],
)
def test_the_farthest_value_is_named(blocks: list[list[float]], outside: str, farthest: str) -> None:
    watch = RangeWatch(Stated())
    see(watch, *blocks)
    (message,) = messages(watch)
    assert f"; {outside} outside, as far as {farthest}" in message


def test_the_borders_belong_to_the_range() -> None:
    within, beyond = RangeWatch(Stated()), RangeWatch(Stated())
    see(within, [0.01, 0.1, -0.1])
    assert messages(within) == []
    see(beyond, [0.01, 0.1, -0.1, 0.2])
    (message,) = messages(beyond)
    assert "; 1 of 4 operating points" in message


def test_no_range_and_no_points_are_no_matter() -> None:
    see(watch := RangeWatch(wl.wear_law("brr")), [0.001, 1.0])
    assert messages(watch) == []
    assert messages(RangeWatch(Stated())) == []


NAMES = ("pressure", "traction", "slip", "slip_speed", "wear_index", "wear_index_density", "frictional_power_density")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_every_variable_is_watched_by_its_patch_mean(name: str, sign: float) -> None:
    creepage = sign * np.geomspace(1e-3, 0.3, 4)
    one = problem(creepage, max_pressure=Q(np.linspace(800.0, 2000.0, 4), "MPa"))
    contact = EXACT.solve(one)
    values = {
        "pressure": 0.25 * np.pi * one.max_pressure,  # the mean of an ellipse
        "traction": contact.mean(np.abs(contact.traction)),
        "slip": np.abs(creepage),
        "slip_speed": 2.0 * np.abs(creepage),
        "wear_index": contact.sum_over_nodes(contact.wear_index_density * contact.area),
        "wear_index_density": contact.mean(contact.wear_index_density),
        "frictional_power_density": 2.0 * contact.mean(contact.wear_index_density),
    }[name]
    between = 0.5 * (values[1:] + values[:-1])
    for low, high, outside in ((between[0], between[1], 3), (0.0, between[1], 2), (between[0], 1e12, 1)):
        watch = RangeWatch(Stated(variable=name, low=low, high=high))
        watch.see(one.size, partial(mean_over_patch, one, {"longitudinal": EXACT.tangential_force(one)}))
        (message,) = messages(watch)
        assert f"range of mean {name.replace('_', ' ')} from" in message
        assert f"; {outside} of 4 operating points {'lies' if outside == 1 else 'lie'} outside" in message


ON_RAILS = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")


@pytest.mark.parametrize("name", NAMES)
def test_every_variable_of_an_ellipse_is_watched_by_its_patch_mean(name: str) -> None:
    along, across = np.array([1e-3, 2e-3, -4e-3, 8e-3]), np.array([2e-3, -1e-3, 3e-3, 5e-3])
    one = ON_RAILS.problem(
        normal_force=Q(np.linspace(60.0, 90.0, 4), "kN"),
        friction_coefficient=0.3,
        longitudinal_creepage=Q(along, ""),
        lateral_creepage=Q(across, ""),
    )
    forces = wl.contact_model("fastsim").creep_forces(one)
    area, slip = np.pi * one.a * one.b, np.hypot(along, across)  # without spin it is the same everywhere
    power = forces.longitudinal * along + forces.lateral * across
    values = {
        "pressure": one.normal_force / area,
        "traction": np.hypot(forces.longitudinal, forces.lateral) / area,
        "slip": slip,
        "slip_speed": 30.0 * slip,
        "wear_index": power,
        "wear_index_density": power / area,
        "frictional_power_density": 30.0 * power / area,
    }[name]
    columns = dataclasses.asdict(forces)
    assert mean_over_patch(one, columns, name) == pytest.approx(values, rel=64 * float(np.finfo(np.float64).eps))


def test_a_range_of_what_has_no_patch_mean_is_refused() -> None:
    with pytest.raises(wl.ModelError, match="`valid_range` names 'x'"):
        see(RangeWatch(Stated(variable="x")), 0.05)


def test_variables_are_warned_of_one_by_one() -> None:
    class Both(Stated):
        @property
        def valid_range(self) -> Mapping[str, tuple[float, float]]:
            return {"slip": (0.0, 0.1), "slip_speed": (0.03, 10.0), "pressure": (0.0, 1e10)}

    watch = RangeWatch(Both())
    see(watch, [0.01, 0.02, 0.2])
    slip, speed = messages(watch)
    assert "mean slip from 0.000 % to 10.00 %; 1 of 3" in slip
    assert "mean slip speed from 0.03000 m/s to 10.00 m/s; 1 of 3" in speed


@pytest.mark.parametrize("declared", [True, False], ids=["closed form", "nodes"])
@pytest.mark.parametrize("use_patch_mean", [False, True], ids=["cells", "patch"])
def test_a_sweep_of_many_blocks_warns_once(declared: bool, use_patch_mean: bool) -> None:
    points = 40_000
    assert points > 2 * BLOCK > 2 * NODE_BLOCK
    contact = RIG | EXACT
    predict = (contact | wl.patch_mean() if use_patch_mean else contact) | Stated(declared=declared)
    # every fourth point lies below the range, every tenth above, in all blocks; one lies farther than all others
    creepage = np.full(points, 0.05)
    creepage[::4], creepage[1::10] = 0.005, 0.15
    creepage[33_333] = 0.25
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        predict(max_pressure="800 MPa", creepage=Q(creepage, ""), friction_coefficient=0.2)
    (message,) = (str(each.message) for each in caught)
    assert caught[0].filename == __file__
    found = re.search(r"(\d+) of (\d+) operating points lie outside, as far as (.*)", message)
    assert found is not None
    assert found.groups() == ("14001", "40000", "25.00 %")


def test_points_that_wear_in_a_model_of_its_own_nodes_are_watched_too() -> None:
    predict = RIG | wl.contact_model("global") | Stated()
    with pytest.warns(wl.RangeWarning, match="600 of 1200 operating points lie outside, as far as 20"):
        predict(max_pressure="800 MPa", creepage=Q(np.tile([0.05, 0.2], 600), ""), friction_coefficient=0.2)
