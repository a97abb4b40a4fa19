"""The section of claims in the report of the paper: its text, its bench, and how numbers are worded."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.cases import case
from tests.plugins.sheffield import AREA, FORCE, FULL_SLIP, SPEED, STEP
from tests.plugins.sheffield_report import SWEEP, study_of
from wearlaw.study.study import run
from wearlaw_sheffield import claims as claims_module
from wearlaw_sheffield.bench import Bench
from wearlaw_sheffield.wording import first_crossing, largest, percent


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


def test_the_bench_has_the_patch_and_the_borders_of_the_formulas(bench: Bench) -> None:
    # The reference multiplies in another order: a few units in the last place.
    assert bench.patch_area == pytest.approx(AREA, rel=1e-14)
    assert bench.full_slip == pytest.approx(FULL_SLIP, rel=1e-14)
    assert bench.full_force == pytest.approx(FORCE, rel=1e-14)
    assert bench.usfd_borders == pytest.approx((55.0 / 5.3 * AREA, 77.26 * AREA), rel=1e-14)
    assert bench.rolling_speed == pytest.approx(SPEED, rel=1e-14)


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
        ({"friction_coefficient": 0.1}, "wear index reaches 185.4 N at 25 % creepage, and catastrophic wear"),
    ],
)
def test_a_sweep_that_the_claims_cannot_be_made_of_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        Bench.of(study_of(**changes))


def test_a_study_without_the_sweep_is_refused() -> None:
    with pytest.raises(wl.InputError, match=r"the case has no sweep 'creepage'; did you mean 'crepage'"):
        Bench.of(run(case(sweeps={"crepage": SWEEP}, profiles={})))


# Wording


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
