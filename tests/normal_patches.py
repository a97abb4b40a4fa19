"""Patches of wheels and rails by virtual penetration and by Hertz, beside half-spaces.

`python -m tests.normal_patches` writes docs/wheelset/patches.csv.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy

from tests import wheel_on_rail
from tests.normal_half_space import Contact, pressed
from wearlaw import Array
from wearlaw_models.rigs.wheelset.normal import HertzPatch, StripPatch, hertz, penetrated  # private: patches of any gap

FILE = Path(__file__).parents[1] / "docs" / "wheelset" / "patches.csv"
HEAD = ("gap", "N [kN]", "p0 [MPa]", "KPEC", "Hertz", "area [mm²]", "KPEC", "Hertz", "δ [µm]", "KPEC", "Hertz")
MODULUS = 82e9 / (1.0 - 0.28)
ALONG = 1.0 / (2.0 * 0.46)
"""A of a wheel with the radius 460 mm on a straight rail [1/m]."""

MANCHESTER = {
    "S1002 on 60E1, tread, 3 mm": (-3.0, 0.1145, 1.803e-4, -7.2e-3, -0.0110, 757.2358),
    "S1002 on 60E1, centred": (0.0, 0.1981, 0.0, 0.0, -0.0290, 751.8726),
    "S1002 on 60E1, 0.5 mm": (0.5, 0.1938, -2.304e-5, 1.2e-3, -0.0568, 744.5026),
    "S1002 on 60E1, 1 mm": (1.0, 0.1839, -5.049e-5, 2.4e-3, -0.0696, 741.9908),
    "S1002 on 60E1, 2 mm": (2.0, 0.1529, -1.128e-4, 4.8e-3, -0.0806, 740.9147),
    "S1002 on 60E1, 5 mm": (5.0, 0.0015, -3.554e-4, 1.2e-2, -0.2905, 727.0855),
    "S1002 on 60E1, 6 mm": (6.0, -0.1961, -6.272e-4, 1.44e-2, -0.4176, 725.1371),
    "S1002 on 60E1, flange root, 8.5 mm": (8.5, -6.8687, -9.408e-3, 2.04e-2, -0.9065, 720.1709),
}
"""Position of the wheelset (y and z in mm, roll, yaw), angle of the plane of contact and its place on the track [mm].

Right wheel, but for the first, which is the left one, mirrored. From the Manchester contact benchmark, case A-2.2, as
computed with CONTACT (examples/mbench_a22_right.inp and .ref_out, mbench_a22_left.ref_out).
"""


class Patch(NamedTuple):
    """A patch: on half-spaces, by virtual penetration and by Hertz with the curvature at the deepest point."""

    full: Contact
    strips: StripPatch
    hertz: HertzPatch


def loaded(
    start: list[float], step: list[float], gap: Array, curvature_x: list[float], modulus: float, force: list[float]
) -> StripPatch:
    """Return the patch by virtual penetration that carries a force, at the smallest penetration that does."""

    def patch(penetration: float) -> StripPatch:
        return penetrated(start, step, gap, curvature_x, modulus, [penetration])

    def excess(logarithm: float) -> float:
        return float(np.log(patch(np.exp(logarithm)).normal_force[0] / force[0]))

    sphere = np.log(np.cbrt(1.125 * (force[0] / modulus) ** 2 * curvature_x[0]))
    above = next(one for one in np.linspace(sphere - 3.0, sphere + 3.0, 121) if excess(one) > 0.0)
    return patch(float(np.exp(scipy.optimize.brentq(excess, above - 0.05, above, xtol=1e-11))))


def smooth(gap: Callable[[Array], Array], curvature: float, force: float, elements: int = 80) -> Patch:
    """Return the patch of a gap that is a function of t [m], under a force."""
    ellipse = hertz(np.array([ALONG]), np.array([curvature]), MODULUS, np.array([force]))
    step = 0.02 * ellipse.b[0]
    t = step * (np.arange(401) - 200.0)
    strips = loaded([t[0]], [step], gap(t)[None], [ALONG], MODULUS, [force])
    edge, wide = strips.y[0, [0, -1]], strips.width.sum()
    y = np.linspace(edge[0] - 0.2 * wide, edge[1] + 0.2 * wide, elements)
    x = np.linspace(-1.35, 1.35, elements) * strips.half_length.max()
    full = pressed(ALONG * x[:, None] ** 2 + gap(y), x[1] - x[0], y[1] - y[0], MODULUS, force)
    return Patch(full, strips, ellipse)


def joined(place: float, force: float) -> Patch:
    """Return the patch of a cone that touches the uncanted 60E1 rail at a distance from its axis [m]."""
    centres, radii, ends = [(0.0, 0.3)], (0.3, 0.08, 0.013), (0.0105, 0.026)
    for radius, smaller, end in zip(radii, radii[1:], ends, strict=False):
        (middle, top), slope = centres[-1], (end - centres[-1][0]) / radius
        centres.append((middle + (radius - smaller) * slope, top - (radius - smaller) * np.sqrt(1.0 - slope**2)))

    def arc(y: Array) -> tuple[Array, Array, Array]:
        number = np.searchsorted(ends, np.abs(y))
        (middles, depths), radius = np.array(centres)[number].T, np.array(radii)[number]
        sine = (np.abs(y) - middles) / radius
        return depths - radius * np.sqrt(1.0 - sine**2), sine * np.sign(y), radius

    drop, sine, radius_there = arc(np.array([place]))
    cosine = np.sqrt(1.0 - sine**2)
    y = np.linspace(place - 0.025, min(place + 0.025, 0.0355), 40001)
    depth = arc(y)[0] - drop
    t, height = (y - place) * cosine + depth * sine, depth * cosine - (y - place) * sine
    return smooth(lambda v: np.interp(v, t, height), 0.5 / float(radius_there[0]), force)


def quartic(curvature: float, cubic: float, fourth: float, force: float) -> Patch:
    """Return the patch of the gap B t² (1 + c v + q v²), where v is t over Hertz's b."""
    b = hertz(np.array([ALONG]), np.array([curvature]), MODULUS, np.array([force])).b[0]
    return smooth(lambda t: curvature * t**2 * (1.0 + cubic * (t / b) + fourth * (t / b) ** 2), curvature, force)


