"""The pressure between wheels and rails, as one convex problem for each wheel.

Rows lie across the area of contact, and elements of constant pressure along each row about its crest. Where bodies
touch, the displacements of half-spaces take up what their undeformed shapes overlap; elsewhere there is no pressure:

    ∑ A_ij p_j = o_i + C_i·d  where p_i > 0,  ≥ o_i + C_i·d  where p_i = 0.

A is the displacement of E. H. Love, Phil. Trans. R. Soc. Lond. A 228 (1929) 377-420, at the straight distance of two
elements in space. Rows at different angles move each other by the cosine of the difference of their angles, and not at
all beyond a right angle: an assumption, since two half-spaces have one plane. The displacement d of the wheelset, such
as the height of its axle and its roll, is what carries the loads, ∑ w_i F_i = Q.

The problem has one solution. It is sought directly: solve for the elements that touch and for d together, leave out
those that pull, take in those that overlap, until neither is left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.rows import Rows

NEAR = 2.5
"""Distance of two elements, over the longer side of one, beyond which two terms of a series give the displacement, with
an error of 1e-3 of it. Near elements are as far apart as the rail's arc between them."""

TOGETHER, MOST = 8, 60
"""Solutions in which elements leave and join together, and the greatest number of solutions; three to six are usual."""

EVEN = 1e-12
"""Difference of distances that is rounding [m]."""

SLACK = 1e-6
"""Overlap that may be left where there is no pressure, over the greatest one of the undeformed bodies."""

BEGINS, JOIN, EARLY = 0.6, 0.5, 3
"""Share of the greatest overlap from which elements touch in the first guess; and of the greatest overlap that is left,
from which they join at the first solutions. On an area that grows, fewer leave it again."""

LONGEST = 1.0
"""Most by which a step changes the overlap anywhere, over the greatest overlap."""

LOOPS = 400
"""Passes of NumPy over one wheel, to judge whether compiled loops are worth while."""

INTS, VECTOR, ROWS = "int64[::1]", "float64[::1]", "float64[:, ::1]"


