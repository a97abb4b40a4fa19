"""Error estimates of means for laws and contact models that declare nothing, errors, and the nodes behind both."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests import reference
from tests.core.integrals import MEANS, REFERENCE, RIG, Points, integrate_wear
from tests.line import uniform_cells
from tests.strategies import EPS, LINE_MODELS
from wearlaw import Array, Nodes, Q
from wearlaw.contact.quadrature import ORDER, Zone, remainder  # private: no result shows them
from wearlaw.errors import ModelError
from wearlaw.numerics.crossings import crossings  # private: not the means that they split
from wearlaw.numerics.integrate import integrate_forces  # private: integrals at the size of blocks
from wearlaw.numerics.staged import staged  # private: a stage around a model without a pipeline

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")

# --- Laws that declare nothing ---------------------------------------------------------------------------------


class Smooth(wl.WearLaw):
    """Rises with the square of q·s."""

    name: ClassVar[str] = "smooth"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return (contact.wear_index_density / 1e6) ** 2


class Kinked(Smooth):
    """Rises from a threshold on."""

    name: ClassVar[str] = "kinked"
    threshold: float = 10.0

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return np.maximum(contact.wear_index_density / 1e6 - p["threshold"], 0.0)


class Jumping(Kinked):
    """Ten times as much from a threshold on."""

    name: ClassVar[str] = "jumping"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        w = contact.wear_index_density / 1e6
        return np.where(w < p["threshold"], 0.1 * w, w)


RATES: dict[type[Smooth], Callable[[Array, float], Array]] = {
    Smooth: lambda w, _: w**2,
    Kinked: lambda w, threshold: np.maximum(w - threshold, 0.0),
    Jumping: lambda w, threshold: np.where(w < threshold, 0.1 * w, w),
}


def rate_of_density(law: type[Smooth], solution: reference.Solution, v: Array) -> Array:
    return RATES[law](solution.density(v) / 1e6, 10.0)


@pytest.mark.validates(
    "integration",
    "`wear_rate_error` bounds the error of a law that declares no breakpoints",
    source="tanh-sinh quadrature of the literature's formulas, written anew for the tests",
    held_to="in {honest:.0%} of the points; its median is below {useful:.0%} of the rate",
    honest=0.95,
    useful=0.05,
)
@pytest.mark.parametrize("law_type", RATES, ids=lambda law: law.name)
@pytest.mark.parametrize("name", ["exact", "fastsim-parabolic-line", "fastsim-elliptic-line"])
def test_the_error_estimate_of_a_law_that_declares_nothing_is_honest(
    name: str, law_type: type[Smooth], honest: float, useful: float
) -> None:
    points = Points(seed=6, size=100)
    points.creepage = 10.0 ** points.random.uniform(-4.0, 0.0, points.size)
    law: Any = law_type() if law_type is Smooth else law_type(threshold=10.0)  # type: ignore[call-arg]
    assert law.breakpoints(law.numbers) is None
    wear = integrate_wear(LINE_MODELS[name], law, points.problem)
    want = []
    for point in points.references():
        solution = REFERENCE[name](point)
        breaks = [] if law_type is Smooth else solution.density_crossings(10e6)
        want.append(solution.mean(functools.partial(rate_of_density, law_type, solution), breaks))
    error = np.abs(wear.wear_rate - want)
    held = error <= wear.wear_rate_error + 1e-12 * np.array(want)
    assert held.mean() >= honest
    # and it is not honest by being useless: in most cases it is below 5 % of the rate
    assert np.median(wear.wear_rate_error / np.maximum(want, 1e-30)) < useful
    if law_type is Smooth:
        assert (error <= 1e-6 * np.array(want)).all()


# --- Contact models that only solve ----------------------------------------------------------------------------


class Celled(wl.ContactModel):
    """Carter's solution on uniform cells, as a model that knows no closed form would give it."""

    name: ClassVar[str] = "celled"
    cells: int = 100

    @property
    def accuracy(self) -> float:
        # Where slip begins in a cell is as good as random; q·s, and at the edges p, grow like square roots.
        return 1.0 / self.cells

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        return LINE_MODELS["exact"].at(problem, uniform_cells(problem.half_width, self.cells))


@pytest.mark.validates(
    "integration",
    "`wear_rate_error` bounds the error of a contact model on cells of its own",
    source="tanh-sinh quadrature of the literature's formulas, written anew for the tests",
    held_to="in {honest:.0%} of the points with two slipping cells or more",
    honest=0.95,
)
def test_a_model_that_only_solves_works_and_says_how_good_it_is(honest: float) -> None:
    points = Points(seed=9, size=200)
    wear = integrate_wear(Celled(), wl.wear_law("usfd"), points.problem)
    want = np.array([MEANS["usfd"](reference.exact(point)) for point in points.references()]) / 1e3
    # A zone of less than two cells cannot be seen at all.
    seen = points.creepage / points.saturation > 0.02
    error = np.abs(wear.wear_rate - want)[seen]
    assert (error <= wear.wear_rate_error[seen]).mean() >= honest
    assert np.median(wear.wear_rate_error[seen] / want[seen]) < 0.1
    force = integrate_forces(LINE_MODELS["exact"], points.problem).longitudinal
    assert wear.tangential_force == pytest.approx(force, rel=4 * EPS)


