"""The forces of Shen, Hedrick and Elkins, against their equations, the linear and the full theory."""

from __future__ import annotations

import pytest
from hypothesis import given

import wearlaw as wl
from tests.plugins.ellipses import EPS, ellipses, limit
from tests.plugins.full_theory import assert_energy_misses_by, assert_forces_miss_by

SHE = wl.contact_model("shen_hedrick_elkins")
LINEAR = wl.contact_model("linear")


@pytest.mark.validates(
    "creep-forces",
    "`shen_hedrick_elkins`: the cubic, in the direction of the linear force",
    source="Vermeulen and Johnson 1964; Shen, Hedrick and Elkins 1983",
    held_to="{roundings} ε",
    roundings=16,
)
@given(problem=ellipses())
def test_the_force_is_the_published_cubic_of_the_linear_one(problem: wl.Problem, roundings: int) -> None:
    linear, found = LINEAR.creep_forces(problem), SHE.creep_forces(problem)
    u = float(linear.tangential / limit(problem))
    share = u - u**2 / 3.0 + u**3 / 27.0 if u <= 3.0 else 1.0
    # The derivative of the cubic vanishes at u = 3, and its terms are at most 3.
    assert float(found.tangential / limit(problem)) == pytest.approx(
        share, rel=roundings * EPS, abs=roundings * EPS * min(u, 3.0)
    )
    cross = float(found.longitudinal * linear.lateral - found.lateral * linear.longitudinal)
    assert abs(cross) <= 8 * EPS * float(found.tangential * linear.tangential)
    assert float(found.spin_moment * linear.tangential) == pytest.approx(
        float(linear.spin_moment * found.tangential), rel=roundings * EPS
    )


@pytest.mark.validates(
    "limits",
    (
        "`shen_hedrick_elkins` misses forces by {curve_most:.1%} of μN on a creep curve (a/b = 1/2), and by "
        "{circle:.1%} in 16 cases on a circle, with lateral creepage and spin of the same sign; there Tγ by "
        "{low:+.0%} to {high:+.0%}"
    ),
    source="CONTACT (Vollebregt), half-space theory",
    held_to="the digits shown",
    curve_most=0.038,
    circle=0.03,
    low=-0.12,
    high=0.25,
)
def test_contact_leaves_it_by_the_digits_shown(curve_most: float, circle: float, low: float, high: float) -> None:
    assert_forces_miss_by(SHE, curve_most, at=0.88, circle=circle)
    assert_energy_misses_by(SHE, low, high, highest="spin_0.003")


def test_it_is_exempt_from_sticking_alone() -> None:
    assert set(SHE.exemptions) == {"stick"}
