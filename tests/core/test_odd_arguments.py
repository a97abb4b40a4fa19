"""Odd arguments raise errors of wearlaw that name the argument, and none of Python's or of other packages'."""

from __future__ import annotations

import datetime
import decimal
import fractions
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd
import pint
import pytest
import xarray as xr

import wearlaw as wl
from tests.core.fits import made_up, usfd
from tests.core.stages import predicted, silently
from wearlaw import Q

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")

PREDICT = usfd("exact")
CONDITIONS: Mapping[str, Any] = {"normal_force": "7 kN", "creepage": "1 %", "friction_coefficient": 0.4}
WHEEL: Mapping[str, Any] = {
    "wheel_radius": "460 mm",
    "rail_head_radius": "300 mm",
    "material": wl.steel(),
    "rolling_speed": "30 m/s",
}


class Refusing:
    """A value that refuses whatever it is asked."""

    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        raise RuntimeError("no comparison")

    def __bool__(self) -> bool:
        raise RuntimeError("no truth")

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise RuntimeError("no array")


ITSELF: list[Any] = []
ITSELF.append(ITSELF)

ODD: Mapping[str, Any] = {
    "pd.NA": pd.NA,
    "NaT": pd.NaT,
    "nan": float("nan"),
    "inf": float("inf"),
    "-inf": -float("inf"),
    "-0.0": -0.0,
    "5e-324": 5e-324,
    "1.7e308": 1.7e308,
    "10**400": 10**400,
    "True": True,
    "numpy bool": np.bool_(True),
    "complex": 1 + 2j,
    "complex array": np.array([1 + 1j]),
    "long double": np.array([np.finfo(np.longdouble).max]),
    "masked array": np.ma.masked_array([1.0, 2.0], mask=[False, True]),
    "masked": np.ma.masked,
    "array of objects": np.array([1, "a", None], dtype=object),
    "0-d object": np.array(None, dtype=object),
    "array of text": np.array(["a", "b"]),
    "dates": np.array(["2020-01-01"], dtype="M8[D]"),
    "records": np.zeros(2, dtype=[("a", float)]),
    "empty array": np.array([]),
    "array of shape (2, 3)": np.ones((2, 3)),
    "array of shape (7,)": np.ones(7),
    "text": "x",
    "no text": "",
    "null": "\0",
    "a number as text": "5",
    "wrong unit": "1 K",
    "nan mm": "nan mm",
    "1e400 kN": "1e400 kN",
    "5e-324 m": "5e-324 m",
    "1.7e308 GPa": "1.7e308 GPa",
    "bytes": b"x",
    "list": [1, 2],
    "ragged list": [[1], [2, 3]],
    "list of itself": ITSELF,
    "tuple": (),
    "dict": {"a": 1},
    "class": int,
    "another class": wl.TwinDisc,
    "function": len,
    "module": wl,
    "quantity of another dimension": Q(1.0, "K"),
    "quantity with several values": Q([1.0, 2.0], "mm"),
    "quantity of nan": Q(np.nan, "%"),
    "complex quantity": pint.Quantity(1j, "mm"),
    "quantity of objects": pint.Quantity(np.array([None], dtype=object), "mm"),
    "masked quantity": pint.Quantity(np.ma.masked_array([1.0, 2.0], mask=[False, True]), "%"),
    "empty quantity": Q(np.array([]), "kN"),
    "temperature": pint.Quantity(20.0, "degC"),
    "quantity of another registry": pint.UnitRegistry().Quantity(1.0, "K"),
    "series": pd.Series([1.0, 2.0]),
    "frame": pd.DataFrame({"a": [1]}),
    "data array": xr.DataArray([1.0, 2.0]),
    "dataset": xr.Dataset(),
    "fraction": fractions.Fraction(1, 2),
    "decimal nan": decimal.Decimal("NaN"),
    "date": datetime.date(2020, 1, 1),
    "slice": slice(None),
    "ellipsis": ...,
    "set": {1},
    "-1": -1,
    "range": range(0),
    "NotImplemented": NotImplemented,
    "material": wl.steel(),
    "unit": Q(1.0, "mm").units,
    "what refuses all": Refusing(),
}

ONE = predicted(PREDICT, **CONDITIONS)
THREE = predicted(PREDICT, **{**CONDITIONS, "creepage": Q([1.0, 2.0, 3.0], "%")})
ON_RAIL = silently(wl.WheelRail(**WHEEL), wl.contact_model("fastsim"), wl.wear_law("usfd"))
ON_ELLIPSE = predicted(ON_RAIL, normal_force="80 kN", longitudinal_creepage="0.2 %", friction_coefficient=0.3)
with warnings.catch_warnings(action="ignore", category=wl.WearlawWarning):
    TESTS = made_up(PREDICT, scatter=0.1)
