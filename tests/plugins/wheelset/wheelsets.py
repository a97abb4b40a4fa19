"""Wheelsets for tests, and their contact by other ways than the plugin's: closed forms and a search in space."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from scipy.spatial.transform import Rotation

import wearlaw as wl
from wearlaw import Array, Q

R0 = 0.46
"""Nominal radius [m]."""


def wheelset(**changed: Any) -> wl.Wheelset:
    """Return the wheelset of the Manchester benchmark A-2.2, S1002 on 60E1 at 1:40, with some fields changed."""
    fields: dict[str, Any] = {
        "wheel": wl.Profile.s1002(),
        "rail": wl.Profile.uic60(),
        "nominal_radius": Q(1e3 * R0, "mm"),
        "flange_back_distance": Q(1360, "mm"),
        "gauge": Q(1435, "mm"),
        "gauge_depth": Q(14, "mm"),
        "rail_cant": "1:40",
        "material": wl.steel(),
        "rolling_speed": Q(2, "m/s"),
    }
    return wl.Wheelset(**fields | changed)


def through(y: Array, z: Array, kind: Any) -> wl.Profile:
    """Return the profile through points [m]."""
    return wl.Profile.from_points(y=Q(1e3 * y, "mm"), z=Q(1e3 * z, "mm"), kind=kind)


def cone(conicity: float) -> wl.Profile:
    """Return a wheel with a straight tread, 120 mm wide."""
    y = np.linspace(-60e-3, 60e-3, 61)
    return through(y, -conicity * y, "wheel")


def hollow(conicity: float, radius: float) -> wl.Profile:
    """Return a wheel whose tread is a concave arc of a radius [m], with a conicity at the taping line."""
    angle = np.arctan(conicity)
    turn = np.linspace(-60e-3, 60e-3, 2401) / radius - angle
    return through(radius * (np.sin(turn) + np.sin(angle)), radius * (np.cos(angle) - np.cos(turn)), "wheel")


def round_head(radius: float) -> wl.Profile:
    """Return a rail whose head is a circular arc, 90 mm wide or down to 60 deg on both sides."""
    most = np.arcsin(min(45e-3 / radius, np.sin(np.pi / 3.0)))
    turn = np.linspace(-most, most, 1601)
    return through(radius * np.sin(turn), radius * (1.0 - np.cos(turn)), "rail")


def on_round_heads(wheel: wl.Profile, radius: float, base: float = 0.75, **changed: Any) -> wl.Wheelset:
    """Return wheels on rails with round heads, whose gauge is measured 1 mm below their tops.

    The base is the distance of the taping lines from the middle [m].
    """
    inside = {"flange_back_distance": Q(2e3 * (base - 0.07), "mm"), "gauge_depth": Q(1, "mm"), "rail_cant": "0 rad"}
    return wheelset(wheel=wheel, rail=round_head(radius), **inside, **changed)


def middle_of_head(radius: float) -> float:
    """Return the distance of the middle of round heads from the middle of the track [m]."""
    return 0.7175 + float(np.sqrt(2e-3 * radius - 1e-6))


class Body:
    """A wheel of revolution in space above its rail, with profiles by `Profile.curve` and geometry of its own.

    The right side is 1 and the left one -1. Positions are in the axes of the track.
    """

    def __init__(self, pair: wl.Wheelset, side: int) -> None:
        self.side = side
        self.curve = pair.wheel.curve
        self.base = 0.75
        self.roller = np.inf if pair.roller_radius is None else float(pair.roller_radius.to("m").magnitude)
        cant = float(pair.rail_cant.to("rad").magnitude)
        rail = pair.rail.curve
        y, z = rail.y, rail.z
        turned = y * np.cos(cant) + z * np.sin(cant), z * np.cos(cant) - y * np.sin(cant)
        self._s = rail.s
        top = int(turned[1].argmin())
        self._rail, self._cant = rail, cant
        depth = float(pair.gauge_depth.to("m").magnitude)
        found = scipy.optimize.minimize_scalar(
            lambda s: self._turned(s)[1], bounds=(rail.s[top - 2], rail.s[top + 2]), method="bounded",
            options={"xatol": 1e-12},
        )  # fmt: skip
        self._top = float(found.fun)
        gauge = scipy.optimize.brentq(
            lambda s: self._turned(s)[1] - self._top - depth, rail.s[0], float(found.x), xtol=1e-15
        )
        self._shift = 0.5 * float(pair.gauge.to("m").magnitude) - self._turned(gauge)[0]
        upright = np.abs(rail.angle - cant) < np.radians(86.0)
        self.first, self.last = rail.s[upright][0], rail.s[upright][-1]

    def _turned(self, s: Any) -> tuple[Any, Any]:
        y, z, _, _ = self._rail.at(s)
        cos, sin = np.cos(self._cant), np.sin(self._cant)
        return y * cos + z * sin, z * cos - y * sin

    def rail(self, s: Any) -> tuple[Any, Any]:
        """Return y outwards from the middle of the track and z of the rail at arc lengths [m]."""
        y, z = self._turned(s)
        return y + self._shift, z - self._top

    def surface(self, s: Any, angle: Any, move: Rotation, shift: Array) -> Array:
        """Return points of the wheel in the axes of the track, at arc lengths [m] and angles from the bottom [rad]."""
        y, z, _, _ = self.curve.at(s)
        radius = R0 + z
        across = self.side * (y + self.base)
        own = np.stack(np.broadcast_arrays(radius * np.sin(angle), across, radius * np.cos(angle)), axis=-1)
        return np.asarray(move.apply(own.reshape(-1, 3)).reshape(own.shape) + shift)

    def height(self, x: Any, y: Any) -> Any:
        """Return z of the rail or the roller [m], by Newton's method on its arc length; infinite beside it."""
        out = np.asarray(self.side * y)
        table = np.linspace(self.first, self.last, 4001)
        at = self.rail(table)[0]
        s = np.interp(out, at, table)
        for _ in range(4):
            s = s - (self.rail(s)[0] - out) / np.cos(self._rail.at(s)[2] - self._cant)
            s = np.clip(s, self.first, self.last)
        z = self.rail(s)[1]
        if np.isfinite(self.roller):
            z = self.roller - np.sqrt((self.roller - z) ** 2 - np.asarray(x) ** 2)
        return np.where((out < at[0]) | (out > at[-1]), np.inf, z)


