"""The normal problem at more positions of wheels on rails: CONTACT's full theory, and the table of the theory page."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import pytest

from tests import normal_patches
from tests.plugins.wheelset.test_normal import assert_near_full_theory

DOCS = Path(__file__).parents[3] / "docs"
ROWS = {(row[0], row[1]): row for row in csv.reader(normal_patches.FILE.read_text(encoding="utf-8").splitlines()[1:])}
FULL = {
    "S1002 on 60E1, 0.5 mm": (9870.0, 632.5, 0.02, 0.12),
    "S1002 on 60E1, 1 mm": (9827.0, 741.3, 0.01, 0.05),
    "S1002 on 60E1, 2 mm": (9799.0, 744.8, 0.01, 0.01),
    "S1002 on 60E1, 5 mm": (9619.0, 1556.0, 0.02, 0.05),
    "S1002 on 60E1, 6 mm": (9709.0, 1149.0, 0.01, 0.02),
}
"""As in `test_wheelset_normal.py`."""


@pytest.mark.parametrize("name", FULL)
def test_pressures_are_near_those_of_contacts_full_theory(name: str) -> None:
    assert_near_full_theory(name, *FULL[name])


SLOW = {f"S1002 on 60E1, {where}" for where in ("tread, 3 mm", "0.5 mm", "1 mm")}


@pytest.mark.parametrize(
    ("name", "force", "solve"),
    [
        pytest.param(*case, id=f"{case[0]} {case[1]:g}")
        for case in normal_patches.cases()
        if case[1] > 1e4 and case[0] not in SLOW
    ],
)
def test_the_table_of_the_page_is_what_is_found(name: str, force: float, solve: Any) -> None:
    row = normal_patches.row(name, force, solve())
    for found, written in zip(row[2:], ROWS[name, row[1]][2:], strict=True):
        # Rounded values may differ by one digit on other machines.
        assert float(found.rstrip(" %")) == pytest.approx(float(written.rstrip(" %")), rel=2e-3, abs=1.0)
