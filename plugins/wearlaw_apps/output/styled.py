"""Tables as HTML for the page."""

from __future__ import annotations

import html
import numbers
import re
from typing import Any

import numpy as np
import pandas as pd

from wearlaw_apps.output.labels import raised, readable

LONG = 20
"""Letters beyond which a text wraps."""


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


def plain_number(value: Any) -> str:
    """Return the text of a cell, "" if the value is missing; a number has four digits and its marks: "4.66 × 10⁻⁵†"."""
    if value is None or value is pd.NA or value != value:
        return ""
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if not is_number(value):
        return str(value)
    text = str(value) if isinstance(value, numbers.Integral) else f"{value:.4g}"
    mantissa, _, power = text.partition("e")
    times = f" × 10{raised(int(power))}" if power else ""
    return f"{mantissa.replace('-', '−')}{times}{getattr(value, 'marks', '')}"


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
        cells = (f"<td{_class(value)}>{html.escape(plain_number(value))}</td>" for value in others)
        lines += ["<tr>", f'<th scope="row">{html.escape(plain_number(first))}</th>', *cells, "</tr>"]
    return "\n".join([*lines, "</tbody>", "</table>"])


def _head(head: str) -> str:
    """Return the head of a column for readers: words without underscores, a minus, its unit in the usual spelling."""
    head = re.sub(r"^-(?=\d)", "−", head)
    words = re.sub("(?<=[a-z]{3})_(?=[a-z]{3})", " ", head)  # symbols such as tr_sc keep theirs
    return re.sub(r"\[[^\]]*\]$", lambda unit: readable(unit[0]), words)


def _class(value: Any) -> str:
    """Return the class of a cell: a number, or a text that wraps."""
    name = "number" if is_number(value) else "long" if len(str(value)) > LONG else ""
    return f' class="{name}"' if name else ""
