"""The claims of Tassini et al. (2010): each number against formulas and integrals of tests/reference.py.

A number in a claim is right if it is the expected one in the digits that it shows.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import optimize

import wearlaw as wl
from tests import reference
from tests.core.cases import case
from wearlaw import Q
from wearlaw.study import run
from wearlaw_sheffield import claims as claims_module
from wearlaw_sheffield import contact_claims, law_claims, local_claims
from wearlaw_sheffield.bench import Bench
from wearlaw_sheffield.wording import first_crossing, largest, percent

LOAD, FRICTION, RADIUS = 741.43e3, 0.46, 0.047 / 4.0
MODULUS = 206.47742e9 / (2.0 * (1.0 - 0.28**2))
SPEED = math.pi * 0.047 * 400.0 / 60.0
HALF_WIDTH = math.sqrt(4.0 * LOAD * RADIUS / (math.pi * MODULUS))
AREA = 2.0 * HALF_WIDTH * 10.0 * 1e3
"""Patch area on a track of 10 mm [mm²]."""
FULL_SLIP = 100.0 * FRICTION * HALF_WIDTH / RADIUS
"""Creepage of full slip [%]."""
FORCE = FRICTION * LOAD * 0.01
"""T in full slip on a track of 10 mm [N]."""
GLOBAL = (5.3, 55.0, 61.9, 77.26)
CORRECTED = {"exact": (5.3, 55.0, 83.7, 95.0), "fastsim": (5.3, 56.5, 83.7, 107.0)}
KTH_MID = (350e-4, 5.5e-4, 35e-4, 5.5e-4)
STEP = 0.02
"""Greatest distance of the creepages at which the claims are computed [%]."""


@pytest.fixture(scope="module")
def bench() -> Bench:
    return Bench(wl.TwinDisc.suros(), Q(741.43, "kN/m"), FRICTION)


def point(percent_creepage: float, load: float = LOAD) -> reference.Point:
    return reference.Point(load, RADIUS, MODULUS, FRICTION, percent_creepage / 100.0, SPEED)


SOLUTIONS: dict[str, Callable[[reference.Point], reference.Solution]] = {
    "exact": reference.exact,
    "fastsim": reference.parabolic,
}


def usfd(model: str, creepage: float, parameters: tuple[float, ...] = GLOBAL) -> float:
    """Return the mean rate of USFD [µg/m/mm²] on cells, or on the patch means."""
    if model != "global":
        m_m, q_s, m_c, transition = parameters
        return reference.usfd_mean(SOLUTIONS[model](point(creepage)), m_m, q_s, m_c, transition)
    return usfd_of(index(creepage) / AREA)


def usfd_of(w: float) -> float:
    m_m, q_s, m_c, transition = GLOBAL
    return m_m * w if w < q_s / m_m else q_s if w < transition else q_s + m_c * (w - transition)


def index(creepage: float) -> float:
    """Return Tγ [N] of the exact theory."""
    d = min(creepage / FULL_SLIP, 1.0)
    return FORCE * d * (2.0 - d) * creepage / 100.0


def creepage_at(wear_index: float) -> float:
    return float(optimize.brentq(lambda x: index(x) - wear_index, 1e-6, 30.0))


def brr_of(wear_index: float) -> float:
    """Return the rate of BRR [µg/m/mm²]: section × D [mm³/km] × π × 7.85 mg/mm³ × 1e-3 µg/mg km/m × 1e3 / A."""
    section = min(0.25 * wear_index, 25.0) if wear_index < 200.0 else 1.19 * wear_index - 154.0
    return section * math.pi * 7.85 / AREA


def kth_of(creepage: float, k: tuple[float, ...] = KTH_MID) -> float:
    """Return the rate of KTH on the patch means below 2.1 GPa [µg/m/mm²]."""
    slip = creepage / 100.0
    coefficient = k[1] if slip * SPEED < 0.2 else k[2]
    return 7850.0 * coefficient * LOAD / (2.0 * HALF_WIDTH) * slip / 2.625e9 * 1e3


K = {"low": (300e-4, 1e-4, 30e-4, 1e-4), "mid": KTH_MID, "high": (400e-4, 10e-4, 40e-4, 10e-4)}


def numbers(text: str, before: str) -> list[str]:
    """Return the number that follows each occurrence of some words."""
    return re.findall(re.escape(before) + r"\s*([+-]?\d+(?:\.\d+)?)", text)


def assert_says(claim: wl.CheckedClaim, before: str, *expected: float, slack: float = 0.0) -> None:
    """The numbers after these words are the expected ones, to half of their last digit."""
    found = numbers(claim.found, before)
    assert len(found) == len(expected), (before, claim.found)
    for text, value in zip(found, expected, strict=True):
        last_digit = 10.0 ** -len(text.partition(".")[2])
        assert abs(float(text) - value) <= 0.5001 * last_digit + slack, (text, value, claim.found)


def assert_shares_at(claim: wl.CheckedClaim, share: Callable[[float], float], *creepages: float) -> None:
    """Each "SHARE % at CREEPAGE %" is the expected one."""
    for creepage in creepages:
        (text,) = re.findall(rf"([+-]?\d+(?:\.\d+)?) %\)? at {creepage:g} %", claim.found)[:1]
        last_digit = 10.0 ** -len(text.partition(".")[2])
        assert abs(float(text) - 100.0 * share(creepage)) <= 0.5001 * last_digit, (creepage, claim.found)


def assert_extreme(claim: wl.CheckedClaim, share: Callable[[float], float], pattern: str) -> float:
    """The greatest share in a claim, and where it is, are met by the reference within a step of the creepages."""
    ((text, where),) = re.findall(pattern, claim.found)
    last_digit = 10.0 ** -len(text.partition(".")[2])
    around = [100.0 * share(float(where) + step) for step in np.linspace(-STEP, STEP, 9)]
    assert min(around) - 0.5 * last_digit <= float(text) <= max(around) + 0.5 * last_digit, (text, around)
    return float(where)


# Contact models


def exact_force(creepage: float) -> float:
    return reference.exact(point(creepage)).force


def test_elliptic_bound_and_exact_theory_have_one_force_in_full_slip(bench: Bench) -> None:
    claim = contact_claims.elliptic_bound_in_full_slip(bench)

    def apart(creepage: float) -> float:
        return 100.0 * (reference.elliptic(point(creepage)).force / exact_force(creepage) - 1.0)

    assert_says(claim, "T differs by", apart(3.0))
    assert_says(claim, "but by", apart(FULL_SLIP))
    assert_says(claim, "less than 2 % from", float(optimize.brentq(lambda x: apart(x) + 2.0, 1.3, 5.0)), slack=STEP)
    assert "by 0.0 % at 25 %" in claim.found
    assert abs(apart(25.0)) < 0.05
    assert claim.holds
    assert "μN" in contact_claims.same_force(bench, "line").found


def test_elliptic_bound_differs_by_less_than_a_tenth_in_partial_slip(bench: Bench) -> None:
    claim = contact_claims.elliptic_bound_in_partial_slip(bench)
    where = assert_extreme(
        claim,
        lambda x: reference.elliptic(point(x)).force / exact_force(x) - 1.0,
        r"differs by (\S+) % at most, at (\S+) %",
    )
    shares = [reference.elliptic(point(x)).force / exact_force(x) - 1.0 for x in np.linspace(0.01, FULL_SLIP, 400)]
    assert -100.0 * min(shares) < 10.0
    assert claim.holds
    assert abs(np.linspace(0.01, FULL_SLIP, 400)[int(np.argmin(shares))] - where) < 0.05


def test_the_averaged_wear_index_is_larger_than_the_energy(bench: Bench) -> None:
    claim = contact_claims.averaged_wear_index(bench)
    for model, solve in SOLUTIONS.items():
        ratios = []
        for creepage in (0.1, 0.5, 1.0):
            solution = solve(point(creepage))
            mean_slip = solution.mean(solution.slip) * 2.0 / solution.border
            ratios.append(mean_slip / (creepage / 100.0))
        (listed,) = re.findall(rf"{model}: ([\d., ]+) times", claim.found)
        assert listed.split(", ") == [f"{ratio:.3g}" for ratio in ratios]
    assert claim.holds


@pytest.mark.parametrize(
    ("flexibility", "most", "at"),
    # With d = ξ/ξ_sat, 1-(1-2d/3)³ - d(2-d) is extreme at d = 3/4: 7/8 - 15/16.
    [("line", -6.25, 0.75 * FULL_SLIP), ("kalker", 4.371, 0.3369)],
)
def test_the_forces_of_both_theories_are_not_the_same(bench: Bench, flexibility: str, most: float, at: float) -> None:
    claim = contact_claims.same_force(bench, flexibility)

    def force(creepage: float) -> float:
        return reference.parabolic(point(creepage), kalker=flexibility == "kalker").force

    where = assert_extreme(
        claim,
        lambda x: (force(x) - exact_force(x)) / (FRICTION * LOAD),
        r"differs by (\S+) % of μN at most, at (\S+) %",
    )
    assert where == pytest.approx(at, abs=STEP)
    assert_says(claim, "FASTSIM differs by", most, slack=0.005)  # 6.25 lies between two printed numbers
    assert_shares_at(claim, lambda x: force(x) / exact_force(x) - 1.0, 0.1, 0.5, 1.0)
    assert not claim.holds


HEAT = {0.2: 1.3, 0.5: 9.2, 1.0: 25.7, 3.0: 102.6, 7.5: 246.0, 10.0: 327.8, 15.0: 492.1, 20.0: 728.4}
"""Frictional heat [W] by creepage [%], Lewis and Dwyer-Joyce (2004), Table 3."""
TRACTION = {creepage: heat / (creepage / 100.0 * SPEED * 7414.3) for creepage, heat in HEAT.items()}
TESTS = np.array(list(TRACTION)), np.array(list(TRACTION.values()))


def test_the_friction_coefficient_is_the_mean_in_full_slip(bench: Bench) -> None:
    claim = contact_claims.friction_is_mean_of_full_slip(bench, TESTS)
    full = list(TRACTION.values())[3:]
    assert_says(claim, "creepage is", sum(full) / 5.0)
    assert "is 0.463," in claim.found
    spread = math.sqrt(sum((t - sum(full) / 5.0) ** 2 for t in full) / 4.0)
    assert_says(claim, "deviation of", spread)
    assert claim.holds
    other = dataclasses.replace(bench, friction_coefficient=0.4)
    assert not contact_claims.friction_is_mean_of_full_slip(other, TESTS).holds
    assert not contact_claims.friction_is_mean_of_full_slip(bench, (TESTS[0], 1.05 * TESTS[1])).holds


def test_measured_and_computed_force_differ_at_low_creepage(bench: Bench) -> None:
    claim = contact_claims.force_differs_at_low_creepage(bench, TESTS)
    pairs = re.findall(r"(0\.\d{3}) against (0\.\d{3}) at ([\d.]+) %", claim.found)
    assert [float(x) for _, _, x in pairs] == [0.2, 0.5, 1.0]
    for measured, computed, x in pairs:
        assert measured == f"{TRACTION[float(x)]:.3f}"
        assert computed == f"{exact_force(float(x)) / LOAD:.3f}"
    assert claim.holds
    same = np.array([exact_force(x) / LOAD if x < FULL_SLIP else t for x, t in TRACTION.items()])
    assert not contact_claims.force_differs_at_low_creepage(bench, (TESTS[0], same)).holds


# The three laws on the patch means


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


@pytest.mark.parametrize("k", ["low", "mid", "high"])
def test_kth_lies_above_usfd_in_severe_wear_at_the_high_end_only(bench: Bench, k: str) -> None:
    claim = law_claims.kth_above_in_severe(bench, k)
    full = 100.0 / FORCE  # creepage [%] a newton in full slip
    begin, end = (kth_of(w * full, K[k]) / 55.0 for w in (55.0 / 5.3 * AREA, 77.26 * AREA))
    assert_says(claim, "KTH is", begin)
    assert_says(claim, "and", end)
    assert claim.holds is (k == "high")
    if k == "mid":
        crossing = 55.0 / kth_of(1.0) / full
        assert_says(claim, "cross at", crossing)
        assert crossing == pytest.approx(97.0, abs=0.5)
    else:
        assert "cross" not in claim.found


def test_brr_and_usfd_cross_at_797_newton(bench: Bench) -> None:
    claim = law_claims.brr_comes_closer(bench)
    crossing = float(optimize.brentq(lambda w: brr_of(w) - usfd_of(w / AREA), 500.0, 850.0))
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


# Cells and patch means


def kth(model: str, creepage: float, load: float = LOAD) -> float:
    return reference.kth_mean(SOLUTIONS[model](point(creepage, load)), KTH_MID)


def test_kth_on_cells_is_not_the_same_with_both_theories(bench: Bench) -> None:
    claim = local_claims.kth_same_on_both_theories(bench)
    assert_shares_at(claim, lambda x: kth("fastsim", x) / kth("exact", x) - 1.0, 0.5, 1.0, 10.0, 19.0, 20.0)
    assert_extreme(
        claim, lambda x: kth("fastsim", x) / kth("exact", x) - 1.0, r"differs by (\S+) % at most, at (\S+) %"
    )
    assert not claim.holds


def test_local_kth_is_global_kth_in_full_slip_below_the_speed_threshold_only(bench: Bench) -> None:
    claim = local_claims.kth_local_like_global(bench)
    assert_shares_at(claim, lambda x: kth("exact", x) / kth_of(x) - 1.0, 0.2, 0.5, 1.0, 10.0, 19.0, 20.0)
    absolute = max(abs(kth("exact", x) - kth_of(x)) for x in np.linspace(0.2, FULL_SLIP, 60))
    assert_says(claim, "do not wear, that is", absolute)
    assert not claim.holds


def test_over_the_load_local_and_global_kth_part_between_the_two_thresholds(bench: Bench) -> None:
    claim = local_claims.kth_local_like_global(bench)
    ((most, load),) = re.findall(r"differs by \+(\d+) % at most, at (\d+) kN/m", claim.found)
    at_mean = 2.1e9**2 * 16.0 * RADIUS / (math.pi * MODULUS)  # where the mean pressure is 2.1 GPa
    assert 0.99 * at_mean < 1e3 * float(load) < at_mean
    newton = 1e3 * float(load)
    mean_pressure = newton / (2.0 * point(1.0, newton).half_width)
    on_means = 7850.0 * 5.5e-4 * mean_pressure * 0.01 / 2.625e9 * 1e3
    # The load is printed to 0.5 kN/m; by its own size the difference moves less than that much of itself.
    assert float(most) == pytest.approx(100.0 * (kth("exact", 1.0, newton) / on_means - 1.0), rel=0.005)


@pytest.mark.parametrize(("model", "border"), [("exact", 11.3), ("fastsim", 9.6)])
def test_usfd_on_cells_is_good_up_to_where_the_first_cells_wear_catastrophically(
    bench: Bench, model: str, border: float
) -> None:
    claim = local_claims.usfd_good_in_mild_and_severe(bench, model)

    def share(creepage: float) -> float:
        return usfd(model, creepage) / usfd("global", creepage) - 1.0

    high = float(optimize.brentq(lambda x: share(x) - 0.1, 5.0, 13.0))
    low = float(optimize.brentq(lambda x: share(x) + 0.1, 0.5, 1.9))
    assert_says(claim, "too high from", high, slack=STEP)
    assert high == pytest.approx(border, abs=0.1)
    assert_says(claim, "less than 10 % up to", low, slack=STEP)
    assert_extreme(claim, share, r"creepage, by (\S+) % at (\S+) %")
    assert not claim.holds


def test_usfd_on_cells_is_too_high_in_catastrophic_wear(bench: Bench) -> None:
    claim = local_claims.usfd_too_high_in_catastrophic(bench)
    exact, fastsim = claim.found.split("FASTSIM")
    for part, model, published in (
        (exact, "exact", (801.9, 2247.1, 3825.0)),
        (fastsim, "fastsim", (1176.6, 2608.1, 4148.6)),
    ):
        for creepage, rate in zip((15.0, 20.0, 25.0), published, strict=True):
            share = percent(usfd(model, creepage) / usfd("global", creepage) - 1.0)
            assert f"{rate:.0f} ({share}) at {creepage:g} %" in part
    assert claim.holds


def test_the_slip_speeds_of_kth_are_creepages(bench: Bench) -> None:
    lower, upper = local_claims.lower_slip_speed(bench), local_claims.upper_slip_speed(bench)
    assert_says(lower, "m/s is", 20.0 / SPEED)
    assert_says(upper, "m/s is", 70.0 / SPEED)
    assert lower.holds
    assert upper.holds
    slower = dataclasses.replace(bench, rig=wl.TwinDisc.suros(rolling_speed="0.5 m/s"))
    assert not local_claims.lower_slip_speed(slower).holds
    faster = dataclasses.replace(bench, rig=wl.TwinDisc.suros(rolling_speed="3 m/s"))
    assert not local_claims.upper_slip_speed(faster).holds


def test_the_pressure_of_kth_is_a_load_by_its_mean(bench: Bench) -> None:
    claim = local_claims.pressure_threshold(bench)
    by_mean = 2.1e9**2 * 16.0 * RADIUS / (math.pi * MODULUS)  # p = P/(2a), a² = 4PR/(πE*)
    by_highest = 2.1e9**2 * math.pi * RADIUS / MODULUS  # p0² = PE*/(πR)
    assert_says(claim, "GPa at", by_mean / 1e3)
    assert_says(claim, "maximum pressure at", by_highest / 1e3)
    assert_says(claim, "kN/m,", 100.0 * (by_mean / 2300e3 - 1.0))
    assert claim.holds
    larger = dataclasses.replace(bench, rig=wl.TwinDisc.suros(diameter="60 mm"))
    assert not local_claims.pressure_threshold(larger).holds


@pytest.mark.parametrize(("model", "beyond"), [("global", 0.0), ("exact", FULL_SLIP)])
def test_the_thresholds_lie_beyond_the_tests_for_the_patch_but_not_for_its_cells(
    bench: Bench, model: str, beyond: float
) -> None:
    claim = local_claims.thresholds_beyond_tests(bench, model)
    assert_says(claim, "slip speed reaches", (20.0 + beyond) / 100.0 * SPEED, 0.2)
    assert_says(claim, "m/s at", 20.0 / SPEED - beyond)
    assert claim.holds is (model == "global")


@pytest.mark.parametrize("model", ["exact", "fastsim"])
def test_the_corrected_sets_overlap_with_the_global_law_above_19_percent_only(bench: Bench, model: str) -> None:
    claim = local_claims.corrected_like_global(bench, model)
    spans = re.findall(r"([+-]\d[\d.]*) % to ([+-]\d[\d.]*) % from ([\d.]+) to ([\d.]+) %", claim.found)
    assert [(float(low), float(high)) for *_, low, high in spans] == [(0.2, 14.0), (14.0, 19.0), (19.0, 25.0)]

    def share(creepage: float) -> float:
        return 100.0 * (usfd(model, creepage, CORRECTED[model]) / usfd("global", creepage) - 1.0)

    for least, most, low, high in spans:
        shares = [share(x) for x in np.linspace(float(low), float(high), 60)]
        assert float(least) <= min(shares) + 0.5
        assert float(most) >= max(shares) - 0.5
        assert float(least) >= min(shares) - 5.0
    assert abs(float(spans[2][0])) < 10.0 > abs(float(spans[2][1]))
    assert float(spans[1][1]) == pytest.approx(share(77.26 * AREA / FORCE * 100.0), rel=0.01)
    assert not claim.holds


# Wording


def test_the_first_crossing_is_found_whichever_curve_is_above() -> None:
    x = np.array([0.0, 1.0, 2.0, 3.0])
    rising = np.array([0.0, 1.0, 2.0, 3.0])
    assert first_crossing(x, rising, np.full(4, 1.25)) == 1.25
    assert first_crossing(x, np.full(4, 1.25), rising) == 1.25
    assert first_crossing(x, rising, np.full(4, 5.0)) is None


def test_the_largest_share_keeps_its_sign() -> None:
    assert largest(np.array([0.1, -0.3, 0.2]), np.array([1.0, 2.0, 3.0])) == (-0.3, 2.0)


@pytest.mark.parametrize(
    ("share", "text"), [(0.1234, "+12.3 %"), (-0.5, "-50.0 %"), (1.5, "+150 %"), (-1e-9, "0.0 %"), (0.0, "0.0 %")]
)
def test_shares_are_written_in_percent(share: float, text: str) -> None:
    assert percent(share) == text


# A law in the wrong place


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


# A study


SWEEP: dict[str, Any] = {
    "normal_force_per_width": "741.43 kN/m",
    "creepage": ["0.1 %", "10 %"],
    "friction_coefficient": FRICTION,
}


def study_of(**changes: Any) -> wl.Study:
    return run(case(sweeps={"creepage": {**SWEEP, **changes}}, profiles={}))


def test_every_claim_names_its_place_and_its_numbers() -> None:
    made = claims_module.section(study_of())
    assert len(made.claims) == len({claim.statement for claim in made.claims}) == 35
    for claim in made.claims:
        assert re.match(r"(Sections? [356]|Table 1)", claim.where)
        assert re.search(r"\d", claim.found)
    holding = sum(claim.holds for claim in made.claims)
    assert made.text.startswith(f"{holding} of 35 claims")
    assert "741.43 kN/m and a friction coefficient of 0.46" in made.text


def test_what_needs_measured_wear_is_named_as_not_checked() -> None:
    text = claims_module.section(study_of()).text
    assert "Not checked, since no table of the measured wear rates is public" in text
    assert "overlap against W.I. but not against creepage" in text


def test_the_bench_is_that_of_the_study() -> None:
    made = Bench.of(study_of(normal_force_per_width="800 kN/m", friction_coefficient=0.5))
    assert made.normal_force_per_width.to("kN/m").magnitude == pytest.approx(800.0, rel=1e-12)
    assert made.friction_coefficient == 0.5
    assert made.rig == wl.TwinDisc.suros()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"friction_coefficient": [0.3, 0.4]}, "must have one load and one friction_coefficient"),
        ({"normal_force_per_width": ["700 kN/m", "800 kN/m"]}, "must have one load and one friction_coefficient"),
        ({"friction_coefficient": 0.1}, "wear index reaches 185.4 N at 25 % creepage, and catastrophic wear"),
    ],
)
def test_a_sweep_that_the_claims_cannot_be_made_of_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        Bench.of(study_of(**changes))


def test_a_study_without_the_sweep_is_refused() -> None:
    with pytest.raises(wl.InputError, match=r"the case has no sweep 'creepage'; did you mean 'crepage'"):
        Bench.of(run(case(sweeps={"crepage": SWEEP}, profiles={})))
