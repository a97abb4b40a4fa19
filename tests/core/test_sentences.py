"""The sentences at the head of a report, and the main result that they and the first figure are about."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray

import wearlaw as wl
from tests.core import cases
from tests.core.axle_case import AXLES, MOVED, ON_AXLE
from tests.core.distributions import Install
from tests.core.outcome_laws import BRONZE
from wearlaw.pipeline.variables import MASS
from wearlaw.report.main_result import MANY_CURVES, MainResult, main_figure, main_result, together
from wearlaw.report.sentences import number, sentences
from wearlaw.study.results import LIMITS, beyond_limits
from wearlaw.study.study import Study, run

POINT: dict[str, Any] = {"max_pressure": "0.9 GPa", "creepage": "0.3 %", "friction_coefficient": 0.2}
FINE = {**POINT, "creepage": {"from": "0.1 %", "to": "10 %", "points": 101, "spacing": "log"}}


def study_of(sweep: dict[str, Any] = FINE, **changes: Any) -> Study:
    fields: dict[str, Any] = {"contact_models": ["global"], "wear_laws": ["usfd"], "profiles": {}, **changes}
    return run(cases.case(sweeps={"one": sweep, **fields.pop("more", {})}, **fields))


def said(study: Study) -> list[str]:
    """Return the sentences of a study with plain spaces."""
    return [text.replace("\N{NO-BREAK SPACE}", " ") for text in sentences(main_result(study))]


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


def test_a_single_law_at_a_single_point_has_a_value() -> None:
    first, second = said(study_of(POINT))
    rate = (wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd"))(**POINT).wear_rate
    assert first == f"The wear rate of usfd is {rate.magnitude:.3g} µg/m/mm²."
    assert second == "The point lies within the range of usfd and below first yield."


def test_a_single_law_over_a_sweep_has_its_lowest_and_highest_value() -> None:
    found = said(with_rates(study_of(THREE_POINTS), usfd=[3.0, 1.25, 1234.0]))
    assert found[0] == (
        "The wear rate of usfd runs from 1.25 µg/m/mm² at a creepage of 2 % to 1230 µg/m/mm² at a creepage of 4 %."
    )
    same = said(with_rates(study_of(THREE_POINTS), usfd=2.0))
    assert same[0] == "The wear rate of usfd is 2 µg/m/mm² at every creepage from 1 to 4 %."


def test_two_laws_at_a_point_differ_by_a_factor() -> None:
    found = said(with_rates(study_of(POINT, wear_laws=["usfd", "kth"]), usfd=2.0, kth=5.0))
    assert (
        found[0]
        == "The most wear, 5 µg/m/mm², comes from kth, and the least, 2 µg/m/mm², comes from usfd: a factor of 2.5."
    )


@pytest.mark.parametrize(
    ("usfd", "kth", "expected"),
    [
        (
            [1.0, 2.0, 3.0],
            [2.0, 5.0, 9.0],
            "The most wear comes from kth and the least from usfd at every creepage from 1 to 4 %, by a factor of 2 to"
            " 3.",
        ),
        (
            [2.0, 4.0, 6.0],
            [1.0, 2.0, 3.0],
            "The most wear comes from usfd and the least from kth at every creepage from 1 to 4 %, by a factor of 2.",
        ),
        (
            [8.0, 2.0, 3.0],
            [1.0, 5.0, 9.0],
            "The most wear, 9 µg/m/mm², comes from kth at a creepage of 4 %, where the least, 3 µg/m/mm², comes from"
            " usfd: a factor of 3; at a creepage of 1 % the factor is 8.",
        ),
        (
            [0.0, 2.0, 3.0],  # a factor says nothing where there is no wear
            [1.0, 5.0, 9.0],
            "The most wear, 9 µg/m/mm², comes from kth at a creepage of 4 %, where the least, 3 µg/m/mm², comes from"
            " usfd: a factor of 3.",
        ),
        (
            [0.0, 0.0, 0.0],
            [1.0, 5.0, 9.0],
            "The predictions differ most at a creepage of 4 %: kth gives 9 µg/m/mm² and usfd 0 µg/m/mm².",
        ),
        (
            [1.0, 2.0, 3.0],
            [1.0, 2.0, 3.0],
            "The predictions of usfd and kth are the same at every creepage from 1 to 4 %.",
        ),
    ],
)
def test_the_most_and_the_least_wear_are_named_with_their_factor(
    three: Study, usfd: list[float], kth: list[float], expected: str
) -> None:
    assert said(with_rates(three, usfd=usfd, kth=kth))[0] == expected


def test_a_band_wider_than_the_factor_between_the_laws_is_named(three: Study) -> None:
    study = with_rates(three, usfd=[1.0, 2.0, 3.0], kth=[2.0, 5.0, 9.0])
    study.sweeps["one"]["wear_rate_low"].loc[{"pair": "kth on global"}] = [1.0, 2.5, 2.25]
    assert said(study)[0].endswith("by a factor of 2 to 3; the published range of kth alone spans a factor of 4.")
    study.sweeps["one"]["wear_rate_low"].loc[{"pair": "kth on global"}] = [1.0, 2.5, 4.5]
    assert said(study)[0].endswith("by a factor of 2 to 3.")


def test_contact_models_are_named_where_a_law_depends_on_them() -> None:
    """In full slip, the exact theory and FASTSIM with Hertz's bound agree; in partial slip they do not."""
    models = ["exact", {"model": "fastsim", "bound": "elliptic"}]
    slips = {**POINT, "creepage": ["9 %", "10 %"]}
    assert said(study_of(slips, contact_models=models))[0].startswith("The wear rate of usfd runs")
    partial = {**POINT, "creepage": ["0.1 %", "0.2 %"]}
    rates = said(study_of(partial, contact_models=["global", "exact"], wear_laws=["kth"]))[0]
    assert rates.startswith("The most wear comes from kth on global and the least from kth on exact at every creepage")