def test_finer_cells_have_a_smaller_error_estimate() -> None:
    points = Points(seed=10, size=50)
    points.creepage = points.saturation * points.random.uniform(0.2, 3.0, points.size)
    coarse, fine = (
        np.median(integrate_wear(Celled(cells=n), wl.wear_law("usfd"), points.problem).wear_rate_error)
        for n in (50, 800)
    )
    assert fine < 0.2 * coarse


def test_one_cell_alone_says_nothing_of_its_error() -> None:
    points = Points(seed=11, size=5)
    wear = integrate_wear(Celled(cells=1), wl.wear_law("usfd"), points.problem)
    assert (wear.wear_rate_error == np.abs(wear.wear_rate)).all()


def test_patch_means_have_no_integration_error() -> None:
    points = Points(seed=12, size=20)
    means = [staged(model, (wl.patch_mean(),)) for model in (LINE_MODELS["exact"], Celled())]
    for model in (wl.contact_model("global"), *means):
        wear = integrate_wear(model, wl.wear_law("usfd"), points.problem)
        assert (wear.wear_rate_error <= 2.0 * EPS * wear.wear_rate).all()


class WithAHole(type(LINE_MODELS["exact"])):  # type: ignore[misc]
    """Carter's theory without closed forms of crossings, whose pressure is unknown close to 1 GPa, between samples."""

    def crossings(self, problem: wl.Problem, variable: str, value: Array) -> None:
        return None

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields: wl.LineFields = super().fields(problem, nodes)
        pressure = np.where(np.abs(fields.pressure - 1e9) < 1e6, np.nan, fields.pressure)
        return dataclasses.replace(fields, pressure=pressure)


def test_a_model_whose_fields_are_not_finite_next_to_a_crossing_is_refused_by_name() -> None:
    model = WithAHole()
    problem = RIG.problem(max_pressure="1.5 GPa", creepage=Q([10.0], "%"), friction_coefficient=0.46)
    with pytest.raises(ModelError, match="contact model 'exact': its pressure crosses a breakpoint, but the "):
        crossings(model, problem, model.zones(problem)[1], {"pressure": (1e9,)})


def zone(length: float | Array = 1.4, half_width: float | Array = 1.1) -> Zone:
    return Zone.of(np.asarray(half_width), np.asarray(length), over_patch=False)


def total(nodes: Nodes, values: Array) -> float:
    return float((values * nodes.length).sum(axis=-1))


def test_points_are_given_by_x_or_counted_from_the_other_edge() -> None:
    nodes = Nodes.at(np.array([-1.0, 0.25]), np.array(1.0))
    assert nodes.x == pytest.approx([-1.0, 0.25])
    assert nodes.from_leading == pytest.approx([0.0, 1.25])
    assert nodes.reversed().x == pytest.approx([1.0, -0.25])


def test_the_middle_stands_for_the_zone() -> None:
    node = zone().middle()
    assert node.x == pytest.approx([0.4], rel=2 * EPS)
    assert node.length == 1.4


@pytest.mark.validates(
    "limits",
    ("Integrals of Hertz's pressure over a slip zone that ends just short of the leading edge lose digits"),
    source="the integral in closed form",
    held_to="up to {most:g} of the whole",
    most=5e-08,
)
def test_a_root_just_outside_a_zone_mapped_over_itself_costs_what_models_declare(most: float) -> None:
    # Hertz's pressure √(1-x²) over [-1+gap, 1]: its leading root lies just outside, √(2 gap) from the real axis.
    gap = np.geomspace(1e-12, 1.0, 2000)
    nodes = zone(2.0 - gap, np.ones_like(gap)).nodes()
    got = (np.sqrt(nodes.from_leading * nodes.from_trailing) * nodes.length).sum(axis=-1)
    before = 0.5 * (np.arccos(1.0 - gap) - (1.0 - gap) * np.sqrt(gap * (2.0 - gap)))
    error = np.abs(got + before - 0.5 * math.pi)
    assert 1e-9 < error.max() < most


# --- The error estimate ----------------------------------------------------------------------------------------


def test_the_remainder_is_summed_over_panels() -> None:
    nodes = zone().nodes(panels=2)
    rough = np.abs(nodes.x - 0.1) * nodes.length
    first, second = rough.copy(), rough.copy()
    first[ORDER:] = 0.0
    second[:ORDER] = 0.0
    assert float(remainder(rough)) == pytest.approx(float(remainder(first) + remainder(second)), rel=8 * EPS)


def test_the_remainder_is_the_size_of_the_last_two_legendre_coefficients() -> None:
    abscissas, weights = np.polynomial.legendre.leggauss(ORDER)
    for degree, expected in ((ORDER - 3, 0.0), (ORDER - 2, 1.0), (ORDER - 1, 1.0)):
        values = np.polynomial.legendre.legval(abscissas, [0.0] * degree + [1.0])
        # (2n+1) ∫ P_n² = 2, the length of a panel times the coefficient
        assert float(remainder(values * weights)) == pytest.approx(2.0 * expected, abs=1e-13)


@given(kink=st.floats(-0.29, 1.09), power=st.sampled_from([0.0, 1.0, 1.5]))
def test_the_remainder_bounds_the_error_of_kinks_and_steps(kink: float, power: float) -> None:
    nodes = zone().nodes()
    values = np.where(nodes.x > kink, np.abs(nodes.x - kink) ** power, 0.0)
    error = abs(total(nodes, values) - (1.1 - kink) ** (power + 1.0) / (power + 1.0))
    # Two coefficients of falling size can both pass close to zero; then a bound by them holds to a factor.
    assert error <= 3.0 * float(remainder(values * nodes.length)) + 8 * EPS
