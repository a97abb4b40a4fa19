"""A rig of two unlike discs, with its contact and wear once more by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import quad

import wearlaw as wl
from wearlaw import Q

RIG = wl.TwinDisc.suros(
    disc_2=wl.Disc(diameter="60 mm", material=wl.steel(density="7100 kg/m^3", youngs_modulus="190 GPa")),
    track_width="8 mm",
)
LAW = wl.wear_law("usfd", fitted_for="exact")
PREDICT = RIG | wl.contact_model("exact") | LAW
FORCE, FRICTION = 6000.0, 0.4
CONDITIONS: Any = {"normal_force": Q(FORCE, "N"), "friction_coefficient": FRICTION}

# The rig again, by hand.
WIDTH, DIAMETERS, DENSITIES = 8e-3, {"disc_1": 47e-3, "disc_2": 60e-3}, {"disc_1": 7850.0, "disc_2": 7100.0}
RADIUS = 23.5e-3 * 30e-3 / 53.5e-3
MODULUS = 1.0 / ((1 - 0.28**2) / 206.47742e9 + (1 - 0.28**2) / 190e9)
HALF_WIDTH = np.sqrt(4 * FORCE / WIDTH * RADIUS / (np.pi * MODULUS))
MAX_PRESSURE = 2 * FORCE / WIDTH / (np.pi * HALF_WIDTH)
SATURATION = FRICTION * HALF_WIDTH / RADIUS


def slip_at(x: float, creepage: float) -> float:
    """Return the slip of a rolling cylinder in Carter's solution, zero in stick."""
    k = FRICTION / RADIUS
    stick = max(HALF_WIDTH - creepage / k, 0.0)  # half its length
    if stick == 0.0:
        return creepage + k * x
    if x <= -HALF_WIDTH + 2 * stick:
        return 0.0
    return float(k * np.sqrt(max((x + HALF_WIDTH - stick) ** 2 - stick**2, 0.0)))


def bound_at(x: float) -> float:
    return float(FRICTION * MAX_PRESSURE * np.sqrt(max(1 - (x / HALF_WIDTH) ** 2, 0.0)))


def carter(creepage: float) -> float:
    """Return T [N] of Carter's theory."""
    return float(FRICTION * FORCE * (1 - max(1 - creepage / SATURATION, 0.0) ** 2))


def mean_over_slip_zone(function: Any, creepage: float) -> float:
    """Return the integral of a function over the slip zone, divided by the length of the whole patch."""
    start = max(HALF_WIDTH - 2 * creepage / (FRICTION / RADIUS), -HALF_WIDTH)
    return float(quad(function, start, HALF_WIDTH, limit=400, epsabs=0, epsrel=1e-10)[0] / (2 * HALF_WIDTH))


def usfd(density: float) -> float:
    """Return the rate [kg/m³] of Table 4 of Tassini et al. (2010), exact, against q·s in N/mm²."""
    if density < 55 / 5.3:
        return 5.3e-3 * density
    return 55e-3 if density < 95 else 55e-3 + 83.7e-3 * (density - 95)
