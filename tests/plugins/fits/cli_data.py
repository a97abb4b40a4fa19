"""A file of tests, and the commands that fit it and compare laws with it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from click.testing import Result

import wearlaw as wl
from wearlaw import Q

CREEPAGE = [0.2, 0.5, 1.0, 2.0, 5.0, 12.0, 16.0, 18.0, 20.0]
SCATTER = [1.1, 0.9, 1.05, 0.97, 1.02, 0.93, 1.08, 0.99, 0.98]
HEAD = "creepage [%],max_pressure [MPa],friction_coefficient,wear_rate [ug/m/mm^2]"
LAW = "usfd:fitted_for=exact"
FIT = ("fit", "tests.csv", "--contact", "exact", "--law", LAW, "--free", "m_m,q_s", "--bootstrap", "0")
COMPARE = ("compare", "tests.csv", "--contacts", "global,exact", "--laws", "usfd,kth,brr")


def rates() -> Any:
    """Return the measurements of tests without scatter."""
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
    return predict(max_pressure="1500 MPa", creepage=Q(CREEPAGE, "%"), friction_coefficient=0.46).wear_rate.magnitude


def rows(values: Any) -> list[str]:
    return [f"{xi},1500,0.46,{rate!r}" for xi, rate in zip(CREEPAGE, np.asarray(values).tolist(), strict=True)]


def write_tests(lines: list[str], head: str = HEAD) -> None:
    Path("tests.csv").write_text("\n".join([head, *lines, ""]), encoding="utf-8")


def listed(result: Result, folder: str) -> set[str]:
    """Return the files that the output lists."""
    return {line.strip() for line in result.stdout.partition(f"Results in {folder}:\n")[2].splitlines()}
