"""Where a strip of FASTSIM first slips, against a scan along it and against roots in fifty digits."""

from __future__ import annotations

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.plugins.fastsim.strips import each_bound
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.zones import (  # private: strips with any growth of the traction
    Growth,
    first_slip,
)

ANGLES = np.linspace(np.pi, 0.0, 4001)[:, None]


def growths() -> Growth:
    """Return strips that stick wholly, in part or not at all, with spin that helps the creepage or works against it."""
    random = np.random.default_rng(1)
    p, r, s = (random.choice([-1.0, 1.0], 3000) * 10.0 ** random.uniform(-4.0, 2.0, 3000) for _ in range(3))
    p[:1000] *= 1e-3
    r[500:2000] = -s[500:2000] * random.uniform(0.0, 2.2, 1500)  # w changes its sign within the strip
    return Growth(p, r, s)


def room(growth: Growth, angle: Array, elliptic: bool) -> Array:
    """Return by how much a strip that has stuck so far could still grow, over U."""
    u, v = 2.0 * np.cos(angle / 2) ** 2, 2.0 * np.sin(angle / 2) ** 2
    grown = np.hypot(growth.along, growth.across + growth.turning * v)
    with np.errstate(divide="ignore"):
        return (np.sqrt(v / u) if elliptic else v) - grown


@each_bound
def test_strip_sticks_up_to_the_first_point_of_a_scan_where_it_can_grow_no_more(elliptic: bool) -> None:
    growth = growths()
    found = 2.0 * np.arctan(np.sqrt(first_slip(growth, elliptic)))
    beyond = room(growth, ANGLES, elliptic) < 0.0
    first = beyond.argmax(axis=0)
    assert beyond.any(axis=0).all()
    after, before = ANGLES[first, 0], ANGLES[np.maximum(first - 1, 0), 0]
    rounding = 4 * EPS * np.pi
    assert (found >= after - rounding).all()
    assert (found <= before + rounding).all()
    assert 200 < (first == 0).sum() < 2800 or elliptic  # strips that slip from the leading edge are among them


def is_root(found: float, growth: tuple[float, float, float], elliptic: bool, tolerance: float) -> bool:
    """Return whether |q|² - g² over U² changes its sign within a share of V/U, in sixty digits."""
    with mpmath.workdps(60):
        p, r, s = map(mpmath.mpf, growth)

        def beyond(ratio: mpmath.mpf) -> bool:
            v = 2 * ratio / (1 + ratio)
            return bool(p**2 + (r + s * v) ** 2 > (ratio if elliptic else v**2))

        here = mpmath.mpf(found)
        return beyond(here * (1 - tolerance)) and not beyond(here * (1 + tolerance))


@pytest.mark.validates(
    "integration",
    "Where a strip of FASTSIM first slips, down to a creepage of 1e-7",
    source="the sign of |q|² - g² in 60 digits",
    held_to="{roundings} ε, relative",
    roundings=50,
)
@each_bound
@pytest.mark.parametrize("size", [1e-7, 1e-5, 1e-2])
def test_little_creepage_has_its_short_slip_zone_to_rounding(elliptic: bool, size: float, roundings: int) -> None:
    # V/U is a difference of numbers near 1 in the cubic, as V is one of D and RS in the quadratic
    random = np.random.default_rng(2)
    p, r, s = (random.uniform(-1.0, 1.0, 40) for _ in range(3))
    growth = Growth(size * p, size * r, s)
    for found, *values in zip(first_slip(growth, elliptic), *growth, strict=True):
        assert is_root(found, tuple(values), elliptic, roundings * EPS)  # some ten operations, among them squares


def test_parabola_has_no_singularity_where_spin_alone_grows_as_fast_as_the_bound() -> None:
    values = [(0.3, r, s) for s in (1.0, 1.0 - 1e-9, 1.0 - 1e-15) for r in (-0.2, -0.05)]
    values.append((1e-10, 1e-9, 1.0 - 1e-8))  # where D and RS are nearly the same
    for growth, found in zip(values, first_slip(Growth(*np.array(values).T), False), strict=True):
        assert is_root(found, growth, False, 50 * EPS)