def wheel(position: tuple[float, ...], force: float) -> Patch:
    """Return the patch of an S1002 wheel on a canted 60E1 rail."""
    y, z, roll, yaw, angle, at = position
    spacing, wide = next(
        grid for least, grid in ((0.6, (0.05, 4.0)), (0.2, (0.1, 12.0)), (0.0, (0.1, 16.0))) if abs(angle) > least
    )
    gap = wheel_on_rail.gap(y, z, roll, yaw, angle=angle, at=at, step=spacing, half_width=wide, half_length=10.0)
    step, across, curvature = 1e-3 * (gap.t[1] - gap.t[0]), 1e-3 * gap.across, 1e3 * gap.curvature
    strips = loaded([1e-3 * gap.t[0]], [step], across[None], [curvature], MODULUS, [force])
    near = across.argmin() + np.arange(-3, 4)
    local = np.polyfit(1e-3 * gap.t[near], across[near], 2)[0]
    full = pressed(1e-3 * gap.height, step, step, MODULUS, force)
    return Patch(full, strips, hertz(np.array([curvature]), np.array([local]), MODULUS, np.array([force])))


def cases() -> Iterator[tuple[str, float, Callable[[], Patch]]]:
    """Yield the name, the force and the solution of each row."""
    for name, place in (
        ("cone on R 300", 0.0),
        ("cone on R 300, 1.5 mm beside R 80", 0.009),
        ("cone on R 80, at R 300", 0.01051),
        ("cone on R 80, 1.5 mm beside R 300", 0.012),
        ("cone on R 80, at R 13", 0.02599),
        ("cone on R 13, 1 mm beside R 80", 0.027),
    ):
        yield name, 8e4, partial(joined, place, 8e4)
    for bend, cubic, fourth in ((0.3, 0.0, 0.5), (1.0, 0.0, 0.5), (6.0, 0.0, 0.5), (30.0, 0.0, 0.5), (6.0, 0.4, 0.4)):
        name = f"B = {bend:g}/m: B t² (1 + {cubic:g} v + {fourth:g} v²)"
        yield name, 8e4, partial(quartic, bend, cubic, fourth, 8e4)
    for name, position in MANCHESTER.items():
        for force in (1e4, 8e4) if abs(position[0]) < 5.0 else (1e4,):
            yield name, force, partial(wheel, position, force)


def row(name: str, force: float, patch: Patch) -> list[str]:
    """Return a row of the file: values on half-spaces, and how far the others are off."""
    full, strips, ellipse = patch
    cells = [name, f"{force / 1e3:g}"]
    for value, unit, others in (
        (full.pressure.max(), 1e6, (strips.max_pressure, ellipse.max_pressure)),
        (full.area, 1e-6, (strips.area, np.pi * ellipse.a * ellipse.b)),
        (full.penetration, 1e-6, (strips.penetration, ellipse.penetration)),
    ):
        cells += [f"{value / unit:.4g}", *(f"{100.0 * (other[0] / value - 1.0):+.0f} %" for other in others)]
    return cells


def write() -> None:
    """Write the file."""
    FILE.parent.mkdir(exist_ok=True)
    with FILE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEAD)
        for name, force, solve in cases():
            writer.writerow(row(name, force, solve()))
            file.flush()


if __name__ == "__main__":
    write()
