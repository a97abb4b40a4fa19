"""The rivals of the benchmarks compute what they claim, so that times are compared at a known error."""

from __future__ import annotations

import itertools

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.benchmarks import rivals
from tests.benchmarks.points import DEFAULT_FORCE, DEFAULT_FRICTION, PARAMETERS, Points, reference, workload
from wearlaw import Array

EPS = np.finfo(np.float64).eps
SATURATION = 0.01231910007955531
"""μa/R at the default load and friction, where d = 1."""
ONSETS = (0.011234428572005021, 0.13713328330242472)
"""Creepages there at which the peak of the density reaches the severe and the catastrophic regime."""

needs_compiler = pytest.mark.skipif(not rivals.compilers(), reason="no C compiler")


def at(*creepages: float) -> Points:
    return Points(
        np.full(len(creepages), DEFAULT_FORCE), np.array(creepages), np.full(len(creepages), DEFAULT_FRICTION)
    )


def by_mpmath(force: float, creepage: float, friction: float) -> mpmath.mpf:
    """Return the mean rate with 30 digits from the formulas in x (Johnson 1985, section 4.2; Carter 1926)."""
    with mpmath.workdps(30):
        p = [mpmath.mpf(value) for value in PARAMETERS]
        radius, modulus, width, m_m, q_s, m_c, tr_sc = p
        load, xi, mu = mpmath.mpf(force) / width, mpmath.mpf(creepage), mpmath.mpf(friction)
        a = mpmath.sqrt(4 * load * radius / (mpmath.pi * modulus))
        k, p0 = mu / radius, 2 * load / (mpmath.pi * a)
        c = a - xi / k
        start = -a + 2 * c if c > 0 else -a

        def density(x: mpmath.mpf) -> mpmath.mpf:
            slip = k * mpmath.sqrt((x + a - c) ** 2 - c**2) if c > 0 else xi + k * x
            return mu * p0 * mpmath.sqrt(1 - (x / a) ** 2) * slip

        def rate(x: mpmath.mpf) -> mpmath.mpf:
            w = density(x)
            return min(m_m * w, q_s) + m_c * max(w - tr_sc, 0)

        xs = [start + (a - start) * mpmath.mpf(i) / 400 for i in range(1, 400)]
        top = max(xs, key=density)
        splits = [start, a]
        for level in (q_s / m_m, tr_sc):
            for below in (start, a) if density(top) > level else ():
                above = top
                for _ in range(100):
                    middle = (below + above) / 2
                    below, above = (middle, above) if density(middle) < level else (below, middle)
                splits.append(above)
        return mpmath.quad(rate, sorted(splits)) / (2 * a)


@pytest.mark.validates(
    "integration",
    "The reference of the accuracy page",
    source="mpmath quadrature in 30 digits (Johnson 1985, section 4.2; Carter 1926)",
    held_to="{roundings} ε, relative",
    roundings=50,
)
def test_the_reference_meets_an_integral_in_thirty_digits(roundings: int) -> None:
    points = at(1e-4, 3e-3, 0.01, 0.0122, 0.0124, 0.03, 0.1, 0.12, 0.3)
    expected = [float(by_mpmath(*point)) for point in zip(points.force, points.creepage, points.friction, strict=True)]
    # A sum of rounded terms, of which each carries some ten roundings.
    np.testing.assert_allclose(reference(points), expected, rtol=roundings * EPS)


@needs_compiler
@pytest.mark.parametrize("flags", [rivals.PLAIN_LIBRARY, rivals.FAST, rivals.CHECK], ids=" ".join)
def test_the_closed_form_in_c_meets_the_reference(flags: tuple[str, ...]) -> None:
    compiled = rivals.Compiled(flags)
    close = np.concatenate([-np.logspace(-12, -2, 41), [0.0], np.logspace(-12, -2, 41)])
    for points in (workload(2000), *(at(*creepage * (1.0 + close)) for creepage in (SATURATION, *ONSETS))):
        # Where it sets in, the catastrophic ramp is a difference of terms 145 times the rate, rounded to some ε each.
        np.testing.assert_allclose(compiled.closed_form(points), reference(points), rtol=300 * EPS)


def rounding(points: Points) -> Array:
    """Return how far the mean over cells may move by rounding [kg/m/m²].

    The square of the slip, in units of (ka)², loses 4 ε near the border of stick, so the slip by min(2√ε, 4ε/s),
    and the rate by at most m_c times the traction times that.
    """
    load = points.force / PARAMETERS.width
    a = np.sqrt(4.0 * load * PARAMETERS.radius / (np.pi * PARAMETERS.modulus))
    saturation = points.friction * a / PARAMETERS.radius
    d = (points.creepage / saturation)[:, None]
    x = rivals.centres(rivals.CELLS)
    slip = np.sqrt(np.maximum((x + d) ** 2 - np.maximum(1.0 - d, 0.0) ** 2, 0.0))
    size = np.maximum(1.0, d) ** 2
    lost = np.minimum(2.0 * np.sqrt(EPS * size), 4.0 * EPS * size / np.maximum(slip, 1e-300))
    density = points.friction * 2.0 * load / (np.pi * a) * saturation
    allowed: Array = PARAMETERS.m_c * density * (np.sqrt(1.0 - x * x) * lost).mean(axis=1)
    return allowed


@needs_compiler
@pytest.mark.parametrize("compiler", rivals.compilers())
@pytest.mark.parametrize("flags", [rivals.FAST, rivals.CHECK], ids=" ".join)
def test_cells_in_c_are_cells_in_numpy(compiler: str, flags: tuple[str, ...]) -> None:
    points = workload(2000)
    apart = np.abs(rivals.Compiled(flags, compiler).cells(points) - rivals.numpy_cells(points))
    assert (apart <= rounding(points)).all()


def test_cells_tuned_by_hand_are_the_same_cells() -> None:
    points = workload(2000)
    apart = np.abs(rivals.numpy_cells_in_buffers(points) - rivals.numpy_cells(points))
    assert (apart <= rounding(points)).all()


@pytest.mark.parametrize("chunk", rivals.CHUNKS)
def test_the_chunk_does_not_change_the_mean(chunk: int) -> None:
    points = workload(1001)
    np.testing.assert_array_equal(rivals.numpy_cells(points, chunk=chunk), rivals.numpy_cells(points, chunk=100))


def test_cells_converge_to_the_reference_with_their_number() -> None:
    points = workload(500)
    exact = reference(points)
    rms = [
        float(np.sqrt(np.mean((rivals.numpy_cells(points, count) / exact - 1.0) ** 2))) for count in (100, 1000, 10_000)
    ]
    # The rate falls to zero like a square root at the ends of the slip zone: order 3/2.
    for coarse, fine in itertools.pairwise(rms):
        assert fine < coarse / 10.0**1.25


@needs_compiler
def test_the_rivals_leave_the_arithmetic_of_the_process_alone() -> None:
    rivals.Compiled(("-O3", "-ffast-math"))
    assert np.array([5e-324]) * 1.0 > 0.0
