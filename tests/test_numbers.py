"""The published and recomputed numbers of the twin-disc study of Tassini et al., Wear 268 (2010) 660-667.

The printed numbers are those of the paper's equations, evaluated once with converged integrals; each is also met
by an integral that the test computes on its own (tests/reference.py).
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import integrate, optimize

import wearlaw as wl
from tests import reference
from wearlaw import Q

RADIUS = 0.047 / 4.0
"""R of two discs of 47 mm [m]."""
MODULUS = 206.47742e9 / (2.0 * (1.0 - 0.28**2))
"""E* of two bodies of the rig's steel [Pa]."""
LOAD = 741.43e3
FRICTION = 0.46
AREA = 2.0 * math.sqrt(4.0 * LOAD * RADIUS / (math.pi * MODULUS)) * 10.0 * 1e3
"""Patch area on a track of 10 mm [mm²]."""

RIG = wl.TwinDisc.suros()
CONDITIONS: dict[str, Any] = {"normal_force": Q(7.4143, "kN"), "friction_coefficient": FRICTION}

# ξ [%], T/μP exact and FASTSIM, Tγ/A [N/mm²], USFD global, cells exact, cells FASTSIM [µg/m/mm²]
TABLE = [
    (0.1, "0.1558", "0.1537", "0.084", "0.45", "0.45", "0.44"),
    (0.5, "0.6470", "0.6119", "1.753", "9.29", "9.29", "8.79"),
    (1.0, "0.9646", "0.9034", "5.227", "27.70", "27.70", "24.68"),
    (2.0, "1", "1", "10.838", "55.00", "46.04", "41.08"),
    (5.0, "1", "1", "27.096", "55.00", "54.00", "50.88"),
    (10.0, "1", "1", "54.192", "55.00", "54.78", "98.85"),
    (15.0, "1", "1", "81.289", "304.4", "801.9", "1176.6"),
    (20.0, "1", "1", "108.385", "1981.6", "2247.1", "2608.1"),
    (25.0, "1", "1", "135.481", "3658.9", "3825.0", "4148.6"),
]
MORE_DIGITS = [
    (1.0, "27.70413", "24.67838"),
    (10.0, "54.78239", "98.85414"),
    (20.0, "2247.0774", "2608.1243"),
]

pytestmark = [
    pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning"),  # the global set on cells is the paper's subject
    pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning"),  # 25 % creepage lies above the tests' range
]


def point(percent: float) -> reference.Point:
    return reference.Point(LOAD, RADIUS, MODULUS, FRICTION, percent / 100.0)


def printed(text: str) -> Any:
    """Return what a number that was rounded to its printed digits may have been."""
    decimals = len(text.partition(".")[2])
    return pytest.approx(float(text), abs=0.5 * 10.0**-decimals if decimals else 1e-14)


def usfd(contact_model: str, percent: float, **options: str) -> wl.Prediction:
    pipeline = RIG | wl.contact_model(contact_model, **options) | wl.wear_law("usfd")
    return pipeline(creepage=Q(percent, "%"), **CONDITIONS)


def usfd_rate(w: float) -> float:
    """Return the USFD rate [µg/m/mm²] of w = Tγ/A [N/mm²], Table 3."""
    if w < 55.0 / 5.3:
        return 5.3 * w
    return 55.0 if w < 77.26 else 61.9 * w - (61.9 * 77.26 - 55.0)


@pytest.mark.parametrize("row", TABLE, ids=lambda row: f"{row[0]}%")
def test_every_printed_number_of_the_creepage_table_is_met(row: tuple[Any, ...]) -> None:
    percent, traction_exact, traction_fastsim, density, on_means, on_exact, on_fastsim = row
    full = FRICTION * 7414.3
    exact, fastsim, means = (usfd(name, percent) for name in ("exact", "fastsim", "global"))
    assert exact.tangential_force.m / full == printed(traction_exact)
    assert fastsim.tangential_force.m / full == printed(traction_fastsim)
    assert exact.wear_index_density.m == printed(density)
    assert means.wear_index_density.m == printed(density)
    assert means.wear_rate.m == printed(on_means)
    assert exact.wear_rate.m == printed(on_exact)
    assert fastsim.wear_rate.m == printed(on_fastsim)


