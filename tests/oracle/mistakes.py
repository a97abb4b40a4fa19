"""Likely mistakes that no other test makes, for the oracle: the type of the error, and the field that it names."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd

import wearlaw as wl
from tests.oracle.applications import TESTS, USFD
from tests.oracle.cases import CONTACTS, POINT, RIGS, WHEELSET

WHEELS = RIGS["wheelset"] | CONTACTS["fastsim"]

CONDITIONS: list[tuple[str, dict[str, Any], str]] = [
    ("yaw in degrees", {"yaw": "20 deg"}, "yaw"),
    ("torque and speed", {"axle_torque": "1 kN*m", "angular_speed": "43 rad/s"}, "axle_torque"),
]
"""A name, changes to the usual point of a wheelset, and the field."""

OTHERS: list[tuple[str, Callable[[], Any], str]] = [
    ("a law without its coefficient", lambda: wl.wear_law("archard"), "coefficient"),
    ("a misspelt option", lambda: wl.contact_model("fastsim", bound="parabola"), "bound"),
    ("a cant without its unit", lambda: wl.rig("wheelset", **WHEELSET | {"rail_cant": 40}), "rail_cant"),
    ("a table without a unit", lambda: wl.sweep(USFD, pd.DataFrame({"creepage": [1.0], "normal_force [kN]": [7.0]}),
        friction_coefficient=0.4), "creepage"),
    ("a table that is not there", lambda: wl.sweep(USFD, "no-such.csv"), "such"),
    ("a free parameter that is not there", lambda: wl.fit(USFD, TESTS, ["q_m"], friction_coefficient=0.4), "q_m"),
    ("a fit of too few tests", lambda: wl.fit(USFD, TESTS[:2], ["m_m", "q_s"], friction_coefficient=0.4), "m_m"),
    ("a distribution without its unit", lambda: wl.uncertainty(USFD, **POINT["twin_disc"] | {
        "creepage": wl.uniform(0.5, 1.5)}), "creepage"),
    ("tests that are not there", lambda: wl.read_tests("no-such.csv"), "such"),
]  # fmt: skip
"""A name, a call, and the field or name that the message should hold."""

FILES: list[tuple[str, str, Callable[[Any], Any], str, str]] = [
    ("tests without a unit", "tests.csv", wl.read_tests, "creepage,normal_force [kN],wear_rate [ug/m/mm^2]\n1,7,2\n",
        "creepage"),
    ("tests with a word", "tests.csv", wl.read_tests, "creepage [%],normal_force [kN],wear_rate [ug/m/mm^2]\n1,7,two\n",
        "wear_rate"),
    ("a profile in metres", "wheel.csv", partial(wl.read_profile, kind="wheel"),
        "".join(f"{0.001 * y},{1e-6 * y * y}\n" for y in range(-60, 61)), "wheel"),
]  # fmt: skip


def mistakes() -> Iterator[tuple[str, Callable[[], Any], str]]:
    """Yield the mistakes by name, each with the field that it is about."""
    for name, changes, field in CONDITIONS:
        yield f"mistake: {name}, wheelset", partial(WHEELS, **POINT["wheelset"] | changes), field
    for name, call, field in OTHERS:
        yield f"mistake: {name}", call, field
    for name, file, read, text, field in FILES:
        yield f"mistake: {name}", partial(_read, file, read, text), field


def _read(file: str, read: Callable[[Any], Any], text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, file)
        path.write_text(text, encoding="utf-8")
        read(path)