def test_contact_models_with_the_same_results_stand_together() -> None:
    models = ["global", "exact", {"model": "fastsim", "bound": "elliptic"}]
    study = with_rates(study_of(THREE_POINTS, contact_models=models), usfd=[1.0, np.nan, 3.0])
    study.sweeps["one"]["wear_rate"].loc[{"pair": "usfd on global"}] = [2.0, np.nan, 9.0]
    assert said(study)[0].startswith(
        "The most wear, 9 µg/m/mm², comes from usfd on global at a creepage of 4 %, where the least, 3 µg/m/mm², comes"
        " from usfd on exact and fastsim: a factor of 3"
    )


def test_values_on_an_axis_have_four_digits() -> None:
    study = with_rates(study_of({**POINT, "creepage": ["1.23456 %", "2 %"]}), usfd=[1.0, 3.0])
    assert "at a creepage of 1.235 % to" in said(study)[0]


def test_regimes_change_where_the_means_over_the_patch_cross_the_borders_of_a_law() -> None:
    """In full slip T = μN, so that Tγ/A is proportional to the creepage and reaches usfd's borders where this says."""
    sweep = {**POINT, "creepage": {"from": "3 %", "to": "90 %", "points": 401, "spacing": "log"}}
    study = study_of(sweep, rig={"preset": "suros", "speed_of": "mean"})
    law, contact = wl.wear_law("usfd"), wl.TwinDisc.suros() | wl.contact_model("global")
    r = contact(max_pressure="0.9 GPa", creepage="10 %", friction_coefficient=0.2)
    per_percent = r.wear_index_density.to("N/m^2").magnitude / 10.0
    found = law.breakpoints(law.numbers)
    assert found is not None
    borders = [border / per_percent for border in found["wear_index_density"]]
    shown = [f"{border:.2g}" for border in borders if 3.0 < border < 90.0]
    assert shown
    assert (
        said(study)[1]
        == f"Over creepage, the mean over the patch changes regime at about {' and '.join(shown)} % (usfd)."
    )


def test_on_cells_regimes_change_where_the_most_loaded_part_of_the_patch_does() -> None:
    """Hertz's pressure is largest in the middle, so KTH's border of 2.1 GPa is reached at that maximum pressure."""
    pressures = {"from": "1.9 GPa", "to": "2.3 GPa", "points": 41}
    study = study_of({**POINT, "max_pressure": pressures}, contact_models=["exact"], wear_laws=["kth"])
    assert said(study)[1].startswith(
        "Over maximum pressure, the most loaded part of the patch changes regime at about 2.1 GPa (kth)"
    )
    below = study_of(
        {**POINT, "max_pressure": {**pressures, "to": "2 GPa"}}, contact_models=["exact"], wear_laws=["kth"]
    )
    assert said(below)[1].startswith("The most loaded part of the patch stays in one regime of kth")


def test_a_change_between_points_far_apart_is_given_by_both() -> None:
    study = study_of(
        {**POINT, "max_pressure": ["1 GPa", "2 GPa", "3 GPa"]}, contact_models=["exact"], wear_laws=["kth"]
    )
    assert "changes regime between 2 and 3 GPa (kth)" in said(study)[1]


def test_full_slip_begins_where_the_stick_ratio_reaches_zero() -> None:
    study = study_of(contact_models=["exact"])
    sweep = study.sweeps["one"]
    slips = sweep.creepage.values[sweep.stick_ratio.sel(contact_model="exact").values == 0.0]
    assert 0.1 < slips[0] < 10.0
    assert said(study)[1].endswith(f"; the whole patch slips from {slips[0]:.3g} % on.")
    small = study_of({**POINT, "creepage": ["0.001 %", "0.002 %"]}, contact_models=["exact"])
    assert said(small)[1].endswith("; part of the patch sticks throughout.")