@pytest.mark.parametrize("row", MORE_DIGITS, ids=lambda row: f"{row[0]}%")
def test_the_rows_with_more_digits_are_met(row: tuple[Any, ...]) -> None:
    percent, on_exact, on_fastsim = row
    assert usfd("exact", percent).wear_rate.m == printed(on_exact)
    assert usfd("fastsim", percent).wear_rate.m == printed(on_fastsim)


@pytest.mark.parametrize("percent", [row[0] for row in TABLE])
@pytest.mark.parametrize(
    ("contact_model", "options", "solve"),
    [
        ("exact", {}, reference.exact),
        ("exact", {"slip": "as_printed"}, lambda p: reference.exact(p, as_printed=True)),
        ("fastsim", {}, reference.parabolic),
        ("fastsim", {"flexibility": "kalker"}, lambda p: reference.parabolic(p, kalker=True)),
        ("fastsim", {"bound": "elliptic"}, reference.elliptic),
    ],
)
def test_the_creepage_table_meets_an_integral_of_its_own(
    contact_model: str, options: dict[str, str], solve: Callable[[reference.Point], reference.Solution], percent: float
) -> None:
    solution, got = solve(point(percent)), usfd(contact_model, percent, **options)
    # Both integrals end at rounding: 1e-13 is what the reference is asked for, and 1e-12 leaves room for a
    # zone of 0.05 half widths at 0.1 %, in which positions are exact to 20 roundings.
    assert got.tangential_force.m == pytest.approx(solution.force * 0.01, rel=1e-14)
    assert got.wear_rate.m == pytest.approx(reference.usfd_mean(solution, 5.3, 55.0, 61.9, 77.26), rel=1e-12)


@pytest.mark.parametrize("percent", [row[0] for row in TABLE])
def test_the_global_column_is_the_law_of_the_mean_wear_index(percent: float) -> None:
    w = reference.exact(point(percent)).force * 10e-3 * percent / 100.0 / AREA
    assert usfd("global", percent).wear_index_density.m == pytest.approx(w, rel=1e-14)
    assert usfd("global", percent).wear_rate.m == pytest.approx(usfd_rate(w), rel=1e-13)


def test_the_reference_meets_a_second_integral_in_another_variable() -> None:
    # QUADPACK over the angle from the leading edge, of the literal eq. (8) in full slip at 15 %.
    a, p0, k = point(15).half_width, point(15).max_pressure, FRICTION / RADIUS

    def rate(angle: float) -> float:
        x = -a * math.cos(angle)
        return usfd_rate(FRICTION * p0 * math.sin(angle) * (0.15 + k * x) / 1e6) * 0.5 * math.sin(angle)

    solution = reference.exact(point(15))
    breaks = [math.acos(v - 1.0) for w in (55.0 / 5.3, 77.26) for v in solution.density_crossings(w * 1e6)]
    edges = [0.0, *sorted(breaks), math.pi]
    total = sum(integrate.quad(rate, low, high, epsrel=1e-13)[0] for low, high in itertools.pairwise(edges))
    assert reference.usfd_mean(solution, 5.3, 55.0, 61.9, 77.26) == pytest.approx(total, rel=1e-13)


def test_lengths_areas_and_saturation_creepages_are_the_printed_ones() -> None:
    prediction = usfd("exact", 1.0)
    problem = prediction.problem
    assert float(problem.effective_modulus) / 1e9 == printed("112.0212")
    assert prediction.half_width.to("mm").m == printed("0.31467")
    assert prediction.patch_area.to("mm^2").m == printed("6.293")
    saturation = float(problem.friction_coefficient * problem.half_width / problem.relative_radius)
    assert 100.0 * saturation == printed("1.2319")
    assert 150.0 * saturation == printed("1.8479")
    assert FRICTION * prediction.normal_force.m == printed("3410.6")
    # at the printed creepages the models pass into full slip
    for name, percent in (("exact", 1.2319), ("fastsim", 1.8479)):
        below, above = (usfd(name, percent + shift).stick_ratio.m for shift in (-0.001, 0.001))
        assert below > 0.0
        assert above == 0.0


