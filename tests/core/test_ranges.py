"""Warnings about operating points outside the range of a wear law."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.core.stages import RAILS, TOUGH
from wearlaw import Array, Q

RIG = wl.TwinDisc.suros(rolling_speed="2 m/s", material=TOUGH)
EXACT = wl.contact_model("exact")
ON_RAILS = RAILS.model_copy(update={"material": TOUGH})


class Stated(wl.WearLaw):
    """A law of two ramps with a range, one of whose ways to be integrated is by closed form."""

    name: ClassVar[str] = "stated"
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


def messages(law: wl.WearLaw, creepage: Any, pressure: Any = "1500 MPa") -> list[str]:
    """Return the warnings of a prediction."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        (RIG | EXACT | law)(creepage=Q(creepage, ""), max_pressure=pressure, friction_coefficient=0.46)
    assert all(each.category is wl.RangeWarning and each.filename == __file__ for each in caught)
    return [str(each.message) for each in caught]


@pytest.mark.parametrize(
    ("creepage", "outside", "farthest"),
    [
        ([0.05, 0.002, 0.02, 0.004], "2 of 4 operating points lie", "0.2000 %"),
        ([0.05, 0.2, 0.02, 0.15], "2 of 4 operating points lie", "20.00 %"),
        ([-0.2, -0.05], "1 of 2 operating points lies", "20.00 %"),
        ([0.01, 0.1, -0.1, 0.2], "1 of 4 operating points lies", "20.00 %"),  # the borders belong to the range
    ],
    ids=["below", "above", "negative creepage", "borders"],
)
def test_the_farthest_value_is_named(creepage: list[float], outside: str, farthest: str) -> None:
    assert messages(Stated(), creepage) == [
        f"wear law 'stated' has a known range of mean slip from 1.000 % to 10.00 %; {outside} outside, as far as"
        f" {farthest}"
    ]


def test_points_within_the_range_say_nothing() -> None:
    assert messages(Stated(), [0.01, 0.1, -0.1]) == []


NAMES = ("pressure", "traction", "slip", "slip_speed", "wear_index", "wear_index_density", "frictional_power_density")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_every_variable_is_watched_by_its_patch_mean(name: str, sign: float) -> None:
    creepage = sign * np.geomspace(1e-3, 0.3, 4)
    pressure = Q(np.linspace(800.0, 2000.0, 4), "MPa")
    one = RIG.problem(creepage=Q(creepage, ""), max_pressure=pressure, friction_coefficient=0.46)
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
        law = Stated(variable=name, low=low, high=high)
        (message,) = messages(law, creepage, pressure)
        assert f"range of mean {name.replace('_', ' ')} from" in message
        assert f"; {outside} of 4 operating points {'lies' if outside == 1 else 'lie'} outside" in message


@pytest.mark.parametrize("name", NAMES)
def test_every_variable_of_an_ellipse_is_watched_by_its_patch_mean(name: str) -> None:
    along, across = np.array([1e-3, 2e-3, -4e-3, 8e-3]), np.array([2e-3, -1.5e-3, 3e-3, 5e-3])
    conditions: dict[str, Any] = {
        "normal_force": Q(np.linspace(60.0, 90.0, 4), "kN"),
        "friction_coefficient": 0.3,
        "longitudinal_creepage": Q(along, ""),
        "lateral_creepage": Q(across, ""),
    }
    one = ON_RAILS.problem(**conditions)
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
    ordered = np.sort(values)
    for gap in (-1e-9, 1e-9):  # on both sides of the least and the greatest mean
        law = Stated(variable=name, low=ordered[0] * (1.0 - gap), high=ordered[-1] * (1.0 + gap))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            (ON_RAILS | wl.contact_model("fastsim") | law)(**conditions)
        said = [str(each.message) for each in caught]
        assert [("2 of 4" in text) for text in said] == ([True] if gap < 0.0 else [])


def test_variables_are_warned_of_one_by_one() -> None:
    class Both(Stated):
        @property
        def valid_range(self) -> Mapping[str, tuple[float, float]]:
            return {"slip": (0.0, 0.1), "slip_speed": (0.03, 10.0), "pressure": (0.0, 1e10)}

    slip, speed = messages(Both(), [0.01, 0.02, 0.2])
    assert "mean slip from 0 % to 10.00 %; 1 of 3" in slip
    assert "mean slip speed from 0.03000 m/s to 10.00 m/s; 1 of 3" in speed


@pytest.mark.parametrize("declared", [True, False], ids=["closed form", "nodes"])
@pytest.mark.parametrize("use_patch_mean", [False, True], ids=["cells", "patch"])
def test_a_sweep_of_many_blocks_warns_once(declared: bool, use_patch_mean: bool) -> None:
    points = 40_000  # three blocks and more
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
