"""The laws side by side: curves against the formulas of the papers, and each number in the words about them."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest

from docs import laws_compared
from docs.laws_compared import CASES, DENSITIES, DISCS, VEHICLE, Case, Curve, curves, solved
from tests.environments import ROOT
from wearlaw import Array

PAGE = " ".join((ROOT / "docs" / "choosing.md").read_text(encoding="utf-8").split())
AREA = {DISCS: 6.2934532e-6, VEHICLE: float(solved(VEHICLE).patch_area[0])}
"""That of the discs is Hertz's, 2ab with a = 2 p0 R/E*; wearlaw's ellipses have tests of their own."""
SETS = {"global": (5.3, 55.0, 61.9, 77.26), "exact": (5.3, 55.0, 83.7, 95.0), "fastsim": (5.3, 56.5, 83.7, 107.0)}
RANGES = {"low": (1e-4, 30e-4, 1e-4), "mid": (5.5e-4, 35e-4, 5.5e-4), "high": (10e-4, 40e-4, 10e-4)}


def pressure(case: Case) -> float:
    """Return the mean pressure [MPa]."""
    return 0.25 * math.pi * 1500.0 if case is DISCS else 80e3 / (1e6 * AREA[case])


def slip_speed(case: Case, densities: Array) -> Array:
    """Return the slip speed [m/s] at Tγ/A [N/mm²]."""
    return densities / (case.friction * pressure(case)) * (1.0 if case is DISCS else 20.0)


def due(case: Case, label: str, w: Array) -> Array:
    """Return the mass per energy [µg/J] at Tγ/A [N/mm²] by the formulas of Tassini et al. (2010), Tables 1 to 4."""
    law, _, chosen = label.partition(", ")
    if law == "usfd":
        slope, plateau, steep, end = SETS[chosen]
        return np.where(w < end, np.minimum(slope * w, plateau), plateau + steep * (w - end)) / w
    if law == "kth":
        mild, severe, fast = RANGES[chosen]
        speed = slip_speed(case, w)
        k = np.where(speed < 0.2, mild, np.where(speed < 0.7, severe, fast))
        return 7850.0 * k / (2.625e9 * case.friction) * 1e9
    index = 1e6 * AREA[case] * w
    section = np.where(index < 100.0, 0.25 * index, np.where(index < 200.0, 25.0, 1.19 * index - 154.0))
    return 1e9 * 7850.0 * math.pi * 1e-12 * section / index


def at(case: Case, density: float) -> dict[str, float]:
    """Return the mass per energy [µg/J] by law and set at one Tγ/A [N/mm²]."""
    return {one.label: float(one.rate[0]) for one in curves(case, np.array([density]))}


@pytest.fixture(scope="module")
def drawn() -> dict[Case, dict[str, Curve]]:
    """Return the curves of the picture by their labels."""
    return {case: {one.label: one for one in curves(case)} for case in CASES}


@pytest.mark.parametrize("case", CASES, ids=["discs", "vehicle"])
def test_the_curves_have_the_formulas_of_the_papers(case: Case, drawn: dict[Case, dict[str, Curve]]) -> None:
    labels = {"brr", *(f"kth, {one}" for one in RANGES), *(f"usfd, {one}" for one in SETS)}
    assert labels <= drawn[case].keys()
    for label in labels:
        # The area of the discs is given with eight digits, and BRR turns it into Tγ less an offset below Tγ.
        assert drawn[case][label].rate == pytest.approx(due(case, label, DENSITIES), rel=1e-6)


def test_the_table_is_what_is_computed() -> None:
    committed = laws_compared.TABLE.read_text(encoding="utf-8")
    assert committed == laws_compared.table(), "renew it with: python -m docs.laws_compared"
    rows = list(csv.DictReader(committed.splitlines()))
    assert next(row for row in rows if row["law and set"] == "usfd, global")["wheel on rail, 5 N/mm²"] == "(5.3)"


def test_the_words_have_the_numbers_of_the_curves() -> None:
    mild, severe = at(DISCS, 10.0), at(DISCS, 70.0)
    border, tested = ({case: case.friction * pressure(case) * limit for case in CASES} for limit in (0.2, 0.197))
    size = {case: 1e-6 * 100.0 / AREA[case] for case in CASES}
    said = [
        f"USFD wears {mild['usfd, global']:.3g} µg/J, BRR {mild['brr']:.3g} µg/J, and KTH {mild['kth, mid']:.3g} µg/J",
        f"from {mild['kth, low']:.3g} to {mild['kth, high']:.3g} µg/J",
        f"At 70 N/mm² on discs USFD wears {severe['usfd, global']:.3g} µg/J, KTH {severe['kth, mid']:.3g} µg/J and BRR"
        f" {severe['brr']:.3g} µg/J, {severe['brr'] / severe['usfd, global']:.0f} times as much",
        f"KTH jumps by a factor of {at(DISCS, 109.0)['kth, mid'] / at(DISCS, 108.0)['kth, mid']:.2g} at a slip speed",
        f"That is {border[DISCS]:.3g} N/mm² on discs, but {border[VEHICLE] / 20.0:.3g} N/mm² under the wheel",
        f"at {size[DISCS]:.3g} N/mm² on discs and at {size[VEHICLE]:.3g} N/mm² under the wheel",
        f"a slip of {100.0 * 0.197 / 20.0:.3g} %, and {tested[VEHICLE] / 20.0:.3g} N/mm² under the wheel",
        f"of the {tested[DISCS]:.3g} N/mm² on discs",
        f"mean pressure p | {pressure(DISCS):.0f} MPa, of 1500 MPa at most | {pressure(VEHICLE):.0f} MPa, under 80 kN",
        f"area A | {1e6 * AREA[DISCS]:.3g} mm² | {1e6 * AREA[VEHICLE]:.3g} mm²",
    ]
    for words in said:
        assert words in PAGE, words
    values = [mild["usfd, global"], mild["brr"], mild["kth, mid"]]
    assert max(values) < 2.0 * min(values)
    assert tested[DISCS] / (tested[VEHICLE] / 20.0) == pytest.approx(40.0, abs=2.0)  # "a fortieth"
