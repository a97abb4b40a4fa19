"""The results of a comparison: tables and figures, also with rates of zero."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.fits.comparisons import EXACT, GLOBAL, by_label, made, order, scattered, usfd
from tests.strategies import EPS
from wearlaw import Q


class Above(wl.WearLaw):
    """Wear in proportion to the wear-index density, but none below a threshold of it."""

    name = "above"
    source = "A test, 3. ed., 2026"
    scale = "patch"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        density = contact.wear_index_density
        return np.where(density < 20e6, 0.0, 5e-9 * density)


def test_the_table_ranks_and_has_its_units_in_the_heads() -> None:
    comparison = wl.compare([EXACT | wl.wear_law("kth"), EXACT | usfd()], scattered())
    table = comparison.table()
    assert list(table.columns) == [
        "predictor", "rms_factor", "bias", "geometric_sd", "largest_factor", "rms_error [ug/m/mm^2]", "tests",
        "in_sample", "without_ratio", "fitted", "aic", "aicc",
    ]  # fmt: skip
    assert table["predictor"].tolist() == ["usfd on exact", "kth on exact"]
    for row, one in zip(table.to_dict("records"), comparison.compared, strict=True):
        for measure in ("rms_factor", "bias", "geometric_sd", "largest_factor", "tests", "without_ratio"):
            assert row[measure] == getattr(one.agreement, measure)
        assert row["rms_error [ug/m/mm^2]"] == pytest.approx(one.agreement.rms_error * 1e3, rel=4 * EPS)


def test_the_figure_has_a_panel_for_each_contact_model_with_measured_over_predicted() -> None:
    data = scattered()
    predictors = [EXACT | usfd(), EXACT | wl.wear_law("kth"), GLOBAL | wl.wear_law("kth"), GLOBAL | wl.wear_law("brr")]
    predictors.append(EXACT | wl.wear_law("kth", coefficient="high"))
    comparison = wl.compare(predictors, data)
    figure = comparison.figure_data()
    assert {panel.title: {c.label for c in panel.curves if c.points} for panel in figure.panels} == {
        "exact": {"usfd", "kth(coefficient=mid)", "kth(coefficient=high)"},
        "global": {"kth(coefficient=mid)", "brr"},
    }
    colours: dict[str, set[int]] = {}
    for panel in figure.panels:
        assert (panel.x.scale, panel.y.scale) == ("log", "log")
        assert panel.x.ends is not None
        assert panel.x.ends == panel.y.ends
        assert all(curve.hollow for curve in panel.curves if curve.points), "only measurements have filled markers"
        for curve in (curve for curve in panel.curves if curve.points):
            predicted = by_label(comparison)[f"{curve.label} on {panel.title}"].predicted
            np.testing.assert_allclose(curve.x, predicted * 1e3, rtol=4 * EPS)
            np.testing.assert_allclose(curve.y, data.wear_rate.magnitude, rtol=4 * EPS)
            colours.setdefault(curve.label, set()).add(curve.colour)
            low, high = panel.x.ends
            assert low < min(curve.x.min(), curve.y.min())
            assert high > max(curve.x.max(), curve.y.max())
    assert all(len(found) == 1 for found in colours.values()), "one law, one colour"
    assert len(set.union(*colours.values())) == len(colours) == 4


# Zero rates


@pytest.fixture(scope="module")
def with_zeros() -> wl.Comparison:
    """A law that predicts no wear in the first tests, beside one that is far off, and a measured rate of zero."""
    rates = made().wear_rate.magnitude.copy()
    rates[3] = 0.0
    laws = {"above": GLOBAL | Above(), "far": GLOBAL | wl.wear_law("brr")}
    return wl.compare(laws, made(wear_rate=Q(rates, "ug/m/mm^2")))


def test_no_predicted_wear_where_some_was_measured_ranks_last_and_is_noted(with_zeros: wl.Comparison) -> None:
    found = by_label(with_zeros)
    missed = int(((found["above"].predicted == 0) != (with_zeros.tests.columns["wear_rate"] == 0)).sum())
    assert missed > 1, "the law must miss some tests here"
    assert order(with_zeros) == ["far", "above"]
    assert found["above"].agreement.without_ratio == missed
    assert any(note.startswith("above: ") and f"zero in {missed} of 8 tests" in note for note in with_zeros.notes)
    assert any(note.startswith("far: ") and "zero in 1 of 8 tests" in note for note in with_zeros.notes)
