"""Tractions and slips along the strips of FASTSIM: against a fine march of its own and a line, and Coulomb's law."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.fastsim.strips import (
    CASE,
    COMPILED,
    ROUNDING,
    each_bound,
    ellipses,
    limit,
    plain_march,
    sample,
    solve,
    strips_at,
)
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.strips import Ellipses  # private: patches with any flexibilities
from wearlaw_models.contact_models.fastsim.zones import (  # private: whatever the excess along a slip zone
    Nodes,
    _where_it_sticks,
)
from wearlaw_models.strips import even_strips  # private: with any number of nodes


def test_parabola_slips_everywhere_beyond_its_last_creepage() -> None:
    # |w| a/g is 9 in the centre, where it is least; at 2 the slip zone reaches the leading edge
    xi, eta = 3e-2, -2e-2
    patches = ellipses(xi, eta, elliptic=False)
    found = solve(patches, stick=2)
    fields = found.fields
    w = np.array([xi / CASE["l1"], eta / CASE["l2"]])
    direction = w / np.hypot(*w)
    slip = fields.length > 0.0
    assert slip[:, 2:].all()
    assert not fields.length[:, :2].any()
    np.testing.assert_allclose(fields.traction_x[:, 2:], direction[0] * fields.bound[:, 2:], rtol=ROUNDING)
    np.testing.assert_allclose(fields.traction_y[:, 2:], direction[1] * fields.bound[:, 2:], rtol=ROUNDING)
    slope = -2.0 * CASE["centre"] / CASE["a"] ** 2 * fields.x  # dg/dx of the parabola
    expected = CASE["l1"] * direction[0] * (np.hypot(*w) - slope)
    np.testing.assert_allclose(fields.slip_x[:, 2:], expected[:, 2:], rtol=1e-12)
    # the sum of sin⁴ over even angles is exact
    np.testing.assert_allclose(np.hypot(found.forces.longitudinal, found.forces.lateral), limit(patches), rtol=1e-12)


def differences(patches: Ellipses, shares: Array, counts: tuple[int, ...]) -> tuple[list[float], Array]:
    """Return how far the traction is at most from the plain march's limit, over the bound, and where that one slips."""
    _, half_x, half_y, _ = plain_march(patches, shares, 8000)
    angle, whole_x, whole_y, slips = plain_march(patches, shares, 16000)
    limits = [2.0 * whole[::2] - half for whole, half in ((whole_x, half_x), (whole_y, half_y))]
    found = []
    for count in counts:
        fields = strips_at(patches, shares, 3, count)
        at = np.arccos(fields.x / (patches.a[:, None, None] * np.sqrt(1.0 - shares**2)))
        off = [
            np.abs(traction[p, :, j] - np.interp(-at[p, :, j], -angle[::2], there[:, p, j])).max()
            for traction, there in zip((fields.traction_x, fields.traction_y), limits, strict=True)
            for p in range(len(patches.a))
            for j in range(shares.size)
        ]
        found.append(float(max(off)) / CASE["centre"])
    return found, slips


@pytest.mark.validates(
    "elliptic-contact",
    "Traction of FASTSIM with spin, from little creepage to full slip",
    source="the published march, written anew, on 8000 and 16000 cells, extrapolated",
    held_to="{coarse_within:g} of the bound on eight nodes, in order {order:g} at least",
    coarse_within=0.002,
    order=1.6,
)
@each_bound
def test_traction_meets_the_limit_of_the_plain_march_in_second_order(
    elliptic: bool, coarse_within: float, order: float
) -> None:
    (coarse, fine), _ = differences(sample(elliptic, count=12), even_strips(7)[0], (8, 32))
    assert coarse < coarse_within
    assert fine < coarse / 4**order  # second order would be 16; there are strips with w near zero among them


