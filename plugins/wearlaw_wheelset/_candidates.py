"""Places where wheels may touch their rails under load, and the gaps around them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_wheelset._motion import placed
from wearlaw_wheelset._search import BLOCK, Position, Section, Touching, gaps
from wearlaw_wheelset._search_loops import compiled_samples, normal_gap

SAMPLES = 81
"""Samples of the gap under a patch."""

SPACING = 0.25e-3
"""Distance from one sample to the next [m]; it is doubled where a patch is wider than the samples."""

SEPARATE = 0.5
"""Two bumps are patches of their own if the gap between them exceeds this share of the penetration, the share of the
virtual penetration."""

SPARE = 1.5
"""A patch is followed if its gap is at most this share of the penetration under the whole load."""


@dataclass(frozen=True)
class Candidates:
    """Places where wheels may touch under load, as arrays with one entry for each of them.

    Attributes
    ----------
    point, side, number : ndarray of int
        Index of the position, of the side (0 left, 1 right) and of the patch on its side.
    position : Position
        In outward coordinates.
    arc, gap : ndarray
        Arc length of the wheel's profile, and vertical gap there at first touching [m].
    cosine : ndarray
        cos δ there [-].
    start, step, samples : ndarray
        The gap normal to the surface around the place, above its least value [m], `samples` of shape (places, samples).
    curvature_x : ndarray
        Half the relative curvature along the rolling direction [1/m].
    """

    point: NDArray[np.intp]
    side: NDArray[np.intp]
    number: NDArray[np.intp]
    position: Position
    arc: Array
    gap: Array
    cosine: Array
    start: Array
    step: Array
    samples: Array
    curvature_x: Array

    @property
    def wheel(self) -> NDArray[np.intp]:
        """Index of the wheel among all wheels."""
        return 2 * self.point + self.side

    def part(self, rows: NDArray[Any]) -> Candidates:
        """Return some of the places."""
        found = {name: getattr(self, name)[rows] for name in self.__dataclass_fields__ if name != "position"}
        return Candidates(position=Position(*(array[rows] for array in self.position)), **found)

    def put(self, rows: NDArray[np.intp], other: Candidates) -> None:
        """Replace some of the places, in place."""
        for name in self.__dataclass_fields__:
            if name != "position":
                getattr(self, name)[rows] = getattr(other, name)
        for array, values in zip(self.position, other.position, strict=True):
            array[rows] = values

    def joined(self, other: Candidates) -> tuple[Candidates, NDArray[np.intp]]:
        """Return the places of both in the order of their positions, and which of this, then the other, each is."""
        order = np.argsort(np.concatenate([self.point, other.point]), kind="stable")
        found = {
            name: np.concatenate([getattr(self, name), getattr(other, name)])[order]
            for name in self.__dataclass_fields__
            if name != "position"
        }
        pairs = zip(self.position, other.position, strict=True)
        return Candidates(position=Position(*(np.concatenate(pair)[order] for pair in pairs)), **found), order


def candidates(section: Section, position: Position, touching: Touching) -> Candidates:
    """Return all places where wheels come close to their rails; positions are of shape (positions, sides)."""
    point, side, number = np.nonzero(~np.isnan(touching.arc))
    here = Position(*(array[point, side] for array in position))
    arc = touching.arc[point, side, number]
    place = placed(section, here, arc)
    count = arc.size
    found = Candidates(
        point, side, number, here, arc, touching.gap[point, side, number], np.cos(place.angle),
        np.empty(count), np.empty(count), np.empty((count, SAMPLES)), 0.5 * np.cos(place.angle) / place.radius,
    )  # fmt: skip
    sample(section, found, np.arange(count), SPACING)
    return found


def sample(section: Section, found: Candidates, rows: NDArray[np.intp], spacing: float) -> None:
    """Fill in, in place, the gaps around some of the places at a spacing [m]."""
    found.start[rows] = -spacing * (SAMPLES // 2)
    found.step[rows] = spacing
    if wl.accelerated(rows.size * SAMPLES):
        samples = np.empty((rows.size, SAMPLES))
        position = (np.ascontiguousarray(array[rows]) for array in found.position)
        compiled_samples(
            *position, found.arc[rows], spacing, *section.wheel_y, *section.wheel_radius, *section.rail_z, samples
        )
        found.samples[rows] = samples
        return
    offsets = spacing * (np.arange(SAMPLES) - SAMPLES // 2)
    for start in range(0, rows.size, BLOCK):
        some = rows[start : start + BLOCK]
        arc = found.arc[some, None] + offsets
        at = gaps(section, Position(*(array[some] for array in found.position)).widened(), arc)
        middle = slice(SAMPLES // 2, SAMPLES // 2 + 1)
        normal, inside = normal_gap(at.gap - at.gap[:, middle], at.rail_slope, at.rail_slope[:, middle])
        inside &= (arc >= section.wheel_y.start) & (arc <= section.wheel_y.end)
        inside &= (at.y >= section.rail_z.start) & (at.y <= section.rail_z.end)
        found.samples[some] = np.where(inside, normal, np.inf)


def separated(found: Candidates, saddle: Array, penetration: Array, share: Array) -> Candidates:
    """Return the places that are patches of their own, each with the gap on its own side of the saddles between them.

    Parameters
    ----------
    found : Candidates
    saddle : ndarray
        Vertical gap of the saddle between each place and the first one of its wheel [m].
    penetration : ndarray
        Estimate of the vertical penetration of each place's wheel [m].
    share : ndarray
        Share of the penetration that the saddle must exceed, `SEPARATE` or less.
    """
    own = (found.number == 0) | ((found.gap < SPARE * penetration) & (saddle > share * penetration))
    first = np.full(found.wheel.max(initial=-1) + 1, np.nan)
    first[found.wheel[found.number == 0]] = found.arc[found.number == 0]
    own &= (found.number == 0) | (np.abs(found.arc - first[found.wheel]) > SPACING)  # a place may be listed twice
    kept = found.part(own)
    order = np.argsort(kept.wheel, kind="stable")
    for shift in (1, 2):
        for one, other in ((order[shift:], order[:-shift]), (order[:-shift], order[shift:])):
            same = kept.wheel[one] == kept.wheel[other]
            _cut(kept, one[same], kept.arc[other[same]])
    return kept


def _cut(found: Candidates, rows: NDArray[np.intp], neighbour: Array) -> None:
    """Make the gaps infinite, in place, beyond the saddle to a neighbour at an arc length of the wheel [m]."""
    if not rows.size:
        return
    offset = found.start[rows, None] + found.step[rows, None] * np.arange(SAMPLES)
    towards = np.sign(neighbour - found.arc[rows])[:, None]
    away = offset * towards
    between = (away >= 0.0) & (away <= np.abs(neighbour - found.arc[rows])[:, None])
    samples = found.samples[rows]
    highest = np.where(between & np.isfinite(samples), samples, -np.inf).argmax(axis=-1)
    border = np.take_along_axis(away, highest[:, None], axis=-1)
    found.samples[rows] = np.where(away > border, np.inf, samples)
