"""Tests of a lab in a CSV file: read, shown, selected, predicted and written."""

from __future__ import annotations

import random
from collections.abc import Iterator

import numpy as np

import wearlaw as wl
from tests.fuzz import mutations
from tests.fuzz.harness import Files, check

SEEDS = [
    "# source: a rig\nlabel,creepage [%],normal_force [kN],traction_coefficient,wear_rate [ug/m/mm^2],comment\n"
    "A1,0.2,7.4,0.09,2.1,\nA2,1,7.4,0.35,26.5,dry\nA4,3,7.4,0.46,NA,\n",
    "label;creepage [%];max_pressure [MPa];friction_coefficient;wear_rate [µg/m/mm²];wear_rate_uncertainty [µg/m/mm²]\n"
    "A1;0.2;1500;0.4;2.1;0.3\nA2;1.5;1500;0.4;26.5;2\n",
    "creepage [%]\tnormal_force [kN]\ttangential_force [N]\twear_rate [ug/m/mm^2]\n1\t7\t2500\t10\n",
    "creepage [%],normal_force [kN],frictional_heat [W],rolling_speed [m/s],wear_rate [ug/m/mm^2]\n1,7.4,30,1,10\n",
    "creepage [%];normal_force [kN];rcf_damage;rolled_distance [km]\n1;7.4;1e-5;2\n",
]


def seeds() -> Iterator[Files]:
    for text in SEEDS:
        yield {"tests.csv": text.encode()}


def draw(random: random.Random) -> Files:
    text = random.choice(SEEDS).encode()
    return {"tests.csv": mutations.mutated(random, text, [mutations.cells, mutations.cells, mutations.units])}


def run() -> None:
    """Read tests, and predict the wear of those that have all conditions."""
    tests = wl.read_tests("tests.csv", outcomes=["rcf_damage"])
    repr(tests)
    check(len(tests) == len(tests.labels), "tests and labels differ in number")
    tests.to_dataframe()
    model = wl.contact_model("global")
    given = tests.conditions(model, friction_coefficient=0.4)
    for name, values in given.items():
        check(np.isfinite(getattr(values, "magnitude", values)).all(), f"{name} is not finite")
    rate = (wl.TwinDisc.suros() | model | wl.wear_law("usfd"))(**given).wear_rate.magnitude
    check(np.all(rate >= 0.0), "a wear rate is negative or no number")
    check(np.isfinite(rate).all(), "a wear rate is infinite")
