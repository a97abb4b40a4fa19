"""The paper of Tassini et al. (2010) by the formulas and integrals of tests/reference.py."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests import reference
from tests.reference import brentq
from wearlaw import Array

LOAD, FRICTION, RADIUS = 741.43e3, 0.46, 0.047 / 4.0
MODULUS = 206.47742e9 / (2.0 * (1.0 - 0.28**2))
SPEED = math.pi * 0.047 * 400.0 / 60.0
"""Surface speed of a disc at 400 rpm [m/s]."""
HALF_WIDTH = math.sqrt(4.0 * LOAD * RADIUS / (math.pi * MODULUS))
AREA = 2.0 * HALF_WIDTH * 10.0 * 1e3
"""Patch area on a track of 10 mm [mm²]."""
FULL_SLIP = 100.0 * FRICTION * HALF_WIDTH / RADIUS
"""Creepage of full slip [%]."""
FORCE = FRICTION * LOAD * 0.01
"""T in full slip on a track of 10 mm [N]."""
GLOBAL = (5.3, 55.0, 61.9, 77.26)
CORRECTED = {"exact": (5.3, 55.0, 83.7, 95.0), "fastsim": (5.3, 56.5, 83.7, 107.0)}
KTH_MID = (350e-4, 5.5e-4, 35e-4, 5.5e-4)
STEP = 0.02
"""Greatest distance of the creepages at which the claims are computed [%]."""
HEAT = {0.2: 1.3, 0.5: 9.2, 1.0: 25.7, 3.0: 102.6, 7.5: 246.0, 10.0: 327.8, 15.0: 492.1, 20.0: 728.4}
"""Frictional heat [W] by creepage [%], Lewis and Dwyer-Joyce (2004), Table 3."""
CONDITIONS: dict[str, Any] = {"normal_force": wl.Q(7.4143, "kN"), "friction_coefficient": FRICTION}


def mean_speed(creepage: float) -> float:
    """Return V [m/s] if disc 1 keeps `SPEED`: (v1 + v2)/2 with (v1 - v2)/V = ξ, at a creepage [%]."""
    slower = SPEED * (2.0 - creepage / 100.0) / (2.0 + creepage / 100.0)
    return 0.5 * (SPEED + slower)


ROLLING_SPEEDS: dict[Any, Callable[[float], float]] = {"disc_1": mean_speed, "mean": lambda _: SPEED}
"""V [m/s] at a creepage [%], by whose surface speed the rig keeps; the rig of the paper keeps that of disc 1."""


def point(creepage: float, load: float = LOAD, kept: str = "disc_1") -> reference.Point:
    """Return the operating point at a creepage [%], by whose surface speed the rig keeps."""
    return reference.Point(load, RADIUS, MODULUS, FRICTION, creepage / 100.0, ROLLING_SPEEDS[kept](creepage))


SOLUTIONS: dict[str, Callable[[reference.Point], reference.Solution]] = {
    "exact": reference.exact,
    "as printed": functools.partial(reference.exact, as_printed=True),
    "fastsim": reference.parabolic,
    "kalker": functools.partial(reference.parabolic, kalker=True),
    "elliptic": reference.elliptic,
}


@functools.cache
def usfd(model: str, creepage: float, parameters: tuple[float, ...] = GLOBAL) -> float:
    """Return the mean rate of USFD [µg/m/mm²] on cells, or on the patch means."""
    if model != "global":
        m_m, q_s, m_c, transition = parameters
        return reference.usfd_mean(SOLUTIONS[model](point(creepage)), m_m, q_s, m_c, transition)
    return usfd_of(index(creepage) / AREA)


def usfd_of(w: float) -> float:
    m_m, q_s, m_c, transition = GLOBAL
    return m_m * w if w < q_s / m_m else q_s if w < transition else q_s + m_c * (w - transition)


def index(creepage: float) -> float:
    """Return Tγ [N] of the exact theory."""
    d = min(creepage / FULL_SLIP, 1.0)
    return FORCE * d * (2.0 - d) * creepage / 100.0


def creepage_at(wear_index: float) -> float:
    return brentq(lambda x: index(x) - wear_index, 1e-6, 30.0)


def brr_of(wear_index: float) -> float:
    """Return the rate of BRR [µg/m/mm²]: section × D [mm³/km] × π × 7.85 mg/mm³ × 1e-3 µg/mg km/m × 1e3 / A."""
    section = min(0.25 * wear_index, 25.0) if wear_index < 200.0 else 1.19 * wear_index - 154.0
    return section * math.pi * 7.85 / AREA


def kth_of(creepage: float, k: tuple[float, ...] = KTH_MID) -> float:
    """Return the rate of KTH on the patch means below 2.1 GPa [µg/m/mm²]."""
    slip = creepage / 100.0
    coefficient = k[1] if slip * mean_speed(creepage) < 0.2 else k[2]
    return 7850.0 * coefficient * LOAD / (2.0 * HALF_WIDTH) * slip / 2.625e9 * 1e3


K = {"low": (300e-4, 1e-4, 30e-4, 1e-4), "mid": KTH_MID, "high": (400e-4, 10e-4, 40e-4, 10e-4)}


def densities(model: str, creepage: Array, cells: int) -> Array:
    """Return q·s [N/mm²] at the middles of uniform cells, of shape (creepages, cells)."""
    v = np.linspace(2.0, 0.0, 2 * cells + 1)[1::2]
    solutions = [SOLUTIONS[model](point(float(one))) for one in creepage]
    return 1e-6 * np.stack([np.where(v < s.border, s.density(np.minimum(v, s.border)), 0.0) for s in solutions])


@functools.cache
def exact_force(creepage: float) -> float:
    return reference.exact(point(creepage)).force


@functools.cache
def kth(model: str, creepage: float, load: float = LOAD, kept: str = "disc_1") -> float:
    return reference.kth_mean(SOLUTIONS[model](point(creepage, load, kept)), KTH_MID)


def printed(text: str) -> Any:
    """Return the range of numbers that round to the printed digits."""
    decimals = len(text.partition(".")[2])
    return pytest.approx(float(text), abs=0.5 * 10.0**-decimals if decimals else 1e-14)
