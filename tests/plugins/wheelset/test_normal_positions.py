"""The normal problem at many random positions of new, worn and measured wheels, beside brute force in space."""

from __future__ import annotations

import numpy as np
import pytest

from tests.plugins.wheelset.brute_force import TURNS, compared, positions
from tests.plugins.wheelset.test_normal import AREA, MISPLACED
from wearlaw_models.rigs.wheelset.stand import BALANCED  # private: the accuracy that a search ends at


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
    for position in positions(60):
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