CASE = wl.load_case("wheel_on_rail")

CALLS: Mapping[str, tuple[Callable[..., Any], Mapping[str, Any]]] = {
    "Q": (Q, {"value": 1.0, "unit": "mm"}),
    "parse": (wl.parse, {"text": "1 mm"}),
    "Unit.si": (wl.Unit("mm").si, {"value": "1 mm", "name": "x"}),
    "Disc": (wl.Disc, {"diameter": "47 mm", "material": "steel"}),
    "suros": (
        wl.TwinDisc.suros,
        {
            "diameter": "47 mm",
            "material": None,
            "disc_1": None,
            "disc_2": None,
            "track_width": "10 mm",
            "rotational_speed": "400 rpm",
            "speed_of": "mean",
        },
    ),
    "WheelRail": (wl.WheelRail, {**WHEEL, "wheel_profile_radius": "inf mm", "contact_angle": "0 deg"}),
    "Material": (wl.Material, {name: getattr(wl.steel(), name) for name in wl.Material.model_fields}),
    "FallingFriction": (wl.FallingFriction, {"static_coefficient": 0.4, "limit_ratio": 0.5, "decay": "1 s/m"}),
    "predict": (PREDICT, {**CONDITIONS, "rolled_distance": "1 km"}),
    "predict on a rail": (
        ON_RAIL,
        {
            "normal_force": "80 kN",
            "longitudinal_creepage": "0.2 %",
            "lateral_creepage": "0.1 %",
            "spin": "0.2 1/m",
            "contact_angle": "1 deg",
            "friction_coefficient": 0.3,
        },
    ),
    "problem": (PREDICT.rig.problem, CONDITIONS),
    "predict.predict": (PREDICT.predict, {"problem": ONE.problem}),
    "predict.posed": (PREDICT.posed, {"conditions": CONDITIONS}),
    "contact_model": (wl.contact_model, {"": "exact"}),
    "wear_law": (wl.wear_law, {"": "usfd"}),
    "law": (wl.law, {"": "usfd"}),
    "stage": (wl.stage, {"": "patch_mean"}),
    "rig": (wl.rig, {"": "twin_disc"}),
    "material": (wl.material, {"": "steel"}),
    "usfd": (lambda **fields: wl.wear_law("usfd", **fields), {"m_m": "1 ug/m/mm^2", "body": "rail"}),
    "wear_coefficient": (
        wl.wear_coefficient,
        {
            "value": 1e-4,
            "form": "k",
            "to": "volume_per_energy",
            "hardness": "2 GPa",
            "density": "7850 kg/m^3",
            "friction_coefficient": 0.4,
        },
    ),
    "Problem.line": (
        wl.Problem.line,
        {
            "normal_force": "7 kN",
            "track_width": "10 mm",
            "relative_radius": "12 mm",
            "shear_modulus": "80 GPa",
            "poisson_ratio": 0.28,
            "friction_coefficient": 0.4,
            "creepage": "1 %",
        },
    ),
    "Outcome": (wl.Outcome, {"name": "damage", "unit": "", "of": "patch"}),
    "creepage_for": (
        lambda predict, **given: wl.creepage_for(predict, **given),
        {"predict": PREDICT, "tangential_force": "1 kN", "normal_force": "7 kN", "friction_coefficient": 0.4},
    ),
    "sweep": (
        lambda predict, table=None, **given: wl.sweep(predict, table, **given),
        {
            "predict": PREDICT,
            "table": None,
            "outputs": ["wear_rate"],
            "workers": 1,
            "normal_force": Q([7.0, 8.0], "kN"),
            "creepage": "1 %",
            "friction_coefficient": 0.4,
        },
    ),
    "uncertainty": (
        lambda predict, **given: wl.uncertainty(predict, **given).median,
        {
            "predict": PREDICT,
            "law": None,
            "stage": None,
            "samples": 4,
            "seed": 0,
            "normal_force": "7 kN",
            "creepage": wl.uniform("1 %", "2 %"),
            "friction_coefficient": 0.4,
        },
    ),
    "normal": (wl.normal, {"mean": "7 kN", "standard_deviation": "1 kN"}),
    "lognormal": (wl.lognormal, {"median": 0.4, "geometric_standard_deviation": 1.2}),
    "uniform": (wl.uniform, {"low": "1 %", "high": "2 %"}),
    "fit": (
        wl.fit,
        {
            "predict": PREDICT,
            "tests": TESTS,
            "free": ["m_m"],
            "friction_coefficient": None,
            "scatter": "relative",
            "bounds": None,
            "starts": 2,
            "bootstrap": 0,
            "seed": 0,
            "confidence": 0.95,
        },
    ),
    "compare": (
        wl.compare,
        {
            "predictors": [PREDICT],
            "tests": TESTS,
            "outcome": None,
            "friction_coefficient": None,
            "cross_validate": None,
        },
    ),
    "read_contact": (lambda paths, reader: wl.read_contact(paths, reader=reader), {"paths": "no.mat", "reader": None}),
    "read_tests": (wl.read_tests, {"path_or_name": "lewis2004", "outcomes": ()}),
    "read_law": (wl.read_law, {"path": "no.toml"}),
    "load_case": (wl.load_case, {"name_or_path": "no.toml"}),
    "run": (wl.run, {"case": CASE}),
    "Prediction.of": (lambda contact, law: wl.Prediction.of(contact, law), {"contact": None, "law": None}),
    "outcome": (THREE.outcome, {"name": "wear_rate", "body": None}),
    "outcome_error": (THREE.outcome_error, {"name": "wear_rate", "body": None}),
    "wear_rate_of": (THREE.wear_rate_of, {"body": "disc_1"}),
    "depth_per_distance": (THREE.depth_per_distance, {"body": "disc_1"}),
    "profile_area_rate": (THREE.profile_area_rate, {"body": "disc_1"}),
    "mass_per_cycle": (THREE.mass_per_cycle, {"body": "disc_1"}),
    "mass_lost": (THREE.mass_lost, {"over": "1 km", "body": "disc_1"}),
    "wear_profile": (ON_ELLIPSE.wear_profile, {"body": "rail", "strips": None, "at": None}),
    "prediction[...]": (lambda key: THREE[key], {"key": "wear_rate"}),
    "in": (lambda key: key in THREE, {"key": "wear_rate"}),
    "sel": (THREE.sel, {"side": "left"}),
    "isel": (THREE.isel, {"point_0": 0}),
    "to_dataset": (THREE.to_dataset, {"names": None}),
    "to_dataframe": (THREE.to_dataframe, {"names": None}),
}
"""Public callables with arguments that are right; each argument is replaced by each of `ODD`."""