def test_the_load_and_the_maximum_pressure_of_the_paper_go_together() -> None:
    contact = RIG | wl.contact_model("exact")
    other: dict[str, Any] = {"creepage": Q(1, "%"), "friction_coefficient": FRICTION}
    assert contact(max_pressure=Q(1500, "MPa"), **other).normal_force_per_width.to("kN/m").m == printed("741.43")
    assert contact(normal_force_per_width="741.43 kN/m", **other).max_pressure.to("MPa").m == pytest.approx(
        1500.0, rel=1e-5
    )


# --- BRR -------------------------------------------------------------------------------------------------------


def brr(wear_index: float) -> wl.Prediction:
    """Return the BRR prediction for Tγ [N] at 1 % creepage, through a measured traction coefficient."""
    pipeline = RIG | wl.contact_model("global") | wl.wear_law("brr")
    return pipeline(creepage=Q(1, "%"), traction_coefficient=wear_index / 74.143, **CONDITIONS)


# Tγ [N], µg/m/mm² on 6.2935 mm²
BRR_RATES = [(50.0, "48.98"), (150.0, "97.96"), (199.9, "97.96"), (200.0, "329.16"), (700.0, "2660.7")]


@pytest.mark.parametrize(("wear_index", "expected"), BRR_RATES)
def test_brr_gives_its_rates_on_the_patch_of_the_paper(wear_index: float, expected: str) -> None:
    contact = brr(100.0).contact
    area = np.array([6.2935e-6])
    given = dataclasses.replace(contact, wear_index=np.array(wear_index), area=area)
    assert float(wl.wear_law("brr").rate(given)[0]) * 1e3 == printed(expected)


@pytest.mark.parametrize(
    ("wear_index", "section"),
    [(50.0, 0.25 * 50.0), (99.9, 0.25 * 99.9), (150.0, 25.0), (199.9, 25.0), (700.0, 1.19 * 700.0 - 154.0)],
)
def test_brr_predicts_the_section_loss_of_table_1(wear_index: float, section: float) -> None:
    assert brr(wear_index).wear_index.m == pytest.approx(wear_index, rel=1e-14)
    assert brr(wear_index).profile_area_rate("disc_1").m_as("mm^2/km") == pytest.approx(section / 47.0, rel=1e-13)


@pytest.mark.parametrize(
    ("wear_index", "mass"), [(50.0, 6.165 * 50.0), (150.0, 616.5), (700.0, 29.35 * 700.0 - 3798.0)]
)
def test_brr_loses_the_mass_that_the_section_loss_means(wear_index: float, mass: float) -> None:
    # ρ π times Table 1, in µg per metre rolled; the coefficients are rounded to four digits.
    lost = brr(wear_index).mass_lost(over="1 m", body="disc_1")
    assert lost.m_as("ug") == pytest.approx(mass, rel=3e-4)


def test_brr_is_a_law_of_the_disc_diameter_in_section_but_not_in_mass() -> None:
    small, large = (
        wl.TwinDisc.suros(diameter=diameter, rolling_speed="1 m/s") | wl.contact_model("global") | wl.wear_law("brr")
        for diameter in ("47 mm", "94 mm")
    )
    conditions: dict[str, Any] = {"creepage": Q(1, "%"), "traction_coefficient": 0.5, **CONDITIONS}
    one, two = small(**conditions), large(**conditions)
    assert one.mass_lost("1 km", "disc_1").m == pytest.approx(two.mass_lost("1 km", "disc_1").m, rel=1e-14)
    assert one.profile_area_rate("disc_1").m == pytest.approx(2.0 * two.profile_area_rate("disc_1").m, rel=1e-14)


