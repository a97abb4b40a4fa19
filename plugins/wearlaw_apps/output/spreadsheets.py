"""CSV files that a spreadsheet opens without computing anything."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

_NUMBER = r"[+-]?[\d.,]*(?:[eE][+-]?\d+)?\s*"
_FORMULA = re.compile(rf'((?:^ *|(?<=[,;\t\r\n]))"?)(?=[=+@＝＋－＠-])(?!{_NUMBER}(?:[,;\t\r\n"]|$))')
"""Where a spreadsheet may begin to read a formula, at any of the usual separators; neither at a number nor at "-"."""


def without_formulas(text: str) -> str:
    """Return the text of a cell or of a whole CSV file, with an apostrophe before what would be computed."""
    return _FORMULA.sub(r"\1'", text)


def write_csv(frame: pd.DataFrame, path: Path) -> None:
    """Write a table as CSV in UTF-8, without formulas in texts and heads."""
    plain = frame.rename(columns=without_formulas)
    for place, kind in enumerate(dtype.kind for dtype in frame.dtypes):
        if kind not in "biuf":
            cells = [without_formulas(cell) if isinstance(cell, str) else cell for cell in frame.iloc[:, place]]
            plain.isetitem(place, np.array(cells, dtype=object))
    plain.to_csv(path, index=False, encoding="utf-8", errors="replace")
