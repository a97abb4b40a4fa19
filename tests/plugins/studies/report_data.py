"""A small study with figures and a section made by hand, for the tests of reports and tables."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

import wearlaw as wl
from tests.cases import case
from wearlaw import CheckedClaim, Curve, FigureData, Panel, PlotAxis, Section, Study
from wearlaw_apps.studies.report.page import report  # private: the page of a study with figures made by hand

EVIL = "<script>alert(1)</script> <b>bold</b> $x_1$ %{y} & &amp; </script> {{ 7 * 7 }} \"'"
"""A text that HTML, plotly.js, MathJax or jinja would each make something else of."""

X = np.array([0.01, 0.1, 1.0, 10.0])
RISING = Curve("rising", X, 3.0 * X, colour=0, dash=1, low=2.0 * X, high=4.0 * X)
FALLING = Curve("falling", X, 1.0 / X, colour=1, dash=2)
LONE = Curve("lone", X[:1], X[:1], colour=2)
POINTS = Curve("tests", X, X, colour=6, points=True)
WITH_ERRORS = Curve("uncertain tests", X, X, colour=5, low=0.5 * X, high=1.25 * X, points=True)
GAPS = Curve("gaps", X, np.array([np.nan, 1.0, np.inf, 2.0]), colour=8, dash=5)
WITHOUT_WEAR = Curve("from nothing", X, X - 0.1, colour=3, dash=3, low=X - 0.1, high=X + 0.1)

LOG_LOG = Panel(
    PlotAxis("creepage [%]", "log"),
    PlotAxis("wear rate [µg/m/mm²]", "log"),
    (RISING, FALLING, LONE, POINTS, WITH_ERRORS, GAPS, WITHOUT_WEAR),
)
ENLARGED = Panel(
    PlotAxis("creepage [%]", ends=(0.0, 1.0)), PlotAxis("stress [MPa]", "log", (0.1, 10.0)), (RISING,), "part"
)
ODDLY_NAMED = Panel(
    PlotAxis(f"x {EVIL}"), PlotAxis(f"y {EVIL}"), (replace(POINTS, label=EVIL), replace(FALLING, label="_")), EVIL
)
ONE = FigureData("one", "A figure", (LOG_LOG,), "What it shows.")
THREE = FigureData("three", "Three panels", (LOG_LOG, ENLARGED, ENLARGED))
ODD = FigureData("odd", EVIL, (ODDLY_NAMED,), EVIL)

TABLE = pd.DataFrame(
    {"model <i>": ["a & b", EVIL], "m_c [µg/m/N]": [-1.5e-7, np.nan], "tests": [3, 12], "fitted": [True, False]}
)
CLAIMS = (
    CheckedClaim(
        "USFD and BRR agree in mild wear.", "section 5.2", "within 16 % up to 3 N/mm²", "holds", "Within 20 %."
    ),
    CheckedClaim(EVIL, "section 5.3", "5.2 µg/m/mm² against 6.1 µg/m/mm²", "does not hold", EVIL),
)
SECTION = Section(
    f"Claims {EVIL}", "First part.\n\nSecond <i>part</i>,\nwith two lines.", CLAIMS, {"table_4": TABLE}, (ODD,)
)


def small_study(title: str = "A small study") -> Study:
    """Return a study with one section, and with figures made by hand in the place of its own."""
    study = replace(wl.run(case(title=title)), sections=(SECTION,))
    study.__dict__["figures"] = (ONE, THREE)
    return study


def page_of(study: Study, case_text: str = "") -> str:
    """Return the report of a study."""
    return report(study, case_text)
