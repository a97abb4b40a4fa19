r"""Tables for LaTeX in the style of booktabs, for \input into a paper."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from typing import Any

import pandas as pd

from wearlaw.errors import printable
from wearlaw.report import tables

_GREEK = {
    letter: unicodedata.name(letter).rsplit()[-1].replace("LAMDA", "LAMBDA")
    for letter in "αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΦΨΩ"
}
_MATHS = {
    "−": "-", "·": r"\cdot", "×": r"\times", "±": r"\pm", "≤": r"\le", "≥": r"\ge", "≠": r"\ne", "≈": r"\approx",
    "∞": r"\infty", "√": r"\surd", "∫": r"\int", "∂": r"\partial", "∝": r"\propto", "→": r"\to", "°": r"^{\circ}",
    "ṡ": r"\dot{s}", "<": "<", ">": ">", "|": "|",
}  # fmt: skip
_TEXT = {
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "µ": r"\textmu{}",
    "–": r"\textendash{}", "—": r"\textemdash{}", "…": r"\dots{}",
    "†": r"\textdagger{}", "‡": r"\textdaggerdbl{}",
}  # fmt: skip
_SYMBOLS = str.maketrans(
    {
        **{letter: f"$\\{name.lower() if letter.islower() else name.capitalize()}$" for letter, name in _GREEK.items()},
        **{character: f"${command}$" for character, command in _MATHS.items()},
        **_TEXT,
    }
)
_RAISED = str.maketrans("⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹", "-+0123456789")
_LOWERED = str.maketrans("₀₁₂₃₄₅₆₇₈₉ᵢᵣ", "0123456789ir")
_RAISED_TEXT = re.compile("[⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹]+")
_LOWERED_TEXT = re.compile("[₀₁₂₃₄₅₆₇₈₉ᵢᵣ]+")
LONG = 40
"""Letters beyond which a text column wraps."""


def latex_table(frame: pd.DataFrame, footnotes: Iterable[str] = ()) -> str:
    """Return a table as a tabular, with the units in the heads of its columns, and footnotes below it."""
    rows = [[cell(value) for value in row] for row in frame.itertuples(index=False, name=None)]
    lines = [
        r"% \usepackage{booktabs}",
        rf"\begin{{tabular}}{{{_columns(frame)}}}",
        r"\toprule",
        _row([escaped(str(head)) for head in frame.columns]),
        r"\midrule",
        *(_row(row) for row in rows),
        r"\bottomrule",
        r"\end{tabular}",
        *(rf"\par{{\footnotesize {escaped(note)}}}" for note in footnotes),
    ]
    return "\n".join(lines) + "\n"


def cell(value: Any) -> str:
    """Return a value as LaTeX source."""
    shown = tables.cell(value)
    if not shown.number:
        return escaped(shown.text)
    mantissa = shown.text.replace("inf", r"\infty")
    number = rf"${mantissa} \times 10^{{{shown.power}}}$" if shown.power else f"${mantissa}$"
    return number + escaped(shown.marks)


def escaped(text: str) -> str:
    """Escape a text for LaTeX."""
    plain = printable(" ".join(text.split()))
    text = re.sub("-(?=-)", "-{}", plain.translate(_SYMBOLS))  # two hyphens would become a dash
    text = _RAISED_TEXT.sub(lambda found: rf"\textsuperscript{{{found[0].translate(_RAISED)}}}", text)
    return _LOWERED_TEXT.sub(lambda found: rf"\textsubscript{{{found[0].translate(_LOWERED)}}}", text)


def _row(cells: list[str]) -> str:
    row = " & ".join(cells)
    # After the \\ of the line above, LaTeX would read a bracket or star as an option of it.
    return (r"{}" if row.startswith(("[", "*")) else "") + row + r" \\"


def _columns(frame: pd.DataFrame) -> str:
    """Return the alignment of each column: numbers right, long texts wrapped."""
    kinds = []
    for number, dtype in enumerate(frame.dtypes):
        longest = max((len(str(value)) for value in frame.iloc[:, number]), default=0)
        text = rf"p{{{LONG / 100:g}\linewidth}}" if longest > LONG else "l"
        marked = all(isinstance(value, tables.Marked) for value in frame.iloc[:, number])
        kinds.append("r" if marked or pd.api.types.is_numeric_dtype(dtype) else text)
    return "".join(kinds)
