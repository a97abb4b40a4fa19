"""The record of a solved elliptic contact: vectors, totals, strips and patch means."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Array, Q


def problem(points: int = 2) -> wl.Problem:
    return wl.Problem.ellipse(
        a=Q(6, "mm"),
        b=Q(4, "mm"),
        normal_force=Q(np.linspace(50, 100, points), "kN"),
        shear_modulus=Q(82, "GPa"),
        poisson_ratio=0.28,
        friction_coefficient=0.3,
        longitudinal_creepage=Q(0.2, "%"),
        lateral_creepage=Q(-0.1, "%"),
        spin=Q(0.5, "1/m"),
        rolling_speed=Q(20, "m/s"),
    )


def forces(points: int = 2) -> wl.CreepForces:
    return wl.CreepForces(
        longitudinal=np.full(points, 3e3), lateral=np.full(points, -4e3), spin_moment=np.full(points, 2.0)
    )


def on_strips() -> wl.Contact:
    """Return two points of three strips with four nodes each, and numbers that all differ."""
    random = np.random.default_rng(3)
    x = np.broadcast_to(np.linspace(-2e-3, 2e-3, 4)[:, None], (2, 4, 3))

    def one() -> Array:
        return random.uniform(0.5, 1.5, (2, 4, 3))

    return wl.Contact.from_strips(
        problem(),
        forces(),
        x=x,
        y=np.broadcast_to(np.array([-2e-3, 0.0, 1e-3]), (2, 3)),
        length=1e-3 * one(),
        strip_width=np.broadcast_to(np.array([2e-3, 3e-3, 1e-3]), (2, 3)),
        traction=(1e8 * one(), -1e8 * one()),
        slip=(1e-3 * one(), -1e-3 * one()),
        traction_bound=np.full((2, 4, 3), 3e8),
    )


def test_scaled_slip_dissipates_what_is_fed_in_and_keeps_its_directions() -> None:
    contact = on_strips()
    scaled = contact.scaled_to_wear_index()
    assert scaled.cell_wear_index == pytest.approx(contact.wear_index, rel=16 * EPS)
    factor = scaled.slip_x / contact.slip_x
    assert factor == pytest.approx(np.broadcast_to(factor[:, :1, :1], factor.shape), rel=4 * EPS)
    assert scaled.slip_y == pytest.approx(factor * contact.slip_y, rel=4 * EPS)
    assert scaled.slip == pytest.approx(factor * contact.slip, rel=4 * EPS)
    assert scaled.traction is contact.traction


def test_slip_that_is_nowhere_cannot_be_scaled() -> None:
    contact = on_strips()
    stuck = contact.replaced(slip=0 * contact.slip, slip_x=0 * contact.slip, slip_y=0 * contact.slip)
    with pytest.raises(wl.InputError, match="no node of the contact dissipates energy"):
        stuck.scaled_to_wear_index()


@pytest.mark.parametrize("fed_in", [1.0, -1.0, 0.25])
def test_slip_is_scaled_where_there_is_any_and_free_rolling_stays(fed_in: float) -> None:
    contact, rolls = on_strips(), np.array([[[1.0]], [[0.0]]])
    little = 1e-2 * rolls  # dissipates less than one newton
    fields = {name: little * getattr(contact, name) for name in ("slip", "slip_x", "slip_y")}
    contact = contact.replaced(**fields, wear_index=np.array([0.25, 0.0]))
    assert 0.0 < contact.cell_wear_index[0] < 1.0
    scaled = contact.scaled_to_wear_index()
    assert scaled.cell_wear_index == pytest.approx([0.25, 0.0], rel=16 * EPS)
    assert (scaled.slip[1] == 0.0).all()
    with pytest.raises(wl.InputError, match="no node of the contact dissipates energy"):
        contact.replaced(wear_index=np.array([0.25, fed_in])).scaled_to_wear_index()


def test_a_patch_as_one_node_holds_means_that_dissipate_the_same() -> None:
    patch = wl.Contact.of_patch(problem(), forces())
    area = np.pi * 6e-3 * 4e-3
    assert patch.pressure.shape == (2, 1, 1)
    assert patch.patch_area == pytest.approx([area] * 2, rel=4 * EPS)
    assert patch.traction[:, 0, 0] == pytest.approx([5e3 / area] * 2, rel=4 * EPS)
    assert patch.traction_x[:, 0, 0] == pytest.approx([3e3 / area] * 2, rel=4 * EPS)
    assert patch.traction_y[:, 0, 0] == pytest.approx([-4e3 / area] * 2, rel=4 * EPS)
    assert patch.pressure[:, 0, 0] == pytest.approx([5e4 / area, 1e5 / area], rel=4 * EPS)
    assert patch.traction_bound[:, 0, 0] == pytest.approx([1.5e4 / area, 3e4 / area], rel=8 * EPS)
    assert patch.strip_width[:, 0] == pytest.approx([8e-3] * 2, rel=4 * EPS)
    assert patch.cell_wear_index == pytest.approx(patch.wear_index, rel=8 * EPS)
    assert (patch.slip_x[0, 0, 0], patch.slip_y[0, 0, 0]) == pytest.approx((2e-3, -1e-3), rel=4 * EPS)


def test_the_slip_of_a_patch_is_the_root_mean_square_of_the_rigid_slip() -> None:
    # ∫ (ξ - φy)² + (η - φx)² over the ellipse, by polar coordinates: exact for a polynomial of second degree.
    angle = 2 * np.pi * np.arange(8) / 8
    radius, weight = np.polynomial.legendre.leggauss(4)
    r, w = 0.5 + 0.5 * radius[:, None], 0.5 * weight[:, None]
    x, y = 6e-3 * r * np.cos(angle), 4e-3 * r * np.sin(angle)
    square = (2e-3 - 0.5 * y) ** 2 + (-1e-3 - 0.5 * x) ** 2
    mean = float((square * w * r).sum() / (w * r * np.ones(8)).sum())
    assert problem().rigid_slip == pytest.approx([np.sqrt(mean)] * 2, rel=16 * EPS)
    assert wl.Contact.of_patch(problem(), forces()).slip[:, 0, 0] == pytest.approx([np.sqrt(mean)] * 2, rel=16 * EPS)


def test_patch_means_of_strips_are_those_of_a_model_that_knows_the_forces_alone() -> None:
    contact = on_strips()
    means, area = contact.patch_mean(), contact.patch_area
    assert means.pressure[:, 0, 0] == pytest.approx(contact.normal_force / area, rel=8 * EPS)
    assert means.traction[:, 0, 0] == pytest.approx(5e3 / area, rel=8 * EPS)
    assert means.slip[:, 0, 0] == pytest.approx(problem().rigid_slip, rel=2 * EPS)
    assert means.wear_index_density[:, 0, 0] * area == pytest.approx(contact.wear_index, rel=8 * EPS)
    assert means.traction_x[:, 0, 0] == pytest.approx(3e3 / area, rel=8 * EPS)
    assert means.traction_y[:, 0, 0] == pytest.approx(-4e3 / area, rel=8 * EPS)
    assert means.strip_width == pytest.approx(np.full((2, 1), 6e-3), rel=8 * EPS)
    assert means.traction_bound[0, 0, 0] == pytest.approx(3e8, rel=8 * EPS)
    # A node without area, such as one of a zone without length, has any bound.
    empty = contact.area.copy()
    empty[:, 0] = 0.0
    bound = np.where(empty == 0.0, np.inf, contact.traction_bound)
    means = contact.replaced(area=empty, traction_bound=bound).patch_mean()
    assert means.traction_bound[0, 0, 0] == pytest.approx(3e8, rel=8 * EPS)