@pytest.mark.parametrize("off", [1e-3, 1e-6, 1e-9])
def test_strip_under_the_ellipse_that_nearly_touches_its_bound_first_is_told_from_one_that_does(off: float) -> None:
    # G = P² + (R + 2 S w/(1+w))² touches w from below where its slope is 1; there two of the cubic's roots coincide,
    # above the third if 4 S² < (1+w)³. A little more of R makes it cross, a little less leaves the third root alone.
    w = np.array([0.5, 1.0, 3.0, 10.0])
    s = 0.5 * np.sqrt((1.0 + w) ** 3 * np.sqrt((1.0 + w) / (4.0 * w)))
    lateral = (1.0 + w) ** 2 / (4.0 * s)
    p, r = np.sqrt(w - lateral**2), lateral - 2.0 * s * w / (1.0 + w)
    more, less = Growth(p, r + off * lateral, s), Growth(p, r - off * lateral, s)
    crosses, passes = first_slip(more, True), first_slip(less, True)
    root = np.sqrt(off)  # the two roots lie about this apart, which divides the rounding
    curvature = 2.0 / (1.0 + w) - 8.0 * s**2 / (1.0 + w) ** 4  # -G''
    np.testing.assert_allclose((crosses - w) / root, 2.0 * lateral / np.sqrt(curvature), rtol=10.0 * root)
    np.testing.assert_allclose(passes, 4.0 * s**2 / (1.0 + w) ** 2 - 1.0, rtol=100.0 * off)
    for found, growth in ((crosses, more), (passes, less)):
        for ratio, *values in zip(found, *growth, strict=True):
            assert is_root(ratio, tuple(values), True, 100 * EPS / root)


@each_bound
def test_spin_that_vanishes_moves_no_slip_zone(elliptic: bool) -> None:
    p, r = np.array([0.3, -1.5, 0.0]), np.array([0.2, 0.4, 0.7])
    without, hardly = (first_slip(Growth(p, r, np.full(3, s)), elliptic) for s in (0.0, 1e-14))
    np.testing.assert_allclose(hardly, without, rtol=100 * 1e-14)  # to first order in S
    square = p * p + r * r
    expected = square if elliptic else np.sqrt(square) / (2.0 - np.sqrt(square))
    np.testing.assert_allclose(without, expected, rtol=10 * EPS)


def test_strip_slips_from_its_leading_edge_where_the_parabola_rises_slower_than_the_traction() -> None:
    p = np.array([2.0 - 1e-9, 2.0, 2.0 + 1e-9, 50.0])
    found = first_slip(Growth(p, np.zeros(4), np.zeros(4)), False)
    assert np.isfinite(found).tolist() == [True, False, False, False]


def test_strip_at_the_brink_of_slipping_from_its_leading_edge_has_a_first_slip_there() -> None:
    random = np.random.default_rng(4)
    angle, s = random.uniform(0.0, 2.0 * np.pi, 2000), random.uniform(-3.0, 3.0, 2000)
    rate = 2.0 - EPS * np.floor(random.uniform(0.0, 6.0, 2000))
    found = first_slip(Growth(rate * np.cos(angle), rate * np.sin(angle) - 2.0 * s, s), False)
    # V is known to rounding over the slope of |q|/U against V there, which vanishes where the root is double
    assert (found > 0.0).all()
    assert np.median(1.0 / (1.0 + found)) < 10 * EPS


@each_bound
def test_strip_without_creepage_sticks_to_its_trailing_edge(elliptic: bool) -> None:
    s = np.linspace(-0.99, 0.99, 500)
    found = first_slip(Growth(np.zeros(500), np.zeros(500), s), elliptic)
    assert (found >= 0.0).all()
    np.testing.assert_allclose(found, 0.0, atol=EPS**1.5)  # of the cubic's rounding Newton's step leaves the square


def test_ellipse_that_spin_alone_just_touches_is_met_there() -> None:
    found = first_slip(Growth(np.zeros(2), np.zeros(2), np.array([1.0, -1.0])), True)
    np.testing.assert_allclose(found, 1.0, atol=10 * EPS**0.5)  # a double root, in the middle of the strip


def test_ellipse_slips_at_the_far_end_of_the_lobe_that_spin_alone_fills() -> None:
    # U V S² = 1 at U = 1 ± sqrt(1 - 1/S²), the smaller of which comes first
    s = np.array([1.001, 1.5, 40.0])
    u = 1.0 - np.sqrt((1.0 - 1.0 / s) * (1.0 + 1.0 / s))
    found = first_slip(Growth(np.zeros(3), np.zeros(3), s), True)
    np.testing.assert_allclose(2.0 / (1.0 + found), u, rtol=1e-10)


def test_far_beyond_the_bound_nothing_overflows() -> None:
    growth = Growth(*(np.full(1, size) for size in (1e30, -1e25, 1e28)))
    assert first_slip(growth, False)[0] == np.inf
    np.testing.assert_allclose(first_slip(growth, True), 1e60, rtol=1e-3)  # U w² = 2 at the leading edge
