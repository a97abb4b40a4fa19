"""Tables for LaTeX, read back by a small reader that knows TeX's special characters and nothing of the writer's."""

from __future__ import annotations

import re
import string
import unicodedata
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wearlaw.report.latex import cell, escaped, latex_table

SPECIAL = set("&%$#_{}~^\\-")
"""Characters that TeX does not print, and the hyphen, two of which it joins to a dash."""

COMMANDS = {
    "textbackslash": "\\", "textasciitilde": "~", "textasciicircum": "^", "textmu": "µ", "textendash": "–",
    "textemdash": "—", "dots": "…", "cdot": "·", "times": "×", "pm": "±", "le": "≤", "ge": "≥", "ne": "≠",
    "approx": "≈", "infty": "∞", "surd": "√", "int": "∫", "partial": "∂", "propto": "∝", "to": "→", "circ": "°",
    "dot": "ṡ",
}  # fmt: skip
"""What LaTeX prints for a command (L. Lamport, LaTeX: A Document Preparation System, 2nd ed., 1994; the symbols of
mathematics after the tables of the LaTeX2e-Kurzbeschreibung)."""

RAISED = "⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹"
LOWERED = "₀₁₂₃₄₅₆₇₈₉ᵢᵣ"
TOKEN = re.compile(
    r"\\(?P<symbol>[&%$#_{}])"
    r"|\\(?P<shift>textsuperscript|textsubscript)\{(?P<shifted>[-+0-9ir]+)\}"
    r"|\\(?P<text>[a-z]+)\{\}"
    r"|\$(?:\^\{)?\\(?P<maths>[A-Za-z]+)(?:\{s\}|\})?\$"
    r"|\$(?P<sign>[-<>|])\$"
    r"|(?P<hyphen>-)(?:\{\}(?=-)|(?!-))"
    r"|(?P<plain>.)",
    re.DOTALL,
)


def read(latex: str) -> str:
    """Return what TeX prints, or fail where it would take a character for something else."""
    shown = ""
    for found in TOKEN.finditer(latex):
        kind, text = str(found.lastgroup), str(found[found.lastgroup or 0])
        if kind == "shifted":
            digits = RAISED if found["shift"] == "textsuperscript" else LOWERED
            shown += "".join(
                next(d for d in digits if unicodedata.normalize("NFKC", d).replace("−", "-") == c) for c in text
            )
        elif kind in ("text", "maths"):
            shown += COMMANDS[text] if text in COMMANDS else greek(text)
        else:
            assert kind != "plain" or text not in SPECIAL, f"TeX does not print {text!r} in {latex!r}"
            shown += "−" if kind == "sign" and text == "-" else text
    return shown


def greek(name: str) -> str:
    size = "SMALL" if name.islower() else "CAPITAL"
    return unicodedata.lookup(f"GREEK {size} LETTER {name.upper().replace('LAMBDA', 'LAMDA')}")


KNOWN = sorted({*string.printable, *COMMANDS.values(), *RAISED, *LOWERED, *"αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΦΨΩ−éß"})


@given(st.lists(st.sampled_from([*KNOWN, "--", "---"])).map("".join))
def test_a_text_is_printed_as_it_is(text: str) -> None:
    assert read(escaped(text)) == " ".join(text.split())


@pytest.mark.parametrize("text", ["".join(KNOWN), "--figure-format", "a---b"])
def test_every_character_is_printed_as_it_is(text: str) -> None:
    assert read(escaped(text)) == " ".join(text.split())


@pytest.mark.parametrize(
    "text", ["µg/m/mm²", "Tγ/A [N/mm²]", "5 % of q_s", "10⁻³ m", "ṡ ≥ 0.2", "μ·p", "ᵢ", "2.1 × 10⁻⁴"]
)
def test_what_the_tables_of_wearlaw_hold_is_ascii(text: str) -> None:
    """Which any LaTeX can read, whatever its input encoding."""
    assert escaped(text).isascii()
    assert read(escaped(text)) == text


def test_signs_that_text_fonts_do_not_have_are_set_as_maths() -> None:
    assert escaped("p < 3 | > 2") == "p $<$ 3 $|$ $>$ 2"


@pytest.mark.parametrize(
    ("value", "latex"),
    [
        (3658.891, "$3659$"),
        (-0.5, "$-0.5$"),
        (4.6611e-05, r"$4.661 \times 10^{-5}$"),
        (-1.5e7, r"$-1.5 \times 10^{7}$"),
        (np.float64(1e100), r"$1 \times 10^{100}$"),
        (float("inf"), r"$\infty$"),
        (12345678, "$12345678$"),
        (float("nan"), ""),
        (None, ""),
        (True, "yes"),
        (np.False_, "no"),
        ("1e5 %", r"1e5 \%"),
    ],
)
def test_a_cell_has_four_digits_and_a_power_of_ten(value: Any, latex: str) -> None:
    assert cell(value) == latex


FRAME = pd.DataFrame(
    {
        "[a] model": ["[usfd & co]", "*kth*", "plain"],
        "TrSC [N/mm²]": [77.26, np.nan, 1.2e-5],
        "remark": ["x" * 41, "5 %", "two\nlines"],
    }
)


def test_a_table_is_a_tabular_with_the_rules_of_booktabs() -> None:
    assert latex_table(FRAME).split("\n") == [
        r"% \usepackage{booktabs}",
        r"\begin{tabular}{lrp{0.4\linewidth}}",
        r"\toprule",
        r"{}[a] model & TrSC [N/mm\textsuperscript{2}] & remark \\",
        r"\midrule",
        r"{}[usfd \& co] & $77.26$ & " + "x" * 41 + r" \\",
        r"{}*kth* &  & 5 \% \\",
        r"plain & $1.2 \times 10^{-5}$ & two lines \\",
        r"\bottomrule",
        r"\end{tabular}",
        "",
    ]


def test_heads_may_repeat_and_a_table_may_be_empty() -> None:
    twice = latex_table(pd.DataFrame([["a", 1.0, 2.0]], columns=["", "1", "1"]))
    assert " & 1 & 1 " in twice
    assert "a & $1$ & $2$ " in twice
    assert latex_table(pd.DataFrame({"a": []})).count("\\\\") == 1
