"""Where the claims of Tassini et al. (2010) turn: other rigs, loads, friction, and laws with other parameters."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.sheffield import (
    AREA,
    FORCE,
    FULL_SLIP,
    GLOBAL,
    KTH_MID,
    LOAD,
    MODULUS,
    SPEED,
    assert_says,
    brr_of,
    index,
    numbers,
    paragraph,
)
from wearlaw_sheffield import contact_claims, law_claims, local_claims, tables
from wearlaw_sheffield.bench import Bench

MILD, SEVERE = GLOBAL[1] / GLOBAL[0] * AREA, GLOBAL[3] * AREA
"""Where severe and where catastrophic wear begins under the load of the paper [N]."""


def under(bench: Bench, load: float = LOAD, friction: float | None = None, **rig: Any) -> Bench:
    """Return a bench under another load [N/m], with another friction coefficient or rig."""
    return dataclasses.replace(
        bench,
        rig=wl.TwinDisc.suros(**rig),
        normal_force_per_width=wl.Q(load, "N/m"),
        friction_coefficient=bench.friction_coefficient if friction is None else friction,
    )


def of_density(bench: Bench, density: float) -> Bench:
    """Return a bench with discs of another density [kg/m³], to which BRR and KTH are proportional, and USFD is not."""
    return under(bench, material=wl.steel(density=wl.Q(density, "kg/m^3")))


def change(monkeypatch: pytest.MonkeyPatch, name: str, **parameters: str) -> None:
    """Let a law have other parameters than the published ones."""
    look_up = wl.wear_law
    monkeypatch.setattr(
        wl, "wear_law", lambda law, **given: look_up(law, **({**parameters, **given} if law == name else given))
    )


@pytest.mark.parametrize(
    ("density", "brr", "expected"),
    [
        (5300.0, False, "does not hold"),
        (5500.0, True, "holds in part"),
        (8090.0, True, "holds"),
        (8110.0, False, "holds in part"),
    ],
)
def test_brr_reproduces_mild_wear_within_a_fifth_of_the_plot_either_way(
    bench: Bench, density: float, brr: bool, expected: str
) -> None:
    ratio = 0.25 * math.pi * density / 1e3 / 5.3
    claim = law_claims.close_in_mild(of_density(bench, density))
    assert_says(paragraph(claim, "BRR"), "BRR is", ratio)
    assert brr is (abs(ratio - 1.0) < 0.2)
    # The least k of KTH in severe wear, 8.15e-4 at 7850 kg/m³, is beyond its range below 6400 kg/m³.
    assert claim.verdict == expected


def test_brr_that_crosses_usfd_before_700_newton_or_is_still_far_there_does_not_come_closer_above(bench: Bench) -> None:
    for density, ratio in ((6000.0, 0.943), (15000.0, 2.357)):
        claim = law_claims.brr_comes_closer(of_density(bench, density))
        assert_says(claim, "N and", ratio, slack=0.0005)
        assert claim.verdict == "does not hold"


def test_brr_that_parts_from_usfd_up_to_700_newton_does_not_come_closer(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    change(monkeypatch, "brr", severe_limit="600 N", severe_slope="1.714 mm^3/km/N")
    claim = law_claims.brr_comes_closer(under(bench))
    assert_says(claim, "BRR is", brr_of(199.0) / 55.0)
    assert_says(claim, "N and", 1.90)
    assert claim.verdict == "does not hold"


def test_where_no_catastrophic_wear_is_met_at_700_newton_brr_is_looked_at_as_near_as_it_can(bench: Bench) -> None:
    light, heavy = under(bench, 500.5e3), under(bench, 2000e3)
    ends = law_claims.brr_comes_closer(light)
    assert_says(ends, "times at", 0.25 * 0.46 * 5005.0)
    assert "do not cross" in ends.found
    begins = law_claims.brr_comes_closer(heavy)
    assert_says(begins, "times at", SEVERE * math.sqrt(2000e3 / LOAD))
    assert len(set(numbers(begins.found, "is") + numbers(begins.found, "N and"))) == 1
    assert begins.verdict == "does not hold"


@pytest.mark.parametrize(("offset", "jump"), [("213 mm^3/km", 1.0), ("188 mm^3/km", 2.0)])
def test_the_tables_say_by_how_much_brr_jumps(monkeypatch: pytest.MonkeyPatch, offset: str, jump: float) -> None:
    assert tables.brr_jump() == {"border": 200.0, "jump": pytest.approx(84.0 / 25.0, rel=1e-12)}
    change(monkeypatch, "brr", severe_offset=offset)  # 1.19 · 200 - 213 = 25, the plateau
    assert tables.brr_jump()["jump"] == pytest.approx(jump, rel=1e-12)


@pytest.mark.parametrize(("share", "holds"), [(0.5, True), (0.2, False)])
def test_the_plateau_of_brr_is_shorter_where_that_of_usfd_is_longer_than_100_newton(
    bench: Bench, share: float, holds: bool
) -> None:
    claim = law_claims.brr_plateau_is_shorter(under(bench, LOAD * share**2))  # the area goes with the root of the load
    assert (claim.verdict == "holds") is holds is (share * (SEVERE - MILD) > 100.0)


@pytest.mark.parametrize(
    ("friction", "speed", "holds"),
    [(0.15, SPEED, True), (0.3, SPEED, False), (0.15, 3.0, False)],
    ids=["slides from 4.5 N", "sticks at 5 N", "passes 0.2 m/s"],
)
def test_kth_is_proportional_where_the_discs_slide_fully_and_slowly(
    bench: Bench, friction: float, speed: float, holds: bool
) -> None:
    claim = law_claims.kth_proportional(under(bench, friction=friction, rolling_speed=wl.Q(speed, "m/s")))
    slides_from = index(FULL_SLIP) * (friction / 0.46) ** 2
    most = 0.0 if 0.2 * speed < 0.2 else KTH_MID[2] / KTH_MID[1] - 1.0
    assert holds is (slides_from < 5.0 and most == 0.0)
    # 0.2 m/s is 74 N, in severe wear, with 3 m/s.
    assert ("severe wear: 1 to 1." in claim.found) is (most == 0.0)
    assert claim.verdict == ("holds" if holds else "holds in part")


def test_kth_is_not_linear_where_its_coefficient_jumps_in_partial_slip(bench: Bench) -> None:
    assert law_claims.kth_linear(under(bench, rolling_speed="20 m/s")).verdict == "does not hold"  # 0.2 m/s is 1 %


def test_a_law_that_grows_faster_than_the_creepage_is_not_linear(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(law_claims, "_kth", lambda bench: bench.creepage**1.5)
    claim = law_claims.kth_linear(bench)
    assert "is 1.500 to 1.500" in claim.found
    assert claim.verdict == "does not hold"


def test_usfd_is_not_quadratic_where_severe_wear_begins_early_in_partial_slip(bench: Bench) -> None:
    claim = law_claims.usfd_quadratic(under(bench, 10.0 * LOAD))
    assert claim.verdict == "holds in part"
    assert "at 1 %" in claim.found


def test_brr_does_not_grow_as_usfd_where_severe_wear_begins_in_partial_slip(bench: Bench) -> None:
    claim = law_claims.brr_like_usfd(under(bench, 2.0 * LOAD))
    # USFD is level from 65 √2 = 92 N on, BRR from 100 N on; full slip begins at 119 N.
    assert_says(claim, "BRR is", 0.25 * math.pi * 7.85 / 5.3)
    assert_says(claim, "to", 0.25 * math.pi * 7.85 / 5.3 * 100.0 / (MILD * math.sqrt(2.0)), slack=0.01)
    assert claim.verdict == "does not hold"


def test_a_law_that_is_bent_in_full_slip_is_not_straight(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(law_claims, "_kth", lambda bench: 1e-6 * bench.creepage**2)
    claim = law_claims.straight_in_full_slip(bench)
    end = 20.0 / (SPEED - 0.1)  # where v1 - v2 is 0.2 m/s if disc 1 keeps its speed, the longer of the two regimes
    # The chord of a parabola from x0 to x1 is (x1-x0)²/4 above it in the middle.
    assert_says(claim, "more than", 100.0 * (end - FULL_SLIP) ** 2 / 4.0 / end**2, slack=0.2)
    assert claim.verdict == "does not hold"


def test_a_regime_that_is_not_met_in_full_slip_has_no_slope(bench: Bench) -> None:
    claim = law_claims.straight_in_full_slip(under(bench, 2.0 * LOAD))
    assert MILD * math.sqrt(2.0) < 2.0 * math.sqrt(2.0) * index(FULL_SLIP)
    assert "USFD mild" not in claim.found
    assert_says(claim, "USFD severe", 0.0)
    assert claim.verdict == "holds"


def test_a_slope_takes_two_creepages(bench: Bench) -> None:
    # Mild wear ends at 100 MILD/(μN) [%]: beyond full slip, which is proportional to μ, by 0.001 % with this μ.
    rise, fall = FULL_SLIP / 0.46, 100.0 * MILD / FORCE * 0.46
    friction = (-0.001 + math.sqrt(0.001**2 + 4.0 * rise * fall)) / (2.0 * rise)
    two = law_claims.straight_in_full_slip(under(bench, friction=friction))
    assert_says(two, "USFD mild", 5.3 * FORCE / AREA / 100.0 * friction / 0.46)
    # If this is the speed of disc 1, KTH jumps at 0.2/(v1 - 0.1), 0.001 % beyond full slip; if the mean, before that.
    speed = wl.Q(20.0 / (FULL_SLIP + 0.001) + 0.1, "m/s")
    one = law_claims.straight_in_full_slip(under(bench, rolling_speed=speed))
    assert "KTH" not in one.found
    assert two.verdict == one.verdict == "holds"


def test_no_jump_is_told_of_where_severe_wear_begins_beyond_it(bench: Bench) -> None:
    claim = law_claims.above_in_severe(under(bench, 10.0 * LOAD))
    assert MILD * math.sqrt(10.0) > 200.0
    assert "at first, and" in claim.found


@pytest.mark.parametrize(
    ("creepage", "expected"),
    [(18.0, "does not hold"), (19.5, "cannot be decided"), (21.0, "holds"), (24.0, "cannot be decided")],
)
def test_a_speed_that_is_not_above_20_percent_whichever_v_is_is_not_that_of_the_paper(
    bench: Bench, creepage: float, expected: str
) -> None:
    claim = local_claims.lower_slip_speed(under(bench, rolling_speed=wl.Q(20.0 / creepage, "m/s")))
    # ξ v1/(1 + ξ/2) = 0.2 m/s with v1 = 0.2/ξ1 is ξ = ξ1/(1 - ξ1/2).
    assert_says(claim, "m/s is", creepage / (1.0 - creepage / 200.0))
    assert_says(claim, "keeps its speed,", creepage)
    how = {
        "does not hold": "The claim fails whichever speed the rig keeps.",
        "cannot be decided": "Whether the claim holds depends on which speed the rig keeps.",
        "holds": "The claim holds whichever speed the rig keeps.",
    }
    assert how[expected] in claim.found
    assert claim.verdict == expected


def test_usfd_on_cells_is_judged_within_the_creepages_of_the_tests(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    change(monkeypatch, "usfd", q_s="0.01 ug/m/mm^2")
    claim = local_claims.usfd_good_in_mild_and_severe(under(bench))
    # All that slips wears severely, a share ξ/ξ_sat of the patch, but for a few cells at its ends.
    said = paragraph(claim, "On the exact theory:")
    assert_says(said, "theory:", 100.0 * (0.2 / FULL_SLIP - 1.0), slack=1.0)
    assert "at 0.20 %" in said.found


def test_usfd_without_a_threshold_is_the_same_on_cells(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    change(monkeypatch, "usfd", q_s="1e6 ug/m/mm^2", tr_sc="1e6 N/mm^2")
    claim = local_claims.usfd_good_in_mild_and_severe(under(bench))
    assert "On the exact theory: 0.0 % to 0.0 %" in claim.found
    assert "too high" not in claim.found
    assert "inf" not in claim.found
    assert claim.verdict == "holds"


def test_slow_discs_pass_no_threshold_and_leave_nothing_undecided(bench: Bench) -> None:
    slow = under(bench, rolling_speed="0.7 m/s")
    # FASTSIM slips by ξ - Lμ dp/dx = ξ + 1.5 ξ_sat at the trailing edge.
    assert 0.007 * (20.0 + 1.5 * FULL_SLIP) < 0.2
    for claim in (local_claims.kth_same_on_both_theories(slow), local_claims.kth_local_like_global(slow)):
        assert "no cell reaches 0.2 m/s up to 20 % creepage:" in claim.found
        assert "keeps its speed" not in claim.found
        assert claim.verdict == "holds"
    assert local_claims.thresholds_beyond_tests(slow).verdict == "holds"


def test_fast_discs_pass_the_threshold_whichever_v_is(bench: Bench) -> None:
    fast = under(bench, rolling_speed="1.3 m/s")
    claim = local_claims.thresholds_beyond_tests(fast)
    assert 0.2 * 1.3 / 1.1 > 0.2
    assert claim.found.count("does not hold") == 3
    assert claim.verdict == "does not hold"


@pytest.mark.parametrize(("diameter", "by_pressure"), [(0.047, True), (0.6, False)])
def test_over_the_load_local_kth_parts_by_the_pressure_where_that_passes_its_threshold(
    bench: Bench, diameter: float, by_pressure: bool
) -> None:
    claim = local_claims.kth_local_like_global(under(bench, diameter=wl.Q(diameter, "m")))
    passed_at = 2.1e9**2 * math.pi * diameter / 4.0 / MODULUS  # p0² = PE*/(πR)
    assert (passed_at < 14829e3) is by_pressure
    assert ("above 2.1 GPa but the mean pressure is not" in claim.found) is by_pressure


def test_usfd_on_cells_is_too_high_with_both_theories_or_not_as_claimed(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    change(
        monkeypatch, "usfd", m_c="0.1 ug/m/N"
    )  # rises so little that rates below the plateau, at the ends, count more
    made = under(bench)
    x = made.creepage[made.between(made.usfd_borders[1], np.inf)]
    mean, exact, fastsim = (made.rate(model, wl.wear_law("usfd"), x) for model in ("global", "exact", "fastsim"))
    assert (exact > mean).all()
    assert not (fastsim > exact).all()
    assert local_claims.usfd_too_high_in_catastrophic(made).verdict == "holds in part"


def test_the_averaged_wear_index_is_comparable_in_full_slip(bench: Bench) -> None:
    claim = contact_claims.averaged_wear_index(under(bench, friction=0.03))
    assert "exact: 1, 1, 1 times" in claim.found
    assert claim.verdict == "does not hold"


def test_a_measured_force_within_the_scatter_of_the_tests_does_not_differ(bench: Bench) -> None:
    creepage = np.array([0.2, 0.5, 1.0, 5.0, 10.0, 20.0])
    scatter = np.array([1.03, 1.03, 1.03, 0.95, 1.0, 1.05])  # a standard deviation of 0.05
    tests = creepage, 0.46 * bench.force("exact", creepage) * scatter
    claim = contact_claims.force_differs_at_low_creepage(bench, tests)
    assert "scatter by 5.0 %" in claim.found
    assert claim.verdict == "does not hold"
