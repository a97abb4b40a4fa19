"""The same results under any `np.errstate` of the caller."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.fits.fits import made_up, usfd
from wearlaw import Array, Q
from wearlaw.pipeline.variables import default_variables

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")

DISCS = wl.TwinDisc.suros()
WHEEL = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
OPTIONS: Mapping[str, Mapping[str, Any]] = {
    "archard": {"coefficient": 1e-4, "hardness": "2.6 GPa"},
    "energy": {"mass_per_energy": "1 ug/J"},
    "thermal": {"hot_ratio": 0.5, "temperature_range": "500 K"},
    "third_body": {"reduction": 0.5},
}

STEEP = wl.FallingFriction(static_coefficient=0.5, limit_ratio=0.4, decay="10000 s/m")
"""exp(-B w) underflows from a creep speed of 75 mm/s."""

# Squares of creepages below 1e-154 underflow; products with forces do so below 1e-308.
ON_A_LINE: Mapping[str, Mapping[str, Any]] = {
    "usual": {"normal_force": "7 kN", "creepage": Q([0.0, 0.001, 1.0, -5.0], "%"), "friction_coefficient": 0.4},
    "tiny": {"normal_force": "7 kN", "creepage": Q([1e-300, 1e-200, 1e-160], ""), "friction_coefficient": 0.4},
    "falling": {"normal_force": "7 kN", "creepage": Q([0.0, 5.0, 10.0], "%"), "friction_coefficient": STEEP},
}
ON_AN_ELLIPSE: Mapping[str, Mapping[str, Any]] = {
    "usual": {
        "normal_force": "80 kN",
        "longitudinal_creepage": Q([0.0, 0.001, 0.2, 5.0], "%"),
        "lateral_creepage": "0.1 %",
        "spin": "0.2 1/m",
        "friction_coefficient": 0.3,
    },
    "tiny": {
        "normal_force": "80 kN",
        "longitudinal_creepage": Q([0.0, 1e-300, 1e-160], ""),
        "lateral_creepage": Q(1e-200, ""),
        "spin": Q(1e-300, "1/m"),
        "friction_coefficient": 0.3,
    },
    "falling": {
        "normal_force": "80 kN",
        "longitudinal_creepage": Q([0.0, 0.2, 5.0], "%"),
        "friction_coefficient": STEEP,
    },
}
RIGS = {"line": (DISCS, ON_A_LINE), "ellipse": (WHEEL, ON_AN_ELLIPSE)}


def every_variable(found: wl.Prediction) -> dict[str, Array]:
    body = next(iter(found.problem.bodies))
    values = {name: np.asarray(found[name].magnitude) for name in default_variables(found)}
    values["error"] = np.asarray(found.wear_rate_error.magnitude)
    for name in ("depth_per_distance", "profile_area_rate", "mass_per_cycle"):
        values[name] = np.asarray(getattr(found, name)(body).magnitude)
    values["mass_lost"] = np.asarray(found.mass_lost("10 km", body).magnitude)
    assert repr(found)
    return values


def check_same(compute: Callable[[], Mapping[str, Array]]) -> None:
    expected = compute()
    with np.errstate(all="raise"):
        found = compute()
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values, err_msg=name)


@pytest.mark.parametrize("conditions", ON_A_LINE)
@pytest.mark.parametrize("law", wl.wear_laws())
@pytest.mark.parametrize(
    ("geometry", "model"),
    [
        (geometry, name)
        for name, model in wl.contact_models().items()
        for geometry in RIGS
        if geometry in model.geometries()
    ],
)
def test_errors_of_floats_end_no_prediction(geometry: str, model: str, law: str, conditions: str) -> None:
    if conditions == "tiny" and model in ("half_space", "strip_theory"):
        pytest.skip("it is not made for creepages below 1e-100")
    rig, known = RIGS[geometry]
    pipeline = rig | wl.contact_model(model)
    wear_law = wl.wear_law(law, **OPTIONS.get(law, {}))
    if wear_law.scale == "patch" and pipeline.scale == "cells":
        pipeline |= wl.patch_mean()
    predict = pipeline | wear_law
    check_same(lambda: every_variable(predict(**known[conditions])))


@pytest.mark.parametrize("conditions", ON_A_LINE)
@pytest.mark.parametrize("geometry", RIGS)
@pytest.mark.parametrize("stage", wl.stages())
def test_errors_of_floats_end_no_stage(stage: str, geometry: str, conditions: str) -> None:
    rig, known = RIGS[geometry]
    model = wl.contact_model("exact" if geometry == "line" else "fastsim")
    predict = rig | model | wl.stage(stage, **OPTIONS.get(stage, {})) | wl.wear_law("usfd")
    check_same(lambda: every_variable(predict(**known[conditions])))


def test_errors_of_floats_end_no_application() -> None:
    predict = DISCS | wl.contact_model("exact") | wl.wear_law("kth")
    conditions: Any = {"normal_force": Q([1.0, 7.0], "kN"), "creepage": Q([0.0, 1e-3, 3.0], "%")}

    def swept() -> dict[str, Array]:
        found = wl.sweep(predict, friction_coefficient=STEEP, **conditions)
        return {str(name): values.values for name, values in found.items()}

    check_same(swept)

    def creepages() -> dict[str, Array]:
        found = wl.creepage_for(
            predict, traction_coefficient=[0.0, 1e-300, 0.3], normal_force="7 kN", friction_coefficient=0.4
        )
        return {"creepage": found.magnitude}

    check_same(creepages)

    def uncertain() -> dict[str, Array]:
        found = wl.uncertainty(
            predict,
            samples=128,
            normal_force=wl.normal("7 kN", "1 kN"),
            creepage=wl.uniform("0 %", "3 %"),
            friction_coefficient=wl.lognormal(0.4, 1.2),
        )
        return {"samples": found["wear_rate"].magnitude, "sobol": found.sobol().to_numpy()}

    check_same(uncertain)


def test_errors_of_floats_end_no_fit() -> None:
    predict = usfd("global")
    tests = made_up(predict, scatter=0.1)

    def fitted() -> dict[str, Array]:
        found = wl.fit(predict, tests, ["m_m", "q_s"], bootstrap=40, starts=4)
        ranked = wl.compare({"fitted": found, "as published": predict}, tests)
        return {"fit": np.array(repr(found)), "compared": ranked.table().to_numpy(dtype=str)}

    check_same(fitted)


class Underflows(wl.WearLaw):
    """A law of a third party that lets numbers underflow and overflow on its way, as is usual with NumPy."""

    name = "underflows"
    source = "a test"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        saturated: Array = 1.0 / (1.0 + np.exp(-contact.pressure)) * np.exp(-contact.pressure)
        return 1e-9 * np.abs(contact.slip) * (1.0 + saturated)


def test_errors_of_floats_end_no_law_of_a_third_party() -> None:
    predict = DISCS | wl.contact_model("exact") | Underflows()
    check_same(lambda: every_variable(predict(**ON_A_LINE["usual"])))


class Own(wl.TwinDisc):
    """A rig of a third party that lets numbers underflow."""

    def problem(self, **conditions: Any) -> wl.Problem:
        assert np.exp(np.float64(-1e9)) == 0.0
        return super().problem(**conditions)


def test_errors_of_floats_end_no_rig_of_a_third_party() -> None:
    rig = Own.model_validate({name: getattr(DISCS, name) for name in type(DISCS).model_fields})
    predict = rig | wl.contact_model("exact") | wl.wear_law("usfd")
    check_same(lambda: every_variable(predict(**ON_A_LINE["usual"])))


@pytest.mark.parametrize("state", ["warn", "raise"])
def test_values_that_overflow_or_underflow_in_si_are_refused_in_words(state: Any) -> None:
    with np.errstate(all=state):
        with pytest.raises(wl.UnitError, match=r"^normal_force: must be finite, got 1\.700e"):
            DISCS.problem(normal_force="1.7e308 kN", creepage="1 %", friction_coefficient=0.4)
        with pytest.raises(wl.UnitError, match=r"^x: must be finite, got 1\.700e\+308 km at index \[1\]"):
            wl.Unit("km").si(Q([1.0, 1.7e308], "km"), "x")
        with pytest.raises(wl.ConfigurationError, match="diameter: must be greater than zero"):
            wl.Disc(diameter="5e-324 mm", material=wl.steel())
        assert repr(Q(1e-310, "mm").to("km"))
        with pytest.raises(wl.ConditionsError, match="the load gives a max pressure of"):
            DISCS.problem(normal_force="1e300 kN", creepage="1 %", friction_coefficient=0.4)


def test_the_state_of_the_caller_stays() -> None:
    predict = DISCS | wl.contact_model("exact") | wl.wear_law("usfd")
    with np.errstate(all="raise"):
        predict(**ON_A_LINE["tiny"])
        with pytest.raises(FloatingPointError):
            np.float64(1e-200) * np.float64(1e-200)
