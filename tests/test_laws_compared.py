"""The laws side by side: curves against the formulas of the papers, and the table of them."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest

from docs import laws_compared
from docs.laws_compared import CASES, DENSITIES, DISCS, VEHICLE, Case, Curve, curves, solved
from wearlaw import Array

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