def test_numbers_on_an_axis_have_the_unit_of_the_case() -> None:
    pressures = {"from": "0.8 GPa", "to": "1 GPa", "points": 5}
    sentence = said(study_of({**POINT, "max_pressure": pressures}))[0]
    assert re.search("at a maximum pressure of 0.8 GPa to .* at a maximum pressure of 1 GPa", sentence)


def test_points_of_a_grid_are_named_by_all_their_axes_and_counted() -> None:
    grid = {**THREE_POINTS, "max_pressure": ["800 MPa", "900 MPa"]}
    first, second, _ = said(study_of(grid))
    assert "at a creepage of 1 % and a maximum pressure of 800 MPa" in first or (
        "at a maximum pressure of 800 MPa and a creepage of 1 %" in first
    )
    assert second.startswith("At a maximum pressure of 900 MPa, ")
    many = said(study_of(grid, contact_models=["exact"], wear_laws=["usfd", "kth"]))[0]
    assert "at all 6 points" in many or "a maximum pressure of" in many


def test_what_lies_outside_a_range_and_beyond_limits_is_placed_on_the_axis() -> None:
    """Tests of usfd ran at mean pressures of 706.8 to 1414 MPa, π/4 of the maximum pressure: from 900 to 1800 MPa."""
    pressures = {"from": "600 MPa", "to": "2000 MPa", "points": 15}
    study = study_of({**POINT, "max_pressure": pressures}, wear_laws=["usfd", "brr"])
    limits = {name: one.sel(contact_model="global").values for name, one in beyond_limits(study.sweeps["one"]).items()}
    first_yield, shakedown = (np.linspace(600, 2000, 15)[one][0] for one in limits.values())
    assert said(study)[-1] == (
        "Points lie outside the range of usfd at 5 of 15 points; the contact is beyond first yield from"
        f" {first_yield:g} MPa on and beyond shakedown from {shakedown:g} MPa on; no range is known for brr."
    )
    upper = study_of({**POINT, "max_pressure": {**pressures, "from": "900 MPa", "points": 12}})
    assert said(upper)[-1].startswith("Points lie outside the range of usfd from 1900 MPa on; ")
    lower = study_of({**POINT, "max_pressure": {**pressures, "to": "1000 MPa", "points": 5}})
    assert said(lower)[-1] == "Points lie outside the range of usfd up to 800 MPa."
    inside = study_of({**POINT, "max_pressure": "900 MPa", "creepage": ["0.1 %", "0.2 %"]})
    assert said(inside)[-1] == "Every point lies within the range of usfd and below first yield."
    unknown = study_of({**POINT, "max_pressure": "900 MPa", "creepage": ["0.1 %", "0.2 %"]}, wear_laws=["brr"])
    assert said(unknown)[-1] == "Every point lies below first yield; no range is known for brr."


def test_other_materials_unknown_limits_and_other_sweeps_are_named() -> None:
    bronze = {"youngs_modulus": "110 GPa", "poisson_ratio": 0.33, "density": "8.8 g/cm^3"}
    assert str(BRONZE.youngs_modulus.to("GPa").magnitude) == "110.0"
    disc = {"diameter": "60 mm", "material": bronze}
    rig = {"type": "twin_disc", "disc_1": disc, "disc_2": disc, "track_width": "8 mm", "rolling_speed": "2 m/s"}
    assert said(study_of(POINT, rig=rig))[-1] == (
        "The point lies outside the range of usfd (fitted to other materials); the elastic limits are not known."
    )
    far = {**POINT, "max_pressure": "3 GPa"}
    assert said(study_of(POINT, more={"far": far}))[-1].endswith("; parts of the sweep 'far' lie outside too.")


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
    first, second, _ = sentences(main)
    assert first.startswith("The most wear of all patches together")
    assert (
        "patches come and go: left, patch 2 at −7\N{NO-BREAK SPACE}mm, right, patch 2 at 7\N{NO-BREAK SPACE}mm"
        in second
    )
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


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (0.0, "0"),
        (1234.5, "1230"),
        (0.0123456, "0.0123"),
        (-2.5, "−2.5"),
        (999999.0, "1000000"),
        (1.0e6, "1 × 10⁶"),
        (3.1415e-5, "3.14 × 10⁻⁵"),
        (25.0, "25"),
    ],
)
def test_numbers_have_three_digits_and_a_power_of_ten_if_they_are_large_or_small(value: float, shown: str) -> None:
    assert number(value) == shown


def test_main_result_is_that_of_the_first_sweep() -> None:
    study = study_of(THREE_POINTS, more={"two": POINT})
    main = main_result(study)
    assert isinstance(main, MainResult)
    assert (main.name, main.outcome, main.axis, main.pairs) == ("one", "wear_rate", "creepage", ("usfd on global",))
