"""Likely mistakes, for the oracle: the type of the error of each, and the field that it names."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd

import wearlaw as wl
from tests.oracle.applications import TESTS, USFD
from tests.oracle.cases import CONTACTS, LAWS, POINT, RIGS, WHEEL_RAIL, WHEELSET
from wearlaw import Q

PREDICT = {
    "twin_disc": USFD,
    "wheel_rail": RIGS["wheel_rail"] | CONTACTS["fastsim"],
    "wheelset": RIGS["wheelset"] | CONTACTS["fastsim"],
}

CONDITIONS: list[tuple[str, str, dict[str, Any], str]] = [
    ("a bare number", "twin_disc", {"creepage": 1}, "creepage"),
    ("a unit of another kind", "twin_disc", {"normal_force": "7 MPa"}, "normal_force"),
    ("a unit that does not exist", "twin_disc", {"normal_force": "7 kNewt"}, "normal_force"),
    ("a negative load", "twin_disc", {"normal_force": "-7 kN"}, "normal_force"),
    ("two loads", "twin_disc", {"max_pressure": "1 GPa"}, "max_pressure"),
    ("no load", "twin_disc", {"normal_force": None}, "normal_force"),
    ("no friction", "twin_disc", {"friction_coefficient": None}, "friction_coefficient"),
    ("negative friction", "twin_disc", {"friction_coefficient": -0.3}, "friction_coefficient"),
    ("creepage above one", "twin_disc", {"creepage": "150 %"}, "creepage"),
    ("a misspelt condition", "twin_disc", {"crepage": "1 %"}, "crepage"),
    ("a condition of another rig", "twin_disc", {"spin": "0.2 1/m"}, "spin"),
    (
        "shapes that differ",
        "twin_disc",
        {"creepage": Q([1, 2], "%"), "friction_coefficient": [0.1, 0.2, 0.3]},
        "creepage",
    ),
    ("a measured traction not used", "twin_disc", {"traction_coefficient": 0.3}, "traction_coefficient"),
    ("spin without a unit", "wheel_rail", {"spin": 0.2}, "spin"),
    ("creepage of discs", "wheel_rail", {"creepage": "1 %"}, "creepage"),
    ("yaw in degrees", "wheelset", {"yaw": "20 deg"}, "yaw"),
    ("a wheel off its rail", "wheelset", {"lateral_displacement": "80 mm"}, "lateral_displacement"),
    ("torque and speed", "wheelset", {"axle_torque": "1 kN*m", "angular_speed": "43 rad/s"}, "axle_torque"),
    ("a curve without a radius", "wheelset", {"curve_radius": "0 m"}, "curve_radius"),
]
"""A name, a rig, changes to its usual point, where None leaves a condition out, and the field."""

OTHERS: list[tuple[str, Callable[[], Any], str]] = [
    ("a misspelt law", lambda: wl.wear_law("usdf"), "usdf"),
    ("a misspelt contact model", lambda: wl.contact_model("fastsm"), "fastsm"),
    ("a misspelt parameter", lambda: wl.wear_law("usfd", q_c="55 ug/m/mm^2"), "q_c"),
    ("a parameter without its unit", lambda: wl.wear_law("usfd", q_s=55), "q_s"),
    ("a law without its coefficient", lambda: wl.wear_law("archard"), "coefficient"),
    ("a misspelt parameter set", lambda: wl.wear_law("usfd", fitted_for="exakt"), "fitted_for"),
    ("a misspelt option", lambda: wl.contact_model("fastsim", bound="parabola"), "bound"),
    ("Poisson's ratio in percent", lambda: wl.steel(poisson_ratio=28), "poisson_ratio"),
    ("a disc without its unit", lambda: wl.TwinDisc.suros(diameter=47), "diameter"),  # type: ignore[arg-type]
    ("a hollow too narrow", lambda: wl.rig("wheel_rail", **WHEEL_RAIL, wheel_profile_radius="-200 mm"),
        "wheel_profile_radius"),
    ("a gauge of another track", lambda: wl.rig("wheelset", **WHEELSET | {"gauge": "1600 mm"}), "gauge"),
    ("a cant without its unit", lambda: wl.rig("wheelset", **WHEELSET | {"rail_cant": 40}), "rail_cant"),
    ("a law before its contact", lambda: RIGS["twin_disc"] | LAWS["kth"][0], "contact"),  # type: ignore[operator]
    ("a stage after its law", lambda: USFD | wl.patch_mean(), "stage"),
    ("a line model on an ellipse", lambda: RIGS["wheel_rail"] | CONTACTS["exact"], "exact"),
    ("a law of means on cells", lambda: PREDICT["wheel_rail"] | LAWS["brr"][0], "brr"),
    ("two laws of wear", lambda: USFD | LAWS["kth"][0], "wear_rate"),
    ("wear of a body that is not there", lambda: USFD(**POINT["twin_disc"]).mass_lost("1 km", "disc_3"), "disc_3"),
    ("wear without a law", lambda: PREDICT["wheel_rail"](**POINT["wheel_rail"]).wear_rate, "law"),
    ("a side that is not there", lambda: PREDICT["wheelset"](**POINT["wheelset"]).sel(side="rigth"), "side"),
    ("an output that is not there", lambda: wl.sweep(USFD, **POINT["twin_disc"] | {"creepage": Q([1, 2], "%")},
        outputs=["wear"]), "wear"),
    ("a table without a unit", lambda: wl.sweep(USFD, pd.DataFrame({"creepage": [1.0], "normal_force [kN]": [7.0]}),
        friction_coefficient=0.4), "creepage"),
    ("a table without a column", lambda: wl.sweep(USFD, pd.DataFrame({"creepage [%]": [1.0]}),
        friction_coefficient=0.4), "normal_force"),
    ("a table that is not there", lambda: wl.sweep(USFD, "no-such.csv"), "such"),
    ("a free parameter that is not there", lambda: wl.fit(USFD, TESTS, ["q_m"], friction_coefficient=0.4), "q_m"),
    ("a fit without friction", lambda: wl.fit(USFD, TESTS, ["q_s"]), "friction_coefficient"),
    ("a fit of too few tests", lambda: wl.fit(USFD, TESTS[:2], ["m_m", "q_s"], friction_coefficient=0.4), "m_m"),
    ("a distribution without its unit", lambda: wl.uncertainty(USFD, **POINT["twin_disc"] | {
        "creepage": wl.uniform(0.5, 1.5)}), "creepage"),
    ("tests that are not there", lambda: wl.read_tests("no-such.csv"), "such"),
    ("a case that is not there", lambda: wl.load_case("tassini2011"), "tassini2011"),
    ("a contact file that is not there", lambda: wl.read_contact("no-such.mat"), "such"),
]  # fmt: skip
"""A name, a call, and the field or name that the message should hold."""

FILES: list[tuple[str, str, Callable[[Any], Any], str, str]] = [
    ("tests without a unit", "tests.csv", wl.read_tests, "creepage,normal_force [kN],wear_rate [ug/m/mm^2]\n1,7,2\n",
        "creepage"),
    ("tests with a word", "tests.csv", wl.read_tests, "creepage [%],normal_force [kN],wear_rate [ug/m/mm^2]\n1,7,two\n",
        "wear_rate"),
    ("a case with a misspelt field", "case.toml", wl.load_case, 'title = "x"\ncontact_modls = ["exact"]\n',
        "contact_modls"),
    ("a case that is no TOML", "case.toml", wl.load_case, "title = x\n", "case"),
    ("a profile in metres", "wheel.csv", partial(wl.read_profile, kind="wheel"),
        "".join(f"{0.001 * y},{1e-6 * y * y}\n" for y in range(-60, 61)), "wheel"),
]  # fmt: skip


def mistakes() -> Iterator[tuple[str, Callable[[], Any], str]]:
    """Yield the mistakes by name, each with the field that it is about."""
    for name, rig, changes, field in CONDITIONS:
        given = {key: value for key, value in (POINT[rig] | changes).items() if value is not None}
        yield f"mistake: {name}, {rig}", partial(PREDICT[rig], **given), field
    for name, call, field in OTHERS:
        yield f"mistake: {name}", call, field
    for name, file, read, text, field in FILES:
        yield f"mistake: {name}", partial(_read, file, read, text), field


def _read(file: str, read: Callable[[Any], Any], text: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, file)
        path.write_text(text, encoding="utf-8")
        read(path)
