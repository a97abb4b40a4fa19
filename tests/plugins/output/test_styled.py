"""Tables as HTML with numbers at the right."""

from __future__ import annotations

import html
import re
from typing import Any

import numpy as np
import pandas as pd
import pytest

from tests.plugins.studies.report_data import EVIL
from wearlaw_apps.output.styled import Marked, html_table, plain_number  # private: tables by themselves

TABLE = pd.DataFrame(
    {
        "model <i>": ["a & b_1", EVIL],
        "rate [µg/m/mm²]": pd.Series([Marked(-1.5e-7, "†‡"), Marked(np.nan, "")], dtype=object),
        "tests": [3, 12],
        "fitted": [True, False],
        "why": ["γ ≤ 1 · 10⁻³ and cᵢ", "x" * 60],
    }
)


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (1.5e-7, "1.5 × 10⁻⁷"),
        (-12345.678, "−1.235 × 10⁴"),
        (0.00012345678, "0.0001235"),
        (1e100, "1 × 10¹⁰⁰"),
        (-3, "−3"),
        (123456, "123456"),
        (Marked(1234.5678, "†"), "1235†"),
        (Marked(np.nan, ""), ""),
        (True, "yes"),
        (float("nan"), ""),
        (None, ""),
        (pd.NA, ""),
        ("-1e5", "-1e5"),
    ],
)
def test_a_cell_shows_four_digits_and_a_power_of_ten(value: Any, shown: str) -> None:
    assert plain_number(value) == shown


def test_html_has_row_heads_numbers_at_the_right_and_every_text_literally() -> None:
    shown = html_table(TABLE, "<caption>")
    cells = [html.unescape(text) for text in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", shown)]
    assert cells[5:10] == ["a & b_1", "−1.5 × 10⁻⁷†‡", "3", "yes", "γ ≤ 1 · 10⁻³ and cᵢ"]
    assert cells[10:13] == [EVIL, "", "12"]
    assert shown.count('<th scope="row">') == 2
    assert "<caption>&lt;caption&gt;</caption>" in shown
    assert shown.count('number"') == 2 + 3, "two heads and three numbers"
    assert "<script" not in shown
    assert " id=" not in shown
