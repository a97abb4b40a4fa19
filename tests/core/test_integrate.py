"""Patch means of wear laws against integrals of their own, at any size of a batch."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests import reference
from tests.core.integrals import FULL_SLIP, MEANS, REFERENCE, RIG, SPEED, Points, compare, integrate_wear
from tests.reference import brentq
from tests.strategies import EPS, LINE_MODELS
from wearlaw import Array, Q
from wearlaw.numerics.integrate import BLOCK, NODE_BLOCK, integrate_slip  # private: sizes of blocks

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")

ACCURACY = 1e-9
"""The relative accuracy that all means are held to; most meet 1e-13, of which the reference gives 12 digits."""


@pytest.mark.validates(
    "integration",
    "Means of USFD and KTH over the patch, all local models, creepages from 1e-7 to 1",
    source="tanh-sinh quadrature of the literature's formulas, written anew for the tests",
    held_to="{within:g}, relative",
    within=ACCURACY,
)
@pytest.mark.parametrize("law", MEANS)
@pytest.mark.parametrize("name", REFERENCE)
def test_patch_means_meet_their_integral_at_any_creepage(name: str, law: str, within: float) -> None:
    points = Points(seed=1, size=30)
    got, want, error = compare(name, law, points)
    assert (np.abs(got - want) <= within * want).all()
    honest = np.abs(got - want) <= error + 1e-12 * want  # the reference itself ends at 1e-13
    # The estimate does not know how a jump of the rate enlarges the rounding of where it lies.
    assert honest.mean() >= (0.95 if "elliptic" in name and law == "kth" else 1.0)


@pytest.mark.validates(
    "integration",
    "Means of USFD and KTH next to full slip, from 0.1 to 1e-12 on both sides",
    source="tanh-sinh quadrature of the literature's formulas, written anew for the tests",
    held_to="{within:g}, relative, and `wear_rate_error` + {reference:g}",
    within=ACCURACY,
    reference=1e-12,
)
@pytest.mark.parametrize("law", MEANS)
@pytest.mark.parametrize("name", REFERENCE)
def test_patch_means_meet_their_integral_next_to_full_slip(
    name: str, law: str, within: float, reference: float
) -> None:
    points = Points(seed=2, size=30)
    centre = 1.0 if name.startswith("exact") else 1.5 * FULL_SLIP[name.rpartition("-")[2]]
    points.creepage = points.saturation * centre * points.crowd()
    got, want, error = compare(name, law, points)
    assert (np.abs(got - want) <= within * want).all()
    assert (np.abs(got - want) <= error + reference * want).all()


@pytest.mark.validates(
    "integration",
    "USFD where severe or catastrophic wear just begins in the patch",
    source="tanh-sinh quadrature of the literature's formulas, written anew for the tests",
    held_to="{within:g}, relative",
    within=ACCURACY,
)
@pytest.mark.parametrize("name", REFERENCE)
@pytest.mark.parametrize("border", [55.0 / 5.3, 77.26])
def test_usfd_means_meet_their_integral_where_a_regime_just_begins(name: str, border: float, within: float) -> None:
    points = Points(seed=3, size=12)
    points.friction = points.random.uniform(0.4, 1.0, points.size)
    points.pressure = points.random.uniform(1.5e9, 4e9, points.size)
    creepages = []
    for point in points.references():

        def excess(creepage: float, point: reference.Point = point) -> float:
            at = REFERENCE[name](reference.Point(point.load, point.radius, point.modulus, point.friction, creepage))
            return float(at.density(min(at.peak, at.border))) / 1e6 - border

        low, high = 1e-7, 1.0
        creepages.append(brentq(excess, low, high, xtol=1e-18) if excess(low) < 0.0 else 0.01)
    points.creepage = np.array(creepages) * points.crowd()
    got, want, _ = compare(name, "usfd", points)
    assert (np.abs(got - want) <= within * want).all()


def jump_condition(points: Points) -> Array:
    """Return how far the mean of KTH moves with a rounding of the pressure.

    Rounding of p0 by 4 EPS moves the root of p0 √(1-t²) = 2.1 GPa by 4 EPS/t, with t ≈ √(2|p0/2.1 GPa - 1|), and
    k jumps by 350/5.5 there.
    """
    return 350.0 / 5.5 * 8.0 * EPS / np.sqrt(2.0 * np.abs(points.pressure / 2.1e9 - 1.0))


@pytest.mark.parametrize("name", REFERENCE)
@pytest.mark.parametrize("where", ["anywhere", "half the patch slips"])
def test_kth_means_meet_their_integral_where_the_pressure_just_reaches_its_border(name: str, where: str) -> None:
    points = Points(seed=4, size=20)
    points.pressure = 2.1e9 * points.crowd()
    if where == "half the patch slips":  # so that slip begins next to the maximum of the pressure
        reduced = 0.5 if name.startswith("exact") else 0.75 if "parabolic" in name else 2.0 / math.pi
        points.creepage = points.saturation * reduced * FULL_SLIP.get(name.rpartition("-")[2], 1.0) * points.crowd()
    got, want, _ = compare(name, "kth", points)
    assert (np.abs(got - want) <= (ACCURACY + jump_condition(points)) * want).all()


@pytest.mark.validates(
    "integration",
    "KTH where the slip speed just reaches 0.2 or 0.7 m/s",
    source="tanh-sinh quadrature of the literature's formulas, written anew for the tests",
    held_to="{within:g}, relative",
    within=ACCURACY,
)
@pytest.mark.parametrize("name", ["exact", "fastsim-parabolic-line"])
@pytest.mark.parametrize("speed", [0.2, 0.7])
def test_kth_means_meet_their_integral_where_the_slip_speed_just_reaches_its_border(
    name: str, speed: float, within: float
) -> None:
    points = Points(seed=5, size=30)
    # in full slip the slip at the trailing edge is ξ + ξ_full
    full = points.saturation * (1.0 if name == "exact" else 1.5)
    points.creepage = np.where(2.0 * full < speed / SPEED, speed / SPEED - full, speed / SPEED + full) * points.crowd()
    got, want, _ = compare(name, "kth", points)
    # a slip that just passes its border does so within (gap·a) of an edge, where the pressure is zero
    assert (np.abs(got - want) <= within * want).all()


# --- Blocks ----------------------------------------------------------------------------------------------------


@pytest.mark.validates(
    "reproducibility",
    "A point in a batch of thousands and alone",
    source="one against the other",
    held_to="{roundings} ε, relative",
    roundings=64,
)
@pytest.mark.parametrize("law", ["usfd", "kth"])
@pytest.mark.parametrize("name", REFERENCE)
def test_results_do_not_depend_on_the_blocks_they_were_computed_in(name: str, law: str, roundings: int) -> None:
    block = NODE_BLOCK if law == "kth" else BLOCK
    points = Points(seed=15, size=2 * block + 100)
    problem = points.problem
    model, wear_law = LINE_MODELS[name], wl.wear_law(law)
    wear = integrate_wear(model, wear_law, problem)
    borders = [0, 1, block - 1, block, block + 1, 2 * block - 1, 2 * block, points.size - 1]
    for index in [*borders, *range(7, points.size, 997)]:
        wear_alone = integrate_wear(model, wear_law, problem[index : index + 1])
        # to rounding, not to the bit: zones without length, which some batches hold, change the order of sums
        assert wear.wear_rate[index] == pytest.approx(wear_alone.wear_rate[0], rel=roundings * EPS)
        assert wear.tangential_force[index] == pytest.approx(wear_alone.tangential_force[0], rel=roundings * EPS)


def test_slip_is_summed_in_blocks() -> None:
    points = Points(seed=17, size=NODE_BLOCK + 30)
    model = LINE_MODELS["exact"]
    slip = integrate_slip(model, points.problem)
    share = np.minimum(points.creepage / points.saturation, 1.0)
    assert slip.slip_area == pytest.approx(share * points.problem.patch_area, rel=64 * EPS)
    alone = integrate_slip(model, points.problem[-1:])
    assert slip.mean_slip[-1] == pytest.approx(alone.mean_slip[0], rel=64 * EPS)


class CountedExact(type(wl.contact_model("exact"))):  # type: ignore[misc]
    """The exact theory that counts how often its fields are computed."""

    computed: ClassVar[list[tuple[int, ...]]] = []

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        self.computed.append(nodes.length.shape)
        found: wl.LineFields = super().fields(problem, nodes)
        return found


@pytest.mark.parametrize("creepage", [Q(0.3, "%"), Q([0.3, -0.2], "%")])
def test_a_line_contact_is_solved_once_whatever_is_read_of_it(creepage: wl.Quantity) -> None:
    CountedExact.computed.clear()
    result = (RIG | CountedExact() | wl.wear_law("kth"))(
        max_pressure="1500 MPa", creepage=creepage, friction_coefficient=0.46
    )
    read = [getattr(result, name) for name in ("wear_rate", "mean_slip", "stick_ratio", "cell_wear_index")]
    assert result.contact.rolling_speed.shape == np.shape(creepage.magnitude)
    assert len(CountedExact.computed) == 1
    afresh = (RIG | wl.contact_model("exact"))(max_pressure="1500 MPa", creepage=creepage, friction_coefficient=0.46)
    for name, value in zip(("mean_slip", "stick_ratio", "cell_wear_index"), read[1:], strict=True):
        assert value.magnitude == pytest.approx(getattr(afresh, name).magnitude, rel=1e-12), name
