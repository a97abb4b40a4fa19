"""The pressure between wheels and rails, as one convex problem for each wheel.

Rows lie across the area of contact, and elements of constant pressure along each row about its crest. Where bodies
touch, the displacements of half-spaces take up what their undeformed shapes overlap; elsewhere there is no pressure:

    ∑ A_ij p_j = o_i + C_i·d  where p_i > 0,  ≥ o_i + C_i·d  where p_i = 0.

A is the displacement of E. H. Love, Phil. Trans. R. Soc. Lond. A 228 (1929) 377-420, at the straight distance of two
elements in space. Rows at different angles move each other by the cosine of the difference of their angles, and not at
all beyond a right angle: an assumption, since two half-spaces have one plane. The displacement d of the wheelset, such
as the height of its axle and its roll, is what carries the loads, ∑ w_i F_i = Q.

At given displacements the problem has one solution. It is sought directly: solve for the elements that touch and for d
together, leave out those that pull, take in those that overlap, until neither is left.
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

FAR = 1e-3
"""Change of the height [m] or of the roll [rad] beyond which rows are laid again before their pressure is known."""

TINY = 1e-300
"""Keeps divisors from zero."""

INTS, VECTOR, ROWS = "int64[::1]", "float64[::1]", "float64[:, ::1]"


@dataclass
class Pressed:
    """Elements of wheels and what is known of their pressure; the elements of a wheel are one piece of each array.

    Attributes
    ----------
    rows : Rows
    modulus : float
        E* [Pa].
    loops : bool
        Whether compiled loops are used.
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
    now : ndarray, (elements,)
        Pressure [Pa] or overlap that is left [m] at the present displacements.
    forces : ndarray, (rows, 1 + unknowns)
        Forces of the rows as linear functions of the displacements [N].
    fresh : ndarray of bool, (wheels,)
        Whether the elements that touch have changed since the response was found.
    moved : ndarray, (positions, unknowns)
        The displacements.
    """

    rows: Rows
    modulus: float
    loops: bool
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
    now: Array
    forces: Array
    fresh: NDArray[np.bool_]
    moved: Array

    @classmethod
    def begun(cls, rows: Rows, modulus: float, rates: Array, loops: bool) -> Pressed:
        """Return elements for rows, of which those touch that overlap much."""
        size, columns = np.diff(rows.start), rows.columns
        both = rows.half[rows.wheel]
        of_row = np.where(both, rows.halves, 2 * rows.halves)
        row = np.repeat(np.arange(rows.wheel.size), of_row)
        column = np.arange(row.size) - np.repeat(np.cumsum(of_row) - of_row, of_row)
        column += np.where(both, 0, columns[rows.wheel] // 2 - rows.halves)[row]
        wheel = rows.wheel[row]
        x = rows.dx[wheel] * (column + np.where(rows.half, 0.5, 0.5 - 0.5 * columns)[wheel])
        shape = rows.overlap[row] - rows.curvature[row] * x * x
        first = np.searchsorted(wheel, np.arange(size.size + 1))
        table = np.concatenate([[0], np.cumsum(size**2 * np.where(rows.half, 3 * columns - 1, 2 * columns - 1))])
        top = np.maximum.reduceat(shape, first[:-1])
        return cls(
            rows, modulus, loops, rates, np.zeros((rates.shape[0], 2)), first, table, np.empty(0), row, column, x,
            shape, shape >= top[wheel] - (1.0 - BEGINS) * np.abs(top[wheel]), np.zeros((row.size, 1 + rates.shape[1])),
            np.zeros(row.size), np.zeros((rates.shape[0], 1 + rates.shape[1])),
            np.ones(size.size, dtype=np.bool_), np.zeros((size.size // 2, rates.shape[1])),
        )  # fmt: skip

    def copy(self) -> Pressed:
        """Return a copy whose pressure changes on its own."""
        names = "weights", "on", "response", "now", "forces", "fresh", "moved"
        return replace(self, **{name: getattr(self, name).copy() for name in names})

    def _influence(self) -> Array:
        """Return the influences, which are kept until they are taken away."""
        if not self.influence.size:
            self.influence = np.empty(self.table[-1])
            rows = self.rows
            arrays = rows.y, rows.z, rows.place.rail_arc, rows.place.angle, rows.width, rows.place.x
            arguments = (
                rows.start, *arrays, rows.dx, rows.columns, rows.half, self.modulus, self.table, self.influence,
            )  # fmt: skip
            (influence_loop if self.loops else influences)(*arguments)
        return self.influence

    @property
    def pressure(self) -> Array:
        """The pressure of the elements [Pa]."""
        return np.where(self.on, self.now, 0.0)

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

    def carry(self, load: Array, points: NDArray[np.intp]) -> None:
        """Find the pressure and the displacements that carry loads, (positions, unknowns) [N], at some positions."""
        rows = self.rows
        area = (np.where(rows.half, 2.0, 1.0) * rows.dx)[rows.wheel] * rows.width
        deepest = rows.deepest.reshape(-1, 2).max(axis=-1)
        arguments = (
            points, load, self.weights, self.rates, rows.start, rows.width, area, deepest, rows.columns, rows.half,
            self.first, self.table, self._influence(), self.row, self.column, self.shape, self.on, self.response,
            self.now, self.forces, self.moved, self.fresh,
        )  # fmt: skip
        (carry_loop if self.loops else carry)(*arguments)


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
        wider = np.maximum(width[some, None], width[some])[..., None]
        wide = np.broadcast_to(wider, x.shape)
        square = x * x + apart * apart
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = beyond(length, wide, square, x * x)
        along = np.abs(arc[some, None] - arc[some])[..., None]
        close = x * x + along**2 < (NEAR * np.maximum(wider, length)) ** 2
        x, apart, wide = x[close], np.broadcast_to(along, x.shape)[close], wide[close]
        high, low = apart + 0.5 * wide, apart - 0.5 * wide
        mean[close] = (edge(x + 0.5 * length, high, low) - edge(x - 0.5 * length, high, low)) / wide
        influence[table[wheel] : table[wheel + 1]] = (mean * turn / (np.pi * modulus)).ravel()


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
    """Fill in the displacements of rows by unit forces per length, (row, pressed row, distance along x) of a wheel.

    Of two rows the wider one presses on the middle of the narrower one, and the same counts the other way round. A mean
    of both ways would leave the first narrow row with 6 % too much pressure.
    """
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
                width_i, width_j = width[i0 + i], width[i0 + j]
                wide = max(width_i, width_j)
                repeated = both and j > 0 and width_i == width[i0 + i - 1] and width_j == width[i0 + j - 1]
                repeated = repeated and abs(t - abs(arc[i0 + i - 1] - arc[i0 + j - 1])) < EVEN
                turns = 1.0
                if repeated:  # but for the turn
                    last_turn = math.cos(angle[i0 + i - 1] - angle[i0 + j - 1]) / (math.pi * modulus)
                    repeated = last_turn > 0.0
                    turns = turn / last_turn if repeated else 1.0
                before, edged = 0.0, False
                for number in range(begin, last):
                    x = number * length + shift
                    square = x * x + square_y
                    if x * x + t * t >= (NEAR * max(length, wide)) ** 2:
                        edged = False
                        value = turn * beyond(length, wide, square, x * x)
                    elif repeated:
                        value = influence[to + number - (size + 1) * span] * turns
                    else:
                        if not edged:
                            before = edge(x - 0.5 * length, t + 0.5 * wide, t - 0.5 * wide)
                        after = edge(x + 0.5 * length, t + 0.5 * wide, t - 0.5 * wide)
                        value = turn * (after - before) / wide
                        before, edged = after, True
                    influence[to + number] = value
                    influence[back + (number if both else -number)] = value
                    if both and 0 < number < count:
                        influence[to - number] = influence[back - number] = value


def respond(
    wheel: int, displacement: Array, start: NDArray[np.intp], width: Array, rates: Array, columns: NDArray[np.intp],
    half: NDArray[np.bool_], first: NDArray[np.intp], table: NDArray[np.intp], influence: Array, row: NDArray[np.intp],
    column: NDArray[np.intp], shape: Array, on: NDArray[np.bool_], response: Array,
) -> None:  # fmt: skip
    """Fill in the responses of the elements of a wheel to displacements."""
    size, count = start[wheel + 1] - start[wheel], columns[wheel]
    span = 3 * count - 1 if half[wheel] else 2 * count - 1
    some = slice(first[wheel], first[wheel + 1])
    of, touches, place = response[some], on[some], row[some] - start[wheel]
    of[:, 0], of[:, 1:] = shape[some], rates[row[some]]
    at, near = np.flatnonzero(touches), np.flatnonzero(touches | (shape[some] + of[:, 1:] @ displacement > 0.0))
    of_wheel = influence[table[wheel] : table[wheel + 1]]
    ahead, along = place[near] * (size * span) + column[some][near], column[some][at]
    middle = place[at] * span + count - 1
    matrix = of_wheel[ahead[:, None] + (middle - along)]
    if half[wheel]:
        matrix += of_wheel[ahead[:, None] + (middle + along + 1)]
    pressed = np.linalg.solve(matrix[touches[near]], of[at])
    of[near] -= matrix @ pressed
    of[at] = pressed / width[row[some][at], None]


def respond_loop(
    wheel: int, displacement: Array, start: NDArray[np.intp], width: Array, rates: Array, columns: NDArray[np.intp],
    half: NDArray[np.bool_], first: NDArray[np.intp], table: NDArray[np.intp], influence: Array, row: NDArray[np.intp],
    column: NDArray[np.intp], shape: Array, on: NDArray[np.bool_], response: Array,
) -> None:  # fmt: skip
    """Fill in the responses of the elements of a wheel to displacements."""
    size, count, begin, end = start[wheel + 1] - start[wheel], columns[wheel], first[wheel], first[wheel + 1]
    span = 3 * count - 1 if half[wheel] else 2 * count - 1
    touching, at, (behind, mirrored) = 0, np.empty(end - begin, np.int64), np.empty((2, end - begin), np.int64)
    for i in range(begin, end):
        response[i, 0] = shape[i]
        for k in range(displacement.size):
            response[i, 1 + k] = rates[row[i], k]
        if on[i]:
            middle = table[wheel] + (row[i] - start[wheel]) * span + count - 1
            at[touching], behind[touching], mirrored[touching] = i, middle - column[i], middle + column[i] + 1
            touching += 1
    matrix, pressed = np.empty((touching, touching)), np.empty((1 + displacement.size, touching))
    for i in range(touching):
        ahead = (row[at[i]] - start[wheel]) * size * span + column[at[i]]
        gather_influences(influence, ahead, behind, mirrored, half[wheel], matrix[i, : i + 1])
        for k in range(pressed.shape[0]):
            pressed[k, i] = response[at[i], k]
    solve(matrix, pressed)
    moved = np.empty(touching)
    for i in range(begin, end):
        overlap = shape[i]
        for k in range(displacement.size):
            overlap += rates[row[i], k] * displacement[k]
        if on[i] or overlap <= 0.0:
            continue
        ahead = (row[i] - start[wheel]) * size * span + column[i]
        gather_influences(influence, ahead, behind, mirrored, half[wheel], moved)
        for k in range(pressed.shape[0]):
            rest = 0.0
            for j in range(touching):
                rest += moved[j] * pressed[k, j]
            response[i, k] -= rest
    for i in range(touching):
        for k in range(pressed.shape[0]):
            response[at[i], k] = pressed[k, i] / width[row[at[i]]]


def gather_influences(
    influence: Array, ahead: int, behind: NDArray[np.intp], mirrored: NDArray[np.intp], half: bool, moved: Array
) -> None:
    """Fill in the displacements of an element by others, and by their mirror images where these count too."""
    if half:
        for j in range(moved.size):
            moved[j] = influence[ahead + behind[j]] + influence[ahead + mirrored[j]]
    else:
        for j in range(moved.size):
            moved[j] = influence[ahead + behind[j]]


def solve(matrix: Array, right: Array) -> None:
    """Solve a symmetric system, whose lower half is given, for each of some right sides by factors L D Lᵀ, in place.

    Loops around LAPACK would take four times as long to compile, and its threads would wait for those of other workers.
    """
    for i in range(matrix.shape[0]):
        for j in range(i):
            rest = 0.0
            for k in range(j):
                rest += matrix[i, k] * matrix[j, k]
            matrix[i, j] -= rest
        rest = 0.0
        for k in range(i):
            share = matrix[i, k] / matrix[k, k]
            rest += matrix[i, k] * share
            matrix[i, k] = share
        matrix[i, i] -= rest
    for side in range(right.shape[0]):
        for i in range(matrix.shape[0]):
            rest = 0.0
            for k in range(i):
                rest += matrix[i, k] * right[side, k]
            right[side, i] -= rest
        for i in range(matrix.shape[0]):
            right[side, i] /= matrix[i, i]
        for i in range(matrix.shape[0] - 1, -1, -1):
            value = right[side, i]
            for k in range(i):
                right[side, k] -= matrix[i, k] * value


def gather(
    begin: int, end: int, row: NDArray[np.intp], area: Array, on: NDArray[np.bool_], response: Array, forces: Array
) -> None:
    """Fill in the forces of the rows of some elements, by the responses of those that touch."""
    some, rows = slice(begin, end), slice(row[begin], row[end - 1] + 1)
    begins = np.flatnonzero(np.diff(row[some], prepend=-1))
    forces[rows] = area[rows, None] * np.add.reduceat(np.where(on[some, None], response[some], 0.0), begins)


def gather_loop(
    begin: int, end: int, row: NDArray[np.intp], area: Array, on: NDArray[np.bool_], response: Array, forces: Array
) -> None:
    """Fill in the forces of the rows of some elements, by the responses of those that touch."""
    forces[row[begin] : row[end - 1] + 1] = 0.0
    for i in range(begin, end):
        if on[i]:
            for k in range(response.shape[1]):
                forces[row[i], k] += area[row[i]] * response[i, k]


def settled(
    begin: int, end: int, displacement: Array, slack: float, number: int, on: NDArray[np.bool_], response: Array,
    now: Array,
) -> bool:  # fmt: skip
    """Fill in what elements have at displacements, let them leave and join, and return whether none does."""
    touches, value = on[begin:end], response[begin:end, 0] + response[begin:end, 1:] @ displacement
    now[begin:end] = value
    leaves, joins = touches & (value < 0.0), ~touches & (value > slack)
    if number < EARLY:
        joins &= value >= JOIN * np.where(joins, value, 0.0).max()
    if number >= TOGETHER and leaves.any():
        joins[:] = False
    on[begin:end] = (touches & ~leaves) | joins
    if not on[begin:end].any():
        on[begin + value.argmax()] = True
    return not (leaves.any() or joins.any())


def settled_loop(
    begin: int, end: int, displacement: Array, slack: float, number: int, on: NDArray[np.bool_], response: Array,
    now: Array,
) -> bool:  # fmt: skip
    """Fill in what elements have at displacements, let them leave and join, and return whether none does."""
    most, top, leave = 0.0, begin, False
    for i in range(begin, end):
        now[i] = response[i, 0]
        for k in range(displacement.size):
            now[i] += response[i, 1 + k] * displacement[k]
        if now[i] > now[top]:
            top = i
        if on[i]:
            leave = leave or now[i] < 0.0
        elif now[i] > slack:
            most = max(most, now[i])
    least = JOIN * most if number < EARLY else 0.0
    join = most > 0.0 and not (leave and number >= TOGETHER)
    touch = False
    for i in range(begin, end):
        on[i] = now[i] >= 0.0 if on[i] else join and now[i] > slack and now[i] >= least
        touch = touch or on[i]
    if not touch:
        on[top] = True
    return not (leave or join)


def moves(
    begin: int, end: int, load: Array, weights: Array, rates: Array, forces: Array, longest: float, moved: Array
) -> bool:
    """Move a wheelset to where rows bear both loads, in place, and return whether it may go so far at once."""
    sums = weights[begin:end].T @ forces[begin:end]
    rest = load - sums[:, 0] - sums[:, 3:] @ moved[2:]  # of what is given
    step = np.zeros(moved.size)
    step[:2] = np.linalg.solve(sums[:, 1:3], rest) - moved[:2]
    most = np.abs(rates[begin:end] @ step).max()
    moved += min(longest / max(most, TINY), 1.0) * step
    return bool(most <= longest)


def moves_loop(
    begin: int, end: int, load: Array, weights: Array, rates: Array, forces: Array, longest: float, moved: Array
) -> bool:
    """Move a wheelset to where rows bear both loads, in place, and return whether it may go so far at once."""
    sums, rest, step = np.zeros((2, 1 + moved.size)), load.copy(), np.zeros(2)
    for i in range(begin, end):
        for wheel in range(2):
            for k in range(sums.shape[1]):
                sums[wheel, k] += weights[i, wheel] * forces[i, k]
    for wheel in range(2):
        rest[wheel] -= sums[wheel, 0]
        for k in range(2, moved.size):  # of what is given
            rest[wheel] -= sums[wheel, 1 + k] * moved[k]
    determinant = sums[0, 1] * sums[1, 2] - sums[0, 2] * sums[1, 1]
    step[0] = (rest[0] * sums[1, 2] - rest[1] * sums[0, 2]) / determinant - moved[0]
    step[1] = (rest[1] * sums[0, 1] - rest[0] * sums[1, 1]) / determinant - moved[1]
    most = TINY
    for i in range(begin, end):
        most = max(most, abs(rates[i, 0] * step[0] + rates[i, 1] * step[1]))
    for k in range(2):
        moved[k] += min(longest / most, 1.0) * step[k]
    return most <= longest


def carry(
    points: NDArray[np.intp], load: Array, weights: Array, rates: Array, start: NDArray[np.intp], width: Array,
    area: Array, deepest: Array, columns: NDArray[np.intp], half: NDArray[np.bool_], first: NDArray[np.intp],
    table: NDArray[np.intp], influence: Array, row: NDArray[np.intp], column: NDArray[np.intp], shape: Array,
    on: NDArray[np.bool_], response: Array, now: Array, forces: Array, moved: Array, fresh: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Fill in pressure, forces and displacements that carry loads at some positions, as `Pressed.carry` asks."""
    for point in points:
        wheels = 2 * point, 2 * point + 1
        for number in range(MOST):
            for wheel in wheels:
                if fresh[wheel]:
                    respond(
                        wheel, moved[point], start, width, rates, columns, half, first, table, influence, row, column,
                        shape, on, response,
                    )  # fmt: skip
                    gather(int(first[wheel]), int(first[wheel + 1]), row, area, on, response, forces)
            done = moves(
                int(start[2 * point]), int(start[2 * point + 2]), load[point], weights, rates, forces,
                float(LONGEST * deepest[point]), moved[point],
            )  # fmt: skip
            for wheel in wheels:
                fresh[wheel] = not settled(
                    int(first[wheel]), int(first[wheel + 1]), moved[point], float(SLACK * deepest[point]), number, on,
                    response, now,
                )  # fmt: skip
                done = done and not fresh[wheel]
            if done or max(abs(moved[point, 0]), abs(moved[point, 1])) > FAR:
                break


FLAGS = "boolean[::1]"
carry_loop = wl.compiled_loop(
    f"void({INTS}, {ROWS}, {ROWS}, {ROWS}, {INTS}, {VECTOR}, {VECTOR}, {VECTOR}, {INTS}, {FLAGS}, {INTS}, {INTS},"
    f" {VECTOR}, {INTS}, {INTS}, {VECTOR}, {FLAGS}, {ROWS}, {VECTOR}, {ROWS}, {ROWS}, {FLAGS})",
    reorders=True,
    instead={"respond": respond_loop, "gather": gather_loop, "moves": moves_loop, "settled": settled_loop},
)(carry)
