"""The gap between an S1002 wheel and a canted UIC 60 rail, surface against surface, as a reference.

The wheel is a surface of revolution, moved, rolled and yawed in space; no contact is searched for. Lengths are in mm.
The track's axes are x forwards, y to the right, z down, and the wheel is the right one. Formulas of the profiles: UIC
510-2 and EN 13674-1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wearlaw import Array

RADIUS, BACK, FLANGE_BACK, GAUGE, GAUGE_DEPTH, CANT = 460.0, 680.0, -70.0, 1435.0, 14.0, np.arctan(1.0 / 40.0)

RUNNING = (
    2.646656573e-13,
    -5.957839843e-12,
    5.309217349e-15,
    -1.562379023e-8,
    5.844240864e-8,
    -2.810427944e-5,
    1.565681624e-3,
    -3.358537058e-2,
    0.0,
)
ROOT = (
    -2.252755540e-7,
    -4.687195829e-5,
    -4.169739389e-3,
    -2.054332446e-1,
    -6.051367875,
    -1.065501873e2,
    -1.038384026e3,
    -4.320221063e3,
)


class Gap(NamedTuple):
    """Gap on a grid of places x along the rail and t along the plane of contact, (x, t)."""

    x: Array
    t: Array
    height: Array


def wheel(s: Array) -> Array:
    """Return the depth of the wheel's profile below the taping line, from the flange to the field side."""
    root, flank = 16.446 - np.sqrt(np.maximum(13.0**2 - (s + 26.210665) ** 2, 0.0)), -93.576667419 - 2.747477419 * s
    flange = 8.834924130 + np.sqrt(np.maximum(20.0**2 - (s + 58.558326413) ** 2, 0.0))
    return np.select(
        [s < -39.764473993, s < -38.426669071, s < -35.0, s < -26.0, s < 32.15796],
        [flange, flank, root, np.polyval(ROOT, s), np.polyval(RUNNING, s)],
        1.364323640 - 0.066666667 * s,
    )


BORDER = 25.98802
"""Where the arcs of 80 and 13 mm of UIC 60 meet, from the middle of its head, which is 72 mm wide."""


def rail() -> tuple[Array, Array]:
    """Return points of the right rail, y and z, from the gauge side outwards."""
    y, z, begin, centre = [], [], 0.0, (0.0, 300.0)
    for radius, end, smaller in ((300.0, np.arcsin(10.5 / 300.0), 80.0), (80.0, None, 13.0), (13.0, 1.5, 13.0)):
        end = np.arcsin((BORDER - centre[0]) / radius) if end is None else end
        angle = np.linspace(begin, end, 10000)
        y.append(centre[0] + radius * np.sin(angle))
        z.append(centre[1] - radius * np.cos(angle))
        step = radius - smaller
        begin, centre = end, (centre[0] + step * np.sin(end), centre[1] - step * np.cos(end))
    half, drop = np.concatenate(y)[1:], np.concatenate(z)[1:]
    flat, down = np.concatenate([-half[::-1], half]), np.concatenate([drop[::-1], drop])
    y_rail, z_rail = flat * np.cos(CANT) + down * np.sin(CANT), down * np.cos(CANT) - flat * np.sin(CANT)
    z_rail = z_rail - z_rail.min()
    gauge = y_rail[np.flatnonzero(z_rail < GAUGE_DEPTH)[0]]
    return y_rail - gauge + 0.5 * GAUGE, z_rail


def gap(
    y: float,
    z: float,
    roll: float,
    yaw: float,
    *,
    angle: float,
    at: float,
    half_width: float,
    half_length: float,
    step: float,
) -> Gap:
    """Return the gap of a wheelset at y and z, in a plane at an angle to the track around the rail's point at y."""
    y_rail, z_rail = rail()
    origin = np.array([at, np.interp(at, y_rail, z_rail)])
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    t_rail, n_rail = turn @ (np.stack([y_rail, z_rail]) - origin[:, None])
    wide, long = round(half_width / step), round(half_length / step)
    t = np.linspace(-wide * step, wide * step, 2 * wide + 1)
    rail_height = np.interp(t, *_rising(t_rail, n_rail))
    s = np.arange(-60.0, 40.0, 0.01)
    radius, axle = RADIUS + wheel(s), BACK - FLANGE_BACK + s

    def row(x: float) -> Array:
        theta = np.zeros_like(s)
        for _ in range(4):
            across = axle * np.cos(roll) - radius * np.cos(theta) * np.sin(roll)
            theta = np.arcsin((x + across * np.sin(yaw)) / (radius * np.cos(yaw)))
        down = axle * np.sin(roll) + radius * np.cos(theta) * np.cos(roll) - RADIUS + z
        out = radius * np.sin(theta) * np.sin(yaw) + across * np.cos(yaw) + y
        height: Array = rail_height - np.interp(t, *_rising(*(turn @ (np.stack([out, down]) - origin[:, None]))))
        return height

    coarse = np.arange(-40.0, 40.1, 0.5)
    middle = coarse[np.argmin([row(x).min() for x in coarse])]
    x = middle + np.linspace(-long * step, long * step, 2 * long + 1)
    height = np.stack([row(v) for v in x])
    return Gap(x, t, height - height.min())


def _rising(t: Array, n: Array) -> tuple[Array, Array]:
    """Return the points of a curve at which t rises beyond all before."""
    keep = np.concatenate([[True], t[1:] > np.maximum.accumulate(t)[:-1]])
    return t[keep], n[keep]
