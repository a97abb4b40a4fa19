"""The claims of Tassini et al. (2010): verdicts and numbers by independent formulas, and where verdicts turn."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy import optimize

import wearlaw as wl
from tests.plugins.tassini2010.paper import (
    AREA,
    CORRECTED,
    FORCE,
    FRICTION,
    FULL_SLIP,
    GLOBAL,
    HEAT,
    LOAD,
    MODULUS,
    RADIUS,
    ROLLING_SPEEDS,
    SOLUTIONS,
    SPEED,
    STEP,
    K,
    brr_of,
    creepage_at,
    exact_force,
    index,
    kth,
    kth_of,
    point,
    usfd,
    usfd_of,
)
from wearlaw_apps.papers.tassini2010 import claims  # private: one claim or table, without the study
from wearlaw_apps.papers.tassini2010.bench import Bench  # private: one claim or table, without the study
from wearlaw_apps.studies.sections import Verdict  # private: the type alone

BEGIN, END = GLOBAL[1] / GLOBAL[0] * AREA, GLOBAL[3] * AREA
"""Where severe and where catastrophic wear begin [N]."""

KINK = 100.0 * END / FORCE
"""Creepage where catastrophic wear begins [%]."""

SLOW = 20.0 / SPEED - 1.5 * FULL_SLIP
"""Creepage [%] from which some cells of FASTSIM pass 0.2 m/s if the mean is kept: they slip by up to ξ + 1.5 ξ_sat."""

TRACTION = {creepage: heat / (creepage / 100.0 * SPEED * 7414.3) for creepage, heat in HEAT.items()}
TESTS = np.array(list(TRACTION)), np.array(list(TRACTION.values()))

Expected = float | tuple[float, float]
"""A number, to half of the last digit shown, or a number and what a grid may miss of it."""


def extreme(f: Callable[[float], float], xs: Iterable[float]) -> tuple[float, float]:
    """Return the value of largest magnitude on a grid, and what this grid or that of the claims misses at most."""
    grid = np.array([*xs], float)
    coarse = np.arange(0, grid.size, 8)  # the differences have few maxima, far more than eight steps wide
    near = 8 * int(np.argmax([abs(f(float(x))) for x in grid[coarse]]))
    values = np.array([f(float(x)) for x in grid[max(near - 8, 0) : near + 9]])
    at = int(np.abs(values).argmax())
    return float(values[at]), float(np.abs(np.diff(values[max(at - 1, 0) : at + 2])).max())


def apart(one: Callable[[float], float], other: Callable[[float], float]) -> Callable[[float], float]:
    """Return the difference in percent of the other."""
    return lambda x: 100.0 * (one(x) / other(x) - 1.0)


def force(model: str, creepage: float) -> float:
    return SOLUTIONS[model](point(creepage)).force


def elliptic_in_full_slip() -> list[Expected]:
    by_force = apart(lambda x: force("elliptic", x), exact_force)
    worn = apart(lambda x: usfd("elliptic", x), lambda x: usfd("exact", x))
    by_kth = 100.0 * (kth("elliptic", 20.0) / kth("exact", 20.0) - 1.0)
    return [by_force(FULL_SLIP), by_force(3.0), 3.0, extreme(worn, np.linspace(3.0, 20.0, 200)), by_kth, 20.0]


def averaged_index() -> list[Expected]:
    ratios: list[Expected] = []
    for model in ("exact", "fastsim"):
        for creepage in (0.1, 0.5, 1.0):
            solution = SOLUTIONS[model](point(creepage))
            ratios.append(solution.mean(solution.slip) * 2.0 / solution.border / (creepage / 100.0))
    return [0.1, 0.5, 1.0, *ratios]


def same_force() -> list[Expected]:
    grid = np.linspace(0.01, 2.0 * FULL_SLIP, 400)
    exact = np.array([exact_force(x) for x in grid])

    def most(ratio: float) -> float:
        stretched = [force("fastsim", 1.5 / ratio * x) for x in grid]
        return 100.0 * float(np.abs(np.array(stretched) - exact).max() / (FRICTION * LOAD))

    best = optimize.minimize_scalar(most, bounds=(1.05, 1.5), method="bounded", options={"xatol": 1e-4}).fun
    kalker = extreme(lambda x: 100.0 * (force("kalker", x) - exact_force(x)) / (FRICTION * LOAD), grid)
    # With d = ξ/ξ_sat, 1-(1-2d/3)³ - d(2-d) is extreme at d = 3/4: 7/8 - 15/16 = 6.25 %, between two printed numbers.
    # The slope of either force in ξ/ξ_sat is at most 3; the grid has steps of 2/400 and misses half of one at most.
    return [(-6.25, 0.005), kalker, (best, 100.0 * 3.0 * 0.5 * 2.0 / 400)]


def friction() -> list[Expected]:
    full = list(TRACTION.values())[3:]
    mean = sum(full) / 5.0
    return [5.0, mean, math.sqrt(sum((t - mean) ** 2 for t in full) / 4.0)]


def in_mild_wear() -> list[Expected]:
    k = (0.0, least_k(), 0.0, 0.0)
    off = extreme(
        lambda w: 100.0 / 55.0 * (kth_of(creepage_at(w), k) - usfd_of(w / AREA)), np.linspace(0.01, BEGIN, 500)
    )
    return [100.0 * (0.25 * math.pi * 7.85 / 5.3 - 1.0), (abs(off[0]), off[1]), least_k()]


def least_k() -> float:
    """Return the least k with which KTH is not below USFD anywhere from `BEGIN` on, where USFD is level."""
    return 5.5e-4 * 55.0 / kth_of(creepage_at(BEGIN))


def in_severe_wear() -> list[Expected]:
    return [brr_of(BEGIN) / 55.0, *(kth_of(creepage_at(BEGIN), K[k]) / 55.0 for k in ("low", "high"))]


def theories(one: str, other: str) -> Expected:
    most, slack = extreme(lambda x: kth(one, x) - (kth_of(x) if other == "global" else kth(other, x)), GRID)
    return abs(most), slack


GRID = np.linspace(0.2, 1.9, 171)
"""Partial slip, of FASTSIM too, in which KTH on cells differs [%]."""


def beyond_slow(one: str, other: str) -> list[Expected]:
    """Return the creepage from which cells pass 0.2 m/s, to a tenth, and the difference beyond, if the mean is kept."""
    of_other = kth_of if other == "global" else lambda x: kth(other, x, kept="mean")
    most = extreme(apart(lambda x: kth(one, x, kept="mean"), of_other), np.linspace(SLOW, 20.0, 320))
    return [math.floor(10.0 * SLOW) / 10.0, most]


def on_both_theories() -> list[Expected]:
    return [theories(one, other) for other in ("exact", "as printed") for one in ("fastsim", "kalker")]


def like_global() -> list[Expected]:
    return [theories("exact", "global"), theories("as printed", "global")]


def local_in_mild_and_severe() -> list[Expected]:
    found: list[Expected] = []
    for model in ("exact", "as printed", "fastsim"):
        grid = [*np.linspace(0.2, 35000.0 / FORCE, 400), 100.0 * BEGIN / FORCE]
        most, slack = extreme(lambda x: 100.0 / 55.0 * (usfd(model, x) - usfd("global", x)), sorted(grid))  # noqa: B023
        found.append((abs(most), slack))
    return found


def local_in_catastrophic() -> list[Expected]:
    shares = [apart(lambda x: usfd(m, x), lambda x: usfd("global", x))(x)  # noqa: B023
              for m in ("exact", "fastsim") for x in (15.0, 20.0, 25.0)]  # fmt: skip
    return [15.0, 20.0, 25.0, *shares]


def creepage_of(slip_speed: float) -> list[Expected]:
    # v1 - v2 = ξ(v1 + v2)/2 with v1 = 0.984 m/s.
    return [100.0 * slip_speed / (SPEED - slip_speed / 2.0)]


def thresholds(kept: str = "disc_1") -> list[Expected]:
    # The last node is up to a thousandth of the patch before the trailing edge.
    beyond = (0.0, FULL_SLIP, 1.5 * FULL_SLIP)
    return [20.0, *(((20.0 + e) / 100.0 * ROLLING_SPEEDS[kept](20.0), 1e-3 * e / 100.0) for e in beyond)]


def gap() -> list[Expected]:
    return [
        number
        for model in ("exact", "fastsim")
        for number in (usfd(model, KINK) - 55.0, KINK, usfd(model, 25.0) - usfd("global", 25.0), 25.0)
    ]


def corrected() -> list[Expected]:
    found: list[Expected] = []
    for model in ("exact", "fastsim"):
        for low, high, top in ((0.2, 30000.0 / FORCE, 55.0), (30000.0 / FORCE, 25.0, usfd("global", 25.0))):
            grid = {*np.linspace(low, high, 400), *(x for x in (100.0 * BEGIN / FORCE, KINK) if low < x < high)}
            most, slack = extreme(
                lambda x: 100.0 / top * (usfd(model, x, CORRECTED[model]) - usfd("global", x)),  # noqa: B023
                sorted(grid),
            )
            found.append((abs(most), slack))
    return found


def at_high_slip() -> list[Expected]:
    # Heat over rolling speed is T times creepage.
    measured = [usfd_of(HEAT[x] / SPEED / AREA) for x in (15.0, 20.0)]
    return [15.0, 20.0, *measured, *(usfd_of(index(x) / AREA) for x in (15.0, 20.0))]


PROPORTION = kth_of(creepage_at(5.0)) / 5.0 / (kth_of(2.0) / index(2.0))
RATIO = 0.25 * math.pi * 7.85 / 5.3
BY_MEAN = 2.1e9**2 * 16.0 * RADIUS / (math.pi * MODULUS) / 1e3
"""Where the mean pressure is 2.1 GPa [kN/m]: p = P/(2a), a² = 4PR/(πE*)."""

PAPER: dict[str, tuple[Verdict, Callable[[], list[Expected]]]] = {
    "elliptic in full slip": ("holds in part", elliptic_in_full_slip),
    "elliptic in partial slip": (
        "holds",
        lambda: [extreme(apart(lambda x: force("elliptic", x), exact_force), np.linspace(0.01, FULL_SLIP, 400))],
    ),
    "averaged index": ("holds", averaged_index),
    "same force": ("does not hold", same_force),
    "friction": ("holds", friction),
    "force at low creepage": (
        "holds",
        lambda: [*list(TRACTION.values())[:3], *(exact_force(x) / LOAD for x in (0.2, 0.5, 1.0)), 0.2, 0.5, 1.0],
    ),
    "all in mild wear": ("holds", in_mild_wear),
    "above in severe wear": ("holds", in_severe_wear),
    "BRR comes closer": ("holds", lambda: [brr_of(END) / 55.0, END, brr_of(700.0) / usfd_of(700.0 / AREA), 700.0]),
    "plateau of BRR": ("holds", lambda: [100.0, 200.0, BEGIN, END]),
    # The first creepage of the bench above 5 N is up to a hundredth beyond it, and the rate over W.I. goes with 1/ξ.
    "KTH proportional": ("holds in part", lambda: [(PROPORTION, 0.01 * PROPORTION), 1.0, 1.0]),
    "KTH linear": ("holds", lambda: [1.0, 1.0]),
    # 1 + (2-2d)/(2-d) is 1.8 where d is 1/3.
    "USFD quadratic": (
        "holds in part",
        lambda: [
            *(1.0 + (2.0 - 2.0 * x / FULL_SLIP) / (2.0 - x / FULL_SLIP) for x in (0.01, 0.1, 0.5, 1.0)),
            *(0.01, 0.1, 0.5, 1.0, 2.0),
            (FULL_SLIP / 3.0, STEP),
        ],
    ),
    "BRR like USFD": ("holds", lambda: [RATIO, RATIO]),
    "straight in full slip": ("holds", lambda: [0.0]),
    "tests over creepage": ("holds", at_high_slip),
    "KTH on both theories": ("holds", lambda: [*on_both_theories(), 20.0]),
    "KTH local like global": ("holds", lambda: [*like_global(), 20.0]),
    "USFD local in mild and severe": ("holds in part", local_in_mild_and_severe),
    "USFD local in catastrophic": ("holds", local_in_catastrophic),
    "lower slip speed": ("holds", lambda: creepage_of(0.2)),
    "upper slip speed": ("holds", lambda: creepage_of(0.7)),
    "pressure threshold": ("holds", lambda: [BY_MEAN, BY_MEAN * (math.pi / 4.0) ** 2]),
    "thresholds beyond tests": ("holds", thresholds),
    "gap in catastrophic": ("holds in part", gap),
    "corrected like global": ("holds in part", corrected),
}
"""The verdict on each claim and the numbers of its row, in their order, by the formulas of the paper and integrals."""

MEAN_KEPT: dict[str, tuple[Verdict, Callable[[], list[Expected]]]] = {
    "KTH on both theories": ("holds in part", lambda: [*on_both_theories(), *beyond_slow("fastsim", "exact")]),
    "KTH local like global": ("holds in part", lambda: [*like_global(), *beyond_slow("exact", "global")]),
    "lower slip speed": ("holds", lambda: [20.0 / SPEED]),
    "upper slip speed": ("holds", lambda: [70.0 / SPEED]),
    "thresholds beyond tests": ("holds in part", lambda: thresholds("mean")),
}
"""The same if the rig keeps the mean of both speeds."""


@pytest.fixture(scope="module")
def rows(bench: Bench) -> dict[str, dict[str, wl.CheckedClaim]]:
    mean_kept = under(bench, rolling_speed=bench.rig.rolling_speed, speed_of="mean")
    return {"disc_1": claims.checked(bench, TESTS), "mean": claims.checked(mean_kept, TESTS)}


@pytest.mark.validates(
    "paper",
    "The {count:g} claims of the paper that its report judges: the verdict and the numbers of each",
    source="Tassini et al. 2010 by hand, and tanh-sinh quadrature, written anew for the tests",
    held_to="the digits that the report shows",
    count=26,
)
@pytest.mark.parametrize(("kept", "name"), [*(("disc_1", name) for name in PAPER), *(("mean", n) for n in MEAN_KEPT)])
def test_a_claim_has_the_verdict_and_the_numbers_of_the_formulas(
    rows: dict[str, dict[str, wl.CheckedClaim]], kept: str, name: str, count: int
) -> None:
    assert list(rows["disc_1"]) == list(PAPER)
    assert len(PAPER) == count
    says, numbers = (PAPER if kept == "disc_1" else MEAN_KEPT)[name]
    row = rows[kept][name]
    assert row.verdict == says
    ours = row.ours.replace("−", "-").replace(" × 10⁻⁴", "e-4")
    shown = re.findall(r"(?<![\w(.])[+-]?\d+(?:\.\d+)?(?:e-\d)?(?![\w(])", ours)
    for text, expected in zip(shown, numbers(), strict=True):
        value, slack = expected if isinstance(expected, tuple) else (expected, 0.0)
        mantissa, _, power = text.partition("e")
        digit = 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))
        assert float(text) == pytest.approx(value, abs=0.5001 * digit + slack, rel=0.0), row.ours


def test_the_speed_that_the_rig_keeps_changes_three_verdicts(rows: dict[str, dict[str, wl.CheckedClaim]]) -> None:
    changed = [name for name in PAPER if rows["disc_1"][name].verdict != rows["mean"][name].verdict]
    assert changed == ["KTH on both theories", "KTH local like global", "thresholds beyond tests"]


def under(bench: Bench, load: float = LOAD, friction: float = FRICTION, **rig: Any) -> Bench:
    """Return a bench under another load [N/m], with another friction coefficient or rig."""
    changed = wl.TwinDisc.suros(**rig)
    return dataclasses.replace(
        bench, rig=changed, normal_force_per_width=wl.Q(load, "N/m"), friction_coefficient=friction
    )


def of_density(density: float) -> dict[str, Any]:
    """Return steel of another density [kg/m³], to which BRR and KTH are proportional, and USFD is not."""
    return {"material": wl.steel(density=wl.Q(density, "kg/m^3"))}


@pytest.mark.parametrize(
    ("claim", "changes", "expected"),
    [
        # The least k of KTH in severe wear, 8.15e-4 at 7850 kg/m³, is beyond its range below 6400 kg/m³.
        (claims.all_in_mild_wear, of_density(5300.0), "does not hold"),
        (claims.all_in_mild_wear, of_density(5500.0), "holds in part"),
        (claims.all_in_mild_wear, of_density(8090.0), "holds"),
        (claims.all_in_mild_wear, of_density(8110.0), "holds in part"),
        (claims.above_in_severe_wear, of_density(6300.0), "does not hold"),
        # BRR at 700 N is 0.943 and 2.357 times USFD.
        (claims.brr_comes_closer, of_density(6000.0), "does not hold"),
        (claims.brr_comes_closer, of_density(15000.0), "does not hold"),
        (claims.kth_linear, {"rolling_speed": "20 m/s"}, "does not hold"),  # 0.2 m/s is 1 %
        # USFD is level from 65 √2 = 92 N on, BRR from 100 N on; full slip begins at 119 N.
        (claims.brr_like_usfd, {"load": 2.0 * LOAD}, "does not hold"),
        # 0.2 m/s is 19.6 % if 1.02 m/s are the mean, and 21.7 % if they are of disc 1.
        (claims.lower_slip_speed, {"rolling_speed": "1.02 m/s", "speed_of": "disc_1"}, "holds"),
        (claims.lower_slip_speed, {"rolling_speed": "1.02 m/s", "speed_of": "mean"}, "does not hold"),
        (claims.lower_slip_speed, {"rolling_speed": "1.3 m/s"}, "does not hold"),
        (claims.upper_slip_speed, {"rolling_speed": "4 m/s"}, "does not hold"),
        (claims.pressure_threshold, {"diameter": "60 mm"}, "does not hold"),
        # FASTSIM slips by ξ + 1.5 ξ_sat at the trailing edge: 0.15 m/s at 20 % with 0.7 m/s.
        (claims.kth_on_both_theories, {"rolling_speed": "0.7 m/s"}, "holds"),
        (claims.kth_local_like_global, {"rolling_speed": "0.7 m/s"}, "holds"),
        (claims.thresholds_beyond_tests, {"rolling_speed": "0.7 m/s"}, "holds"),
        (claims.thresholds_beyond_tests, {"rolling_speed": "1.3 m/s"}, "does not hold"),
    ],
)
def test_a_verdict_turns_where_the_formulas_say(
    bench: Bench, claim: Callable[[Bench], wl.CheckedClaim], changes: dict[str, Any], expected: Verdict
) -> None:
    assert claim(under(bench, **changes)).verdict == expected


def test_tests_on_the_model_do_not_part_from_it(bench: Bench) -> None:
    scatter = np.array([1.03, 1.03, 1.03, 0.95, 0.97, 1.0, 1.03, 1.05])
    tests = TESTS[0], 0.46 * bench.force("exact", TESTS[0]) * scatter
    assert claims.force_at_low_creepage(bench, tests).verdict == "does not hold"
    on_model = TESTS[0], 0.46 * bench.force("exact", TESTS[0])
    assert claims.tests_over_creepage(bench, on_model).verdict == "does not hold"
    more = TESTS[0], 1.05 * TESTS[1]
    assert claims.friction(bench, more).verdict == "does not hold"


# The bench


def study_of(**rig: Any) -> Any:
    """Return as much of a study as the sections need."""
    return SimpleNamespace(case=SimpleNamespace(rig=wl.TwinDisc.suros(**rig)))


WHEEL: Any = SimpleNamespace(case=SimpleNamespace(rig=wl.rig("wheel_rail", **wl.WheelRail.example_fields)))


def test_the_bench_has_the_rig_of_the_study_and_the_borders_of_the_formulas(bench: Bench) -> None:
    assert Bench.of(study_of()) == bench
    assert Bench.of(study_of(speed_of="mean")).rig.speed_of == "mean"
    for other in (study_of(rolling_speed="2 m/s"), study_of(diameter="60 mm"), WHEEL):
        with pytest.raises(wl.InputError, match=r"^rig: "):
            Bench.of(other)
    # The reference multiplies in another order: a few units in the last place.
    assert bench.patch_area == pytest.approx(AREA, rel=1e-14)
    assert bench.full_slip == pytest.approx(FULL_SLIP, rel=1e-14)
    assert bench.usfd_borders == pytest.approx((BEGIN, END), rel=1e-14)
    assert bench.window == pytest.approx(350.0, rel=1e-4)  # 6.2934 mm² in five digits
    assert (bench.creepage[0], bench.creepage[-1]) == (1e-3, 25.0)
    assert np.diff(bench.creepage).max() <= STEP * (1.0 + 1e-9)
    for kink in (0.2, 1.0, FULL_SLIP, 100.0 * BEGIN / FORCE, KINK):
        assert np.abs(bench.creepage / kink - 1.0).min() < 1e-14


def test_the_section_of_a_study_has_a_row_for_each_claim() -> None:
    section = claims.section(study_of())
    assert len({claim.theirs for claim in section.claims}) == len(PAPER)
    assert all(re.match(r"Sections? [356]", claim.where) and claim.why.endswith(".") for claim in section.claims)
    assert "741.43 kN/m and a friction coefficient of 0.46" in section.text
