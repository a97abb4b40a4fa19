"""The figure and the table at the head of a report, and the main result that they are about."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray

import wearlaw as wl
from tests.core import cases
from tests.core.axle_case import AXLES, MOVED, ON_AXLE
from tests.core.distributions import Install
from wearlaw.pipeline.variables import MASS
from wearlaw_studies.report.main_result import MANY_CURVES, main_figure, main_result, main_table, together
from wearlaw_studies.results import LIMITS, beyond_limits
from wearlaw_studies.study import Study, run

POINT: dict[str, Any] = {"max_pressure": "0.9 GPa", "creepage": "0.3 %", "friction_coefficient": 0.2}
FINE = {**POINT, "creepage": {"from": "0.1 %", "to": "10 %", "points": 101, "spacing": "log"}}


def study_of(sweep: dict[str, Any] = FINE, **changes: Any) -> Study:
    fields: dict[str, Any] = {"contact_models": ["global"], "wear_laws": ["usfd"], "profiles": {}, **changes}
    return run(cases.case(sweeps={"one": sweep, **fields.pop("more", {})}, **fields))


def with_rates(study: Study, **rates: Any) -> Study:
    """Return a study whose pairs, by law, have these outcomes, without bands."""
    (sweep,) = study.sweeps.values()
    changed = sweep.copy(deep=True)
    for pair in study.pairs:
        for name in ("wear_rate", "wear_rate_low", "wear_rate_high"):
            changed[name].loc[{"pair": pair.label}] = rates[pair.law]
    return replace(study, sweeps={"one": changed})


THREE_POINTS = {**POINT, "creepage": ["1 %", "2 %", "4 %"]}


@pytest.fixture(scope="module")
def three() -> Study:
    return study_of(THREE_POINTS, wear_laws=["usfd", "kth"])


def test_the_table_has_least_and_most_borders_and_what_lies_outside(three: Study) -> None:
    study = with_rates(three, usfd=[3.0, 1.25, 1234.0], kth=[2.0, 5.0, np.nan])
    study.sweeps["one"]["outside_range"].loc[{"pair": "usfd on global"}] = [0.0, 1.0, 0.0]
    usfd, kth = main_table(main_result(study)).to_dict("records")
    assert usfd == {
        "pair": "usfd on global",
        "least [µg/m/mm²]": 1.25,
        "least at": "2 %",
        "most [µg/m/mm²]": 1234.0,
        "most at": "4 %",
        "regimes change at": "wear index over area Tγ/A 10.38, 77.26 N/mm²",
        "outside the range": "1 of 3",
        "beyond shakedown": "nowhere",
    }
    assert [kth[f"{end} [µg/m/mm²]"] for end in ("least", "most")] == [2.0, 5.0]
    assert kth["regimes change at"].endswith("slip speed 0.2, 0.7 m/s")


def test_the_table_of_a_single_point_names_no_place() -> None:
    (row,) = main_table(main_result(study_of({**POINT, "max_pressure": "3 GPa"}))).to_dict("records")
    rate = (wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd"))(
        **{**POINT, "max_pressure": "3 GPa"}
    ).wear_rate
    assert row["least [µg/m/mm²]"] == row["most [µg/m/mm²]"] == pytest.approx(rate.magnitude)
    assert not {"least at", "most at"} & {*row}
    assert row["outside the range"] == row["beyond shakedown"] == "everywhere"


def test_places_have_all_axes_in_the_units_of_the_case() -> None:
    grid = {**POINT, "max_pressure": ["900 MPa", "950 MPa"], "creepage": ["0.1 %", "0.3 %"]}
    (row,) = main_table(main_result(study_of(grid))).to_dict("records")
    assert row["most at"] == "950 MPa, 0.3 %"


def test_values_along_several_patches_are_summed_and_marked_if_any_patch_is(install: Install) -> None:
    install(*AXLES)
    study = run(wl.Case(**{**ON_AXLE, "profiles": {}}))
    main = main_result(study)
    sweep, whole = study.sweeps["moving"], main.sweep
    assert (main.outcome, main.axis) == (MASS, "displacement")
    np.testing.assert_allclose(whole[MASS], sweep[MASS].fillna(0.0).sum(["side", "patch"]))
    for name, beyond in beyond_limits(whole).items():
        xarray.testing.assert_equal(beyond, beyond_limits(sweep)[name].any(["side", "patch"]))
    np.testing.assert_array_equal(whole.outside_range, sweep.outside_range.max(["side", "patch"]))
    (panel,) = main_figure(main).panels
    np.testing.assert_array_equal(panel.curves[0].x, MOVED)
    np.testing.assert_allclose(panel.curves[0].y, whole[MASS].sel(pair=panel.curves[0].label))


def test_an_outcome_that_cannot_be_added_is_the_largest_of_all_patches(install: Install) -> None:
    install(*AXLES)
    study = run(wl.Case(**{**ON_AXLE, "profiles": {}}))
    main, sweep = main_result(study), study.sweeps["moving"]
    largest = together(sweep, "wear_rate")
    found = np.nanmax(sweep.wear_rate.transpose(..., "side", "patch"), axis=(-2, -1))
    np.testing.assert_array_equal(largest.wear_rate, found)
    assert main_figure(main).caption.endswith(" The sum over all patches.")
    of_rates = replace(main, outcome="wear_rate", sweep=largest)
    assert main_figure(of_rates).caption.endswith(" The largest of all patches.")


def test_limits_of_several_patches_are_those_of_the_patch_furthest_beyond(install: Install) -> None:
    install(*AXLES)
    sweep = run(wl.Case(**{**ON_AXLE, "profiles": {}})).sweeps["moving"]
    whole = together(sweep, MASS)
    for limit in LIMITS:
        found = whole.max_pressure / whole[limit]
        xarray.testing.assert_allclose(found, (sweep.max_pressure / sweep[limit]).max(["side", "patch"]), rtol=1e-14)


def test_the_main_outcome_is_wear_beside_other_outcomes() -> None:
    points = {"threshold": "5 N", "peak": "50 N", "balance": "175 N", "peak_damage": 1e-5, "beyond": "zero"}
    main = main_result(study_of(POINT, laws=[{"model": "wlrm", **points}]))
    assert (main.outcome, main.pairs) == ("wear_rate", ("usfd on global",))


def test_the_figure_shows_one_contact_model_if_all_would_be_too_many() -> None:
    models = ["global", "exact", "fastsim"]
    few = main_figure(main_result(study_of(contact_models=models[:2], wear_laws=["usfd", "kth"])))
    assert len(few.panels[0].curves) == 4 <= MANY_CURVES
    many = main_figure(main_result(study_of(contact_models=models, wear_laws=["usfd", "kth", "brr"])))
    assert [curve.label for curve in many.panels[0].curves] == ["usfd on global", "kth on global", "brr on global"]
    assert many.caption.endswith("Only the pairs with global are shown; the tables hold all.")


OTHER = {"traction": {"sweep": "one", "x": "creepage", "y": "traction_coefficient"}}


def test_scales_follow_the_spacing_of_the_sweep_and_the_spread_of_the_outcome() -> None:
    def scales(sweep: dict[str, Any]) -> tuple[str, str]:
        (panel,) = main_figure(main_result(study_of(sweep, figures=OTHER))).panels
        return panel.x.scale, panel.y.scale

    linear = {"from": "1 %", "to": "2 %", "points": 5}
    assert scales({**POINT, "creepage": linear}) == ("linear", "linear")
    assert scales(FINE) == ("log", "log")


@pytest.mark.parametrize(
    ("rates", "scale"),
    [
        ([0.01, 0.02, 0.4], "log"),
        ([1.0, 2.0, 29.0], "linear"),
        ([0.0, 1.0, 40.0], "log"),
        ([0.0, 1.0, 20.0], "linear"),
        ([np.nan, 1.0, 40.0], "log"),
        ([-0.5, 1.0, 40.0], "linear"),
        ([0.0, 0.0, 0.0], "linear"),
    ],
)
def test_outcomes_of_one_sign_that_differ_by_more_than_thirty_have_a_logarithmic_axis(
    rates: list[float], scale: str
) -> None:
    figure = main_figure(main_result(with_rates(study_of(THREE_POINTS, figures=OTHER), usfd=rates)))
    assert figure.panels[0].y.scale == scale


def test_main_result_is_that_of_the_first_sweep() -> None:
    study = study_of(THREE_POINTS, more={"two": POINT})
    main = main_result(study)
    assert (main.name, main.outcome, main.axis, main.pairs) == ("one", "wear_rate", "creepage", ("usfd on global",))