@pytest.mark.validates(
    "elliptic-contact",
    "Strips of FASTSIM that slip, stick and slip again",
    source="the published march, written anew, on 8000 and 16000 cells, extrapolated",
    held_to="{coarse_within:g} of the bound on eight nodes, in order {order:g} at least",
    coarse_within=0.003,
    order=1.6,
)
@each_bound
def test_strips_that_stick_again_meet_the_limit_of_the_plain_march_in_second_order(
    elliptic: bool, coarse_within: float, order: float
) -> None:
    patches = ellipses([1e-4, -2e-4], [1e-3, 1e-4], [1.5, 2.0], elliptic=elliptic)
    (coarse, fine), slips = differences(patches, np.array([-0.01, 0.02]), (8, 32))
    changes = np.diff(slips[2:].astype(int), axis=0)  # in the first cell the parabola itself slips or not
    assert (changes == -1).any(axis=0).all()
    assert slips[-1].all()
    assert coarse < coarse_within
    assert fine < coarse / 4**order


@pytest.mark.validates(
    "elliptic-contact",
    "A strip with the flexibility of a line is the line contact, both bounds",
    source="closed forms of line contact (Tassini et al. 2010, section 3.2.2)",
    held_to="{within:g}, relative",
    within=1e-12,
)
@each_bound
def test_centre_strip_with_the_flexibility_of_a_line_is_the_line_contact(elliptic: bool, within: float) -> None:
    a, modulus, friction = CASE["a"], 1.12e11, 0.3
    p0 = CASE["centre"] / friction
    radius = modulus * a / (2.0 * p0)
    xi = np.geomspace(1e-5, 0.1, 30)
    patches = ellipses(xi, elliptic=elliptic, l1=4.0 * a / (np.pi * modulus))
    fields = strips_at(patches, np.zeros(1), 3, 12)
    force = (fields.length * fields.traction_x).sum(axis=1)[:, 0]
    reduced = np.pi * xi * radius / (2.0 * friction * a)
    if elliptic:
        expected = CASE["centre"] * a * (np.arctan(reduced) + reduced / (1.0 + reduced**2))
    else:  # a parabola of the same height: μP [1 - (1-d)³], d = κ/2, where μP = 4/3 a μp0
        expected = 4.0 / 3.0 * a * CASE["centre"] * (1.0 - (1.0 - np.minimum(reduced / 2.0, 1.0)) ** 3)
    np.testing.assert_allclose(force, expected, rtol=within)


def check_laws(patches: Ellipses, shares: Array) -> Array:
    """Check what holds in all strips and return which of them stick again."""
    fields = strips_at(patches, shares, 3, 8)
    for name in ("x", "length", "traction_x", "traction_y", "slip_x", "slip_y", "bound"):
        assert np.isfinite(getattr(fields, name)).all(), name
    traction, slip = np.hypot(fields.traction_x, fields.traction_y), np.hypot(fields.slip_x, fields.slip_y)
    assert (traction <= fields.bound * (1.0 + ROUNDING)).all()
    assert (slip[traction < fields.bound * (1.0 - ROUNDING)] == 0.0).all()
    l1, l2 = patches.longitudinal_flexibility[:, None, None], patches.lateral_flexibility[:, None, None]
    over_l = fields.slip_x / l1, fields.slip_y / l2  # is along the traction
    assert (over_l[0] * fields.traction_x >= 0.0).all()
    assert (over_l[1] * fields.traction_y >= 0.0).all()
    across = over_l[0] * fields.traction_y - over_l[1] * fields.traction_x
    assert (np.abs(across) <= ROUNDING * np.hypot(*over_l) * traction).all()
    assert (np.diff(fields.x, axis=1) >= 0.0).all()
    assert (fields.length >= 0.0).all()
    half_length = patches.a[:, None] * np.sqrt((1.0 - shares) * (1.0 + shares))
    again = np.asarray((slip[:, 3:] == 0.0).any(axis=1))
    error = np.abs(fields.length.sum(axis=1) / (2.0 * half_length) - 1.0)
    # Gauss's quadrature of the sine over π, half of π^(2n+1) n!^4 / ((2n+1) (2n)!^3), by 8 nodes or 3 in a zone
    assert error[~again].max() < 1e-12
    assert error[again].max() < 7.5e-4
    return again