SLOW = ("sweep", "uncertainty", "fit", "compare", "run", "read_contact", "read_law", "load_case")
"""Callables that take long where they accept a value, tried with some of them only."""

FEW = ("pd.NA", "nan", "masked", "text", "list of itself", "dict", "module", "complex", "array of shape (7,)", "frame")


def foreign(call: str, argument: str, value: str) -> str:
    """Return the error that is none of wearlaw's, or ""."""
    function, given = CALLS[call]
    odd = ODD[value]
    try:
        function(odd) if not argument else function(**{**given, argument: odd})
    except wl.WearlawError as error:
        return "" if str(error) else "an error without message"
    except Exception as error:
        return f"{value}: {error!r}"
    return ""


@pytest.mark.parametrize(
    ("call", "argument"), [(call, argument) for call, (_, given) in CALLS.items() for argument in given]
)
def test_odd_arguments_raise_errors_of_wearlaw(call: str, argument: str) -> None:
    tried = FEW if call in SLOW else ODD
    assert [found for found in (foreign(call, argument, value) for value in tried) if found] == []


class Friction:
    """A law of friction of a user."""

    def __init__(self, coefficient: Callable[[Any], Any]) -> None:
        self.coefficient = coefficient


@pytest.mark.parametrize(
    ("coefficient", "says"),
    [
        (lambda _: np.ones(7), r"returned an array of shape \(7,\) for creep speeds of shape \(3,\)"),
        (
            lambda speed: speed * np.nan,
            r"is wrong at creep speeds of 0.009795 to .* got nan at index \[0\]",
        ),
        (lambda speed: -speed, r"must be a positive finite number, got -0.009"),
        (lambda speed: speed + np.inf, "must be a positive finite number, got inf"),
        (lambda speed: 1j * speed, "is not a real number"),
        (lambda _: None, "None is not a real number"),
        (lambda speed: np.ma.masked_array(speed, mask=True), "masked entries have no value"),
        (lambda _: 1 / 0, "failed: ZeroDivisionError: division by zero"),
    ],
)
def test_a_wrong_law_of_friction_is_named(coefficient: Callable[[Any], Any], says: str) -> None:
    conditions: Any = {**CONDITIONS, "creepage": Q([1.0, 2.0, 3.0], "%"), "friction_coefficient": Friction(coefficient)}
    with pytest.raises(wl.ModelError, match=rf"^friction_coefficient: friction law Friction .*{says}"):
        PREDICT(**conditions)


