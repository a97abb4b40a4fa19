"""The section of claims in the report of the paper: its text, its bench, and how numbers are worded."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.cases import case
from tests.plugins.sheffield import AREA, FORCE, FULL_SLIP, ROLLING_SPEEDS, SPEED, STEP
from tests.plugins.sheffield_report import SWEEP, study_of
from wearlaw.study.study import run
from wearlaw_sheffield import claims as claims_module
from wearlaw_sheffield.bench import Bench
from wearlaw_sheffield.local_claims import upper_slip_speed
from wearlaw_sheffield.wording import at_both, by_speed, first_crossing, largest, percent, verdict


def test_every_claim_names_its_place_its_criterion_and_its_numbers() -> None:
    made = claims_module.section(study_of())
    assert len(made.claims) == len({claim.statement for claim in made.claims}) == 28
    for claim in made.claims:
        assert re.match(r"Sections? [356]", claim.where)
        assert claim.criterion.endswith(".")
        assert re.search(r"\d", claim.found) or claim.verdict == "cannot be decided"
    assert made.text.startswith("28 claims from sections 3 to 6")
    assert "741.43 kN/m and a friction coefficient of 0.46" in made.text
    assert "At every creepage this rig keeps the surface speed of disc 1 at 0.984 m/s." in made.text


def test_the_text_names_the_speed_that_the_rig_of_the_case_keeps() -> None:
    content = {"sweeps": {"creepage": SWEEP}, "profiles": {}, "rig": {"preset": "suros", "rolling_speed": "1.1 m/s"}}
    text = claims_module.section(run(case(**content))).text
    assert "this rig keeps the mean of the surface speeds at 1.100 m/s." in text


def test_what_needs_measured_wear_is_named() -> None:
    text = claims_module.section(study_of()).text
    assert "The measured wear rates have not been published as numbers" in text
    assert "USFD on the patch means stands in for the measurements" in text


def test_the_bench_is_that_of_the_study() -> None:
    made = Bench.of(study_of(normal_force_per_width="800 kN/m", friction_coefficient=0.5))
    assert made.normal_force_per_width.to("kN/m").magnitude == pytest.approx(800.0, rel=1e-12)
    assert made.friction_coefficient == 0.5
    assert made.rig == wl.TwinDisc.suros()


def test_the_bench_has_the_patch_and_the_borders_of_the_formulas(bench: Bench) -> None:
    # The reference multiplies in another order: a few units in the last place.
    assert bench.patch_area == pytest.approx(AREA, rel=1e-14)
    assert bench.full_slip == pytest.approx(FULL_SLIP, rel=1e-14)
    assert bench.full_force == pytest.approx(FORCE, rel=1e-14)
    assert bench.usfd_borders == pytest.approx((55.0 / 5.3 * AREA, 77.26 * AREA), rel=1e-14)
    assert bench.kept_speed == pytest.approx(SPEED, rel=1e-14)
    assert bench.window == pytest.approx(350.0, rel=1e-4)  # 6.2934 mm² in five digits


@pytest.mark.parametrize("rig", [wl.TwinDisc.suros(), wl.TwinDisc.suros(rotational_speed="400 rpm", speed_of="mean")])
def test_a_bench_stands_for_both_speeds_that_a_rig_can_keep(bench: Bench, rig: wl.TwinDisc) -> None:
    benches = dataclasses.replace(bench, rig=rig).at_speeds()
    assert [one.rig.speed_of for one in benches.values()] == ["disc_1", "mean"]
    assert list(benches) == ["if disc 1 keeps its speed", "if the mean does"]
    for one, speed in zip(benches.values(), ROLLING_SPEEDS.values(), strict=True):
        found = one.creepage_at(0.2)
        assert found / 100.0 * speed(found) == pytest.approx(0.2, rel=1e-14)
        predicted = one.predict("global", wl.wear_law("kth"), 20.0).contact.slip_speed
        assert predicted == pytest.approx(0.2 * speed(20.0), rel=1e-14)
    assert benches["if disc 1 keeps its speed"].creepages_at(0.2) == (
        "22.62 % if disc 1 keeps its speed, 20.32 % if the mean does"
    )


def test_discs_that_are_too_slow_for_a_slip_speed_have_no_creepage_of_it(bench: Bench) -> None:
    # The surface speeds of 0.3 m/s and -0.4 m/s differ by 0.7 m/s, and their mean is below zero.
    slow = dataclasses.replace(bench, rig=wl.TwinDisc.suros(rolling_speed="0.3 m/s", speed_of="disc_1"))
    assert slow.creepages_at(0.7, digits=1) == "no creepage if disc 1 keeps its speed, 233.3 % if the mean does"
    assert upper_slip_speed(slow).verdict == "holds"


def test_the_creepages_of_the_bench_are_dense_and_meet_its_kinks(bench: Bench) -> None:
    x = bench.creepage
    assert x[0] == 1e-3
    assert x[-1] == 25.0
    assert np.diff(x).max() <= STEP * (1.0 + 1e-9)
    assert np.diff(np.log(x[x < 1.0])).max() < STEP
    for kink in (0.2, 1.0, FULL_SLIP, 5500.0 / 5.3 * AREA / FORCE, 7726.0 * AREA / FORCE):
        assert np.abs(x / kink - 1.0).min() < 1e-14


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"friction_coefficient": [0.3, 0.4]}, "must have one load and one friction_coefficient"),
        ({"normal_force_per_width": ["700 kN/m", "800 kN/m"]}, "must have one load and one friction_coefficient"),
        ({"friction_coefficient": 0.1}, "wear index reaches only 185.4 N at 25 % creepage"),
    ],
)
def test_a_sweep_that_the_claims_cannot_be_made_of_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        Bench.of(study_of(**changes))


def test_a_study_without_the_sweep_is_refused() -> None:
    with pytest.raises(wl.InputError, match=r"the case has no sweep 'creepage'; did you mean 'crepage'"):
        Bench.of(run(case(sweeps={"crepage": SWEEP}, profiles={})))


# Wording


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        ([True, True], "holds"),
        ([True, False], "holds in part"),
        ([True, None], "holds in part"),
        ([False, False], "does not hold"),
        ([None, False], "cannot be decided"),
        ([None], "cannot be decided"),
    ],
)
def test_the_verdict_on_a_claim_is_that_on_its_parts(parts: list[bool | None], expected: wl.Verdict) -> None:
    assert verdict(parts) == verdict(reversed(parts)) == expected


def test_what_depends_on_the_speed_cannot_be_decided() -> None:
    assert [at_both(parts) for parts in ([True, True], [False, False], [True, False])] == [True, False, None]
    assert [by_speed(part) for part in (True, False, None)] == [
        "This part of the claim holds whichever speed the rig keeps.",
        "This part of the claim fails whichever speed the rig keeps.",
        "Whether this part of the claim holds depends on which speed the rig keeps.",
    ]


def test_the_first_crossing_is_found_whichever_curve_is_above() -> None:
    x = np.array([0.0, 1.0, 2.0, 3.0])
    rising = np.array([0.0, 1.0, 2.0, 3.0])
    assert first_crossing(x, rising, np.full(4, 1.25)) == 1.25
    assert first_crossing(x, np.full(4, 1.25), rising) == 1.25
    assert first_crossing(x, rising, np.full(4, 5.0)) is None
    assert first_crossing(x, rising, rising + 0.5) is None


def test_curves_that_cross_twice_or_at_a_point_cross_where_they_first_do() -> None:
    x = np.array([0.0, 1.0, 2.0, 3.0])
    assert first_crossing(x, np.array([1.0, -1.0, -1.0, 2.0]), np.zeros(4)) == 0.5
    assert first_crossing(x, np.array([1.0, 0.0, -3.0, 2.0]), np.zeros(4)) == 1.0
    assert first_crossing(x, np.array([1.0, 1.0, -1.0, -3.0]), np.zeros(4)) == 1.5
    assert first_crossing(x, np.array([1.0, 0.0, 1.0, 2.0]), np.zeros(4)) is None


def test_the_largest_share_keeps_its_sign() -> None:
    assert largest(np.array([0.1, -0.3, 0.2]), np.array([1.0, 2.0, 3.0])) == (-0.3, 2.0)


@pytest.mark.parametrize(
    ("share", "text"),
    [
        *((0.1234, "+12.3 %"), (-0.5, "-50.0 %"), (1.0, "+100 %"), (-1.5, "-150 %")),
        *((0.0, "0.0 %"), (-1e-9, "0.0 %"), (5e-4, "+0.1 %")),
    ],
)
def test_shares_are_written_in_percent(share: float, text: str) -> None:
    assert percent(share) == text
