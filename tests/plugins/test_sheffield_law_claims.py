"""Claims of Tassini et al. (2010) on the three laws on patch means, by independent formulas."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import pytest

import wearlaw as wl
from tests.plugins.sheffield import (
    AREA,
    FORCE,
    FULL_SLIP,
    STEP,
    K,
    assert_says,
    brr_of,
    creepage_at,
    index,
    kth_of,
    usfd_of,
)
from tests.roots import brentq
from wearlaw_sheffield import law_claims
from wearlaw_sheffield.bench import Bench


def test_brr_is_close_to_usfd_in_mild_wear(bench: Bench) -> None:
    claim = law_claims.brr_close_in_mild(bench)
    assert_says(claim, "Up to", 55.0 / 5.3 * AREA)
    ratio = 0.25 * math.pi * 7.85 / 5.3
    assert_says(claim, "BRR is", ratio)
    assert_says(claim, f"{ratio:.3f} to", ratio)
    assert claim.holds


@pytest.mark.parametrize(("k", "holds"), [("low", False), ("mid", True), ("high", False)])
def test_kth_is_close_to_usfd_in_mild_wear_only_in_the_middle_of_its_range(bench: Bench, k: str, holds: bool) -> None:
    claim = law_claims.kth_close_in_mild(bench, k)
    ratios = [kth_of(creepage_at(w), K[k]) / usfd_of(w / AREA) for w in (5.0, 55.0 / 5.3 * AREA * (1.0 - 1e-9))]
    assert_says(claim, "KTH is", ratios[0])
    assert_says(claim, "and", ratios[1])
    assert claim.holds is holds
    assert holds is all(0.5 < ratio < 2.0 for ratio in ratios)


def test_brr_lies_above_usfd_in_severe_wear_ever_more(bench: Bench) -> None:
    claim = law_claims.brr_above_in_severe(bench)
    begin, end = 55.0 / 5.3 * AREA, 77.26 * AREA
    assert_says(claim, "From", begin)
    assert_says(claim, "N, BRR is", brr_of(begin) / 55.0)
    assert_says(claim, "at first,", brr_of(199.0) / 55.0)
    assert_says(claim, "jump at 200 N, and", brr_of(end) / 55.0)
    assert claim.holds


@pytest.mark.validates(
    "paper",
    (
        "KTH above USFD in severe wear, as the paper says: at the high end of k only; in its middle from "
        "where both cross"
    ),
    source="Tassini et al. 2010, section 5.1.1; ρ k p s/H and Table 3 by hand",
    held_to="crossing at {ours:g} N to {rounded:g} N, shares to the digits shown",
    ours=97.0,
    rounded=0.5,
)
@pytest.mark.parametrize("k", ["low", "mid", "high"])
def test_kth_lies_above_usfd_in_severe_wear_at_the_high_end_only(
    bench: Bench, k: str, ours: float, rounded: float
) -> None:
    claim = law_claims.kth_above_in_severe(bench, k)
    full = 100.0 / FORCE  # creepage [%] a newton in full slip
    begin, end = (kth_of(w * full, K[k]) / 55.0 for w in (55.0 / 5.3 * AREA, 77.26 * AREA))
    assert_says(claim, "KTH is", begin)
    assert_says(claim, "and", end)
    assert claim.holds is (k == "high")
    if k == "mid":
        crossing = 55.0 / kth_of(1.0) / full
        assert_says(claim, "cross at", crossing)
        assert crossing == pytest.approx(ours, abs=rounded)
    else:
        assert "cross" not in claim.found


def test_brr_and_usfd_cross_at_797_newton(bench: Bench) -> None:
    claim = law_claims.brr_comes_closer(bench)
    crossing = brentq(lambda w: brr_of(w) - usfd_of(w / AREA), 500.0, 850.0)
    assert_says(claim, "cross at", crossing)
    assert round(crossing) == 797
    assert_says(claim, "N and", brr_of(700.0) / usfd_of(700.0 / AREA))
    assert claim.holds


def test_brr_jumps_at_200_newton(bench: Bench) -> None:
    claim = law_claims.brr_jumps(bench)
    assert_says(claim, "From", brr_of(199.999))
    assert_says(claim, "to", brr_of(200.0))
    assert "From 97.96 to 329.2 µg/m/mm²" in claim.found
    assert_says(claim, "factor of", 84.0 / 25.0)
    assert claim.holds


def test_the_plateau_of_brr_is_shorter(bench: Bench) -> None:
    claim = law_claims.brr_plateau_is_shorter(bench)
    assert "from 100 to 200 N in BRR" in claim.found
    assert_says(claim, "BRR, from", 55.0 / 5.3 * AREA)
    assert claim.holds


def test_kth_is_proportional_to_the_wear_index_in_full_slip_only(bench: Bench) -> None:
    claim = law_claims.kth_proportional(bench)
    at_5 = kth_of(creepage_at(5.0)) / 5.0
    in_full_slip = kth_of(2.0) / index(2.0)
    assert_says(claim, "it is", at_5 / in_full_slip)
    assert_says(claim, "from", index(FULL_SLIP))
    assert "constant within 0.00 %" in claim.found
    assert not claim.holds


def test_kth_grows_with_the_creepage_and_usfd_with_its_square(bench: Bench) -> None:
    linear, square = law_claims.kth_linear(bench), law_claims.usfd_quadratic(bench)
    assert "is 1.000 to 1.000" in linear.found
    assert linear.holds
    for creepage in (0.01, 0.1, 0.5, 1.0):
        d = creepage / FULL_SLIP
        assert f"{1.0 + (2.0 - 2.0 * d) / (2.0 - d):.2f} at {creepage:g} %" in square.found
    assert_says(square, "2 up to", 2.0 / 3.0 * FULL_SLIP, slack=STEP)
    assert square.holds


def test_brr_grows_as_usfd_in_partial_slip(bench: Bench) -> None:
    claim = law_claims.brr_like_usfd(bench)
    assert_says(claim, "BRR is", 0.25 * math.pi * 7.85 / 5.3)
    assert claim.holds


def test_in_full_slip_the_laws_are_straight_in_each_regime(bench: Bench) -> None:
    claim = law_claims.straight_in_full_slip(bench)
    density = FORCE / AREA / 100.0
    assert_says(claim, "USFD mild", 5.3 * density)
    assert_says(claim, "USFD severe", 0.0)
    assert_says(claim, "USFD catastrophic", 61.9 * density)
    assert_says(claim, "KTH below 0.2 m/s", kth_of(1.0))
    assert claim.holds


@pytest.mark.parametrize(
    "claim",
    [law_claims.brr_above_in_severe, law_claims.brr_comes_closer],
    ids=lambda claim: claim.__name__,
)
def test_brr_of_a_light_metal_does_not_lie_above(bench: Bench, claim: Any) -> None:
    light = wl.steel(density="2700 kg/m^3")
    assert not claim(dataclasses.replace(bench, rig=wl.TwinDisc.suros(material=light))).holds


def test_kth_of_a_heavy_metal_lies_above_everywhere(bench: Bench) -> None:
    heavy = dataclasses.replace(bench, rig=wl.TwinDisc.suros(material=wl.steel(density="19000 kg/m^3")))
    assert law_claims.kth_above_in_severe(heavy, "mid").holds
    assert not law_claims.kth_close_in_mild(heavy, "mid").holds
    assert not law_claims.brr_close_in_mild(heavy).holds
