"""Profiles of standards by their formulas: the wheel S1002 and the head of the rail 60E1."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from wearlaw import Array
from wearlaw_wheelset._curve import Arc, Parametric, Piece

MM = 1e-3

S1002_RUNNING = (
    0.0,
    -3.358537058e-2,
    1.565681624e-3,
    -2.810427944e-5,
    5.844240864e-8,
    -1.562379023e-8,
    5.309217349e-15,
    -5.957839843e-12,
    2.646656573e-13,
)
"""Coefficients of the running surface, from -26 to 32.15796 mm, of z [mm] in powers of y [mm]."""

S1002_ROOT = (
    -4.320221063e3,
    -1.038384026e3,
    -1.065501873e2,
    -6.051367875,
    -2.054332446e-1,
    -4.169739389e-3,
    -4.687195829e-5,
    -2.252755540e-7,
)
"""Coefficients towards the root of the flange, from -35 to -26 mm."""


def s1002() -> list[Piece]:
    """Return the wheel profile S1002, from the back of the flange to the field side, in SI units.

    Source: UIC 510-2 and EN 13715. The points of the Manchester contact benchmark lie within 1.6e-6 mm of it.
    """
    return [
        _arc((-49.5, 9.519259302), -20.5, -70.0, -62.764705882),
        _arc((-55.0, 16.0), -12.0, -62.764705882, -49.662510381),
        _arc((-58.558326413, 8.834924130), -20.0, -49.662510381, -39.764473993),
        _line(-93.576667419, -2.747477419, -39.764473993, -38.426669071),
        _arc((-26.210665, 16.446), 13.0, -38.426669071, -35.0),
        _polynomial(S1002_ROOT, -35.0, -26.0),
        _polynomial(S1002_RUNNING, -26.0, 32.15796),
        _line(1.364323640, -0.066666667, 32.15796, 60.0),
    ]


def uic60() -> list[Piece]:
    """Return the head of the rail 60E1 (UIC 60), from the gauge side to the field side, in SI units.

    Tangent arcs of 300 mm up to 10.5 mm from the axis, of 80 mm, and of 13 mm, then sides of 1 in 20 down to 37 mm
    below the top. The head is 72 mm wide where the sides begin, so the arcs of 80 mm end 25.988 mm from the axis.

    Source: UIC 861-3 and EN 13674-1. The points of the Manchester contact benchmark, which are canted by 1 in 40, lie
    within 3e-5 mm of it.
    """
    radii, side, corner = (300.0, 80.0, 13.0), math.atan(20.0), 36.0
    sine = 10.5 / radii[0]
    centres = [(0.0, radii[0])]
    centres.append(_tangent(centres[0], radii[0] - radii[1], sine))
    sine = (corner - radii[2] * math.sin(side) - centres[1][0]) / (radii[1] - radii[2])
    centres.append(_tangent(centres[1], radii[1] - radii[2], sine))
    ends = (10.5, centres[1][0] + radii[1] * sine)
    height = centres[2][1] - radii[2] * math.cos(side) - 20.0 * corner
    bottom = (37.0 - height) / 20.0
    bounds = (*ends, corner)
    right, left = [], []
    for (y, z), radius, (begin, end) in zip(centres[1:], radii[1:], pairwise(bounds), strict=True):
        right.append(_arc((y, z), radius, begin, end))
        left.append(_arc((-y, z), radius, -end, -begin))
    top = _arc(centres[0], radii[0], -ends[0], ends[0])
    rises, falls = _line(height, -20.0, -bottom, -corner), _line(height, 20.0, corner, bottom)
    return [rises, *left[::-1], top, *right, falls]


FORMULAS: dict[str, tuple[str, Callable[[], list[Piece]]]] = {"s1002": ("wheel", s1002), "uic60": ("rail", uic60)}
"""Kind and pieces of each profile by its name."""


def _tangent(centre: tuple[float, float], difference: float, sine: float) -> tuple[float, float]:
    """Return the centre of a smaller arc that touches one about `centre` where the angle has this sine."""
    return centre[0] + difference * sine, centre[1] - difference * math.sqrt(1.0 - sine**2)


def _arc(centre: tuple[float, float], radius: float, begin: float, end: float) -> Arc:
    """Return an arc in mm; the radius is negative where the angle falls."""
    return Arc.about((MM * centre[0], MM * centre[1]), 1.0 / (MM * radius), MM * begin, MM * end)


def _line(height: float, slope: float, begin: float, end: float) -> Arc:
    """Return the line z = height + slope y in mm."""
    length = MM * (end - begin) * math.hypot(1.0, slope)
    return Arc(MM * begin, MM * (height + slope * begin), math.atan(slope), 0.0, length)


def _polynomial(coefficients: tuple[float, ...], begin: float, end: float) -> Parametric:
    polynomial = np.polynomial.Polynomial(coefficients)
    derivatives = [polynomial.deriv(order) if order else polynomial for order in range(3)]
    straight = (lambda y: y, np.ones_like, np.zeros_like)

    def derivative(y: Array, order: int) -> tuple[Array, Array]:
        return MM * straight[order](y), MM * derivatives[order](y)

    return Parametric(derivative, np.linspace(begin, end, 1 + math.ceil(end - begin)))