def test_brr_meets_usfd_at_797_newtons() -> None:
    def difference(wear_index: float) -> float:
        law_rates: list[float] = []
        for name in ("brr", "usfd"):
            pipeline = RIG | wl.contact_model("global") | wl.wear_law(name)
            # 20 % creepage, so that Tγ/A moves through the catastrophic regime with T
            coefficient = wear_index / (7414.3 * 0.2)
            got = pipeline(creepage=Q(20, "%"), traction_coefficient=coefficient, **CONDITIONS)
            law_rates.append(got.wear_rate.m)
        return law_rates[0] - law_rates[1]

    # (29.35 Tγ - 3798)/A = 55 + 61.9 (Tγ/A - 77.26), with 29.35 and 3798 in full
    density = 7.85
    slope, offset = density * math.pi * 1.19, density * math.pi * 154.0
    by_hand = ((61.9 * 77.26 - 55.0) * AREA - offset) / (61.9 - slope)
    root = optimize.brentq(difference, 500.0, 1000.0, xtol=1e-9)
    assert root == pytest.approx(797.0, abs=0.5)
    assert root == pytest.approx(by_hand, rel=1e-9)
    assert difference(796.0) > 0.0 > difference(798.0)
    assert all(difference(wear_index) > 0.0 for wear_index in np.linspace(201.0, 796.0, 20))


# --- KTH -------------------------------------------------------------------------------------------------------

K = {  # Table 2, in the order high pressure, low, middle and high slip speed
    "low": (300e-4, 1e-4, 30e-4, 1e-4),
    "mid": (350e-4, 5.5e-4, 35e-4, 5.5e-4),
    "high": (400e-4, 10e-4, 40e-4, 10e-4),
}


@pytest.mark.parametrize(("coefficient", "expected"), [("low", "3.523"), ("mid", "19.377"), ("high", "35.231")])
def test_kth_gives_its_rates_at_one_percent(coefficient: str, expected: str) -> None:
    pipeline = RIG | wl.contact_model("global") | wl.wear_law("kth", coefficient=coefficient)
    got = pipeline(creepage=Q(1, "%"), **CONDITIONS).wear_rate.m
    mean_pressure = 7414.3 / (AREA * 1e-6)
    assert got == printed(expected)
    assert got == pytest.approx(7850.0 * K[coefficient][1] * mean_pressure * 0.01 / 2.625e9 * 1e3, rel=1e-14)


@pytest.mark.parametrize("coefficient", ["low", "mid", "high"])
@pytest.mark.parametrize(
    ("pressure", "slip_speed", "field"),
    [
        (1e9, 0.1, 1),
        (1e9, np.nextafter(0.2, 0.0), 1),
        (1e9, 0.2, 2),
        (1e9, np.nextafter(0.7, 0.0), 2),
        (1e9, 0.7, 3),
        (1e9, 5.0, 3),
        (np.nextafter(2.1e9, 0.0), 0.1, 1),
        (np.nextafter(2.1e9, 0.0), 0.3, 2),
        (np.nextafter(2.1e9, 0.0), 0.8, 3),
        (2.1e9, 0.1, 0),
        (2.1e9, 0.3, 0),
        (2.1e9, 0.8, 0),
        (3.0e9, 0.3, 0),
    ],
)
def test_kth_takes_the_right_field_on_both_sides_of_every_border(
    coefficient: str, pressure: float, slip_speed: float, field: int
) -> None:
    contact = dataclasses.replace(
        brr(100.0).contact,
        pressure=np.array([pressure]),
        slip=np.array([slip_speed]),
        rolling_speed=np.array(1.0),
    )
    rate = float(wl.wear_law("kth", coefficient=coefficient).rate(contact)[0])
    expected = 7850.0 * K[coefficient][field] * pressure * slip_speed / 2.625e9
    assert rate == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("percent", [row[0] for row in TABLE])