def standing(displacement: Any, roll: Any, yaw: Any, height: Any) -> tuple[Rotation, Array]:
    """Return the rotation, first roll and then yaw, and the place of the middle of a wheelset [m] in the track."""
    return Rotation.from_euler("xz", [roll, yaw]), np.array([0.0, displacement, height - R0])


def gap(body: Body, s: Any, angle: Any, move: Rotation, shift: Array) -> Any:
    """Return the vertical gap between points of the wheel and the rail below them [m]."""
    at = body.surface(s, angle, move, shift)
    return body.height(at[..., 0], at[..., 1]) - at[..., 2]


def least_gap(body: Body, move: Rotation, shift: Array) -> tuple[float, Array]:
    """Return the least vertical gap between the surface of a wheel and its rail, and where it is [m].

    A grid over the wheel comes first, then Powell's search from its least points.
    """
    s = np.arange(body.curve.s[0], body.curve.s[-1], 0.1e-3)
    angle = np.linspace(-0.12, 0.12, 49)
    grid = gap(body, s[:, None], angle, move, shift)
    rows = grid.min(axis=1)
    inner = np.flatnonzero((rows[1:-1] <= rows[:-2]) & (rows[1:-1] <= rows[2:])) + 1
    best, place = np.inf, np.zeros(3)
    for row in inner[np.argsort(rows[inner])][:3]:
        if rows[row] > rows.min() + 1e-4:  # the grid is within 20 µm of the surface where it is nearest
            continue
        start = np.array([s[row], angle[grid[row].argmin()]])
        found = scipy.optimize.minimize(
            lambda x: float(gap(body, x[0], x[1], move, shift)), start, method="Nelder-Mead",
            options={"xatol": 1e-10, "fatol": 1e-16, "maxiter": 400,
                     "initial_simplex": start + np.array([[0.0, 0.0], [1e-4, 0.0], [0.0, 4e-3]])},
        )  # fmt: skip
        if found.fun < best:
            best, place = float(found.fun), body.surface(found.x[0], found.x[1], move, shift)
    return best, place


def borne(problem: Any, lateral_force: Array) -> tuple[Array, Array]:
    """Return the vertical and the lateral forces of wheels on rails, (positions, 2), by rows and creep forces [N]."""
    patches, angle = problem.loads.patches, np.nan_to_num(problem.contact_angle).reshape(-1, 2, 3)
    across, wheel = np.nan_to_num(lateral_force).reshape(angle.shape), 2 * patches.point + patches.side
    there = np.asarray(problem.exists).reshape(angle.shape)[patches.point, patches.side, patches.number]
    sums = [
        np.bincount(wheel, there * patches.force * part, angle.size // 3).reshape(-1, 2)
        for part in (patches.upright, patches.sign * patches.across)
    ]
    return sums[0] + (across * np.sin(angle)).sum(axis=-1), sums[1] + (across * np.cos(angle)).sum(axis=-1)
