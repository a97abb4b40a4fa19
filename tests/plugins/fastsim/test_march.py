"""Kalker's march: what holds in every cell."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.ellipses import of_ratio
from tests.plugins.fastsim.march import CREEPAGES, sample
from tests.plugins.fastsim.marks import each_bound
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.march import (  # private: patches with any flexibilities
    Cells,
    Ellipses,
    forces,
    march,
    strip_centres,
)


def power(cells: Cells) -> Array:
    """Return q·s [N/m²]."""
    return cells.traction_x * cells.slip_x + cells.traction_y * cells.slip_y


def summed(value: Array, ellipses: Ellipses) -> Array:
    """Return the sum over the patch of cells, times their areas."""
    _, count, strips = value.shape
    area = ellipses.cell_lengths(count, strips) * (2.0 / strips) * ellipses.b[:, None]
    total: Array = (value.sum(axis=1) * area).sum(axis=-1)
    return total


def rounding(ellipses: Ellipses, cells: Cells) -> tuple[Array, Array]:
    """Return by how much tractions [Pa] and slips [-] may differ between ways to sum up the growth of the traction.

    Each of n steps rounds a traction that is within its bound six times. Slip is the difference of what has grown and
    what is left of it, over the length of a cell and times the flexibility, of which the growth is the rigid slip.
    """
    count, strips = cells.x.shape[1:]
    traction = 6.0 * count * EPS * ellipses.bound_centre[:, None, None]
    size = np.maximum(ellipses.a, ellipses.b)
    growth = (
        np.abs(ellipses.longitudinal_creepage) / ellipses.longitudinal_flexibility
        + np.abs(ellipses.lateral_creepage) / ellipses.lateral_flexibility
        + 2.0 * np.abs(ellipses.spin) / ellipses.spin_flexibility * size
    )
    flexibility = np.maximum(ellipses.longitudinal_flexibility, ellipses.lateral_flexibility)[:, None, None]
    per_length = 2.0 * traction / ellipses.cell_lengths(count, strips)[:, None, :]
    return traction, flexibility * (per_length + 12.0 * EPS * growth[:, None, None])


def assert_same_cells(found: Cells, expected: Cells, ellipses: Ellipses) -> None:
    traction, slip = rounding(ellipses, expected)
    size = np.abs(expected.x).max(axis=(1, 2), keepdims=True)
    allowed = {"x": 6.0 * EPS * size, "bound": traction}
    for name in ("traction_x", "traction_y", "slip_x", "slip_y", *allowed):
        near = allowed.get(name, traction if name.startswith("traction") else slip)
        assert (np.abs(getattr(found, name) - getattr(expected, name)) <= near).all(), name


@each_bound
def test_the_bound_is_kept_and_is_the_mean_of_both_ends(elliptic: bool) -> None:
    ellipses = sample(200, elliptic)
    cells = march(ellipses, 30, 7)
    # q and the bound are sums of two terms each, of which q has another three roundings.
    assert (np.hypot(cells.traction_x, cells.traction_y) <= cells.bound * (1.0 + 8.0 * EPS)).all()
    half = 0.5 * ellipses.cell_lengths(30, 7)[:, None, :]
    share = (strip_centres(7) * np.ones(30)[:, None])[None]
    ends = [1.0 - ((cells.x + side) / ellipses.a[:, None, None]) ** 2 - share**2 for side in (-half, half)]
    ends = [np.sqrt(np.maximum(end, 0.0)) if elliptic else np.maximum(end, 0.0) for end in ends]
    expected = 0.5 * ellipses.bound_centre[:, None, None] * (ends[0] + ends[1])
    # 1 - (x/a)² - (y/b)² loses some ε, of which the root makes more where it is zero.
    near = 1e-7 if elliptic else 16.0 * EPS
    np.testing.assert_allclose(cells.bound, expected, atol=near * ellipses.bound_centre.max(), rtol=16.0 * EPS)


@each_bound
def test_slip_is_zero_in_stick_and_only_there(elliptic: bool) -> None:
    ellipses = sample(200, elliptic, spin=0.0)
    cells = march(ellipses, 30, 7)
    growth = np.hypot(
        ellipses.longitudinal_creepage / ellipses.longitudinal_flexibility,
        ellipses.lateral_creepage / ellipses.lateral_flexibility,
    )
    s = np.sqrt(1.0 - strip_centres(7) ** 2)
    end = 2.0 * np.arange(1, 31)[:, None] / 30.0  # from the leading edge, over the half length
    bound = ellipses.bound_centre[:, None, None] * (
        s * np.sqrt(end * (2.0 - end)) if elliptic else s * s * end * (2.0 - end)
    )
    grown = growth[:, None, None] * end * ellipses.a[:, None, None] * s
    slips = np.hypot(cells.slip_x, cells.slip_y) > 0.0
    clear = np.abs(grown - bound) > 100.0 * EPS * grown
    assert (slips == (grown > bound))[clear].all()
    assert 0.2 < slips.mean() < 0.9


@each_bound
def test_without_spin_the_cells_dissipate_what_the_forces_do(elliptic: bool) -> None:
    ellipses = sample(200, elliptic, spin=0.0)
    cells = march(ellipses, 30, 7)
    found = forces(ellipses, cells)
    expected = ellipses.longitudinal_creepage * found.longitudinal + ellipses.lateral_creepage * found.lateral
    traction, slip = rounding(ellipses, cells)
    reach = np.hypot(ellipses.longitudinal_creepage, ellipses.lateral_creepage)[:, None, None]
    allowed = summed(cells.bound * slip + traction * reach, ellipses)
    assert (power(cells) >= 0.0).all()
    assert (np.abs(summed(power(cells), ellipses) - expected) <= allowed).all()


@each_bound
def test_a_mirrored_problem_has_the_mirrored_solution(elliptic: bool) -> None:
    ellipses = sample(100, elliptic)
    mirrored = dataclasses.replace(ellipses, lateral_creepage=-ellipses.lateral_creepage, spin=-ellipses.spin)
    cells, image = march(ellipses, 30, 8), march(mirrored, 30, 8)
    signs = {"traction_y": -1.0, "slip_y": -1.0}
    back = {name: signs.get(name, 1.0) * array[..., ::-1] for name, array in image._asdict().items()}
    assert_same_cells(Cells(**back), cells, ellipses)
    found, other = forces(ellipses, cells), forces(mirrored, image)
    limit = 8 * 30 * EPS * np.pi * ellipses.a * ellipses.b * ellipses.bound_centre
    assert (np.abs(found.longitudinal - other.longitudinal) < limit).all()
    assert (np.abs(found.lateral + other.lateral) < limit).all()
    assert (np.abs(found.spin_moment + other.spin_moment) < limit * np.maximum(ellipses.a, ellipses.b)).all()


@each_bound
def test_without_creepage_or_friction_nothing_is_transmitted(elliptic: bool) -> None:
    at_rest = march(sample(3, elliptic, **dict.fromkeys(CREEPAGES, 0.0)), 10, 5)
    for name in ("traction_x", "traction_y", "slip_x", "slip_y"):
        assert (getattr(at_rest, name) == 0.0).all()
    smooth = sample(3, elliptic, bound_centre=0.0, spin=0.0)
    cells = march(smooth, 10, 5)
    assert (cells.traction_x == 0.0).all()
    assert (cells.traction_y == 0.0).all()
    # The growth over the length of a cell, and back.
    creepage = smooth.longitudinal_creepage[:, None, None]
    np.testing.assert_allclose(cells.slip_x, np.broadcast_to(creepage, cells.x.shape), rtol=8.0 * EPS)


@pytest.mark.parametrize("bound", ["parabolic", "elliptic"])
def test_a_uniform_march_has_its_own_forces_near_those_of_the_adaptive_one(bound: str) -> None:
    problem = of_ratio(1.5, 0.28, longitudinal_creepage=1e-3, lateral_creepage=-5e-4, spin=0.2)
    uniform, adaptive = (
        wl.contact_model("fastsim", bound=bound, march=march, strips=20) for march in ("uniform", "adaptive")
    )
    contact, forces = uniform.solve(problem), uniform.creep_forces(problem)
    assert contact.traction_x.shape[-1] == 20, "as many cells in a strip as strips"
    assert contact.force_x == pytest.approx(forces.longitudinal, rel=1e-12)  # sums of 400 cells
    assert contact.force_y == pytest.approx(forces.lateral, rel=1e-12)
    other, full_slip = adaptive.creep_forces(problem), problem.friction_coefficient * problem.normal_force
    apart = np.hypot(forces.longitudinal - other.longitudinal, forces.lateral - other.lateral) / full_slip
    assert 1e-6 < apart < uniform.elliptic_accuracy + adaptive.elliptic_accuracy


@pytest.mark.parametrize("strips", [1, 1001, 10.0])
def test_strips_are_a_whole_number_from_2_to_1000(strips: object) -> None:
    with pytest.raises(wl.ConfigurationError, match="strips"):
        wl.contact_model("fastsim", strips=strips)


def test_settings_of_an_ellipse_are_shown_where_they_differ_from_the_default() -> None:
    assert "strips" not in repr(wl.contact_model("fastsim"))
    assert "bound='parabolic'" in repr(wl.contact_model("fastsim", strips=20))
    assert "strips=20" in repr(wl.contact_model("fastsim", strips=20))


@pytest.mark.parametrize(("march", "share"), [("adaptive", 0.5), ("uniform", 1.0)])
def test_the_stated_accuracy_is_in_inverse_proportion_to_the_strips(march: str, share: float) -> None:
    model = wl.contact_model("fastsim", march=march, strips=20)
    assert model.elliptic_accuracy == share / 20
    assert model.refined() == wl.contact_model("fastsim", march=march, strips=40)
