"""Comparisons of laws that have seen the tests, of other outcomes than wear and of stages, and cross-validation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.outcome_laws import CONDITIONS, Damage, Heat
from tests.plugins.fits.comparisons import SCATTER, by_label, made, scattered, usfd
from tests.plugins.fits.fits import EXACT, GLOBAL, sloping
from tests.plugins.fits.test_fit_stages import SOFT, Softer, made_up
from wearlaw import Q
from wearlaw.errors import FitError
from wearlaw_apps.fits import Comparison, WearTests

pytestmark = pytest.mark.filterwarnings(
    "ignore::wearlaw.errors.FitWarning"
)  # most compare fits to the tests themselves

MARK = "fitted to these tests, which flatters their rank: "


def folds(points: Any, how: Any) -> list[Any]:
    """Return the tests in each fold: operating points are dealt in a random order with the seed 0."""
    count = points.max() + 1
    dealt = np.random.default_rng(0).permutation(count)
    number = count if how == "leave-one-out" else how
    return [np.flatnonzero(np.isin(points, dealt[fold::number])) for fold in range(number)]


def seen(comparison: Comparison) -> dict[str, int]:
    return {one.names.label: one.in_sample for one in comparison.compared}


def test_a_law_knows_the_tests_that_it_was_fitted_to_also_from_a_file(tmp_path: Path) -> None:
    tests = scattered()
    fit = wl.fit(EXACT | usfd(), tests, ["q_s"], bootstrap=0)
    fit.to_toml(tmp_path / "law.toml")
    read = wl.read_law(tmp_path / "law.toml")
    other = GLOBAL | wl.wear_law("brr")
    comparison = wl.compare({"fit": fit, "read": EXACT | read, "other": other}, tests)
    assert seen(comparison) == {"fit": 8, "read": 8, "other": 0}
    (note,) = [note for note in comparison.notes if note.startswith(MARK)]
    assert "fit (8 of 8)" in note
    assert "read (8 of 8)" in note
    assert "other" not in note.replace("other tests", "")


def test_some_of_the_tests_of_a_fit_are_known_again_under_other_labels_and_units() -> None:
    tests = scattered()
    fit = wl.fit(EXACT | usfd(), tests[:5], ["m_m"], bootstrap=0)
    again = WearTests.from_arrays(
        creepage=Q(tests.creepage.to("").magnitude, ""),
        max_pressure="1.5 GPa",
        friction_coefficient=0.46,
        wear_rate=tests.wear_rate.to("g/m^3"),
        labels=[f"test {i}" for i in range(8)],
        source="elsewhere",
    )
    assert seen(wl.compare({"a": EXACT | fit.predict.laws[0]}, again)) == {"a": 5}
    changed = made(wear_rate=tests.wear_rate * 1.001)
    comparison = wl.compare({"a": EXACT | fit.predict.laws[0]}, changed)
    assert seen(comparison) == {"a": 0}
    assert not any(note.startswith(MARK) for note in comparison.notes)
    assert "in_sample" not in repr(comparison)


# Cross-validation


@pytest.mark.validates(
    "fitting",
    "Leave-one-out predictions of a law that is linear in its two parameters",
    source="the closed form y - e/(1 - h) of the residuals e and leverages h of one linear fit",
    held_to="a relative error of {within:g}",
    within=1e-6,
)
def test_leaving_one_out_is_the_closed_form_of_a_linear_law(within: float) -> None:
    creepage = Q([2.0, 4.0, 6.0, 9.0, 12.0, 16.0], "%")
    conditions: Any = {"creepage": creepage, "max_pressure": "1500 MPa", "friction_coefficient": 0.46}
    density = (GLOBAL | sloping)(**conditions).wear_index_density.to("N/mm^2").magnitude
    y = 1.0 + 2.0 * density * [1.1, 0.9, 1.05, 0.97, 1.02, 0.93]
    tests = WearTests.from_arrays(**conditions, wear_rate=Q(y, "ug/m/mm^2"))
    fit = wl.fit(GLOBAL | sloping, tests, ["offset", "slope"], scatter="absolute", bootstrap=0, bounds=WIDE)
    design = np.stack([np.ones(6), density], axis=-1)
    hat = design @ np.linalg.pinv(design)
    expected = y - (y - hat @ y) / (1.0 - np.diag(hat))
    comparison = wl.compare({"line": fit}, tests, cross_validate="leave-one-out")
    (one,) = comparison.compared
    # The sum of squares is flat at the best fit, so that the search ends within the root of rounding, about 1e-8.
    assert one.predicted * 1e3 == pytest.approx(expected, rel=within)
    assert one.agreement.rms_error * 1e3 == pytest.approx(np.sqrt(np.mean((expected - y) ** 2)), rel=10 * within)
    assert repr(comparison).startswith("1 predictor on 6 tests, best first, fits cross-validated (leave-one-out);")


WIDE: Any = {"offset": ("1e-6 ug/m/mm^2", "1e3 ug/m/mm^2"), "slope": ("1e-3 ug/m/N", "1e3 ug/m/N")}


@pytest.mark.parametrize(
    ("creepage", "point", "how"),
    [
        *((np.linspace(0.1, 0.5, 8), np.arange(8), how) for how in ("leave-one-out", 4, 3)),
        *(([0.1, 0.2, 0.3, 0.4, 0.2, 0.1, 0.1, 0.40001], np.array([0, 1, 2, 3, 1, 0, 0, 3]), how)
          for how in ("leave-one-out", 2, 3)),
    ],
)  # fmt: skip
def test_each_fold_is_predicted_by_the_mean_factor_of_the_others(creepage: Any, point: Any, how: Any) -> None:
    """In the mild regime the only free parameter is a factor: its logarithm is the mean of those of the other tests.

    Repeated tests have other labels, wear rates and measured tractions, and are left out together.
    """
    conditions: Any = {"creepage": Q(creepage, "%"), "max_pressure": "1500 MPa", "friction_coefficient": 0.46}
    truth = (EXACT | usfd())(**conditions).wear_rate
    tests = WearTests.from_arrays(
        **conditions, traction_coefficient=0.1 * SCATTER, wear_rate=truth * SCATTER, labels=list("abcdefgh")
    )
    fit = wl.fit(EXACT | usfd(), tests, ["m_m"], bootstrap=0)
    parts, count = folds(point, how), int(point.max()) + 1
    assert sorted(np.concatenate(parts)) == list(range(8))
    assert sum(np.unique(point[part]).size for part in parts) == count  # no point is in two folds
    expected = np.empty(8)
    for held in parts:
        expected[held] = np.exp(np.delete(np.log(SCATTER), held).mean())
    comparison = wl.compare([fit, EXACT | usfd()], tests, cross_validate=how)
    one = by_label(comparison)["usfd fitted on exact"]
    # As above, 1e-8 of the best fit.
    assert one.predicted * 1e3 == pytest.approx(truth.magnitude * expected, rel=1e-6)
    assert one.in_sample == 0
    assert comparison.cross_validated == (how if how == "leave-one-out" else f"{how} folds")
    note = f"the 8 tests are at {count} operating points; cross-validation leaves out repeated tests together"
    assert (note in comparison.notes) == (count < 8)
    with pytest.raises(wl.InputError, match=rf"^cross_validate: .* from 2 to {count}, .* got 9"):
        wl.compare([fit], tests, cross_validate=9)


def test_cross_validation_needs_two_operating_points_and_a_fit() -> None:
    tests = made(creepage="0.5 %", wear_rate=Q(10.0 * SCATTER, "ug/m/mm^2"))
    fit = wl.fit(EXACT | usfd(), tests, ["m_m"], bootstrap=0)
    with pytest.raises(wl.InputError, match=r"^cross_validate: "):
        wl.compare([fit], tests, cross_validate="leave-one-out")
    with pytest.raises(wl.InputError, match=r"^cross_validate: .* Fit"):
        wl.compare([EXACT | usfd()], scattered(), cross_validate=4)


def test_a_fold_without_which_a_parameter_is_not_determined_is_named() -> None:
    """Only the last two tests depend on the catastrophic regime."""
    fit = wl.fit(EXACT | usfd(), scattered(), ["m_m", "m_c"], bootstrap=0)
    with pytest.raises(FitError, match=r"usfd fitted on exact: cannot be fitted without tests number .*8.*m_c"):
        wl.compare([fit], scattered(), cross_validate=2)


def measured(outcomes: Any, **more: Any) -> WearTests:
    return WearTests.from_arrays(**CONDITIONS, outcomes=outcomes, **more)


def test_predictions_of_heat_are_compared_in_its_unit() -> None:
    predict = {"third": EXACT | Heat(share=0.3), "half": EXACT | Heat(share=0.6)}
    tests = measured({"heat_flux": (EXACT | Heat(share=0.3))(**CONDITIONS)["heat_flux"].to("kW/mm^2")})
    found = wl.compare(predict, tests)
    assert [one.names.label for one in found.compared] == ["third", "half"]
    assert found.compared[0].agreement.rms_factor == pytest.approx(1.0, rel=1e-12)
    assert found.compared[1].agreement.bias == pytest.approx(2.0, rel=1e-12)
    heat = predict["half"](**CONDITIONS)["heat_flux"].magnitude
    assert found.predictions()["half [W/mm^2]"].tolist() == pytest.approx(heat, rel=1e-12)
    rms = np.sqrt(np.mean((0.5 * heat) ** 2))
    assert found.table()["rms_error [W/mm^2]"].tolist()[1] == pytest.approx(rms, rel=1e-12)
    assert repr(found).startswith("2 predictors on 7 tests of heat flux, best first; rms_error in W/mm²")
    figure = found.figure_data()
    assert figure.title == "Measured against predicted heat flux"
    assert figure.panels[0].x.label == "predicted heat flux [W/mm²]"


def test_one_of_several_outcomes_is_chosen_by_name() -> None:
    predict = EXACT.with_law(wl.wear_law("kth"), Heat(), Damage())
    both = predict(**CONDITIONS)
    tests = measured({"heat_flux": both["heat_flux"], "rcf_damage": both["rcf_damage"]}, wear_rate=both.wear_rate)
    for name in ("wear_rate", "heat_flux", "rcf_damage"):
        (one,) = wl.compare([predict], tests, outcome=name).compared
        # The prediction comes in its unit and goes back to SI; KTH beside other laws has other nodes.
        assert one.agreement.rms_error <= 1e-12 * np.abs(tests.measured(name, str(both[name].units))).max()
    with pytest.raises(wl.InputError, match=r'share wear_rate and heat_flux and rcf_damage, .* as in outcome="wear_'):
        wl.compare([predict], tests)
    with pytest.raises(wl.InputError, match=r"outcome: .*'heat_flx'; did you mean 'heat_flux'"):
        wl.compare([predict], tests, outcome="heat_flx")
    with pytest.raises(wl.InputError, match="no outcome in common; they predict heat_flux, rcf_damage"):
        wl.compare([EXACT | Heat(), EXACT | Damage()], tests)
    with pytest.raises(wl.InputError, match="none of the 7 tests has a rcf damage, which a comparison needs"):
        wl.compare([EXACT | Damage()], measured({"heat_flux": both["heat_flux"]}))
    (shared,) = wl.compare([EXACT | Heat()], tests).compared
    assert shared.names.label == "heat on exact"


def test_stages_are_named_and_a_fitted_stage_predicts() -> None:
    kth = wl.wear_law("kth")
    soft, stiff = (EXACT.model_copy(update={"stages": (Softer(reduction=part),)}) for part in (0.5, 1.0))
    tests = WearTests.from_arrays(**CONDITIONS, wear_rate=(soft | kth)(**CONDITIONS).wear_rate)
    found = wl.compare([stiff | kth, soft | kth], tests)
    names = [one.names.label for one in found.compared]
    assert names == ["kth on exact, softer(reduction=0.5)", "kth on exact, softer(reduction=1.0)"]
    given: Any = {"creepage": made_up().creepage, "max_pressure": "1500 MPa", "friction_coefficient": 0.4}
    wear = (EXACT | Softer(reduction=0.6) | kth)(**given).wear_rate
    both = made_up(wear_rate=wear)
    fit = wl.fit(SOFT | kth, both, ["reduction"], bootstrap=0)
    (one,) = wl.compare([fit], both).compared
    assert one.names.label == "kth fitted on exact, softer"
    assert one.agreement.rms_factor == pytest.approx(1.0, rel=1e-6)
    assert fit.contact_parameters == ("reduction",)
