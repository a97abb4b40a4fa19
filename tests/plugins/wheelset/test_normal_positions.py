"""The normal problem at many random positions of new, worn and measured wheels, on rollers too, beside brute force."""

from __future__ import annotations

from functools import partialmethod
from itertools import islice
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.brute_force import TURNS, compared, positions
from tests.plugins.wheelset.test_normal import AREA, MISPLACED
from wearlaw import Q
from wearlaw_models.rigs.wheelset.loads import Loads  # private: layings of rows, and where wheels stand in them
from wearlaw_models.rigs.wheelset.stand import BALANCED  # private: the accuracy that a search ends at

FLANKS = (103, 56), (104, 25), (104, 41), (106, 6), (109, 54)
"""Seed and number of positions: three at which a step by rates leads a wheelset up its flank, away from its balance,
one at which the angles of wheel and rail differ by up to 0.1 rad within the contact, and one with yaw at which the
curvature of the wheel's profile jumps there."""


@pytest.mark.validates(
    "wheelset",
    "Pressure of new wheels and of those worn by up to 2 mm, two humps included, at 60 random positions from tread to"
    " flange, yaw from -12 to 24 mrad, 10 to 90 kN: maximum, area, force in other places after a shift of 0.1 mm",
    source="half-spaces between the surfaces in space, on 120 by 120 elements, where the rail turns by 0.2 rad or less",
    held_to="{pressure:.0%}, {area:.0%}, {misplaced:.0%}",
    pressure=0.02,
    area=AREA,
    misplaced=MISPLACED,
)
def test_wheels_at_random_are_pressed_as_by_brute_force(pressure: float, area: float, misplaced: float) -> None:
    found = []
    for position in (*positions(60), *(next(islice(positions(60, seed), at, None)) for seed, at in FLANKS)):
        for due, off in compared(position):
            assert off is not None, position
            assert off.load == pytest.approx(0.0, abs=BALANCED), position
            if due.turn <= TURNS:
                found.append(off[:3])
    assert len(found) > 60
    assert (np.abs(found).max(axis=0) <= (pressure, area, misplaced)).all()


@pytest.mark.validates(
    "wheelset",
    "Maximum pressure of profiles measured with a noise of 1 and 10 µm and smoothed by as much",
    source="half-spaces between the surfaces in space, of the same profiles",
    held_to="{share:.0%}",
    share=0.05,
)
@pytest.mark.parametrize("noise", [0.001, 0.01])
def test_measured_wheels_are_pressed_as_by_brute_force(noise: float, share: float) -> None:
    for position in positions(5, seed=55, noise=noise):
        for due, off in compared(position):
            assert off is not None, position
            if position.name == "measured" and due.turn <= TURNS:
                assert abs(off.pressure) <= share, position


@pytest.mark.validates(
    "wheelset",
    "Pressure of new and worn wheels on rollers of 350 and 800 mm at random displacements up to 6.2 mm, with yaw 0 and"
    " 20 mrad: maximum, area",
    source="half-spaces between the surfaces of revolution in space, on 120 by 120 elements, where the profile turns by"
    " 0.2 rad or less",
    held_to="{pressure:.0%}, {area:.0%}",
    pressure=0.01,
    area=0.03,
)
@pytest.mark.parametrize(("radius", "yaw"), [(350, 0.0), (350, 20e-3), (800, 0.0), (800, 20e-3)])
def test_wheels_are_pressed_on_rollers_as_by_brute_force(radius: int, yaw: float, pressure: float, area: float) -> None:
    found = []
    for position in positions(8, seed=58 + radius, roller_radius=Q(radius, "mm")):
        if abs(position.displacement) > 6.2e-3:  # beyond, wheels climb
            continue
        for due, off in compared(position._replace(yaw=yaw)):
            assert off is not None, position
            assert off.load == pytest.approx(0.0, abs=BALANCED), position
            if due.turn <= TURNS:
                found.append(off[:2])
    assert len(found) > 4
    assert (np.abs(found).max(axis=0) <= (pressure, area)).all()


@pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")
@pytest.mark.parametrize("again", [0, 8])
def test_results_have_their_rows_where_the_wheels_stand(again: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a worn flank lies along the rail, rows are laid millimetres away at first."""
    monkeypatch.setattr(Loads, "until_near", partialmethod(Loads.until_near, again=again))
    pair = next(islice(positions(6, seed=408), 5, None)).pair
    problem: Any = (pair | wl.contact_model("fastsim")).posed({
        "lateral_displacement": Q([6.6425, 6.645, 6.655], "mm"), "vertical_load": "75.2 kN",
        "friction_coefficient": 1e-7,
    })  # fmt: skip
    last = problem.loads._gathered("shift")
    assert (last <= 1.0).all() == (again > 0)
    assert (problem.exists.any(axis=(1, 2)) == (last <= 1.0)).all()
