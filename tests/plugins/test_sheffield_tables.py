"""Tables 1 to 4 of Tassini et al. (2010) as printed there, and its Table 4 as a fit done anew."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import optimize

import wearlaw as wl
from tests import reference
from tests.plugins.sheffield import (
    AREA,
    CORRECTED,
    FORCE,
    FRICTION,
    GLOBAL,
    LOAD,
    densities,
    index,
    point,
    usfd_of,
)
from wearlaw import Array
from wearlaw_sheffield import table_4, tables
from wearlaw_sheffield.bench import Bench

SUROS: Any = SimpleNamespace(case=SimpleNamespace(rig=wl.TwinDisc.suros()))
"""As much of a study as the tables need."""


def rows(table: pd.DataFrame) -> list[tuple[Any, ...]]:
    return list(table.itertuples(index=False, name=None))


def test_table_1_is_that_of_the_paper() -> None:
    assert rows(tables.table_1()) == [
        ("Tγ < 100", "0.25 Tγ / D"),
        ("100 ≤ Tγ < 200", "25 / D"),
        ("Tγ ≥ 200", "(1.19 Tγ - 154) / D"),
    ]


def test_table_2_is_that_of_the_paper_with_its_first_row_corrected() -> None:
    assert rows(tables.table_2()) == [
        ("p > 2.1", "any ṡ", 300.0, 400.0),
        ("p < 2.1", "ṡ < 0.2", 1.0, 10.0),
        ("p < 2.1", "0.2 ≤ ṡ < 0.7", 30.0, 40.0),
        ("p < 2.1", "ṡ ≥ 0.7", 1.0, 10.0),
    ]
    assert 'prints "ṡ ≥ 0.2" in the first row' in tables.section(SUROS).text


def test_table_3_is_that_of_the_paper_with_the_global_parameters() -> None:
    table = rows(tables.table_3())
    assert [(regime, equation) for regime, _, equation, _ in table] == [
        ("mild", "m_m w"),
        ("severe", "q_s"),
        ("catastrophic", "m_c w - (m_c tr_sc - q_s)"),
    ]
    assert [with_numbers for *_, with_numbers in table] == ["5.3 w", "55", "61.9 w - 4727.39"]
    offset = 61.9 * 77.26 - 55.0
    assert f"{offset:.2f}" == "4727.39"
    assert table[1][1] == "10.38 ≤ w < tr_sc = 77.26"


@pytest.mark.validates(
    "paper",
    "The published sets in the report's Table 4",
    source="Tassini et al. 2010, Table 4",
    held_to="all digits",
)
def test_table_4_is_that_of_the_paper() -> None:
    table = tables.table_4().set_index("parameter").T
    assert list(table.columns) == ["m_m [µg/m/N]", "q_s [µg/m/mm²]", "m_c [µg/m/N]", "tr_sc [N/mm²]"]
    assert [tuple(row) for row in table.to_numpy()] == [GLOBAL, CORRECTED["exact"], CORRECTED["fastsim"]]


def test_the_tables_follow_the_laws_when_these_change(monkeypatch: pytest.MonkeyPatch) -> None:
    look_up = wl.wear_law
    monkeypatch.setattr(wl, "wear_law", lambda name, **_: look_up(name, **CHANGED[name]))
    assert "0.3 Tγ / D" in str(rows(tables.table_1()))
    assert rows(tables.table_2())[0][:1] == ("p > 2",)
    assert "6 w" in str(rows(tables.table_3()))
    assert tables.table_4()["exact theory"][0] == 6.0


CHANGED: dict[str, dict[str, Any]] = {
    "brr": {"mild_slope": "0.3 mm^3/km/N", "plateau": "30 mm^3/km"},
    "kth": {"pressure_threshold": "2 GPa"},
    "usfd": {"m_m": "6 ug/m/N"},
}


def test_the_text_says_how_much_the_printed_slip_dissipates() -> None:
    solution = reference.exact(point(0.1), as_printed=True)
    ratio = 2.0 * solution.point.half_width * solution.mean(solution.density) / (solution.force * 0.001)
    assert f"dissipates {ratio:.1f} times Tγ" in tables.section(SUROS).text
    # The load of 741.43 kN/m is the pressure of 1500 MPa in five digits.
    assert tables.printed_slip(wl.TwinDisc.suros()) == pytest.approx(ratio, rel=1e-5)
    assert round(ratio, 1) == 3.0


def fit_over_cells(model: str, highest: float, norm: str, cells: int) -> Array:
    """Return q_s, m_c and tr_sc by a fit to sums over cells."""
    creepage = np.linspace(highest / 200.0, highest, 200)
    target = np.array([usfd_of(index(x) / AREA) for x in creepage])
    w = densities(model, creepage, cells)

    def residuals(parameters: Array) -> Array:
        q_s, m_c, transition = parameters
        local = (np.minimum(5.3 * w, q_s) + m_c * np.maximum(w - transition, 0.0)).mean(axis=1)
        return np.asarray(local - target if norm == "absolute" else np.log(local / target))

    found = optimize.least_squares(residuals, CORRECTED[model][1:], x_scale=(50.0, 80.0, 100.0), xtol=1e-10)
    return np.asarray(found.x)


@pytest.mark.validates(
    "paper",
    "Table 4 fitted anew: the fits of q_s, m_c and tr_sc to the global law",
    source="least squares of scipy over sums of 4000 cells, written anew for the tests",
    held_to="{cell:g}, relative (a cell)",
    cell=1.0 / 4000,
)
@pytest.mark.parametrize(
    ("model", "highest", "norm"),
    [
        ("exact", 20.5, "absolute"),
        ("fastsim", 20.5, "absolute"),
        ("exact", 18.0, "relative"),
        ("fastsim", 25.0, "relative"),
    ],
)
def test_the_fits_are_those_over_cells(bench: Bench, model: str, highest: float, norm: Any, cell: float) -> None:
    found = table_4.fitted(bench, model, highest, norm)
    # The rate jumps or bends inside a few cells at most, so that sums over cells are right to about a cell's share.
    over_cells = fit_over_cells(model, highest, norm, round(1.0 / cell))
    assert list(found.parameters.values()) == pytest.approx(list(over_cells), rel=cell)


def test_the_fits_up_to_20_and_a_half_percent_are_near_the_papers_sets(bench: Bench) -> None:
    # Computed once on another spacing of the creepages, with which m_c moves by 0.2 and the others by 0.05.
    for model, expected in (("exact", (53.0, 84.3, 92.7)), ("fastsim", (55.2, 94.9, 108.7))):
        found = table_4.fitted(bench, model, 20.5, "absolute").parameters
        for value, known, slack in zip(found.values(), expected, (0.05, 0.2, 0.05), strict=True):
            assert abs(value - known) <= slack + 0.05  # half of the last digit


def test_more_starting_points_find_nothing_else(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    one = table_4.fitted(bench, "fastsim", 20.5, "absolute")
    monkeypatch.setattr(table_4, "STARTS", 64)
    many = table_4.fitted(bench, "fastsim", 20.5, "absolute")
    assert many.parameters == pytest.approx(one.parameters, rel=1e-6)


def test_no_fit_is_worse_than_the_papers_set_by_its_own_measure(bench: Bench) -> None:
    for model in ("exact", "fastsim"):
        for norm in table_4.NORMS:
            one = table_4.fitted(bench, model, 22.0, norm)
            assert 0.0 < one.rms < one.rms_published


def test_the_root_mean_squares_are_those_of_the_residuals(bench: Bench) -> None:
    one = table_4.fitted(bench, "exact", 25.0, "absolute")
    creepage = np.linspace(0.125, 25.0, 200)
    target = np.array([usfd_of(index(x) / AREA) for x in creepage])
    w = densities("exact", creepage, 4000)
    for parameters, rms in (((*one.parameters.values(),), one.rms), (CORRECTED["exact"][1:], one.rms_published)):
        q_s, m_c, transition = parameters
        local = (np.minimum(5.3 * w, q_s) + m_c * np.maximum(w - transition, 0.0)).mean(axis=1)
        assert rms == pytest.approx(float(np.sqrt(np.mean((local - target) ** 2))), rel=1.0 / 4000)


def test_a_fit_beyond_shakedown_does_not_repeat_the_warning_of_the_study(bench: Bench) -> None:
    heavy = dataclasses.replace(bench, normal_force_per_width=wl.Q(2.0 * LOAD, "N/m"))
    conditions: dict[str, Any] = {
        "normal_force_per_width": heavy.normal_force_per_width,
        "friction_coefficient": FRICTION,
    }
    with pytest.warns(wl.RangeWarning, match="shakedown limit"):
        (heavy.rig | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact"))(creepage="1 %", **conditions)
    one = table_4.fitted(heavy, "exact", 20.5, "absolute")
    assert one.rms < one.rms_published


def made(model: str, highest: float, norm: Any, **parameters: float) -> table_4.Fitted:
    return table_4.Fitted(model, highest, norm, parameters, 1.0, 2.0)


def test_the_fits_are_listed_by_their_measure_to_two_digits_of_parameters_and_four_of_residuals() -> None:
    parameters = {"q_s": 53.2468, "m_c": 84.9753, "tr_sc": 92.1357}
    one = table_4.Fitted("exact", 22.0, "absolute", parameters, 1.23456, 2.34567)
    table = table_4.sensitivity([one, made("exact", 18.0, "relative", **parameters)], "absolute")
    assert rows(table) == [("exact", 22.0, 53.25, 84.98, 92.14, 1.2346, 2.3457)]


def test_the_claim_says_how_many_fits_are_near_and_which_is_nearest() -> None:
    near = made("exact", 22.0, "absolute", q_s=52.0, m_c=84.0, tr_sc=94.0)
    far = made("exact", 18.0, "relative", q_s=52.0, m_c=120.0, tr_sc=94.0)
    other = made("fastsim", 25.0, "absolute", q_s=55.0, m_c=83.7, tr_sc=95.0)
    claim = table_4.follows_from_a_fit([far, near, other])
    nearest = f"closest to {100.0 * 3.0 / 55.0:.1f} % (exact theory)"
    assert f"1 of 2 fits similar, the {nearest}; 0 of 1 fits similar" in claim.ours
    assert claim.verdict == "holds in part"
    published = {model: dict(zip(table_4.FREE, CORRECTED[model][1:], strict=True)) for model in ("exact", "fastsim")}
    same = [made(model, 22.0, "absolute", **parameters) for model, parameters in published.items()]
    assert table_4.follows_from_a_fit(same).verdict == "holds"
    assert table_4.follows_from_a_fit([far, other]).verdict == "does not hold"


def test_the_section_holds_the_fits_beside_the_papers_sets_and_their_residuals(bench: Bench) -> None:
    shown = {model: table_4.fitted(bench, model, 20.5, "absolute") for model in ("exact", "fastsim")}
    table = table_4.side_by_side(shown)
    assert tuple(table["simplified theory, paper"]) == CORRECTED["fastsim"]
    assert list(table["exact theory, fit"]) == [5.3, *(round(v, 2) for v in shown["exact"].parameters.values())]
    figure = table_4.residual_figure(bench, shown, "relative")
    assert [panel.title for panel in figure.panels] == ["Exact theory", "Simplified theory"]
    published, fitted = figure.panels[0].curves
    at = int(np.abs(published.x - 20.0).argmin())
    m_m, q_s, m_c, transition = CORRECTED["exact"]
    local = reference.usfd_mean(reference.exact(point(float(published.x[at]))), m_m, q_s, m_c, transition)
    expected = 100.0 * (local / usfd_of(FORCE * published.x[at] / 100.0 / AREA) - 1.0)
    assert published.y[at] == pytest.approx(expected, abs=1e-6)
    assert np.abs(fitted.y - published.y).max() > 1.0
    absolute = table_4.residual_figure(bench, shown, "absolute").panels[0].curves[0]
    assert absolute.y[at] == pytest.approx(expected / 100.0 * usfd_of(FORCE * published.x[at] / 100.0 / AREA), abs=1e-3)
