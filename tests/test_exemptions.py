"""The energy balance of line models, the invariants that a contact model does not keep, and its actual behaviour."""

from __future__ import annotations

import pytest
from hypothesis import given

import wearlaw as wl
from tests.strategies import EPS, MODELS
from wearlaw import Q
from wearlaw_kit import line_problems


def exempt(claim: str) -> list[str]:
    return [name for name in MODELS if claim in MODELS[name].exemptions]


def suros(name: str, percent: float) -> wl.Contact:
    problem = wl.TwinDisc.suros().problem(normal_force="7.4143 kN", creepage=Q(percent, "%"), friction_coefficient=0.46)
    return MODELS[name].solve(problem)


EXEMPTIONS: dict[str, set[str]] = {
    "exact": set(),
    "exact-as_printed": {"energy_balance"},
    "fastsim-parabolic-line": set(),
    "fastsim-parabolic-kalker": {"initial_slope"},
    "fastsim-elliptic-line": {"saturation"},
    "fastsim-elliptic-kalker": {"saturation", "initial_slope"},
    "global": {"stick"},
    "global-of-elliptic": {"stick", "saturation"},
}


@pytest.mark.parametrize("name", MODELS)
def test_the_exemptions_are_those_that_are_shown_to_be_needed_here(name: str) -> None:
    assert set(MODELS[name].exemptions) == EXEMPTIONS[name]
    assert all(MODELS[name].exemptions.values())


@pytest.mark.validates(
    "limits",
    "The slip that eq. 7 prints (`as_printed`) dissipates {times:g} times Tγ at 0.1 % creepage",
    source="conservation of energy",
    held_to="{rounded:g}",
    times=3.0,
    rounded=0.05,
)
def test_the_printed_slip_dissipates_three_times_what_is_fed_in(times: float, rounded: float) -> None:
    contact = suros("exact-as_printed", 0.1)
    dissipated = float(contact.sum_over_nodes(contact.wear_index_density * contact.area))
    assert dissipated / float(contact.wear_index) == pytest.approx(times, abs=rounded)


def test_the_printed_slip_is_that_of_full_slip_above_saturation() -> None:
    assert suros("exact-as_printed", 2.0).slip == pytest.approx(suros("exact", 2.0).slip, rel=4 * EPS)


@pytest.mark.validates(
    "limits",
    (
        "With the elliptic bound FASTSIM never slips fully: T lacks {at_2:.1%} of μN at 2 % creepage, "
        "{at_20:.4%} at 20 %"
    ),
    source="Kalker 1982; (2/π)[atan κ + κ/(1+κ²)]",
    held_to="{within:.0%} of these shares",
    at_2=2.2e-2,
    at_20=2.6e-5,
    within=0.03,
)
@pytest.mark.parametrize("percent", [2.0, 20.0])
@pytest.mark.parametrize("name", ["fastsim-elliptic-line", "global-of-elliptic"])
def test_the_elliptic_bound_never_lets_the_whole_patch_slip(
    name: str, percent: float, at_2: float, at_20: float, within: float
) -> None:
    contact = suros(name, percent)
    assert 1.0 - float(contact.tangential_force) / (0.46 * 7414.3) == pytest.approx(
        {2.0: at_2, 20.0: at_20}[percent], rel=within
    )


@pytest.mark.parametrize("name", exempt("stick"))
def test_the_one_cell_slips_below_its_bound(name: str) -> None:
    contact = suros(name, 0.1)
    assert float(contact.traction[0]) < 0.2 * float(contact.traction_bound[0])
    assert float(contact.slip[0]) == pytest.approx(0.001, rel=EPS)


GRAZING = 5e-8
"""Relative error of an integral of Hertz's pressure next to full slip, at most.

The 24 Gauss-Legendre nodes of a zone meet p = p0 √(1-(x/a)²) to rounding except where the leading edge lies just
outside the zone; `test_integrate_estimates.py` measures it.
"""

SMOOTH_DISSIPATION = ("exact", "fastsim-parabolic-line", "fastsim-parabolic-kalker", "global", "global-of-elliptic")
"""Models whose q·s is smooth in θ wherever the slip zone begins, so that its quadrature ends at rounding."""


@pytest.mark.validates(
    "invariants",
    "∫ q s dx = T ξ on a line, all models that claim it, any load, friction and creepage",
    source="conservation of energy",
    held_to=("{roundings:g} ε over the share that slips; {grazing:g} more next to full slip where q·s is not smooth"),
    roundings=64.0,
    grazing=GRAZING,
)
@pytest.mark.parametrize("name", [name for name in MODELS if "energy_balance" not in MODELS[name].exemptions])
@given(problem=line_problems())
@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # it holds at any values
def test_slip_dissipates_the_energy_that_the_creepage_feeds_in(
    name: str, problem: wl.Problem, roundings: float, grazing: float
) -> None:
    contact = MODELS[name].solve(problem)
    dissipated = float(contact.sum_over_nodes(contact.wear_index_density * contact.area))
    # A position x is exact to the rounding of a. What is integrated over a slip zone of length 2h is therefore exact to
    # EPS·a/h, one over the share that slips.
    share = float(contact.slip_area / contact.patch_area)
    quadrature = 0.0 if name in SMOOTH_DISSIPATION else grazing
    assert dissipated == pytest.approx(
        float(contact.tangential_force * problem.creepage), rel=quadrature + roundings * EPS / share
    )
    assert contact.wear_index == pytest.approx(contact.tangential_force * problem.creepage, rel=EPS)
