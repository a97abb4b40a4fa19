"""What the elliptic contacts of wearlaw are compared with, and the operating points for it."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_fastsim._march import Ellipses, forces, march  # private: timed without the rest

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


class MarchAndLaw:
    """The march of Kalker (1982) in NumPy and the USFD law in its cells, in blocks."""

    def __init__(self, problem: wl.Problem, elliptic: bool, cells: int, strips: int, block: int) -> None:
        self._parts = [Ellipses.of(problem[first : first + block], elliptic) for first in range(0, problem.size, block)]
        self._cells, self._strips = cells, strips

    def __call__(self) -> Outcome:
        """Return the outcome at all operating points."""
        longitudinal, lateral, rate = (np.concatenate(some) for some in zip(*map(self._of, self._parts), strict=True))
        return longitudinal, lateral, rate

    def _of(self, patches: Ellipses) -> Outcome:
        cells = march(patches, self._cells, self._strips)
        total = forces(patches, cells)
        energy = cells.traction_x * cells.slip_x + cells.traction_y * cells.slip_y
        rate = M_M * np.minimum(energy, Q_S / M_M) + M_C * np.maximum(energy - TR_SC, 0.0)
        lengths = patches.cell_lengths(self._cells, self._strips)
        mean = (rate.sum(axis=1) * lengths).sum(axis=-1) * (2.0 / self._strips) / (np.pi * patches.a)
        return total.longitudinal, total.lateral, mean
