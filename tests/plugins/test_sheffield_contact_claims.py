"""Claims of Tassini et al. (2010) on forces and friction, by independent formulas."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest
from scipy import optimize

from tests import reference
from tests.plugins.sheffield import (
    FRICTION,
    FULL_SLIP,
    HEAT,
    KEPT,
    LOAD,
    SOLUTIONS,
    SPEED,
    STEP,
    assert_extreme,
    assert_says,
    assert_shares_at,
    exact_force,
    kth,
    mean_speed,
    numbers,
    paragraph,
    point,
    usfd,
)
from tests.roots import brentq
from wearlaw_sheffield import contact_claims
from wearlaw_sheffield.bench import Bench
from wearlaw_sheffield.wording import percent


def test_elliptic_bound_and_exact_theory_have_one_force_in_full_slip(bench: Bench) -> None:
    claim = contact_claims.elliptic_bound_in_full_slip(bench)

    def apart(creepage: float) -> float:
        return 100.0 * (reference.elliptic(point(creepage)).force / exact_force(creepage) - 1.0)

    assert_says(claim, "T differs by", apart(FULL_SLIP))
    assert_says(claim, "less than 2 % from", brentq(lambda x: apart(x) + 2.0, 1.3, 5.0), slack=STEP)
    assert "by 0.0 % at 20 %" in claim.found
    assert abs(apart(20.0)) < 0.05


def test_elliptic_bound_and_exact_theory_do_not_wear_the_same_in_full_slip(bench: Bench) -> None:
    claim = contact_claims.elliptic_bound_in_full_slip(bench)

    def worn(creepage: float) -> float:
        return usfd("elliptic", creepage) / usfd("exact", creepage) - 1.0

    assert_says(claim, "USFD on cells differs by", 100.0 * worn(FULL_SLIP))
    assert_extreme(claim, worn, r"by at most (\S+) % from 3 % on, at (\S+) %")
    assert_says(claim, "KTH on cells differs by", 100.0 * (kth("elliptic", FULL_SLIP) / kth("exact", FULL_SLIP) - 1.0))
    for kept, words in KEPT.items():
        share = kth("elliptic", 20.0, kept=kept) / kth("exact", 20.0, kept=kept) - 1.0
        assert abs(share) > 0.02
        assert f"{percent(share)} {words}" in claim.found
    assert "This part of the claim fails whichever speed the rig keeps." in claim.found
    assert claim.verdict == "holds in part"


def test_elliptic_bound_differs_by_less_than_a_tenth_in_partial_slip(bench: Bench) -> None:
    claim = contact_claims.elliptic_bound_in_partial_slip(bench)
    where = assert_extreme(
        claim,
        lambda x: reference.elliptic(point(x)).force / exact_force(x) - 1.0,
        r"differs by at most (\S+) %, at (\S+) %",
    )
    shares = [reference.elliptic(point(x)).force / exact_force(x) - 1.0 for x in np.linspace(0.01, FULL_SLIP, 400)]
    assert -100.0 * min(shares) < 10.0
    assert claim.verdict == "holds"
    assert abs(np.linspace(0.01, FULL_SLIP, 400)[int(np.argmin(shares))] - where) < 0.05


def test_the_averaged_wear_index_is_larger_than_the_energy(bench: Bench) -> None:
    claim = contact_claims.averaged_wear_index(bench)
    for model in ("exact", "fastsim"):
        solve, ratios = SOLUTIONS[model], []
        for creepage in (0.1, 0.5, 1.0):
            solution = solve(point(creepage))
            mean_slip = solution.mean(solution.slip) * 2.0 / solution.border
            ratios.append(mean_slip / (creepage / 100.0))
        (listed,) = re.findall(rf"{model}: ([\d., ]+) times", claim.found)
        assert listed.split(", ") == [f"{ratio:.3g}" for ratio in ratios]
    assert claim.verdict == "holds"


@pytest.mark.parametrize(
    ("flexibility", "most", "at"),
    # With d = ξ/ξ_sat, 1-(1-2d/3)³ - d(2-d) is extreme at d = 3/4: 7/8 - 15/16.
    [("line", -6.25, 0.75 * FULL_SLIP), ("kalker", 4.371, 0.3369)],
)
def test_the_forces_of_both_theories_are_not_the_same(bench: Bench, flexibility: str, most: float, at: float) -> None:
    whole = contact_claims.same_force(bench)
    start = {"line": "L = 4a/(πE*)", "kalker": "L = 32a/(3π²E*)"}[flexibility]
    claim = paragraph(whole, start)

    def force(creepage: float) -> float:
        return reference.parabolic(point(creepage), kalker=flexibility == "kalker").force

    where = assert_extreme(
        claim,
        lambda x: (force(x) - exact_force(x)) / (FRICTION * LOAD),
        r"differs by at most (\S+) % of μN, at (\S+) %",
    )
    assert where == pytest.approx(at, abs=STEP)
    assert_says(claim, "FASTSIM differs by at most", most, slack=0.005)  # 6.25 lies between two printed numbers
    assert_shares_at(claim, lambda x: force(x) / exact_force(x) - 1.0, 0.1, 0.5, 1.0)
    assert claim.verdict == "does not hold"


def test_no_flexibility_makes_the_forces_the_same(bench: Bench) -> None:
    """T/(μP) of both theories by the reference: the creepage of FASTSIM's full slip goes with L."""
    grid = np.linspace(0.01, 2.0 * FULL_SLIP, 400)
    exact = np.array([exact_force(x) for x in grid])

    def most(ratio: float) -> float:
        stretched = [reference.parabolic(point(1.5 / ratio * x)).force for x in grid]
        return float(np.abs(np.array(stretched) - exact).max() / (FRICTION * LOAD))

    found = optimize.minimize_scalar(most, bounds=(1.05, 1.5), method="bounded", options={"xatol": 1e-4})
    claim = contact_claims.same_force(bench)
    # The slope of either force in ξ/ξ_sat is at most 3; the grid has steps of 2/400 and misses half of one at most.
    assert_says(claim, "No L gets below", 100.0 * found.fun, slack=100.0 * 3.0 * 0.5 * 2.0 / 400)
    (best,) = numbers(claim.found, "reaches full slip at")
    assert most(float(best)) == pytest.approx(found.fun, abs=3.0 * 0.5 * 2.0 / 400)


