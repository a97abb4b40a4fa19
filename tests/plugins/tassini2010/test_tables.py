"""Tables 1 to 4 of Tassini et al. (2010) as printed there, and its Table 4 as a fit done anew."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import optimize

import wearlaw as wl
from tests import reference
from tests.plugins.tassini2010.paper import AREA, CORRECTED, GLOBAL, densities, index, point, usfd_of
from wearlaw import Array
from wearlaw_apps.papers.tassini2010 import table_4, tables  # private: one claim or table, without the study
from wearlaw_apps.papers.tassini2010.bench import Bench  # private: one claim or table, without the study

SUROS: Any = SimpleNamespace(case=SimpleNamespace(rig=wl.TwinDisc.suros()))
"""As much of a study as the tables need."""


def rows(table: pd.DataFrame) -> list[tuple[Any, ...]]:
    return list(table.itertuples(index=False, name=None))


def test_table_1_is_that_of_the_paper() -> None:
    assert rows(tables.table_1()) == [
        ("Tγ < 100", "0.25 Tγ / D"),
        ("100 ≤ Tγ < 200", "25 / D"),
        ("Tγ ≥ 200", "(1.19 Tγ − 154) / D"),
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
        ("catastrophic", "m_c w − (m_c tr_sc − q_s)"),
    ]
    assert [with_numbers for *_, with_numbers in table] == ["5.3 w", "55", "61.9 w − 4727.39"]
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


def test_the_numbers_of_the_text_are_those_of_the_formulas() -> None:
    solution = reference.exact(point(0.1), as_printed=True)
    ratio = 2.0 * solution.point.half_width * solution.mean(solution.density) / (solution.force * 0.001)
    jump = (1.19 * 200.0 - 154.0) / 25.0
    text = tables.section(SUROS).text
    for said in (f"dissipates {ratio:.1f} times Tγ", f"by a factor of {jump:.2f}", f"{2.1 / 0.8:.3f} GPa follows"):
        assert said in text


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


@pytest.mark.parametrize(
    ("norm", "difference"),
    [("absolute", lambda local, target: local - target), ("relative", lambda local, target: np.log(local / target))],
)
def test_the_root_mean_squares_are_those_of_the_residuals(bench: Bench, norm: Any, difference: Any) -> None:
    one = table_4.fitted(bench, "exact", 25.0, norm)
    creepage = np.linspace(0.125, 25.0, 200)
    target = np.array([usfd_of(index(x) / AREA) for x in creepage])
    w = densities("exact", creepage, 4000)
    for parameters, rms in (((*one.parameters.values(),), one.rms), (CORRECTED["exact"][1:], one.rms_published)):
        q_s, m_c, transition = parameters
        local = (np.minimum(5.3 * w, q_s) + m_c * np.maximum(w - transition, 0.0)).mean(axis=1)
        assert rms == pytest.approx(float(np.sqrt(np.mean(difference(local, target) ** 2))), rel=1.0 / 4000)


def made(model: str, highest: float, norm: Any, **parameters: float) -> table_4.Fitted:
    return table_4.Fitted(model, highest, norm, parameters, 1.0, 2.0)


def test_the_fits_are_listed_behind_the_papers_set_of_their_model() -> None:
    parameters = {"q_s": 53.2468, "m_c": 84.9753, "tr_sc": 92.1357}
    fits = [table_4.Fitted("exact", 22.0, "absolute", parameters, 1.23456, 2.34567)]
    table = table_4.table(fits)
    of_paper, fit, other = (tuple(row) for row in table.astype(object).where(table.notna(), "").to_numpy())
    assert of_paper == ("exact theory", "paper", "", *CORRECTED["exact"][1:], "", "")
    assert fit == ("exact theory", "absolute [µg/m/mm²]", 22.0, 53.25, 84.98, 92.14, 1.2346, 2.3457)
    assert other[:2] == ("simplified theory", "paper")


def test_the_claim_says_how_many_fits_are_near_and_which_is_nearest() -> None:
    near = made("exact", 22.0, "absolute", q_s=50.5, m_c=84.0, tr_sc=94.0)
    far = made("exact", 18.0, "relative", q_s=50.5, m_c=120.0, tr_sc=94.0)
    other = made("fastsim", 25.0, "absolute", q_s=55.0, m_c=83.7, tr_sc=95.0)
    claim = table_4.follows_from_a_fit([far, near, other])
    nearest = f"closest to {100.0 * 4.5 / 55.0:.1f} % (exact theory)"
    assert f"1 of 2 fits similar, the {nearest}; 0 of 1 fits similar" in claim.ours
    assert claim.verdict == "holds in part"
    published = {model: dict(zip(table_4.FREE, CORRECTED[model][1:], strict=True)) for model in ("exact", "fastsim")}
    same = [made(model, 22.0, "absolute", **parameters) for model, parameters in published.items()]
    assert table_4.follows_from_a_fit(same).verdict == "holds"
    assert table_4.follows_from_a_fit([far, other]).verdict == "does not hold"


def test_the_section_has_each_fit(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    def fitted(_: Bench, model: str, highest: float, norm: Any) -> table_4.Fitted:
        q_s = 50.0 + 0.1 * highest + (norm == "relative")  # tells the fits from each other
        return made(model, highest, norm, q_s=q_s, m_c=84.0, tr_sc=94.0)

    monkeypatch.setattr(table_4, "fitted", fitted)
    monkeypatch.setattr(Bench, "of", lambda _: bench)
    section = table_4.section(SUROS)
    fits = section.tables["table_4_fit"]
    assert sorted(fits["up to creepage [%]"].dropna()) == sorted([18.0, 20.5, 22.0, 25.0] * 4)
