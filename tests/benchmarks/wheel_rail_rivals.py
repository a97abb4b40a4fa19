"""What the elliptic contacts of wearlaw are compared with, and the operating points for it."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from pathlib import Path

import numpy as np

import wearlaw as wl
from tests.benchmarks.rivals import FAST
from wearlaw import Array
from wearlaw_fastsim._march import Cells, Ellipses, forces, march  # private: timed without the rest

AXIS_RATIOS = (0.2, 5.0)
CREEPAGES = (1e-4, 3e-2)
SPINS = (0.0, 1.0)
FRICTIONS = (0.1, 0.5)
WORKLOAD = (
    f"a/b log-uniform {AXIS_RATIOS[0]:g} to {AXIS_RATIOS[1]:g}, both creepages log-uniform {CREEPAGES[0]:g} to "
    f"{CREEPAGES[1]:g} of either sign, spin uniform {SPINS[0]:g} to {SPINS[1]:g} 1/m, friction uniform "
    f"{FRICTIONS[0]:g} to {FRICTIONS[1]:g}; 80 kN on √(ab) = 5 mm of steel, USFD law with the global parameters"
)

M_M, Q_S, M_C, TR_SC = 5.3e-9, 0.055, 61.9e-9, 77.26e6
"""USFD, global parameters in SI (Tassini et al., Wear 268 (2010) 660-667, Table 4)."""

RIVAL_CELLS = 50

Outcome = tuple[Array, Array, Array]
"""Both forces [N], and the area mean of the wear rate [kg/m/m²]."""


def workload(count: int) -> wl.Problem:
    """Return operating points that vary in everything."""
    rng = np.random.default_rng(19820101)

    def log_uniform(low: float, high: float) -> Array:
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    root = np.sqrt(log_uniform(*AXIS_RATIOS))
    creepages = {
        name: log_uniform(*CREEPAGES) * rng.choice([-1.0, 1.0], count)
        for name in ("longitudinal_creepage", "lateral_creepage")
    }
    equal = {
        "normal_force": 8e4,
        "shear_modulus": 82e9,
        "poisson_ratio": 0.28,
        "rolling_speed": 30.0,
        "density": 7850.0,
    }
    return wl.Problem.ellipse_from_si(
        a=5e-3 * root,
        b=5e-3 / root,
        spin=rng.uniform(*SPINS, count),
        friction_coefficient=rng.uniform(*FRICTIONS, count),
        **creepages,
        **{name: np.full(count, value) for name, value in equal.items()},
    )


def ellipses(problem: wl.Problem, *, elliptic: bool) -> Ellipses:
    """Return the problem of the simplified theory with the flexibilities of Kalker (1982)."""
    ratio, scale = problem.a / problem.b, problem.a / problem.shear_modulus
    coefficients = wl.kalker.coefficients(ratio, problem.poisson_ratio)
    return Ellipses(
        a=problem.a,
        b=problem.b,
        longitudinal_creepage=problem.longitudinal_creepage,
        lateral_creepage=problem.lateral_creepage,
        spin=problem.spin,
        longitudinal_flexibility=8.0 * scale / (3.0 * coefficients.c11),
        lateral_flexibility=8.0 * scale / (3.0 * coefficients.c22),
        spin_flexibility=np.pi * np.sqrt(ratio) * scale / (4.0 * coefficients.c23),
        bound_centre=problem.friction_coefficient * problem.max_pressure * (1.0 if elliptic else 4.0 / 3.0),
        elliptic=elliptic,
    )


class Compiled:
    """wheel_rail_march.c, compiled with the given flags."""

    def __init__(self, flags: tuple[str, ...] = FAST, compiler: str = "cc") -> None:
        with tempfile.TemporaryDirectory() as folder:
            compiled, library = Path(folder) / "march.o", Path(folder) / "march.so"
            source = Path(__file__).with_name("wheel_rail_march.c")
            subprocess.run([compiler, *flags, "-c", "-fPIC", "-o", compiled, source], check=True)
            # Linked without the flags, as in rivals.py.
            subprocess.run([compiler, "-shared", "-o", library, compiled, "-lm"], check=True)
            self._library = ctypes.CDLL(str(library))

    def march(self, patches: Ellipses, cells: Cells) -> None:
        """Fill cells in C order."""
        given = [array.flatten() for array in patches.arrays]  # read-only ones have no ctypes
        arrays = [np.ctypeslib.as_ctypes(array.reshape(-1)) for array in (*given, *cells.arrays)]
        self._library.march(*map(ctypes.c_size_t, cells.x.shape), ctypes.c_int(patches.elliptic), *arrays)


class MarchAndLaw:
    """The march of Kalker (1982) in NumPy and the USFD law in its cells, in memory that is used again and again."""

    def __init__(
        self, patches: Ellipses, cells: int = RIVAL_CELLS, strips: int = RIVAL_CELLS, block: int = 128
    ) -> None:
        self._patches, self._block = patches, block
        self._cells = Cells.empty(block, cells, strips, compiled=False)
        self._work = [np.empty_like(self._cells.x) for _ in range(2)]

    def __call__(self) -> Outcome:
        """Return the outcome at all operating points."""
        count = self._patches.a.size
        found = np.empty((3, count))
        for first in range(0, count, self._block):
            part = slice(first, min(first + self._block, count))
            found[:, part] = self._on_block(self._patches.part(part), part.stop - first)
        return found[0], found[1], found[2]

    def _on_block(self, patches: Ellipses, count: int) -> Outcome:
        cells = self._cells.part(slice(count))
        rate, over = (array[:count] for array in self._work)
        march(patches, cells, compiled=False)
        total = forces(patches, cells)
        np.multiply(cells.traction_x, cells.slip_x, out=rate)
        np.multiply(cells.traction_y, cells.slip_y, out=over)
        np.add(rate, over, out=rate)
        np.subtract(rate, TR_SC, out=over)
        np.maximum(over, 0.0, out=over)
        np.minimum(rate, Q_S / M_M, out=rate)
        strips = rate.shape[-1]
        lengths = patches.cell_lengths(rate.shape[1], strips)
        along = M_M * rate.sum(axis=1) + M_C * over.sum(axis=1)
        mean = (along * lengths).sum(axis=-1) * (2.0 / strips) / (np.pi * patches.a)
        return total.longitudinal, total.lateral, mean
