r"""Tables for LaTeX in the style of booktabs, for \input into a paper."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from typing import Any

import pandas as pd

from wearlaw.report import tables

_MATHS = {
    "−": "-", "·": r"\cdot", "×": r"\times", "±": r"\pm", "≤": r"\le", "≥": r"\ge", "≠": r"\ne", "≈": r"\approx",
    "∞": r"\infty", "√": r"\surd", "∫": r"\int", "∂": r"\partial", "∝": r"\propto", "→": r"\to", "°": r"^{\circ}",
    "ṡ": r"\dot{s}", "<": "<", ">": ">", "|": "|",
    **{letter: f"\\{unicodedata.name(letter).rsplit()[-1].lower().replace('lamda', 'lambda')}"
       for letter in "αβγδεζηθικλμνξπρστυφχψω"},
    **{letter: f"\\{unicodedata.name(letter).rsplit()[-1].capitalize().replace('Lamda', 'Lambda')}"
       for letter in "ΓΔΘΛΞΠΣΦΨΩ"},
}  # fmt: skip
_TEXT = {
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "µ": r"\textmu{}",
    "–": r"\textendash{}", "—": r"\textemdash{}", "…": r"\dots{}",
    "†": r"\textdagger{}", "‡": r"\textdaggerdbl{}",
}  # fmt: skip
_SYMBOLS = str.maketrans({**{character: f"${command}$" for character, command in _MATHS.items()}, **_TEXT})
_SHIFTED = {"superscript": "⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹", "subscript": "₀₁₂₃₄₅₆₇₈₉ᵢᵣ"}
LONG = 40
"""Letters beyond which a text column wraps."""


def latex_table(frame: pd.DataFrame, footnotes: Iterable[str] = ()) -> str:
    """Return a table as a tabular, with the units in the heads of its columns, and footnotes below it."""
    shown = pd.DataFrame([[cell(value) for value in row] for row in frame.itertuples(index=False, name=None)])
    shown = shown.reindex(columns=range(frame.shape[1]))
    heads = [_guarded(escaped(str(head))) for head in frame.columns]
    style = shown.style.hide(axis="index").format_index(lambda number: heads[int(str(number))], axis="columns")
    tabular = style.to_latex(column_format=_columns(frame), hrules=True)
    below = (rf"\par{{\footnotesize {escaped(note)}}}" for note in footnotes)
    return "\n".join([r"% \usepackage{booktabs}", tabular.rstrip("\n"), *below]) + "\n"


def cell(value: Any) -> str:
    """Return a value as LaTeX source."""
    shown = tables.cell(value)
    if not shown.number:
        return _guarded(escaped(shown.text))
    mantissa = shown.text.replace("inf", r"\infty")
    number = rf"${mantissa} \times 10^{{{shown.power}}}$" if shown.power else f"${mantissa}$"
    return number + escaped(shown.marks)


def escaped(text: str) -> str:
    """Escape a text for LaTeX."""
    # Two hyphens would become a dash.
    source = re.sub("-(?=-)", "-{}", " ".join(text.split()).translate(_SYMBOLS))
    for kind, digits in _SHIFTED.items():
        plain = str.maketrans({digit: unicodedata.normalize("NFKC", digit).replace("−", "-") for digit in digits})
        source = re.sub(f"[{digits}]+", lambda run: rf"\text{kind}{{{run[0].translate(plain)}}}", source)  # noqa: B023
    return source


def _guarded(source: str) -> str:
    r"""Keep LaTeX from reading a bracket or star as an option of the \\ of the line above."""
    return "{}" + source if source.startswith(("[", "*")) else source


def _columns(frame: pd.DataFrame) -> str:
    """Return the alignment of each column: numbers right, long texts wrapped."""
    kinds = []
    for number, dtype in enumerate(frame.dtypes):
        longest = max((len(str(value)) for value in frame.iloc[:, number]), default=0)
        text = rf"p{{{LONG / 100:g}\linewidth}}" if longest > LONG else "l"
        marked = all(isinstance(value, tables.Marked) for value in frame.iloc[:, number])
        kinds.append("r" if marked or pd.api.types.is_numeric_dtype(dtype) else text)
    return "".join(kinds)
