"""The normal problem of a wheel on a rail by brute force: half-spaces under the gap between the surfaces in space.

It takes profiles by `Profile.curve` and shares nothing else with the plugin. Coordinates are outward ones: x along the
rail, y from the middle of the track to the field side, z down. The wheel is a surface of revolution, rolled, yawed and
moved; the gap at a place of the rail is the distance to the wheel along the rail's normal, with the wheel where it
stands under its load. Rows of elements lie along x, each with its own normal, and their distances are those of the
rail's arc: that is right where the rail turns little within the contact.

`python -m tests.plugins.wheelset.brute_force 60` writes how far predictions at as many random positions are from it;
further arguments, such as `strips=40`, are fields of the rig, and `noise=0.01` adds rigs measured with a noise [mm].
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import scipy

import wearlaw as wl
from tests.normal_half_space import pressed
from tests.plugins.wheelset.wheelsets import Body, wheelset
from wearlaw import Array, Q

FAR, REACH = 1e-3, 45e-3
"""Gap where surfaces are not looked for, and the greatest distance of contacts along the rail from the first [m]."""

TURNS = 0.2
"""Turn of the rail within a contact up to which rows by its arc are half-spaces [rad]."""


class Pressed(NamedTuple):
    """The contact of a wheel.

    Attributes
    ----------
    max_pressure, area, normal_force : float
        The greatest pressure [Pa], the area [m²] and ∫ p dA [N].
    s, force : ndarray, (rows,)
        Arc lengths of the rail's profile [m], and the force of each row per arc length [N/m].
    height : float
        How far the middle of the wheelset lies below the rails' tops, less the radius [m].
    turn : float
        How far the rail turns within the contact [rad].
    """

    max_pressure: float
    area: float
    normal_force: float
    s: Array
    force: Array
    height: float
    turn: float


class Wheel:
    """A wheel above its rail; displacement [m], yaw and roll [rad] have the signs of outward coordinates."""

    def __init__(self, pair: wl.Wheelset, displacement: float, yaw: float, roll: float) -> None:
        self.at = displacement
        self.turn = np.cos(yaw), np.sin(yaw), np.cos(roll), np.sin(roll)
        self.nominal = wl.scalar_si(pair.nominal_radius, "m")
        base = 0.5 * wl.scalar_si(pair.flange_back_distance, "m") - wl.scalar_si(pair.flange_back_position, "m")
        curve = pair.wheel.curve
        steep = np.flatnonzero(np.abs(curve.angle) > np.radians(86.0))
        kept = slice(steep[curve.y[steep] < 0.0].max(initial=-1) + 1, None)
        self.radius = scipy.interpolate.CubicHermiteSpline(
            curve.y[kept] + base, self.nominal + curve.z[kept], np.tan(curve.angle[kept])
        )
        self.slope = self.radius.derivative()
        self.rail, self.cant, self.curve = Body(pair, 1), wl.scalar_si(pair.rail_cant, "rad"), pair.rail.curve
        (e1, n1), (e2, n2) = (
            (wl.scalar_si(one.youngs_modulus, "Pa"), one.poisson_ratio)
            for one in (pair.material, pair.rail_material or pair.material)
        )
        self.roller = np.inf if pair.roller_radius is None else wl.scalar_si(pair.roller_radius, "m")
        self.modulus = 1.0 / ((1.0 - n1**2) / e1 + (1.0 - n2**2) / e2)

    def angle(self, s: Array) -> Array:
        """Return the angle of the rail at arc lengths [m] in the track [rad]."""
        return np.asarray(self.curve.at(s)[2] - self.cant)

    def gap(self, x: Array, s: Array, height: float) -> Array:
        """Return the distance from places on the rail to the wheel along the rail's normals, (x, s) [m]."""
        cos_yaw, sin_yaw, cos_roll, sin_roll = self.turn

        def turned(x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
            across = y * cos_yaw - x * sin_yaw
            return x * cos_yaw + y * sin_yaw, across * cos_roll + z * sin_roll, z * cos_roll - across * sin_roll

        y, z = self.rail.rail(s)
        lean, z = np.arcsin(x[:, None] / (self.roller - z)), self._surface(x[:, None], z)
        place = turned(x[:, None], y - self.at, z - height + self.nominal)
        upright = np.cos(self.angle(s))
        normal = turned(upright * np.sin(lean), np.sin(self.angle(s)), -upright * np.cos(lean))
        low, high = self.radius.x[[0, -1]]
        gap = over = np.zeros((x.size, s.size))
        for _ in range(50):
            along, across, down = (at + gap * way for at, way in zip(place, normal, strict=True))
            radius, across = np.hypot(along, down), np.clip(across, low, high)
            rise = (along * normal[0] + down * normal[2]) / radius - self.slope(across) * normal[1]
            over = radius - self.radius(across)
            before, gap = gap, np.clip(gap - over / np.minimum(rise, -1e-3), -FAR, FAR)
            if np.abs(gap - before).max() < 1e-10:
                break
        return np.where(np.abs(over) < 1e-9, gap, FAR)

    def _surface(self, x: Array, z: Array) -> Array:
        """Return z of the rail, or of the roller, at places whose z at x = 0 is given [m]."""
        if np.isinf(self.roller):
            return z + 0.0 * x
        radius = self.roller - z
        return np.asarray(self.roller - np.sqrt(radius**2 - x**2))

    def pressed(self, load: float, elements: int = 120) -> Pressed:
        """Return the contact under a vertical load [N], without friction.

        `elements` is their number over the overlap of the undeformed bodies, along and across.
        """
        height, cosine, first = self._touching()
        height += 0.25e-3 * (load / 90e3) ** (2.0 / 3.0) / cosine
        force, accuracy = load / cosine, 1e-3
        for count in (elements // 3, elements):
            x, s = self._grid(height, count, first)
            dx, ds, angle, pressure = x[1] - x[0], s[1] - s[0], self.angle(s), None
            for _ in range(50):
                gap = self.gap(x, s, height)
                pressure, level, _ = pressed(gap, dx, ds, self.modulus, force, 1e-2 * accuracy, pressure)
                row = dx * pressure.sum(axis=0)
                vertical = ds * float(row @ np.cos(angle))
                height += level * force / vertical
                missing, force = load / vertical - 1.0, force * load / vertical
                if abs(missing) < accuracy and abs(level) < -accuracy * gap.min():
                    break
            else:
                raise ArithmeticError("no balance")
            accuracy = 1e-5
        on = angle[row > 0.0]
        assert pressure is not None
        area = dx * ds * np.count_nonzero(pressure)
        return Pressed(float(pressure.max()), area, force, s, row, height, float(np.ptp(on)))

    def _touching(self) -> tuple[float, float, float]:
        """Return the height at which rigid bodies touch [m], the cosine of the rail's angle there, and x there [m]."""
        cos_yaw, sin_yaw, cos_roll, sin_roll = self.turn
        turn = np.arange(-0.1, 0.1, 2e-3)[:, None]
        axial = np.arange(self.radius.x[0], self.radius.x[-1], 0.1e-3)
        radius = self.radius(axial)
        out = axial * cos_roll - radius * np.cos(turn) * sin_roll
        down = axial * sin_roll + radius * np.cos(turn) * cos_roll - self.nominal
        x, y = radius * np.sin(turn) * cos_yaw - out * sin_yaw, radius * np.sin(turn) * sin_yaw + out * cos_yaw
        y += self.at
        table = np.linspace(self.rail.first, self.rail.last, 4001)
        y_rail, z_rail = self.rail.rail(table)
        beside = (y < y_rail[0]) | (y > y_rail[-1])
        free = np.where(beside, np.inf, self._surface(x, np.interp(y, y_rail, z_rail))) - down
        first = np.unravel_index(free.argmin(), free.shape)
        return float(free[first]), float(np.cos(self.angle(np.interp(y[first], y_rail, table)))), float(x[first])

    def _grid(self, height: float, count: int, first: float) -> tuple[Array, Array]:
        """Return places x and s [m] of elements over the overlap of the undeformed bodies and two beyond."""
        steps = 1e-3, 0.1e-3
        x, s = np.arange(first - REACH, first + REACH, steps[0]), np.arange(self.rail.first, self.rail.last, steps[1])
        over = self.gap(x, s, height) < 0.0
        lengths = over.sum(axis=0).max(), over.any(axis=0).sum()
        places = x[over.any(axis=1)], s[over.any(axis=0)]
        fine = [step * (length + 1) / count for step, length in zip(steps, lengths, strict=True)]
        along, across = (
            np.arange(at[0] - step - 2.0 * d, at[-1] + step + 2.0 * d, d)
            for at, step, d in zip(places, steps, fine, strict=True)
        )
        return along, across


class Position(NamedTuple):
    """A position of a wheelset: its name, the rig, displacement [m], yaw [rad] and load of each wheel [N]."""

    name: str
    pair: wl.Wheelset
    displacement: float
    yaw: float
    load: float


def worn(profile: wl.Profile, *bumps: tuple[float, float, float]) -> wl.Profile:
    """Return a profile after wear by bells, each of a place, a width and a depth [mm]."""
    s = 1e3 * profile.curve.s
    depth = sum(deep * np.exp(-(((s - at) / wide) ** 2)) for at, wide, deep in bumps)
    return profile.worn(Q(s, "mm"), Q(np.asarray(depth), "mm"))


def measured(profile: wl.Profile, noise: float, rng: np.random.Generator) -> wl.Profile:
    """Return a profile from points 0.2 mm apart with a noise [mm], smoothed by as much."""
    y, z, angle, _ = profile.curve.at(np.arange(profile.curve.s[0], profile.curve.s[-1], 0.2e-3))
    off = rng.normal(0.0, 1e-3 * noise, y.size)
    y, z = y - off * np.sin(angle), z + off * np.cos(angle)
    return wl.Profile.from_points(y=Q(1e3 * y, "mm"), z=Q(1e3 * z, "mm"), kind=profile.kind, smoothing=Q(noise, "mm"))


def positions(count: int, seed: int = 54, noise: float = 0.0, **fields: Any) -> Iterator[Position]:
    """Yield random positions, with the rig's fields: a third new, the others worn by up to 2 mm.

    Wear of treads, roots and rails overlaps, and leaves two humps where it is narrow. With a noise [mm], each rig comes
    twice: as it is, and measured.
    """
    rng = np.random.default_rng(seed)
    for index in range(count):
        wheel, rail, name = wl.Profile.s1002(), wl.Profile.uic60(), "new"
        tread, root, head, corner = rng.uniform(0.0, [2.0, 1.0, 1.0, 1.0])
        wide = rng.uniform(8.0, 20.0, 2)
        if index % 3:
            wheel = worn(wheel, (rng.uniform(-5.0, 5.0), wide[0], tread), (-38.0, 6.0, root))
            rail = worn(rail, (rng.uniform(-5.0, 5.0), wide[1], head), (-32.0, 6.0, corner))
            name = f"worn {tread:.1f} {root:.1f} {head:.1f} {corner:.1f}"
        at = rng.uniform(-7.5e-3, 7.5e-3), rng.uniform(-12e-3, 24e-3), rng.uniform(10e3, 90e3)
        yield Position(name, wheelset(wheel=wheel, rail=rail, **fields), *at)
        if noise:
            rough = wheelset(wheel=measured(wheel, noise, rng), rail=measured(rail, noise, rng), **fields)
            yield Position("measured", rough, *at)


class Difference(NamedTuple):
    """A prediction for a wheel beside brute force: the pressure and the area, less one, the share of the force in other
    places, the shift along the rail that leaves the least [m], and the vertical load over that asked for, less one."""

    pressure: float
    area: float
    misplaced: float
    shift: float
    load: float


def difference(problem: Any, side: int, due: Pressed, load: float) -> Difference:
    """Return how the problem of one position of a wheelset differs on a side, 0 or 1."""
    exists, strips = problem.exists[side], problem.strips
    middle, way = problem.bodies["rail"].profile_position[side][exists], 2.0 * side - 1.0
    sums = []
    for place, y, width, force in zip(
        middle, strips.y[side][exists], strips.width[side][exists], strips.normal_force[side][exists], strict=True
    ):
        y, width, force = (array[width > 0.0] for array in (y, width, force))  # without strips that only fill up
        order = np.argsort(way * y)
        borders = place + way * y[order][0] + np.concatenate([[0.0], np.cumsum(width[order])]) - 0.5 * width[order][0]
        sums.append((borders, np.concatenate([[0.0], np.cumsum(force[order])])))
    step = due.s[1] - due.s[0]
    loaded = due.s[due.force > 0.0]
    edges = np.linspace(loaded[0] - 0.5 * step, loaded[-1] + 0.5 * step, 21)
    total = step * np.concatenate([[0.0], np.cumsum(due.force)])
    expected = np.diff(np.interp(edges, np.append(due.s, due.s[-1] + step) - 0.5 * step, total), prepend=0.0)
    best = np.inf, 0.0
    for shift in np.linspace(-0.1e-3, 0.1e-3, 41):
        below = sum(
            scipy.interpolate.PchipInterpolator(at, force)(np.clip(edges + shift, at[0], at[-1])) for at, force in sums
        )
        found = np.diff(np.asarray(below), prepend=0.0)
        best = min(best, (float(0.5 * np.abs(found - expected).sum() / due.normal_force), shift))
    return Difference(
        float(np.nanmax(problem.max_pressure[side]) / due.max_pressure - 1.0),
        float(np.nansum(strips.area[side]) / due.area - 1.0),
        *best,
        float(np.nanmax(problem.wheel_load[side])) / load - 1.0,
    )


def compared(position: Position, model: str = "fastsim") -> Iterator[tuple[Pressed, Difference | None]]:
    """Yield the left and the right wheel by brute force, without friction and at the roll of the prediction.

    The difference is None where the prediction has no result.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        problem: Any = (position.pair | wl.contact_model(model)).posed({
            "lateral_displacement": Q(1e3 * position.displacement, "mm"), "yaw": Q(1e3 * position.yaw, "mrad"),
            "vertical_load": Q(1e-3 * position.load, "kN"), "friction_coefficient": 1e-7,
        })  # fmt: skip
    roll = 0.0 if np.isnan(problem.roll).all() else np.nanmax(problem.roll)
    for side, way in ((0, -1.0), (1, 1.0)):
        due = Wheel(position.pair, way * position.displacement, way * position.yaw, way * roll).pressed(position.load)
        yield due, difference(problem, side, due, position.load) if problem.exists[side].any() else None


def main(count: int, noise: float = 0.0, **fields: Any) -> None:
    """Print the wheels of random positions, and the worst differences where rows by the rail's arc are half-spaces."""
    head = [
        "rig: wear of tread, root, head, corner [mm]", "side", "u [mm]", "yaw [mrad]", "load [kN]", "p [MPa]",
        "area [mm²]", "peaks", "turn [rad]", "Δp [%]", "Δarea [%]", "misplaced [%]", "shift [mm]", "Δload",
        *(["p less that of the smooth rig [%]"] if noise else []),
    ]  # fmt: skip
    print("|", " | ".join(head), "|\n" + len(head) * "|-" + "|")
    found, smooth, apart = [], [0.0, 0.0], []
    for position in positions(count, noise=noise, **fields):
        heights = []
        for side, (due, off) in enumerate(compared(position)):
            heights.append(due.height)
            inner = due.force[1:-1]
            peaks = np.count_nonzero((inner > due.force[:-2]) & (inner >= due.force[2:]) & (inner > 0.1 * inner.max()))
            cells = [position.name, "left" if side == 0 else "right", f"{1e3 * position.displacement:.2f}"]
            cells += [f"{1e3 * position.yaw:.1f}", f"{1e-3 * position.load:.1f}", f"{1e-6 * due.max_pressure:.0f}"]
            cells += [f"{1e6 * due.area:.1f}", f"{peaks}", f"{due.turn:.2f}"]
            if off is None:
                cells += ["none"]
            else:
                cells += [f"{100.0 * value:.2f}" for value in off[:3]] + [f"{1e3 * off.shift:.3f}", f"{off.load:.0e}"]
                if due.turn <= TURNS:
                    found.append(off)
            if position.name == "measured" and off is not None:
                own = due.max_pressure / smooth[side] - 1.0
                cells.append(f"{100.0 * ((1.0 + own) * (1.0 + off.pressure) - 1.0):.2f}, brute force {100.0 * own:.2f}")
            smooth[side] = smooth[side] if position.name == "measured" else due.max_pressure
            print("|", " | ".join(cells), "|", flush=True)
        apart.append(abs(heights[1] - heights[0]))
    values = 100.0 * np.abs(np.array(found))[:, :3]
    worst, mean = values.max(axis=0).round(2), np.sqrt((values**2).mean(axis=0)).round(2)
    print(f"\nΔp, Δarea, misplaced [%] of {len(found)} wheels that turn by {TURNS:g} rad or less: {worst}, rms {mean}.")
    print(
        f"Heights of both wheels: {1e6 * np.median(apart):.2f} µm apart in the median, {1e6 * max(apart):.1f} at most."
    )


if __name__ == "__main__":
    given = dict(argument.split("=") for argument in sys.argv[2:])
    main(int(sys.argv[1]), float(given.pop("noise", 0.0)), **given)