@dataclass
class Pressed:
    """Elements of wheels and what is known of their pressure; the elements of a wheel are one piece of each array.

    Attributes
    ----------
    rows : Rows
    rates, weights : ndarray, (rows, unknowns)
        Rates of the overlap with the unknown displacements, and what the force of a row adds to the loads.
    first, table : ndarray of int, (wheels + 1,)
        First element of each wheel, and the first number of its influences.
    influence : ndarray
        Displacements of rows by unit forces per length on rows, over the distance along x [m²/N].
    row : ndarray of int, (elements,)
        Row of each element.
    x, shape : ndarray, (elements,)
        Place along the rail from the crest, and the overlap as rows were laid [m].
    on : ndarray of bool, (elements,)
        Which elements touch.
    response : ndarray, (elements, 1 + unknowns)
        Pressure where they touch, otherwise the overlap that is left, as a linear function of the displacements.
    fresh : ndarray of bool, (wheels,)
        Whether the elements that touch have changed since the response was found.
    moved : ndarray, (positions, unknowns)
        The displacements.
    """

    rows: Rows
    modulus: float
    rates: Array
    weights: Array
    first: NDArray[np.intp]
    table: NDArray[np.intp]
    influence: Array
    row: NDArray[np.intp]
    column: NDArray[np.intp]
    x: Array
    shape: Array
    on: NDArray[np.bool_]
    response: Array
    fresh: NDArray[np.bool_]
    moved: Array

    @classmethod
    def begun(cls, rows: Rows, modulus: float, rates: Array) -> Pressed:
        """Return elements for rows, of which those touch that overlap much."""
        size, columns = np.diff(rows.start), rows.columns
        both = rows.half[rows.wheel]
        of_row = np.where(both, rows.own, 2 * rows.own)
        row = np.repeat(np.arange(rows.wheel.size), of_row)
        column = np.arange(row.size) - np.repeat(np.cumsum(of_row) - of_row, of_row)
        column += np.where(both, 0, columns[rows.wheel] // 2 - rows.own)[row]
        wheel = rows.wheel[row]
        x = rows.dx[wheel] * (column + np.where(rows.half, 0.5, 0.5 - 0.5 * columns)[wheel])
        shape = rows.overlap[row] - rows.curvature[row] * x * x
        first = np.searchsorted(wheel, np.arange(size.size + 1))
        table = np.concatenate([[0], np.cumsum(size**2 * np.where(rows.half, 3 * columns - 1, 2 * columns - 1))])
        top = np.maximum.reduceat(shape, first[:-1])
        return cls(
            rows, modulus, rates, np.zeros((rates.shape[0], 2)), first, table, np.empty(0), row, column, x, shape,
            shape >= top[wheel] - (1.0 - BEGINS) * np.abs(top[wheel]), np.zeros((row.size, 1 + rates.shape[1])),
            np.ones(size.size, dtype=np.bool_), np.zeros((size.size // 2, rates.shape[1])),
        )  # fmt: skip

    def copy(self) -> Pressed:
        """Return a copy whose pressure changes on its own."""
        names = "weights", "on", "response", "fresh", "moved"
        return replace(self, **{name: getattr(self, name).copy() for name in names})

    def _influence(self) -> Array:
        """Return the influences, which are kept until they are taken away."""
        if not self.influence.size:
            self.influence = np.empty(self.table[-1])
            rows = self.rows
            arrays = rows.y, rows.z, rows.place.rail_arc, rows.place.angle, rows.width, rows.place.x
            given = (
                rows.start, *arrays, rows.dx, rows.columns, rows.half, self.modulus, self.table, self.influence,
            )  # fmt: skip
            (influence_loop if wl.accelerated(LOOPS * rows.dx.size) else influences)(*given)
        return self.influence

    @property
    def pressure(self) -> Array:
        """The pressure of the elements [Pa]."""
        return np.where(self.on, self._now(), 0.0)

    def _now(self) -> Array:
        moved = self.moved[self.rows.wheel[self.row] // 2]
        now: Array = self.response[:, 0] + (self.response[:, 1:] * moved).sum(axis=-1)
        return now

    def overlap(self) -> Array:
        """Return the overlap of the undeformed bodies in rows [m]."""
        rows = self.rows
        overlap: Array = rows.overlap + (self.rates * self.moved[rows.wheel // 2]).sum(axis=-1)
        return overlap

    def peaks(self) -> tuple[Array, Array]:
        """Return the maximum pressure of rows [Pa] and the middle of their pressure along the rail [m].

        Over the square of x, the square of the pressure of half an ellipse is a line, so the maximum is that of a
        parabola of squares over the greatest one and its neighbours.
        """
        rows, pressure = self.rows, self.pressure
        square = pressure**2
        begins = np.flatnonzero(np.diff(self.row, prepend=-1))
        before, after = np.roll(square, 1), np.roll(square, -1)
        before[begins] = np.where(rows.half[rows.wheel], square[begins], 0.0)
        after[begins - 1] = 0.0
        bend = 2.0 * square - before - after
        top = (square > 0.0) & (square >= before) & (square >= after)
        peak = np.where(top, square, 0.0)
        np.add(peak, (after - before) ** 2 / (8.0 * np.where(bend > 0.0, bend, np.inf)), out=peak, where=top)
        most = np.sqrt(np.maximum.reduceat(peak, begins))
        sums = np.add.reduceat(pressure, begins)
        offset = np.add.reduceat(pressure * self.x, begins) / np.where(sums > 0.0, sums, 1.0)
        return most, rows.place.x + np.where(rows.half[rows.wheel], 0.0, offset)

    @property
    def forces(self) -> Array:
        """Forces of the rows as linear functions of the displacements, (rows, 1 + unknowns)."""
        rows = self.rows
        area = (np.where(rows.half, 2.0, 1.0) * rows.dx)[rows.wheel] * rows.width
        begins = np.flatnonzero(np.diff(self.row, prepend=-1))
        forces: Array = np.add.reduceat(np.where(self.on[:, None], self.response, 0.0), begins)
        return forces * area[:, None]

    def carry(self, load: Array) -> None:
        """Find the pressure and the displacements that carry loads, (positions, unknowns) [N]."""
        rows, wheel = self.rows, self.rows.wheel[self.row]
        deepest = rows.deepest.reshape(-1, 2).max(axis=-1)
        point, slack = rows.start[:-1:2], SLACK * deepest[wheel // 2]
        for number in range(MOST):
            self._respond()
            forces = self.forces
            sums = np.add.reduceat(self.weights[:, :, None] * forces[:, None, :], point)
            step = np.zeros(self.moved.shape)
            held = load.shape[1]
            found = np.linalg.solve(sums[..., 1 : 1 + held], (load - sums[..., 0])[..., None])[..., 0]
            step[:, :held] = found - self.moved[:, :held]
            most = np.maximum.reduceat(np.abs((self.rates * step[rows.wheel // 2]).sum(axis=-1)), point)
            share = np.minimum(LONGEST * deepest / np.maximum(most, TINY), 1.0)
            self.moved += share[:, None] * step
            now = self._now()
            leaves, joins = self.on & (now < 0.0), ~self.on & (now > slack)
            if number < EARLY:
                most = np.maximum.reduceat(np.where(joins, now, 0.0), self.first[:-1])
                joins &= now >= JOIN * most[wheel]
            if number >= TOGETHER:
                joins &= ~np.logical_or.reduceat(leaves, self.first[:-1])[wheel]
            self.fresh |= np.logical_or.reduceat(leaves | joins, self.first[:-1])
            if not self.fresh.any() and (share == 1.0).all():
                break
            self.on = (self.on & ~leaves) | joins
            for empty in np.flatnonzero(~np.logical_or.reduceat(self.on, self.first[:-1])):
                self.on[self.first[empty] + now[self.first[empty] : self.first[empty + 1]].argmax()] = True

    def _respond(self) -> None:
        """Find the responses of wheels whose elements in touch have changed, in place."""
        wheels, rows = np.flatnonzero(self.fresh), self.rows
        given = (
            wheels, rows.start, rows.width, self.rates, rows.columns, rows.half, self.first, self.table,
            self._influence(), self.row, self.column, self.shape, self.moved, self.on, self.response,
        )  # fmt: skip
        (respond_loop if wl.accelerated(LOOPS * wheels.size) else respond)(*given)
        self.fresh[:] = False


TINY = 1e-300


def influences(
    start: NDArray[np.intp],
    y: Array,
    z: Array,
    arc: Array,
    angle: Array,
    width: Array,
    crest: Array,
    dx: Array,
    columns: NDArray[np.intp],
    half: NDArray[np.bool_],
    modulus: float,
    table: NDArray[np.intp],
    influence: Array,
) -> None:
    """Fill in the displacements of rows by unit forces per length, as `influence_loop` does."""
    for wheel in range(dx.size):
        some, count, length = slice(start[wheel], start[wheel + 1]), columns[wheel], dx[wheel]
        number = np.arange(1 - count, 2 * count if half[wheel] else count)
        apart = np.hypot(*(array[some, None] - array[some] for array in (y, z)))[..., None]
        turn = np.maximum(np.cos(angle[some, None] - angle[some]), 0.0)[..., None]
        shift = 0.0 if half[wheel] else (crest[some, None] - crest[some])[..., None]
        x = np.abs(length * number + shift) + np.zeros_like(apart)
        wide = np.broadcast_to(width[some][:, None], x.shape)
        square = x * x + apart * apart
        with np.errstate(divide="ignore", invalid="ignore"):
            found = beyond(length, wide, square, x * x)
        along = np.abs(arc[some, None] - arc[some])[..., None]
        widest = np.maximum(np.maximum(width[some, None], width[some])[..., None], length)
        close = x * x + along**2 < (NEAR * widest) ** 2
        x, apart, wide = x[close], np.broadcast_to(along, x.shape)[close], wide[close]
        high, low = apart + 0.5 * wide, apart - 0.5 * wide
        found[close] = (edge(x + 0.5 * length, high, low) - edge(x - 0.5 * length, high, low)) / wide
        found = 0.5 * (found + found.transpose(1, 0, 2)[..., :: 1 if half[wheel] else -1])
        influence[table[wheel] : table[wheel + 1]] = (found * turn / (np.pi * modulus)).ravel()


def beyond(length: Any, width: Any, square: Any, square_x: Any) -> Any:
    """Return the mean of 1/r over a rectangle times its length, far away, by the squares of the distance and of x."""
    bend = length * length * (3.0 * square_x - square) + width * width * (2.0 * square - 3.0 * square_x)
    return length / np.sqrt(square) * (1.0 + bend / (24.0 * square * square))


def edge(x: Any, high: Any, low: Any) -> Any:
    """Return the integral of 1/r from 0 to x along a strip between two edges."""
    size = np.abs(x) + TINY
    above = x * (np.arcsinh(high / size) - np.arcsinh(low / size))
    return above + high * np.arcsinh(x / (np.abs(high) + TINY)) - low * np.arcsinh(x / (np.abs(low) + TINY))


@wl.compiled_loop(
    f"void({INTS}, {VECTOR}, {VECTOR}, {VECTOR}, {VECTOR}, {VECTOR}, {VECTOR}, {VECTOR}, {INTS}, boolean[::1], float64,"
    f" {INTS}, {VECTOR})"
)
def influence_loop(
    start: NDArray[np.intp],
    y: Array,
    z: Array,
    arc: Array,
    angle: Array,
    width: Array,
    crest: Array,
    dx: Array,
    columns: NDArray[np.intp],
    half: NDArray[np.bool_],
    modulus: float,
    table: NDArray[np.intp],
    influence: Array,
) -> None:
    """Fill in the displacements of rows by unit forces per length, (row, pressed row, distance along x) of a wheel."""
    for wheel in range(dx.size):
        i0, size, count, length = start[wheel], start[wheel + 1] - start[wheel], columns[wheel], dx[wheel]
        both = half[wheel]
        last = 2 * count if both else count
        span = last + count - 1
        begin = 0 if both else 1 - count
        for i in range(size):
            for j in range(i + 1):
                across, down = y[i0 + i] - y[i0 + j], z[i0 + i] - z[i0 + j]
                square_y = across * across + down * down
                t, shift = abs(arc[i0 + i] - arc[i0 + j]), 0.0 if both else crest[i0 + i] - crest[i0 + j]
                turn = max(math.cos(angle[i0 + i] - angle[i0 + j]), 0.0) / (math.pi * modulus)
                to, back = (
                    table[wheel] + (i * size + j) * span + count - 1,
                    table[wheel] + (j * size + i) * span + count - 1,
                )
                one, other = width[i0 + i], width[i0 + j]
                even = one == other
                repeated = both and even and j > 0 and one == width[i0 + i - 1] and other == width[i0 + j - 1]
                repeated = repeated and abs(t - abs(arc[i0 + i - 1] - arc[i0 + j - 1])) < EVEN
                turns = 1.0
                if repeated:  # but for the turn
                    last_turn = math.cos(angle[i0 + i - 1] - angle[i0 + j - 1]) / (math.pi * modulus)
                    repeated = last_turn > 0.0
                    turns = turn / last_turn if repeated else 1.0
                before = before_other = 0.0
                known = False
                for number in range(begin, last):
                    x = number * length + shift
                    square = x * x + square_y
                    if x * x + t * t >= (NEAR * max(length, one, other)) ** 2:
                        known = False
                        value = beyond(length, other, square, x * x)
                        if not even:
                            value = 0.5 * (value + beyond(length, one, square, x * x))
                        value *= turn
                    elif repeated:
                        value = influence[to + number - (size + 1) * span] * turns
                    else:
                        if not known:
                            before = edge(x - 0.5 * length, t + 0.5 * other, t - 0.5 * other)
                            before_other = edge(x - 0.5 * length, t + 0.5 * one, t - 0.5 * one)
                        after = edge(x + 0.5 * length, t + 0.5 * other, t - 0.5 * other)
                        after_other = after if even else edge(x + 0.5 * length, t + 0.5 * one, t - 0.5 * one)
                        value = 0.5 * turn * ((after - before) / other + (after_other - before_other) / one)
                        before, before_other, known = after, after_other, True
                    influence[to + number] = value
                    influence[back + (number if both else -number)] = value
                    if both and 0 < number < count:
                        influence[to - number] = influence[back - number] = value


def respond(
    wheels: NDArray[np.intp],
    start: NDArray[np.intp],
    width: Array,
    rates: Array,
    columns: NDArray[np.intp],
    half: NDArray[np.bool_],
    first: NDArray[np.intp],
    table: NDArray[np.intp],
    influence: Array,
    row: NDArray[np.intp],
    column: NDArray[np.intp],
    shape: Array,
    moved: Array,
    on: NDArray[np.bool_],
    response: Array,
) -> None:
    """Fill in the responses of the elements of wheels to displacements, as `respond_loop` does."""
    for wheel in wheels:
        size, count = start[wheel + 1] - start[wheel], columns[wheel]
        span = 3 * count - 1 if half[wheel] else 2 * count - 1
        some = slice(first[wheel], first[wheel + 1])
        of, of_row, of_column = response[some], row[some] - start[wheel], column[some]
        of[:, 0], of[:, 1:] = shape[some], rates[row[some]]
        touch = on[some]
        at = np.flatnonzero(touch)
        near = np.flatnonzero(touch | (of[:, 0] + of[:, 1:] @ moved[wheel // 2] > 0.0))
        lead = of_row[near, None] * (size * span) + of_column[near, None]
        trail = of_row[at] * span + count - 1
        of_wheel = influence[table[wheel] : table[wheel + 1]]
        matrix = of_wheel[lead + (trail - of_column[at])]
        if half[wheel]:
            matrix += of_wheel[lead + (trail + of_column[at] + 1)]
        wide = width[row[some][at], None]
        pressed = np.linalg.solve(matrix[touch[near]], of[at]) / wide
        of[near] -= matrix @ (wide * pressed)
        of[at] = pressed


@wl.compiled_loop(
    f"void({INTS}, {INTS}, {VECTOR}, {ROWS}, {INTS}, boolean[::1], {INTS}, {INTS}, {VECTOR}, {INTS}, {INTS}, {VECTOR},"
    f" {ROWS}, boolean[::1], {ROWS})",
    reorders=True,
)
def respond_loop(
    wheels: NDArray[np.intp],
    start: NDArray[np.intp],
    width: Array,
    rates: Array,
    columns: NDArray[np.intp],
    half: NDArray[np.bool_],
    first: NDArray[np.intp],
    table: NDArray[np.intp],
    influence: Array,
    row: NDArray[np.intp],
    column: NDArray[np.intp],
    shape: Array,
    moved: Array,
    on: NDArray[np.bool_],
    response: Array,
) -> None:
    """Fill in the responses of the elements of wheels to displacements, by the Cholesky factors of those that touch."""
    unknowns = rates.shape[1]
    for wheel in wheels:
        i0, e0, size, count = start[wheel], first[wheel], start[wheel + 1] - start[wheel], columns[wheel]
        both = half[wheel]
        span = 3 * count - 1 if both else 2 * count - 1
        of_wheel = influence[table[wheel] : table[wheel + 1]]
        total = first[wheel + 1] - e0
        at, lead = np.empty(total, np.int64), np.empty(total, np.int64)
        trail, mirrored = np.empty(total, np.int64), np.empty(total, np.int64)
        near = np.empty(total, np.int64)
        held = others = 0
        for e in range(e0, e0 + total):
            now = response[e, 0] = shape[e]
            for k in range(unknowns):
                response[e, 1 + k] = rates[row[e], k]
                now += rates[row[e], k] * moved[wheel // 2, k]
            if on[e]:
                i = row[e] - i0
                at[held], lead[held] = e, i * size * span + column[e]
                trail[held], mirrored[held] = i * span + count - 1 - column[e], i * span + count + column[e]
                held += 1
            elif now > 0.0:
                near[others] = e
                others += 1
        lower, right = np.empty((held, held)), np.empty((1 + unknowns, held))
        for i in range(held):
            for r in range(1 + unknowns):
                right[r, i] = response[at[i], r]
            for j in range(i + 1):
                lower[i, j] = of_wheel[lead[i] + trail[j]]
                if both:
                    lower[i, j] += of_wheel[lead[i] + mirrored[j]]
        for j in range(held):
            for i in range(j, held):
                value = lower[i, j]
                for k in range(j):
                    value -= lower[i, k] * lower[j, k]
                lower[i, j] = math.sqrt(value) if i == j else value / lower[j, j]
        for r in range(1 + unknowns):
            for j in range(held):
                value = right[r, j]
                for k in range(j):
                    value -= lower[j, k] * right[r, k]
                right[r, j] = value / lower[j, j]
            for j in range(held - 1, -1, -1):
                value = right[r, j] = right[r, j] / lower[j, j]
                for k in range(j):
                    right[r, k] -= value * lower[j, k]
        moves = np.empty(held)
        for i in range(others):
            begin = (row[near[i]] - i0) * size * span + column[near[i]]
            for j in range(held):
                moves[j] = of_wheel[begin + trail[j]]
            if both:
                for j in range(held):
                    moves[j] += of_wheel[begin + mirrored[j]]
            for r in range(1 + unknowns):
                value = 0.0
                for j in range(held):
                    value += moves[j] * right[r, j]
                response[near[i], r] -= value
        for i in range(held):
            for r in range(1 + unknowns):
                response[at[i], r] = right[r, i] / width[row[at[i]]]
