"""What lies outside the range of a law, its materials or elastic theory is marked in results, figures and tables."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests import cases
from tests.cases import case
from tests.core.stages import silently
from tests.plugins.studies.panels import by_label, by_name
from tests.plugins.studies.report_data import page_of
from wearlaw import Q
from wearlaw.errors import CompositionError
from wearlaw_apps.studies.report.tables import FOOTNOTES, summaries  # private: the marks of each number

RIG = wl.TwinDisc.suros()
BRONZE = wl.Material(youngs_modulus="110 GPa", poisson_ratio=0.34, density="8800 kg/m^3")
LOADS = {"from": "300 MPa", "to": "3000 MPa", "points": 28}  # in steps of 100 MPa


@pytest.fixture(scope="module")
def study() -> wl.Study:
    by_load = {**cases.POINT, "max_pressure": LOADS}
    return wl.run(case(wear_laws=["usfd", "kth"], sweeps={"creepage": cases.SWEEP, "load": by_load}))


@pytest.fixture(scope="module")
def on_rail() -> wl.Study:
    return wl.run(wl.load_case("wheel_on_rail"))


# Predictions


@pytest.mark.parametrize("model", ["exact", "fastsim", "global"])
def test_a_prediction_has_the_limits_of_its_traction(model: str) -> None:
    conditions: dict[str, Any] = {"max_pressure": "1500 MPa", "friction_coefficient": 0.46}
    r = (RIG | wl.contact_model(model))(creepage=Q([0.0, -0.1, 0.5, 5.0], "%"), **conditions)
    k, t = 541.3e6, np.abs(r.traction_coefficient.magnitude)
    first = wl.elastic_limit.first_yield(k, t, 0.46, poisson_ratio=0.28)
    np.testing.assert_allclose(r.first_yield.to("Pa").magnitude, first, rtol=1e-12)
    np.testing.assert_allclose(r.shakedown_limit.to("Pa").magnitude, wl.elastic_limit.shakedown_limit(k, t, 0.46))
    (at_once,) = (RIG | wl.contact_model(model))(creepage=Q([5.0], "%"), **conditions).shakedown_limit
    alone = (RIG | wl.contact_model(model))(creepage="5 %", **conditions).shakedown_limit
    assert alone == at_once
    assert repr(alone) == "1177 MPa"  # k/μ


def test_without_a_yield_stress_there_is_no_limit() -> None:
    soft = wl.steel(shear_yield_stress=None)
    r = (wl.TwinDisc.suros(material=soft) | wl.contact_model("exact"))(
        max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.4
    )
    with pytest.raises(CompositionError, match="no body's material has a shear_yield_stress"):
        r.first_yield  # noqa: B018


def test_points_outside_are_those_that_the_warning_counts() -> None:
    predict = RIG | wl.contact_model("global") | wl.wear_law("usfd")
    pressure = Q([300, 899, 900, 1500, 1800, 1801], "MPa")
    r = predict(max_pressure=pressure, creepage="1 %", friction_coefficient=0.46)
    assert r.outside_range.magnitude.tolist() == [1, 1, 0, 0, 0, 1]
    with pytest.warns(wl.RangeWarning, match="wear index density .* 1 of 3 operating points lies outside"):
        r = predict(max_pressure="1500 MPa", creepage=Q([1, 20, -20.1], "%"), friction_coefficient=0.46)
    assert r.outside_range.magnitude.tolist() == [0, 0, 1]


def test_all_points_of_other_materials_are_outside() -> None:
    predict = silently(wl.TwinDisc.suros(material=BRONZE), wl.contact_model("global"), wl.wear_law("brr"))
    r = predict(max_pressure="1000 MPa", creepage=Q([1, 2], "%"), friction_coefficient=0.3)
    assert r.outside_range.magnitude.tolist() == [1, 1]


@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")
def test_a_law_without_a_record_has_no_outside() -> None:
    law = wl.wear_law("kth", pressure_threshold="1 GPa")
    r = (RIG | wl.contact_model("global") | law)(max_pressure="5 GPa", creepage="90 %", friction_coefficient=0.4)
    assert r.outside_range == 0


# Results


def test_the_wear_of_a_rail_is_outside_a_law_of_wheel_steel(on_rail: wl.Study) -> None:
    elastic = on_rail.profiles["curve"].outside_range
    assert elastic.sel(pair="kth on strip_theory") == 0
    wheel, rail, *_ = by_name(on_rail)["curve_across_the_patch"].panels
    assert np.asarray(by_label(rail)["usfd on strip_theory"].outside).all()
    assert not np.asarray(by_label(rail)["kth on strip_theory"].outside).any()
    outside = bool(elastic.sel(pair="usfd on strip_theory").item())
    assert np.asarray(by_label(wheel)["usfd on strip_theory"].outside).all() == outside


# Tables


def marks_of(frame: pd.DataFrame, row: str) -> list[str]:
    (found,) = (values for values in frame.itertuples(index=False, name=None) if values[0] == row)
    return [value.marks for value in found[1:]]


def test_tables_mark_wear_rates_and_say_what_the_marks_mean(study: wl.Study) -> None:
    table = {one.name: one for one in summaries(study)}["wear_rate_load"]
    heads = [float(head) for head in table.frame.columns[1:]]
    sweep = study.sweeps["load"].sel(max_pressure=heads, method="nearest")
    assert heads == [300, 1000, 1700, 2300, 3000]
    for row, pair in (("usfd on exact", "usfd on exact"), ("kth on global, low end", "kth on global")):
        one = sweep.sel(pair=pair)
        limits = sweep.sel(contact_model=one.pair_contact_model.item())
        expected = [
            ("†" if outside else "") + ("‡" if p > shakedown else "*" if p > first else "")
            for outside, p, first, shakedown in zip(
                one.outside_range.values, heads, limits.first_yield.values, limits.shakedown_limit.values, strict=True
            )
        ]
        assert marks_of(table.frame, row) == expected
        assert len(set(expected)) > 2
    assert table.footnotes == tuple(f"{mark} {meaning}" for mark, meaning in FOOTNOTES.items())


def test_marks_are_in_the_report_but_not_in_numbers(study: wl.Study) -> None:
    table = {one.name: one for one in summaries(study)}["wear_rate_load"]
    page = page_of(study)
    assert "†‡</td>" in page
    assert "‡ beyond shakedown" in page
    numbers = table.frame.to_csv(index=False)
    assert "†" not in numbers
    read = pd.read_csv(io.StringIO(numbers))
    np.testing.assert_array_equal(read.iloc[:, 1:], table.frame.iloc[:, 1:].astype(float))