@pytest.mark.parametrize(("contact_model", "solve"), [("exact", reference.exact), ("fastsim", reference.parabolic)])
def test_kth_on_cells_meets_an_integral_of_its_own(
    contact_model: str, solve: Callable[[reference.Point], reference.Solution], percent: float
) -> None:
    pipeline = RIG | wl.contact_model(contact_model) | wl.wear_law("kth")
    got = pipeline(creepage=Q(percent, "%"), **CONDITIONS).wear_rate.m
    speed = 400.0 * 2.0 * math.pi / 60.0 * 0.0235
    solution = solve(dataclasses.replace(point(percent), speed=speed))
    assert got == pytest.approx(reference.kth_mean(solution, K["mid"]), rel=1e-12)


# --- Thresholds of section 5.2 ---------------------------------------------------------------------------------


def test_severe_wear_by_slip_speed_begins_above_20_percent_creepage() -> None:
    def slip_speed(percent: float) -> float:
        contact = (RIG | wl.contact_model("global"))(creepage=Q(percent, "%"), **CONDITIONS).contact
        return float(contact.slip_speed[0])

    border = optimize.brentq(lambda percent: slip_speed(percent) - 0.2, 10.0, 30.0)
    assert border == printed("20.3")
    kth = RIG | wl.contact_model("global") | wl.wear_law("kth")
    below, above = (kth(creepage=Q(border + d, "%"), **CONDITIONS).wear_rate.m for d in (-1e-6, 1e-6))
    assert above / below == pytest.approx(35.0 / 5.5, rel=1e-6)


def test_seizure_begins_at_a_mean_pressure_of_2356_kilonewtons_per_metre() -> None:
    def jumps_at(load: float, model: str) -> bool:
        """Whether KTH's rate is that of the high-pressure field anywhere just above a load, and not just below."""
        pipeline = RIG | wl.contact_model(model) | wl.wear_law("kth")
        below, above = (
            pipeline(
                normal_force_per_width=Q(load + d, "kN/m"), creepage=Q(1, "%"), friction_coefficient=FRICTION
            ).wear_rate.m
            for d in (-0.5, 0.5)
        )
        return bool(above > 1.01 * below)

    mean = math.pi * (4.0 / math.pi * 2.1e9) ** 2 * RADIUS / MODULUS / 1e3
    assert mean == pytest.approx(2356.0, abs=0.5)
    assert jumps_at(mean, "global")
    maximum = math.pi * 2.1e9**2 * RADIUS / MODULUS / 1e3
    assert maximum == pytest.approx(1453.0, abs=0.5)
    assert not jumps_at(maximum, "global")


# --- Section 5.1.1: the laws against each other ----------------------------------------------------------------


def test_the_three_laws_stand_to_each_other_as_section_5_1_1_says() -> None:
    def rates(wear_index: float, law: str, **options: str) -> float:
        # full slip: T = μN, so that Tγ sets the creepage
        creepage = wear_index / (FRICTION * 7414.3)
        pipeline = RIG | wl.contact_model("global", total_from="exact") | wl.wear_law(law, **options)
        got: float = pipeline(creepage=Q(creepage, ""), **CONDITIONS).wear_rate.m
        return got

    severe = np.linspace(55.0 / 5.3 * AREA + 0.1, 350.0, 30)
    assert all(rates(w, "brr") > rates(w, "usfd") for w in severe)
    assert all(rates(w, "kth", coefficient="high") > rates(w, "usfd") for w in severe)
    crossing = optimize.brentq(lambda w: rates(w, "kth", coefficient="mid") - rates(w, "usfd"), 70.0, 200.0)
    assert crossing == pytest.approx(97.0, abs=0.5)
    # mild: "close" is within a factor of 1.6 of USFD for BRR (6.165 against 5.3 per N) and KTH's mid range
    for w in (45.0, 50.0, 60.0):
        assert rates(w, "brr") == pytest.approx(6.165 / 5.3 * rates(w, "usfd"), rel=3e-4)
        assert rates(w, "kth", coefficient="low") < rates(w, "usfd")