@pytest.mark.validates(
    "invariants",
    "FASTSIM on strips: |q| ≤ bound, no slip below it, slip along the traction, creepages from 1e-12 to 1",
    source="Coulomb's law",
    held_to="a hundred roundings",
)
@each_bound
def test_fields_keep_their_laws_at_any_creepage(elliptic: bool) -> None:
    random = np.random.default_rng(5)
    signs = random.choice([-1.0, 0.0, 1.0], (3, 400), p=[0.45, 0.1, 0.45])
    xi, eta, phi = signs * 10.0 ** random.uniform(-12, 0, (3, 400))
    patches = ellipses(xi, eta, 100.0 * phi, elliptic=elliptic)
    assert check_laws(patches, np.array([-0.999999, -0.6, 0.0, 0.3, 0.999999])).any()


@each_bound
def test_fields_keep_their_laws_however_strips_stick_and_slip(elliptic: bool) -> None:
    # with sizes of one, xi, eta and phi/2 are what the traction grows by
    random = np.random.default_rng(6)
    xi = random.choice([-1.0, 1.0], 30000) * 10.0 ** random.uniform(-12.0, 1.0, 30000)
    phi = random.choice([-1.0, 1.0], 30000) * 10.0 ** random.uniform(-0.5, 1.8, 30000)
    unit = dict.fromkeys(CASE, 1.0)
    patches = ellipses(xi, phi * random.uniform(-1.0, 1.0, 30000), phi, elliptic=elliptic, **unit)
    assert check_laws(patches, np.zeros(1)).mean() > 0.2


@pytest.mark.skipif(True not in COMPILED, reason="numba is not installed")
@each_bound
def test_compiled_loops_are_the_same_as_numpy(elliptic: bool) -> None:
    # strips that slip from the leading edge, that stick again, that stick in part and that do not slip
    patches = ellipses(
        [3e-2, 1e-4, -2e-4, 2e-3, 0.0], [0, 1e-3, 1e-4, -1e-3, 0], [0, 1.5, 2, 0.2, 0], elliptic=elliptic
    )
    shares = np.array([-0.9, -0.3, -0.01, 0.02, 0.5])
    found = []
    for on in (False, True):
        wl.accelerate(on)
        found.append(strips_at(patches, shares, 4, 10))
    wl.accelerate(None)
    for name in found[0]._fields:
        plain, compiled = (getattr(fields, name) for fields in found)
        # rounding of some ten operations in each of the nodes, as where a patch is mirrored
        np.testing.assert_allclose(compiled, plain, rtol=0.0, atol=1000 * EPS * np.abs(plain).max(), err_msg=name)


def test_a_slip_zone_whose_excess_does_not_fall_to_zero_after_all_sticks_where_it_is_least() -> None:
    x = np.array([0.1, 0.4, 0.7])[:, None]
    bound, none = 1.0 - x**2, np.zeros((3, 1))
    zone = Nodes(x, none + 1.0, bound, 0.6 * bound, -0.8 * bound, none, none, np.array([[3.0], [0.5], [2.0]]))
    point = _where_it_sticks(zone, elliptic=False)
    assert np.cos(point.angle) == pytest.approx(0.4, rel=ROUNDING)
    assert (point.x[0], point.y[0]) == pytest.approx((0.6 * 0.84, -0.8 * 0.84), rel=ROUNDING)
    at_once = _where_it_sticks(zone._replace(excess=np.array([[-1.0], [-2.0], [2.0]])), elliptic=False)
    assert np.cos(at_once.angle) == pytest.approx(0.1, rel=ROUNDING)
