"""What FASTSIM takes from a contact problem, and the cells and strips that it hands back."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.ellipses import EPS, TABLE_E3, ellipse, of_ratio
from wearlaw import Q
from wearlaw_models.contact_models.fastsim.strips import Ellipses  # private: the flexibilities

Bound = Literal["elliptic", "parabolic"]
BOUNDS: tuple[Bound, ...] = ("elliptic", "parabolic")


def two_loads() -> wl.Problem:
    """Two ellipses that slip in part, a/b = 1/2 and larger."""
    return ellipse(a=Q([3.0, 4.0], "mm"), longitudinal_creepage=np.array([1e-3, 2e-3]), lateral_creepage=5e-4, spin=0.2)


@pytest.mark.parametrize(("axis_ratio", "poisson_ratio"), TABLE_E3)
@pytest.mark.parametrize(("elliptic", "share"), [(True, 1.5), (False, 2.0)])
def test_flexibilities_and_bound_are_those_of_the_simplified_theory(
    axis_ratio: float, poisson_ratio: float, elliptic: bool, share: float
) -> None:
    c11, c22, c23, _ = TABLE_E3[axis_ratio, poisson_ratio]
    problem = of_ratio(axis_ratio, poisson_ratio).flatten()
    found = Ellipses.of(problem, elliptic)
    a, b = 6e-3 * np.sqrt(axis_ratio), 6e-3 / np.sqrt(axis_ratio)
    # Kalker 1982: L1 = 8a/(3 C11 G), L2 = 8a/(3 C22 G), L3 = π a √(a/b)/(4 C23 G); some ten roundings
    assert found.longitudinal_flexibility == pytest.approx(8.0 * a / (3.0 * c11 * 80e9), rel=32 * EPS)
    assert found.lateral_flexibility == pytest.approx(8.0 * a / (3.0 * c22 * 80e9), rel=32 * EPS)
    assert found.spin_flexibility == pytest.approx(np.pi * a * np.sqrt(a / b) / (4.0 * c23 * 80e9), rel=32 * EPS)
    # the load is that of Hertz's ellipse, 2πab p0/3, or of a paraboloid, πab p0/2
    assert found.bound_centre == pytest.approx(share * 0.3 * 80e3 / (np.pi * a * b), rel=8 * EPS)


@pytest.mark.parametrize("strips", [2, 10, 25])
def test_nodes_lie_on_strips_that_fill_the_ellipse(strips: int) -> None:
    problem = two_loads()
    contact = wl.contact_model("fastsim", strips=strips).solve_ellipse(problem)
    number = np.arange(strips)
    angle = np.pi * (strips - number) / (strips + 1)  # even in the angle of y = b cos β
    share, width = np.cos(angle), np.pi / (strips + 1) * np.sin(angle)
    along = max(round(0.4 * strips), 4) + max(strips, 8)
    assert contact.x.shape == contact.area.shape == (2, along, strips)
    # a cosine loses up to an EPS of b
    assert contact.y == pytest.approx(np.broadcast_to(6e-3 * share, contact.y.shape), abs=2 * EPS * 6e-3)
    assert contact.strip_width == pytest.approx(np.broadcast_to(6e-3 * width, (2, strips)), abs=8 * EPS * 6e-3)
    half_length = problem.a[:, None] * np.sqrt((1.0 - share) * (1.0 + share))
    area = 2.0 * half_length * 6e-3 * width
    # the lengths of some 60 nodes add up
    assert contact.area.sum(axis=1) == pytest.approx(area, abs=64 * EPS * area.max())
    assert (np.diff(contact.x, axis=1) >= 0.0).all()
    # next to the side of the patch 1 - y/b loses digits, here two
    assert (np.abs(contact.x) <= half_length[:, None, :] + 16 * EPS * 4e-3).all()


@pytest.mark.parametrize("bound", BOUNDS)
def test_the_bound_of_each_node_is_that_of_the_theory(bound: Bound) -> None:
    problem, model = two_loads(), wl.contact_model("fastsim", bound=bound, strips=8)
    a, area = problem.a[:, None, None], np.pi * problem.a[:, None, None] * 6e-3
    for contact in (model.solve_ellipse(problem), model.on_strips(problem, np.array([-0.5, 0.1, 0.8]))):
        assert contact is not None
        inside = 1.0 - (contact.x / a) ** 2 - (contact.y / 6e-3) ** 2
        # Hertz's ellipse, 3N/(2πab) √…, or a paraboloid, 2N/(πab) (…); the difference from one loses digits at the edge
        shape = 1.5 * np.sqrt(np.maximum(inside, 0.0)) if bound == "elliptic" else 2.0 * inside
        off = np.abs(contact.traction_bound - 0.3 * 80e3 / area * shape)
        assert (off * np.maximum(shape, 1e-3) <= 64 * EPS * 0.3 * 80e3 / area).all()


def test_strips_can_lie_where_they_are_asked_for() -> None:
    problem = two_loads()
    contact = wl.contact_model("fastsim", strips=10).on_strips(problem, np.array([-0.5, 0.1, 0.8]))
    assert contact is not None
    assert contact.x.shape == (2, 4 + 10, 3)
    assert contact.y[:, 0] == pytest.approx(np.broadcast_to([-3e-3, 0.6e-3, 4.8e-3], (2, 3)), rel=4 * EPS)
    # each stands for what is nearest to it
    assert contact.strip_width == pytest.approx(np.broadcast_to([4.8e-3, 3.9e-3, 3.3e-3], (2, 3)), rel=8 * EPS)
    alone = wl.contact_model("fastsim", strips=10).on_strips(problem, np.array([0.1]))
    assert alone is not None
    assert alone.strip_width == pytest.approx(12e-3, rel=4 * EPS)
    assert alone.traction_x[..., 0] == pytest.approx(contact.traction_x[..., 1], rel=16 * EPS)


@pytest.mark.parametrize("bound", BOUNDS)
def test_scaled_slip_dissipates_what_the_creepages_do_and_local_slip_does_not(bound: Bound) -> None:
    problem = two_loads()
    local, scaled = (wl.contact_model("fastsim", bound=bound, slip=slip) for slip in ("local", "scaled"))
    found = scaled.solve_ellipse(problem)
    # sums of some 200 terms
    assert found.cell_wear_index == pytest.approx(found.wear_index, rel=256 * EPS)
    assert (np.abs(local.solve_ellipse(problem).cell_wear_index / found.wear_index - 1.0) > 1e-3).all()
    shares = np.array([-0.5, 0.1, 0.8])
    some, as_found = scaled.on_strips(problem, shares), local.on_strips(problem, shares)
    assert some is not None
    assert as_found is not None
    assert some.cell_wear_index == pytest.approx(some.wear_index, rel=256 * EPS)
    assert (np.abs(as_found.cell_wear_index / some.wear_index - 1.0) > 1e-3).all()


@pytest.mark.parametrize("bound", ["parabolic", "elliptic"])
def test_as_many_strips_as_are_allowed_give_finite_tractions(bound: str) -> None:
    # A direction that turns towards w in each of many steps: its vector may double in every one, 2^1024 is infinite.
    contact = wl.contact_model("fastsim", bound=bound, strips=1000).solve(ellipse(longitudinal_creepage=[0.001]))
    fewer = wl.contact_model("fastsim", bound=bound, strips=250).solve(ellipse(longitudinal_creepage=[0.001]))
    assert np.isfinite(contact.traction_x).all()
    assert np.isfinite(contact.slip).all()
    assert contact.force_x == pytest.approx(fewer.force_x, rel=1.0 / 250**2)  # second order without spin


def test_exemptions_are_those_of_the_settings() -> None:
    exempt = {
        (): set(),
        (("bound", "elliptic"),): {"saturation"},
        (("flexibility", "kalker"),): {"initial_slope"},
        (("interpolation", "contact"),): {"initial_slope"},
        (("bound", "elliptic"), ("flexibility", "kalker")): {"saturation", "initial_slope"},
        (("strips", 4),): {"accuracy"},
        (("strips", 5),): set(),
    }
    for settings, claims in exempt.items():
        assert set(wl.contact_model("fastsim", **dict(settings)).exemptions) == claims


@pytest.mark.parametrize("strips", [1, 1001, 10.0])
def test_strips_are_a_whole_number_from_2_to_1000(strips: object) -> None:
    with pytest.raises(wl.ConfigurationError, match="strips"):
        wl.contact_model("fastsim", strips=strips)


def test_settings_of_an_ellipse_are_shown_where_they_differ_from_the_default() -> None:
    assert "strips" not in repr(wl.contact_model("fastsim"))
    assert "bound='parabolic'" in repr(wl.contact_model("fastsim", strips=20))
    assert "strips=20" in repr(wl.contact_model("fastsim", strips=20))


def test_the_stated_accuracy_is_in_inverse_proportion_to_the_strips() -> None:
    model = wl.contact_model("fastsim", strips=20)
    assert model.elliptic_accuracy == 0.5 / 20
    assert model.refined() == wl.contact_model("fastsim", strips=40)