def test_a_law_of_friction_may_return_one_number() -> None:
    several: Any = {
        **CONDITIONS,
        "creepage": Q([1.0, 2.0, 3.0], "%"),
        "friction_coefficient": Friction(lambda _: 0.4),
    }
    assert PREDICT(**several) == THREE


@pytest.mark.parametrize("coefficient", [1.7e308, Friction(lambda _: 1e300)])
def test_friction_that_no_contact_comes_near_is_not_blamed_on_a_model(coefficient: Any) -> None:
    with pytest.raises(wl.ConditionsError, match=r"^friction_coefficient: must be at most 1e\+12"):
        PREDICT(**{**CONDITIONS, "friction_coefficient": coefficient})


@pytest.mark.parametrize("model", ["exact", "fastsim", "global"])
def test_the_greatest_friction_gives_finite_numbers(model: str) -> None:
    found = (wl.TwinDisc.suros() | wl.contact_model(model))(**{**CONDITIONS, "friction_coefficient": 1e12})
    assert np.isfinite(found.tangential_force.magnitude)


@pytest.mark.parametrize("radius", ["-5e-324 mm", "5e-324 mm", "1e-310 mm", "0 mm"])
@pytest.mark.parametrize("field", ["rail_head_radius", "wheel_profile_radius"])
def test_a_radius_next_to_zero_is_refused(field: str, radius: str) -> None:
    with pytest.raises(wl.ConfigurationError, match="a radius must not be zero or next to it; a flat body has"):
        wl.WheelRail(**{**WHEEL, field: radius})


@pytest.mark.parametrize("disc", ["wheel", 3.0, {"diameter": "47 mm"}])
@pytest.mark.parametrize("name", ["disc_1", "disc_2"])
def test_a_wrong_disc_of_suros_is_named(name: str, disc: Any) -> None:
    with pytest.raises(wl.ConfigurationError, match=rf"^TwinDisc: {name}"):
        wl.TwinDisc.suros(**{name: disc})


def test_a_distance_for_each_point_must_fit_the_points() -> None:
    says = r"^over: an array of shape \(2,\) does not broadcast to the operating points, of shape \(3,\)"
    with pytest.raises(wl.InputError, match=says):
        THREE.mass_lost(Q([1.0, 2.0], "m"), "disc_1")


@pytest.mark.parametrize("body", [pd.NA, None, [], np.array(["disc_1"])])
@pytest.mark.parametrize("call", ["wear_rate_of", "depth_per_distance", "profile_area_rate", "mass_per_cycle"])
def test_what_is_no_name_of_a_body_is_refused(call: str, body: Any) -> None:
    with pytest.raises(wl.InputError, match=r"^body: "):
        getattr(THREE, call)(body)


@pytest.mark.parametrize(
    "value",
    [
        1 + 2j,
        np.array([1 + 1j, 2.0]),
        np.ma.masked_array([1.0, 2.0], mask=[False, True]),
        pint.Quantity(np.array([1j]), "kN"),
        pint.Quantity(np.ma.masked_array([1.0, 2.0], mask=[False, True]), "kN"),
    ],
)
def test_a_wrong_axis_of_a_sweep_is_named(value: Any) -> None:
    conditions: Any = {**CONDITIONS, "normal_force": value, "creepage": Q([1.0, 2.0], "%")}
    with pytest.raises(wl.UnitError, match=r'^normal_force: .* or several as in normal_force=Q\(\[1, 2\], "kN"\)$'):
        wl.sweep(PREDICT, **conditions)


@pytest.mark.parametrize(
    "call",
    [
        PREDICT,
        PREDICT.rig.problem,
        ON_RAIL,
        lambda **given: wl.sweep(PREDICT, **{**CONDITIONS, "creepage": Q([1.0, 2.0], "%"), **given}),
        lambda **given: wl.uncertainty(PREDICT, **given),
        lambda **given: wl.creepage_for(PREDICT, traction_coefficient=0.1, **given),
        THREE.sel,
        THREE.isel,
        lambda **given: wl.contact_model("exact", **given),
        lambda **given: wl.wear_law("usfd", **given),
        wl.TwinDisc,
        wl.Material,
    ],
)
def test_a_keyword_may_be_called_self(call: Callable[..., Any]) -> None:
    with pytest.raises(wl.WearlawError, match=r"\bself\b"):
        call(self=1)
