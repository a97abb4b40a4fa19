"""Wearlaw and its rivals on the same operating points: CPU time, and error against the reference."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from tests.benchmarks import rivals
from tests.benchmarks.points import Points, in_si, pipeline, reference, workload
from tests.benchmarks.report import Gate, Row
from tests.benchmarks.rivals import CELLS, CHUNKS, Compiled
from tests.benchmarks.timing import in_mode, modes, side_by_side
from wearlaw import Array

POINTS = 100_000
CURVE_POINTS = 10_000
CURVE_CELLS = (10, 30, 300, 1000, 3000)
CURVE_ROUNDS = 5

NUMPY_CELLS = "cells, NumPy"
C_CELLS = "cells, C"
C_CLOSED = "closed form, C"


def compare(rounds: int) -> tuple[list[Row], list[Gate]]:
    """Return a row for every rival, and the gates that compare them."""
    points = workload(POINTS)
    exact = reference(points)
    works = _rivals(points)
    if C_CELLS in works:
        np.testing.assert_allclose(_rate(works[C_CELLS]()), _rate(works[NUMPY_CELLS]()), rtol=1e-9)
    times = side_by_side(works, rounds)
    errors = {name: _error(_rate(work()), exact) for name, work in works.items()}
    rows = [
        Row(name, CELLS if name.startswith("cells") else None, 1e6 * times.median(name) / POINTS, *errors[name])
        for name in works
    ]
    gates = [
        Gate("time, wearlaw with NumPy over cells in NumPy", times.ratio(_wearlaw("NumPy"), NUMPY_CELLS), 0.25),
        Gate("rms error, wearlaw with NumPy over cells", errors[_wearlaw("NumPy")][0] / errors[NUMPY_CELLS][0], 1e-3),
    ]
    if C_CLOSED in works and "numba" in modes():
        ratio = times.ratio(_wearlaw("numba"), C_CLOSED)
        gates.append(Gate("time, wearlaw with numba over closed form in C", ratio, 1.5))
    return rows, gates


def curve() -> list[Row]:
    """Return rows of the algorithms of cells for other numbers of cells."""
    points = workload(CURVE_POINTS)
    exact = reference(points)
    chunk = _best_chunk(points)
    works: dict[tuple[str, int], Callable[[], Array]] = {
        (NUMPY_CELLS, count): partial(rivals.numpy_cells, points, count, chunk) for count in CURVE_CELLS
    }
    if rivals.has_compiler():
        fast = Compiled(rivals.FAST)
        works |= {(C_CELLS, count): partial(fast.cells, points, count) for count in CURVE_CELLS}
    times = side_by_side({f"{name} {count}": work for (name, count), work in works.items()}, CURVE_ROUNDS)
    return [
        Row(name, count, 1e6 * times.median(f"{name} {count}") / CURVE_POINTS, *_error(work(), exact))
        for (name, count), work in works.items()
    ]


def _rivals(points: Points) -> dict[str, Callable[[], object]]:
    predict, conditions = pipeline(), points.conditions()
    works: dict[str, Callable[[], object]] = {
        _wearlaw(name): in_mode(on, lambda: predict(**conditions).wear_rate) for name, on in modes().items()
    }
    works[NUMPY_CELLS] = partial(rivals.numpy_cells, points, chunk=_best_chunk(points))
    if rivals.has_compiler():
        works[C_CELLS] = partial(Compiled(rivals.FAST).cells, points)
        works[C_CLOSED] = partial(Compiled(rivals.PLAIN_LIBRARY).closed_form, points)
    else:
        print("no C compiler: the rivals in C are left out")
    return works


def _best_chunk(points: Points) -> int:
    """Return the chunk with which the cells in NumPy are fastest here."""
    works = {str(chunk): partial(rivals.numpy_cells, points, chunk=chunk) for chunk in CHUNKS}
    times = side_by_side(works, rounds=3)
    return int(min(works, key=times.median))


def _wearlaw(mode: str) -> str:
    return f"wearlaw, {mode}"


def _rate(outcome: object) -> Array:
    """Return the outcome of a rival [kg/m/m²]."""
    return outcome if isinstance(outcome, np.ndarray) else in_si(outcome)


def _error(found: Array, exact: Array) -> tuple[float, float]:
    """Return the root mean square and the largest of the relative errors."""
    relative = found / exact - 1.0
    return float(np.sqrt(np.mean(relative * relative))), float(np.abs(relative).max())
