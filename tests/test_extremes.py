"""Operating points far from any test: numbers that make sense or refusals, also under `np.errstate(all="raise")`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import MODELS
from wearlaw import Array, Q

pytestmark = [
    pytest.mark.filterwarnings("error"),
    pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning"),
]

# ξ_sat = 1.2319 % and ξ_f = 1.8479 % are those of 1500 MPa with a friction of 0.46.
CREEPAGE = [0.0, -0.0, 1e-300, 1e-30, 1e-15, -1e-7, 1e-3, -0.02, 0.3, 1.0, -1.0, 0.012319, 0.0184785]
FRICTION = [1e-12, 1e-6, 1e-3, 0.46, 2.0, 100.0]
MAX_PRESSURE = [1e-3, 1e3, 1e6, 1.5e9, 2.1e9, 1e12, 1e20]
LAWS = {
    "usfd": wl.wear_law("usfd"),
    "kth": wl.wear_law("kth"),
    "low plateau": wl.wear_law("usfd", q_s="1e-9 ug/m/mm^2", tr_sc="1e9 N/mm^2"),
    "threshold out of reach": wl.wear_law("usfd", tr_sc="1e300 N/m^2"),
}


def grid() -> tuple[Array, Array, Array]:
    creepage, friction, pressure = np.meshgrid(CREEPAGE, FRICTION, MAX_PRESSURE)
    return creepage.ravel(), friction.ravel(), pressure.ravel()


@pytest.mark.validates(
    "invariants",
    "Loads from 1 mPa to 1e14 MPa, friction from 1e-12 to 100, creepage from 0 to 1: finite numbers, none negative",
    source="what a wear rate can be",
    held_to="everywhere; alone and in a batch to {within:g} and the stated error",
    within=1e-12,
)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", MODELS)
def test_every_result_is_a_number_that_makes_sense(name: str, law: str, within: float) -> None:
    creepage, friction, pressure = grid()
    predict = wl.TwinDisc.suros() | MODELS[name] | LAWS[law]
    result = predict(max_pressure=Q(pressure, "Pa"), creepage=Q(creepage, ""), friction_coefficient=friction)
    rate, error = result.wear_rate.m, result.wear_rate_error.m
    for value in (rate, error, result.mean_slip.m, result.stick_ratio.m, result.tangential_force.m):
        assert np.isfinite(value).all()
    assert (rate >= 0.0).all()
    assert (error >= 0.0).all()
    assert (rate[creepage == 0.0] == 0.0).all()
    for i in range(0, creepage.size, 37):
        alone = predict(
            max_pressure=Q(pressure[i], "Pa"), creepage=Q(creepage[i], ""), friction_coefficient=float(friction[i])
        )
        # each is within its error of the truth; denormal numbers have no relative accuracy
        assert alone.wear_rate.m == pytest.approx(rate[i], rel=within, abs=2.0 * error[i] + 1e-290)


STEEP = wl.FallingFriction(static_coefficient=0.5, limit_ratio=0.4, decay="10000 s/m")
"""exp(-B w) underflows from a creep speed of 75 mm/s."""

DISCS = wl.TwinDisc.suros()
WHEEL = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
# Squares of creepages below 1e-154 underflow; products with forces do so below 1e-308.
TINY = Q([0.0, 1e-300, 1e-160, 0.01], "")


@pytest.mark.parametrize(
    ("geometry", "model"),
    [
        *(("line", name) for name in ("exact", "fastsim", "global")),
        *(("ellipse", name) for name in ("fastsim", "linear", "polach", "shen_hedrick_elkins")),
    ],
)
@pytest.mark.parametrize("friction", [0.4, STEEP], ids=["constant", "falling"])
def test_a_caller_that_raises_on_errors_of_floats_gets_the_same(geometry: str, friction: Any, model: str) -> None:
    rig, creepage = (DISCS, "creepage") if geometry == "line" else (WHEEL, "longitudinal_creepage")
    predict = rig | wl.contact_model(model) | wl.wear_law("usfd")
    given: dict[str, Any] = {"normal_force": "7 kN", "friction_coefficient": friction, creepage: TINY}
    expected = predict(**given).wear_rate
    with np.errstate(all="raise"):
        found = predict(**given).wear_rate
    np.testing.assert_array_equal(found.magnitude, expected.magnitude)


REFUSED: dict[str, tuple[type[wl.WearlawError], str, Any]] = {
    "pressure beyond floats in SI": (wl.UnitError, "max_pressure", lambda: line(max_pressure="1e308 MPa")),
    "force beyond floats in SI": (wl.UnitError, "normal_force", lambda: line(normal_force="1.7e308 kN")),
    "force that no disc carries": (wl.ConditionsError, "max pressure", lambda: line(normal_force="1e300 kN")),
    "friction of no contact": (wl.ConditionsError, "friction_coefficient", lambda: line(friction_coefficient=1e-13)),
    "diameter of nothing": (
        wl.ConfigurationError,
        "diameter",
        lambda: wl.Disc(diameter="5e-324 mm", material=wl.steel()),
    ),
    "density beyond floats in SI": (
        wl.ConfigurationError,
        "density",
        lambda: wl.Material(youngs_modulus="5 Pa", poisson_ratio=0.0, density="1e308 g/mm^3"),
    ),
}
"""The type of the error and the word that it names, by what is wrong."""


def line(**given: Any) -> wl.Problem:
    load = {} if {"max_pressure", "normal_force"} & {*given} else {"max_pressure": "1500 MPa"}
    return DISCS.problem(**{"creepage": "1 %", "friction_coefficient": 0.4, **load, **given})


@pytest.mark.parametrize("what", REFUSED)
@pytest.mark.parametrize("state", ["warn", "raise"])
def test_a_number_that_cannot_be_is_refused_by_name(what: str, state: Any) -> None:
    kind, name, make = REFUSED[what]
    with np.errstate(all=state), pytest.raises(kind, match=name):
        make()
