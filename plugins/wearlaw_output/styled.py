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
        found = super().__new__(cls, value)
        found.marks = marks
        return found


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
    heads = [
        _element("th", html.escape(str(head)), "number" if _holds_numbers(frame, number) else "")
        for number, head in enumerate(frame.columns)
    ]
    rows = [
        [_element("td" if number else "th", _html(value), _class(value)) for number, value in enumerate(row)]
        for row in frame.itertuples(index=False, name=None)
    ]
    body = "\n".join(f"<tr>{''.join(row)}</tr>" for row in rows)
    head = f"<caption>{html.escape(caption)}</caption>\n<thead><tr>{''.join(heads)}</tr></thead>"
    return f"<table>\n{head}\n<tbody>\n{body}\n</tbody>\n</table>"


def latex_table(frame: pd.DataFrame, footnotes: Iterable[str] = ()) -> str:
    """Return a table as a tabular, with the units in the heads of its columns, and footnotes below it."""
    rows = [[_latex(str(head)) for head in frame.columns]]
    rows += [[_latex(value) for value in row] for row in frame.itertuples(index=False, name=None)]
    head, *body = (" & ".join(row) + r" \\" for row in rows)
    columns = "".join(_column(frame, number) for number in range(frame.shape[1]))
    lines = [r"% \usepackage{booktabs}", rf"\begin{{tabular}}{{{columns}}}", r"\toprule", head, r"\midrule", *body,
             r"\bottomrule", r"\end{tabular}"]  # fmt: skip
    lines += [rf"\par{{\footnotesize {escaped(note)}}}" for note in footnotes]
    return "\n".join(lines) + "\n"


def _holds_numbers(frame: pd.DataFrame, column: int) -> bool:
    return any(map(is_number, frame.iloc[:, column]))


def _element(tag: str, text: str, kind: str) -> str:
    return f'<{tag} class="{kind}">{text}</{tag}>' if kind else f"<{tag}>{text}</{tag}>"


def _class(value: Any) -> str:
    """Return the class of a cell: a number, or a text that wraps."""
    return "number" if is_number(value) else "long" if len(str(value)) > LONG // 2 else ""


def _html(value: Any) -> str:
    text, power, marks = (html.escape(part) for part in cell(value))
    if is_number(value):
        text, power = text.replace("-", "−"), power.replace("-", "−")
    return f"{text}{f' × 10<sup>{power}</sup>' if power else ''}{f'<sup>{marks}</sup>' if marks else ''}"


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


def _column(frame: pd.DataFrame, number: int) -> str:
    """Return the alignment of a column: numbers right, long texts wrapped."""
    if _holds_numbers(frame, number):
        return "r"
    longest = max((len(str(value)) for value in frame.iloc[:, number]), default=0)
    return rf"p{{{LONG / 100:g}\linewidth}}" if longest > LONG else "l"
