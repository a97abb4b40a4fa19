"""Equivalent conicity against cones, elliptic integrals and an integration of the wheelset's motion along the track."""

import numpy as np
import pytest
import scipy

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.conicity import (  # private: one step of the contact, against another way to it
    NODES,
    equivalent_conicity,
)

E, R0 = 1.5, 0.46
"""Distance of the rolling circles and nominal radius [m]; the conicity depends on neither."""


def rounding(wider: float) -> float:
    """Return the relative rounding of the conicity, from a table that is so many times wider than the wave.

    The heights γ ŷ² cos² θ are differences of integrals of up to γ (wider ŷ)², with an error of eps of them. cos² θ is
    (π (k + 1/2)/N)² at the k-th of N nodes from either end, and the mean of its inverse over the nodes N.
    """
    return float(np.finfo(float).eps) * NODES * wider**2


@pytest.mark.parametrize("conicity", [0.025, 0.2, 1.2])
@pytest.mark.parametrize("amplitude", [0.001, 0.003, 0.01])
def test_cones_have_their_own_conicity(conicity: float, amplitude: float) -> None:
    y = np.linspace(-0.01, 0.01, 41)
    found = equivalent_conicity(y, 2.0 * conicity * y, amplitude)
    assert found == pytest.approx(conicity, rel=rounding(0.01 / amplitude))


def progressive(y: Array) -> Array:
    return 0.3 * y + 4000.0 * y**3


@pytest.mark.parametrize("amplitude", [0.001, 0.003, 0.007])
@pytest.mark.parametrize("spacing", [1e-4, 1e-5])
def test_a_progressive_difference_has_the_period_of_duffing(amplitude: float, spacing: float) -> None:
    """y'' = -(α y + β y³) has the period 4 K(m)/√(α + β ŷ²), m = β ŷ²/(2 (α + β ŷ²)) (Abramowitz and Stegun, 17)."""
    y = np.linspace(-0.008, 0.008, 2 * round(0.008 / spacing) + 1)
    alpha, beta = 0.3 / (E * R0), 4000.0 / (E * R0)
    stiff = alpha + beta * amplitude**2
    wavelength = 4.0 * scipy.special.ellipk(beta * amplitude**2 / (2.0 * stiff)) / np.sqrt(stiff)
    conicity = 2.0 * E * R0 * (np.pi / wavelength) ** 2
    # The slopes of the interpolation are off by at most δ, a third of h² times the third derivative of 24000/m². The
    # integral of a cubic is off by h²/12 times the difference of δ between its ends, beside that of Δr. In the cell of
    # the turning point, Δr itself is off by up to hδ/4, for a share of √(2h/ŷ) of the angle θ.
    slope = spacing**2 * 24000.0 / 3.0
    energy = 0.15 * np.array([0.008, amplitude]) ** 2 + 1000.0 * np.array([0.008, amplitude]) ** 4
    turning = 0.25 * spacing * slope / float(progressive(np.asarray(amplitude))) * np.sqrt(2.0 * spacing / amplitude)
    bound = spacing**2 / 12.0 * slope / energy[1] + turning + rounding(np.sqrt(energy[0] / energy[1]))
    assert equivalent_conicity(y, progressive(y), amplitude) == pytest.approx(conicity, rel=float(bound))


def lopsided(y: Array) -> Array:
    """A difference that is steeper on one side, and zero at 1 mm."""
    return 0.25 * (y - 0.001) + 30.0 * (y - 0.001) ** 2 + 3000.0 * (y - 0.001) ** 3


def wave(start: float) -> tuple[float, float]:
    """Return the amplitude and the conicity of the wave that turns at `start`, from the motion along the track."""

    def turned(x: float, state: Array) -> float:  # noqa: ARG001  as solvers call it
        return float(state[1])

    def motion(x: float, state: Array) -> list[float]:  # noqa: ARG001
        return [float(state[1]), -float(lopsided(state[0])) / (E * R0)]

    turned.terminal, turned.direction = True, 1.0  # type: ignore[attr-defined]
    found = scipy.integrate.solve_ivp(
        motion, (0.0, 100.0), [start, 0.0], "DOP853", events=[turned], rtol=1e-12, atol=1e-15, max_step=0.1
    )
    half, other = float(found.t_events[0][0]), float(found.y_events[0][0][0])
    return 0.5 * (start - other), 2.0 * E * R0 * (np.pi / (2.0 * half)) ** 2


@pytest.mark.parametrize("start", [0.002, 0.004, 0.006])
def test_a_lopsided_difference_follows_the_motion_along_the_track(start: float) -> None:
    amplitude, conicity = wave(start)
    y = np.linspace(-0.01, 0.01, 4001)
    # As above, 0.005 mm apart: 1e-12. Steps of 0.1 m of the motion are 0.02 of a wave: 8th order leaves less than 1e-9.
    assert equivalent_conicity(y, lopsided(y), amplitude) == pytest.approx(conicity, rel=1e-9)


def test_cones_inside_a_jump_keep_their_conicity() -> None:
    y = np.linspace(-0.005, 0.005, 21)
    jumped = 0.002 * y + np.where(np.abs(y) > 0.0026, np.sign(y) * 0.001, 0.0)
    # A monotone interpolation stays between 0.004 and 0.005 mm in the last cell: within 25 % of the cones.
    assert 0.0008 < equivalent_conicity(y, jumped, 0.0024) < 0.00125


Y = np.linspace(-0.01, 0.01, 41)


@pytest.mark.parametrize(
    ("y", "difference", "amplitude", "message"),
    [
        (Y, 0.4 * Y, 0.011, "a wave of 11 mm is 22 mm wide, but the displacements reach from -10 to 10 mm"),
        (Y, 0.4 * Y + 0.01, 0.003, "must change its sign, but lies between 6 and 14 mm"),
        (Y, -0.4 * Y, 0.003, "does not steer the wheelset back"),
        (Y, 0.4 * (Y - 0.008), 0.005, "no wave of 5 mm fits between -10 and 10 mm"),
    ],
)
def test_a_table_without_a_wave_is_refused(y: Array, difference: Array, amplitude: float, message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        equivalent_conicity(y, difference, amplitude)
