"""The normal problem of wheels by brute force, which predictions are compared with, against Hertz."""

from __future__ import annotations

import numpy as np
import pytest

from tests.plugins.wheelset.brute_force import Wheel
from tests.plugins.wheelset.wheelsets import R0, cone, on_round_heads, wheelset
from wearlaw import hertz_ellipse

ELEMENTS = 60


def check(wheel: Wheel, load: float, angle: float, curvatures: tuple[float, float], varies: float) -> None:
    """Compare a wheel with Hertz, on a plane at an angle [rad]; `varies` is the share by which the approach does."""
    found = wheel.pressed(load, ELEMENTS)
    cosine = np.cos(angle)
    force = np.array(load / cosine)
    a, b = hertz_ellipse.semi_axes(force, np.array(curvatures[0]), np.array(curvatures[1]), wheel.modulus)
    approach = hertz_ellipse.approach(force, a, b, wheel.modulus)
    # The pressure of elements is right to the square of their size. What varies to both sides counts by its square.
    within = 1.0 / ELEMENTS**2 + varies**2
    assert found.normal_force == pytest.approx(force, rel=within)
    assert found.max_pressure == pytest.approx(float(hertz_ellipse.max_pressure(force, a, b)), rel=within)
    # The approach grows with the power 2/3 of the load.
    sunk = found.height - wheel.pressed(load / 8.0, ELEMENTS).height
    assert sunk * cosine == pytest.approx(0.75 * approach, rel=2.0 * within)
    # The patch has 0.7 of the elements on either axis, and half of one too much at either end.
    assert found.area == pytest.approx(np.pi * a * b, rel=2.0 / (0.7 * ELEMENTS) + varies**2)
    step = found.s[1] - found.s[0]
    assert step * found.force.sum() == pytest.approx(found.normal_force, rel=1e-5)


@pytest.mark.parametrize(("radius", "yaw"), [(0.08, 0.2), (0.3, 0.0), (0.3, -0.5)])
def test_yawed_cylinders_on_round_heads_are_pressed_as_by_hertz(radius: float, yaw: float) -> None:
    # At any yaw the cylinder touches the middle of the head.
    pair = on_round_heads(cone(1e-9), radius)
    wheel = Wheel(pair, 0.75 * (1.0 - np.cos(yaw)), yaw, 0.0)
    c, s = np.cos(yaw), np.sin(yaw)
    form = np.array([[c * c, c * s], [c * s, s * s]]) / (2.0 * R0) + np.diag([0.0, 0.5 / radius])
    low, high = np.linalg.eigvalsh(form)
    check(wheel, 80e3, 0.0, (low, high), wheel.pressed(80e3, ELEMENTS).turn / 2.0)


def test_a_straight_flank_on_the_gauge_corner_is_pressed_as_by_hertz() -> None:
    # The flank of S1002 falls by 2.747 on the arc of 13 mm, 12.7 mm below the taping line.
    wheel, slope = Wheel(wheelset(), 7e-3, 0.0, 0.0), 2.747477419
    angle = np.arctan(slope)
    found = wheel.pressed(2e3, ELEMENTS)
    s = float(found.s @ found.force / found.force.sum())
    _, z = wheel.rail.rail(s)
    radius = R0 + z - found.height
    check(wheel, 2e3, angle, (0.5 * np.cos(angle) / radius, 0.5 / 0.013), slope * found.turn / 2.0)
