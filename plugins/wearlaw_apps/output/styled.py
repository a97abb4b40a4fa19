r"""Tables as HTML for the page, and for LaTeX, to \input into a paper."""

from __future__ import annotations

import html
import numbers
import re
import unicodedata
from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd

from wearlaw_apps.output.labels import raised, readable

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


class Marked(float):
    """A number with marks such as "†" behind it, which footnotes explain; files of numbers leave them out."""

    marks: str

    def __new__(cls, value: float, marks: str) -> Marked:
        """Return the number with its marks."""
        number = super().__new__(cls, value)
        number.marks = marks
        return number


def is_number(value: Any) -> bool:
    """Return whether a cell holds a number, which stands at the right."""
    return not isinstance(value, (bool, np.bool_)) and isinstance(value, numbers.Real) and bool(value == value)


def cell(value: Any) -> tuple[str, str, str]:
    """Return the text of a cell, and for numbers its power of ten and its marks: four significant digits.

    The text is empty if the value is missing.
    """
    if value is None or value is pd.NA or value != value:
        return "", "", ""
    if isinstance(value, (bool, np.bool_)):
        return ("yes" if value else "no"), "", ""
    if isinstance(value, numbers.Integral) or not is_number(value):
        return str(value), "", ""
    mantissa, _, power = f"{value:.4g}".partition("e")
    return mantissa, str(int(power)) if power else "", getattr(value, "marks", "")


def html_table(frame: pd.DataFrame, caption: str) -> str:
    """Return a table for the page, with the first column as the heads of its rows, and numbers at the right."""
    rows = list(frame.itertuples(index=False, name=None))
    heads = [html.escape(_head(str(head))) for head in frame.columns]
    for number, head in enumerate(heads):
        if any(is_number(row[number]) for row in rows):
            heads[number] = f'<span class="number">{head}</span>'
    lines = ["<table>", f"<caption>{html.escape(caption)}</caption>", "<thead>", "<tr>"]
    lines += [*(f'<th scope="col">{head}</th>' for head in heads), "</tr>", "</thead>", "<tbody>"]
    for first, *others in rows:
        cells = (f"<td{_class(value)}>{_html(value)}</td>" for value in others)
        lines += ["<tr>", f'<th scope="row">{_html(first)}</th>', *cells, "</tr>"]
    return "\n".join([*lines, "</tbody>", "</table>"])


def _head(head: str) -> str:
    """Return the head of a column for readers: words without underscores, a minus, its unit in the usual spelling."""
    head = re.sub(r"^-(?=\d)", "−", head)
    words = re.sub("(?<=[a-z]{3})_(?=[a-z]{3})", " ", head)  # symbols such as tr_sc keep theirs
    return re.sub(r"\[[^\]]*\]$", lambda unit: readable(unit[0]), words)


def latex_table(frame: pd.DataFrame, footnotes: Iterable[str] = ()) -> str:
    """Return a table as a tabular, with the units in the heads of its columns, and footnotes below it."""
    heads = [_guarded(escaped(str(head))) for head in frame.columns]
    rows = [[_latex(value) for value in row] for row in frame.itertuples(index=False, name=None)]
    head, *body = (" & ".join(cells) + r" \\" for cells in (heads, *rows))
    begin = [r"% \usepackage{booktabs}", rf"\begin{{tabular}}{{{_columns(frame)}}}", r"\toprule", head, r"\midrule"]
    below = (rf"\par{{\footnotesize {escaped(note)}}}" for note in footnotes)
    return "\n".join([*begin, *body, r"\bottomrule", r"\end{tabular}", *below]) + "\n"


def _class(value: Any) -> str:
    """Return the class of a cell: a number, or a text that wraps."""
    name = "number" if is_number(value) else "long" if len(str(value)) > LONG // 2 else ""
    return f' class="{name}"' if name else ""


def plain_number(value: Any) -> str:
    """Return the text of a cell with its power of ten and its marks, as in "4.66 × 10⁻⁵†"."""
    text, power, marks = cell(value)
    if is_number(value):
        text = text.replace("-", "−")
    return f"{text}{f' × 10{raised(int(power))}' if power else ''}{marks}"


def _html(value: Any) -> str:
    return html.escape(plain_number(value))


def _latex(value: Any) -> str:
    text, power, marks = cell(value)
    if not is_number(value):
        return _guarded(escaped(text))
    mantissa = text.replace("inf", r"\infty")
    return (rf"${mantissa} \times 10^{{{power}}}$" if power else f"${mantissa}$") + escaped(marks)


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
        marked = all(isinstance(value, Marked) for value in frame.iloc[:, number])
        kinds.append("r" if marked or pd.api.types.is_numeric_dtype(dtype) else text)
    return "".join(kinds)