TRACTION = {creepage: heat / (creepage / 100.0 * SPEED * 7414.3) for creepage, heat in HEAT.items()}
TESTS = np.array(list(TRACTION)), np.array(list(TRACTION.values()))


@pytest.mark.validates(
    "paper",
    "The paper's friction coefficient is the mean traction of the tests in full slip",
    source="Lewis and Dwyer-Joyce 2004, Table 3, by hand",
    held_to="{paper} in the paper, {ours} here",
    paper=FRICTION,
    ours="0.463",
)
def test_the_friction_coefficient_is_the_mean_in_full_slip(bench: Bench, paper: float, ours: str) -> None:
    assert bench.friction_coefficient == paper
    claim = contact_claims.friction_is_mean_of_full_slip(bench, TESTS)
    full = list(TRACTION.values())[3:]
    assert_says(claim, "creepage on is", sum(full) / 5.0)
    assert f"is {ours}," in claim.found
    spread = math.sqrt(sum((t - sum(full) / 5.0) ** 2 for t in full) / 4.0)
    assert_says(claim, "deviation of", spread)
    # V is (v1 + v2)/2, and T the heat over ξV.
    assert_says(
        claim, "T/N would be", sum(HEAT[x] / (x / 100.0 * mean_speed(x) * 7414.3) for x in list(HEAT)[3:]) / 5.0
    )
    assert claim.verdict == "holds"
    other = dataclasses.replace(bench, friction_coefficient=0.4)
    assert contact_claims.friction_is_mean_of_full_slip(other, TESTS).verdict == "does not hold"
    more = TESTS[0], 1.05 * TESTS[1]
    assert contact_claims.friction_is_mean_of_full_slip(bench, more).verdict == "does not hold"


def test_measured_and_computed_force_differ_at_low_creepage(bench: Bench) -> None:
    claim = contact_claims.force_differs_at_low_creepage(bench, TESTS)
    pairs = re.findall(r"(0\.\d{3}) against (0\.\d{3}) at ([\d.]+) %", claim.found)
    assert [float(x) for _, _, x in pairs] == [0.2, 0.5, 1.0]
    for measured, computed, x in pairs:
        assert measured == f"{TRACTION[float(x)]:.3f}"
        assert computed == f"{exact_force(float(x)) / LOAD:.3f}"
    assert claim.verdict == "holds"
    same = np.array([exact_force(x) / LOAD if x < FULL_SLIP else t for x, t in TRACTION.items()])
    assert contact_claims.force_differs_at_low_creepage(bench, (TESTS[0], same)).verdict == "does not hold"
