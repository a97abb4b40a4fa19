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


def test_the_page_says_what_the_table_shows() -> None:
    text = " ".join((DOCS / "theory-wheelset.md").read_text(encoding="utf-8").split())

    def worst(column: int, chosen: set[str]) -> int:
        return max(abs(int(row[column].rstrip(" %"))) for (name, _), row in ROWS.items() if name in chosen)

    names = {name for name, _ in ROWS}
    humps = {f"S1002 on 60E1, {where}" for where in ("centred", "0.5 mm", "1 mm", "2 mm", "5 mm")}
    sharp, steady = {"cone on R 80, at R 13"}, names - humps - {"cone on R 80, at R 13"}
    assert len(ROWS) == len(list(normal_patches.cases())) == 24
    assert (worst(3, steady), worst(9, steady), worst(4, steady)) == (11, 1, 20)
    assert "within 11 % of the maximum pressure" in text
    assert "its penetration is within 1 %" in text
    assert "Hertz is off by up to 20 % there" in text
    assert (worst(3, sharp), worst(4, sharp)) == (19, 41)
    assert (worst(3, humps), worst(6, humps), worst(4, humps), worst(7, humps)) == (27, 42, 45, 59)
    assert "its maximum pressure is off by up to 27 % and its area by up to 42 %" in text
    assert "is off by up to 45 % and 59 %" in text
