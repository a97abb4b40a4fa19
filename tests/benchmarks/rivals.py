"""What wearlaw is compared with: the algorithm of the literature, and compiled code for one pair of models only.

The rivals know no units, no other contact model and no other law. Each is exact contact and USFD written out, from
the formulas of Tassini et al., Wear 268 (2010) 660-667, with the slip of Carter (1926).
"""

from __future__ import annotations

import ctypes
import math
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from tests.benchmarks.points import PARAMETERS, Points
from wearlaw import Array

CELLS = 100
"""As in Tassini et al. (2010)."""

CHUNKS = (3_200, 6_400, 12_800, 25_600, 51_200)
"""Cells of a chunk to choose from: the fastest depends on the cache and on the allocator."""

FAST = ("-O3", "-march=native", "-ffast-math")
PLAIN_LIBRARY = ("-O3", "-march=native")


def numpy_cells(points: Points, count: int = CELLS, chunk: int = 6_400) -> Array:
    """Return the mean over uniform cells, in chunks of operating points × cells that stay in the cache."""
    rows = max(chunk // count, 1)
    rate = np.empty(points.count)
    for first in range(0, points.count, rows):
        part = slice(first, first + rows)
        rate[part] = _cells(points[part], count)
    return rate


def _cells(points: Points, count: int) -> Array:
    """Return the mean of the rate over cells; stick has no slip, so its traction is not needed."""
    p = PARAMETERS
    load = points.force / p.width
    a = np.sqrt(4.0 * load * p.radius / (math.pi * p.modulus))
    k = points.friction / p.radius
    bound = points.friction * 2.0 * load / (math.pi * a)  # μp0
    saturation = k * a
    d = points.creepage / saturation
    stick = np.maximum(1.0 - d, 0.0)  # c/a
    x = centres(count)
    position = x + d[:, None]  # (x + a - c)/a
    slip = np.sqrt(np.maximum(position * position - (stick * stick)[:, None], 0.0))  # s/(ka); ξ + kx for c = 0
    w = (bound * saturation)[:, None] * (np.sqrt(1.0 - x * x) * slip)
    rate = np.minimum(p.m_m * w, p.q_s) + p.m_c * np.maximum(w - p.tr_sc, 0.0)
    mean: Array = rate.mean(axis=-1)
    return mean


def centres(count: int) -> Array:
    """Return x/a at the centres of uniform cells over the patch."""
    return (2.0 * np.arange(count) + 1.0) / count - 1.0


def has_compiler() -> bool:
    """Return whether there is a C compiler."""
    return shutil.which("cc") is not None


class Compiled:
    """rivals.c, compiled with the given flags."""

    def __init__(self, flags: tuple[str, ...]) -> None:
        with tempfile.TemporaryDirectory() as folder:
            compiled, library = Path(folder) / "rivals.o", Path(folder) / "rivals.so"
            source = Path(__file__).with_name("rivals.c")
            subprocess.run(["cc", *flags, "-c", "-fPIC", "-o", compiled, source], check=True)
            # Linked without the flags: with -ffast-math the library would flush the whole process's denormals to zero.
            subprocess.run(["cc", "-shared", "-o", library, compiled, "-lm"], check=True)
            self._library = ctypes.CDLL(str(library))
        self._parameters = np.array(PARAMETERS)

    def cells(self, points: Points, count: int = CELLS) -> Array:
        """Return the mean over uniform cells."""
        x = centres(count)
        root, rate = np.sqrt(1.0 - x * x), np.empty(points.count)
        self._library.cells(
            *_arguments(points, rate), _pointer(self._parameters), ctypes.c_size_t(count), _pointer(x), _pointer(root)
        )
        return rate

    def closed_form(self, points: Points) -> Array:
        """Return the mean over the patch in closed form."""
        rate = np.empty(points.count)
        self._library.closed_form(*_arguments(points, rate), _pointer(self._parameters))
        return rate


def _arguments(points: Points, rate: Array) -> tuple[object, ...]:
    arrays = (points.force, points.creepage, points.friction, rate)
    return (ctypes.c_size_t(points.count), *(_pointer(array) for array in arrays))


def _pointer(array: Array) -> object:
    return np.ctypeslib.as_ctypes(array)
