"""The normal problem of a patch on elastic half-spaces, solved element by element.

Where the bodies touch, the displacement by the pressure closes the gap and the approach δ is used up; elsewhere the
pressure is zero:

    g(x, t) + 1/(π E*) ∫∫ p/√((x - x')² + (t - t')²) dx' dt' = δ  where p > 0,  ≥ δ  where p = 0.

The pressure is constant on rectangles (A. E. H. Love, Phil. Trans. R. Soc. Lond. A 228 (1929) 377-420), and conjugate
gradients find it together with the area of contact, with products by FFT (I. A. Polonsky and L. M. Keer, Wear 231
(1999) 206-219). Elements lie on multiples of their size from the contact point, and their size follows the area in
which the undeformed bodies overlap. So the force is a continuous function of δ, and on an ellipse the error of its
grid does not depend on δ.

The gap of a wheel is g(t) + A(t) (x - x_m(t))², with the place x_m of the least gap, which yaw moves along the rail. A
row of elements with the force per width q and the maximum pressure p0 becomes a strip of half the length 2q/(π p0),
which it has if its pressure is half an ellipse, as on Hertz's patch. Strips lie about x = 0: x_m is left out of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from wearlaw import Array
from wearlaw_wheelset._candidates import Candidates
from wearlaw_wheelset._motion import curvature_along, placed
from wearlaw_wheelset._search import Section, gaps

FAR = 1e3
"""Gap where the bodies are sure not to touch, over the approach."""

ACCURACY = 1e-9
"""Greatest gap within the area of contact that is left over, over the approach."""

ITERATIONS = 500
"""Greatest number of iterations; 15 to 40 are usual."""

NEWTON = 3
"""Steps to the distance of a wheel from its rail along the normal: a tenth of a millimetre to 1e-9 m."""

FLOOR = 1e-6
"""Pressure and length of strips that do not touch, over the greatest ones."""


class Rows(NamedTuple):
    """Rows of elements of a patch, and its pressure.

    Attributes
    ----------
    y, half_length, max_pressure : ndarray
        Place across the patch from the contact point, half the length [m] and the maximum pressure [Pa] of each row.
    width : float
        Width of a row [m].
    rail_y : float
        Place of the centre of the pressure on the rail, in the axes of `Gaps.y` [m].
    angle : float
        Contact angle, the mean over the pressure [rad].
    pressure : ndarray, (along x, along y)
        Pressure of the elements [Pa].
    middle, own : int
        Indices of the contact point among them.
    """

    y: Array
    half_length: Array
    max_pressure: Array
    width: float
    rail_y: float
    angle: float
    pressure: Array
    middle: int
    own: int


def rows(
    section: Section, place: Candidates, depth: float, modulus: float, count: int, start: Rows | None = None
) -> Rows:
    """Return the rows of the patch of one place at a penetration along its normal.

    Parameters
    ----------
    section : Section
    place : Candidates
        One place.
    depth : float
        Approach along the normal, δ [m].
    modulus : float
        Effective modulus, E* [Pa].
    count : int
        Number of rows over the width in which the undeformed bodies overlap, and of elements over its length. Those
        rows that touch are about two thirds of them.
    start : Rows, optional
        Those of a penetration close by; they save iterations.
    """
    spacing, samples = float(place.step[0]), place.samples[0]
    rise = np.sqrt(samples) - np.sqrt(depth)  # linear from sample to sample where the gap is a parabola
    within, beyond = (np.maximum(one[:-1], 0.0) + np.maximum(one[1:], 0.0) for one in (-rise, rise))
    dy = spacing * float((within / (within + beyond)).sum()) / count
    dx = 2.0 * np.sqrt(depth / float(place.curvature_x[0])) / count
    low, high = place.start[0] + spacing * (np.flatnonzero(rise < 0.0)[[0, -1]] + (-1.0, 1.0))
    y = dy * np.arange(np.floor(low / dy) - count // 2, np.ceil(high / dy) + count // 2)
    own = int(np.abs(y).argmin())
    arc = place.arc_at(y[None])[0]
    at, there = gaps(section, place.position, arc), placed(section, place.position, arc)
    shift, turn = at.x - at.x[own], float(there.angle[own])
    # The wheel is lowered, not pressed along its normal, and the gap taken along the normal.
    vertical, distance = at.gap - at.gap[own] - depth / np.cos(turn), np.zeros(y.shape)
    for _ in range(NEWTON):
        rail, slope = section.rail_z.at(at.y - distance * np.sin(turn))
        left = vertical + rail - section.rail_z.at(at.y)[0] - distance * np.cos(turn)
        distance += left / (np.cos(turn) + slope * np.sin(turn))
    height = distance + depth
    known = np.isfinite(place.between(place.samples, y[None])[0]) & (np.abs(y) < -place.start[0])
    height = np.where(known, height, FAR * depth)
    if not (height < depth).any():  # on the way to a balance, the contact point may lie beyond the known surfaces
        height[own - 1 : own + 2] = 0.0
    bend = 0.5 * curvature_along(section, place.position, there, arc) / np.cos(there.angle - turn)
    near = height < depth
    middle = int((np.abs(shift[near]) + np.sqrt((depth - height[near]) / bend[near])).max() / dx) + 1
    x = dx * np.arange(-middle, middle + 1.0)[:, None]
    gap = np.where(near, height + bend * (x - shift) ** 2, FAR * depth)

    pressure, guess = np.zeros(gap.shape), None if start is None else _moved(start, gap.shape, middle, own)
    inside = slice(near.argmax(), near.size - near[::-1].argmax())
    first = None if guess is None or not guess[:, inside].any() else guess[:, inside]
    pressure[:, inside] = pressed(gap[:, inside], dx, dy, modulus, depth, first)
    most = pressure.max(axis=0)
    kept = np.sort(np.argsort(np.where(most > 0.0, most, -height))[-count:])
    force, most = dx * pressure.sum(axis=0)[kept], np.maximum(most[kept], FLOOR * most.max())
    half_length = 2.0 / np.pi * force / most
    half_length = np.maximum(half_length, FLOOR * half_length.max())
    share = force / force.sum()
    # The pressed wheel overlaps the rail, and on a slope the surfaces' points on a normal then differ in y.
    foot = np.interp(share @ y[kept], y[kept], (at.y - distance * np.sin(turn))[kept])
    return Rows(y[kept], half_length, most, dy, float(foot), float(share @ there.angle[kept]), pressure, middle, own)


def _moved(start: Rows, shape: tuple[int, ...], middle: int, own: int) -> Array:
    """Return a pressure on another grid, by elements from the contact point."""
    found = np.zeros(shape)
    new, old = [], []
    for size, other, at, was in zip(shape, start.pressure.shape, (middle, own), (start.middle, start.own), strict=True):
        before, after = min(at, was), min(size - at, other - was)
        new.append(slice(at - before, at + after))
        old.append(slice(was - before, was + after))
    found[tuple(new)] = start.pressure[tuple(old)]
    return found


def pressed(gap: Array, dx: float, dy: float, modulus: float, approach: float, start: Array | None = None) -> Array:
    """Return the pressure of half-spaces on the elements of a grid, (along x, along y) [Pa].

    Parameters
    ----------
    gap : ndarray, (along x, along y)
        Gap of the undeformed bodies as they touch [m]. The grid reaches beyond the patch.
    dx, dy : float
        Size of an element [m].
    modulus : float
        Effective modulus, E* [Pa].
    approach : float
        Approach of the bodies from first touching, δ [m].
    start : ndarray, optional
        A guess of the pressure.

    Raises
    ------
    NumericsError
        If no solution is found.
    """
    nx, ny = gap.shape
    shape = scipy.fft.next_fast_len(2 * nx - 1, real=True), scipy.fft.next_fast_len(2 * ny - 1, real=True)
    x, y = (dx * (np.arange(nx + 1) - 0.5))[:, None], dy * (np.arange(ny + 1) - 0.5)
    corner = x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))
    quarter = np.diff(np.diff(corner, axis=0), axis=1) / (np.pi * modulus)
    kernel = np.zeros(shape)
    kernel[:nx, :ny] = quarter
    kernel[-nx + 1 :, :ny] = quarter[:0:-1]
    kernel[:, -ny + 1 :] = kernel[:, ny - 1 : 0 : -1]
    transform = scipy.fft.rfft2(kernel)

    def displaced(pressure: Array) -> Array:
        product = transform * scipy.fft.rfft2(pressure, s=shape)
        moved: Array = scipy.fft.irfft2(product, s=shape)[:nx, :ny]
        return moved

    def overlap() -> Array:
        """Return a first pressure, with the displacement of the bodies where they overlap most."""
        least = gap.min()  # far from zero where the deepest point is not that of first touching
        root = np.sqrt(np.maximum(0.5 * (approach + (least if least > 0.5 * approach else 0.0)) - gap, 0.0))
        return np.asarray(root * ((approach - least) / displaced(root).max()))

    pressure = overlap() if start is None else start
    rest, small = displaced(pressure) + gap - approach, ACCURACY * approach
    step, before = np.zeros_like(gap), np.inf
    for _ in range(ITERATIONS):
        touches = pressure > 0.0
        if np.abs(rest[touches]).max() < small and rest[~touches].min(initial=0.0) > -small:
            return pressure
        norm = float(np.square(rest[touches]).sum())
        step = np.where(touches, rest + norm / before * step, 0.0)
        moved = displaced(step)
        length = float((rest * step).sum() / (moved * step).sum())
        trial, before = pressure - length * step, norm
        again = (trial <= 0.0) & (rest < -small)
        if again.any() or (trial < 0.0).any():
            pressure = np.maximum(np.where(again, pressure - length * rest, trial), 0.0)
            if not pressure.any():  # the guess was far too high
                pressure = overlap()
            rest = displaced(pressure) + gap - approach
            before = np.inf if again.any() else norm
        else:
            pressure, rest = trial, rest - length * moved
    raise ArithmeticError(f"no pressure on half-spaces was found in {ITERATIONS} iterations")
