"""The rivals of elliptic contacts compute what they claim."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import wearlaw as wl
from tests.benchmarks import rivals
from tests.benchmarks.wheel_rail_rivals import Compiled, MarchAndLaw, ellipses, workload
from wearlaw_fastsim._march import Cells, forces, march

EPS = np.finfo(np.float64).eps
CELLS, STRIPS = 30, 21

needs_compiler = pytest.mark.skipif(not rivals.compilers(), reason="no C compiler")


@needs_compiler
@pytest.mark.parametrize("compiler", rivals.compilers())
@pytest.mark.parametrize("flags", [rivals.FAST, rivals.PLAIN_LIBRARY, rivals.CHECK], ids=" ".join)
@pytest.mark.parametrize("elliptic", [False, True], ids=["parabolic", "elliptic"])
def test_the_march_in_c_is_the_march(elliptic: bool, flags: tuple[str, ...], compiler: str) -> None:
    patches = ellipses(workload(200), elliptic=elliptic)
    found, expected = (Cells.empty(200, CELLS, STRIPS, compiled=compiled) for compiled in (True, False))
    Compiled(flags, compiler).march(patches, found)
    march(patches, expected, compiled=False)
    # Each of the steps rounds a traction, or a slip that is a difference of such, up to six times.
    for mine, theirs in zip(found.arrays, expected.arrays, strict=True):
        largest = np.abs(theirs).max(axis=(1, 2), keepdims=True)
        assert (np.abs(mine - theirs) <= 12.0 * CELLS * EPS * largest).all()


@pytest.mark.parametrize("block", [7, 128])
def test_the_rival_in_numpy_evaluates_the_law_in_all_cells(block: int) -> None:
    patches = ellipses(workload(100), elliptic=False)
    patches = dataclasses.replace(patches, bound_centre=5.0 * patches.bound_centre)  # up to the catastrophic regime
    cells = Cells.empty(100, CELLS, STRIPS, compiled=False)
    march(patches, cells, compiled=False)
    total = forces(patches, cells)
    w = cells.traction_x * cells.slip_x + cells.traction_y * cells.slip_y
    assert (w > 77.26e6).any()
    # Continuous at 10.4 and 77.2 N/mm², as in Tassini et al., Wear 268 (2010) 660-667, Table 4.
    rate = np.interp(1e-6 * w, [0.0, 55.0 / 5.3, 77.26, 1e5], [0.0, 55.0, 55.0, 55.0 + 61.9 * (1e5 - 77.26)])
    area = patches.cell_lengths(CELLS, STRIPS) * 2.0 / STRIPS * patches.b[:, None]
    mean = 1e-3 * (rate.sum(axis=1) * area).sum(axis=-1) / (np.pi * patches.a * patches.b)
    longitudinal, lateral, wear = MarchAndLaw(patches, CELLS, STRIPS, block)()
    np.testing.assert_array_equal(longitudinal, total.longitudinal)
    np.testing.assert_array_equal(lateral, total.lateral)
    np.testing.assert_allclose(wear, mean, rtol=1e-12)


def test_the_rival_marches_on_the_patches_of_wearlaw() -> None:
    problem = workload(50)
    contact = wl.contact_model("fastsim", strips=20).solve(problem)
    assert isinstance(contact, wl.Contact)
    found = MarchAndLaw(ellipses(problem, elliptic=False), 200, 50)()
    limit = problem.friction_coefficient * problem.normal_force
    # 200 cells are of first order, one per cent of them is usual with spin; see the tests of the march.
    assert (np.hypot(found[0] - contact.force_x, found[1] - contact.force_y) < 0.01 * limit).all()
