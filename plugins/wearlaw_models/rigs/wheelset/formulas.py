"""Profiles of standards by their formulas."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterator
from functools import cache, partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from wearlaw import Array
from wearlaw_models.rigs.wheelset.curve import Arc, Curve, Parametric, Piece, joined
from wearlaw_models.rigs.wheelset.fields import CONVEX

MM = 1e-3
SIDE = math.atan(20.0)
"""Angle of the sides of a rail's head [rad]."""

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
    """Return the head of the rail UIC 60, from the gauge side to the field side, in SI units.

    Arcs of 300 mm up to 10.5 mm from the axis, of 80 mm, and of 13 mm. The head is 72 mm wide where the sides begin.

    Source: UIC 861-3. The points of the Manchester contact benchmark, which are canted by 1 in 40, lie within 3e-5 mm
    of it.
    """
    middle = 10.5 * (300.0 - 80.0) / 300.0  # that of the arc of 80 mm
    sine = (36.0 - 13.0 * math.sin(SIDE) - middle) / (80.0 - 13.0)
    return _head((300.0, 80.0, 13.0), (10.5, middle + 80.0 * sine), 37.0)


def rail_60e1() -> list[Piece]:
    """Return the head of the rail 60E1: arcs of 300 mm, 80 mm and 13 mm."""
    return _head((300.0, 80.0, 13.0), (0.5 * 20.456, 0.5 * 52.053), 35.0)


def rail_60e2() -> list[Piece]:
    """Return the head of the rail 60E2: arcs of 200 mm, 70 mm, 16 mm and 8 mm."""
    return _head((200.0, 70.0, 16.0, 8.0), (0.5 * 23.778, 0.5 * 48.913, 0.5 * 70.774), 35.0)


def rail_54e1() -> list[Piece]:
    """Return the head of the rail 54E1 (UIC 54): arcs of 300 mm, 80 mm and 13 mm."""
    return _head((300.0, 80.0, 13.0), (0.5 * 20.024, 0.5 * 49.727), 33.0)


def cone(slope: float) -> list[Piece]:
    """Return a conical wheel without a flange, whose radius falls outwards by a slope."""
    return [_line(0.0, -slope, -35.0, 60.0)]


class Formula(NamedTuple):
    """A profile by formula: its kind, the function that returns its pieces, and what `wearlaw show` says of it."""

    kind: str
    pieces: Callable[[], list[Piece]]
    source: str


DRAWING = (
    "Arcs that touch each other, then sides of 1 in 20. Source: the drawing in EN 13674-1:2017, read in the package"
    " EN13674 of A. Rohrbeck (github.com/rohrbecka/EN13674); the head comes out as wide as the standard says."
)

FORMULAS: dict[str, Formula] = {
    "s1002": Formula(
        "wheel",
        s1002,
        "S1002 of UIC 510-2 and EN 13715. The points of the Manchester contact benchmark lie within 1.6e-6 mm of it.",
    ),
    "uic60": Formula(
        "rail",
        uic60,
        "UIC 60, as in the Manchester contact benchmark, whose points lie within 3e-5 mm of it. rail_60e1"
        " follows the drawing in EN 13674-1, and lies up to 0.04 mm lower beside the middle.",
    ),
    "rail_60e1": Formula("rail", rail_60e1, f"60E1. {DRAWING}"),
    "rail_60e2": Formula("rail", rail_60e2, f"60E2. {DRAWING}"),
    "rail_54e1": Formula("rail", rail_54e1, f"54E1, formerly UIC 54. {DRAWING}"),
    "cone20": Formula("wheel", partial(cone, 1.0 / 20.0), "A cone of 1 in 20 without a flange, from -35 to 60 mm."),
    "cone40": Formula("wheel", partial(cone, 1.0 / 40.0), "A cone of 1 in 40 without a flange, from -35 to 60 mm."),
}
"""Profiles by their names."""


def explain_profile(name: str, source: str) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a profile by formula."""
    yield f"profile of a {FORMULAS[name].kind}"
    yield ""
    yield from textwrap.wrap(source, 88)
    yield ""
    yield f'A case names it: {FORMULAS[name].kind} = "{name}"'
    yield f'In Python: wearlaw_models.rigs.wheelset.Profile.named("{name}")'


def _head(radii: tuple[float, ...], ends: tuple[float, ...], depth: float) -> list[Piece]:
    """Return the head of a rail down to a depth, from arcs that touch each other at ends, and sides of 1 in 20 [mm]."""
    centre, arcs = (0.0, radii[0]), [(0.0, radii[0])]
    for radius, smaller, end in zip(radii, radii[1:], ends, strict=False):
        sine = (end - centre[0]) / radius
        centre = (
            centre[0] + (radius - smaller) * sine,
            centre[1] - (radius - smaller) * math.sqrt(1.0 - sine**2),
        )
        arcs.append(centre)
    corner = centre[0] + radii[-1] * math.sin(SIDE)
    height = centre[1] - radii[-1] * math.cos(SIDE) - 20.0 * corner
    bottom = (depth - height) / 20.0
    right, left = [], []
    for (y, z), radius, (begin, end) in zip(arcs[1:], radii[1:], pairwise((*ends, corner)), strict=True):
        right.append(_arc((y, z), radius, begin, end))
        left.append(_arc((-y, z), radius, -end, -begin))
    top = _arc(arcs[0], radii[0], -ends[0], ends[0])
    rises, falls = _line(height, -20.0, -bottom, -corner), _line(height, 20.0, corner, bottom)
    return [rises, *left[::-1], top, *right, falls]


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


@cache
def curve_of(name: str) -> Curve:
    """Return the curve of a formula."""
    return joined(FORMULAS[name].pieces(), CONVEX[FORMULAS[name].kind])
