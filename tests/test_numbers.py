"""The published and recomputed numbers of the creepage table of Tassini et al., Wear 268 (2010) 660-667.

The printed numbers are those of the paper's equations, evaluated once with converged integrals; each is also met
by an integral that the test computes on its own (tests/reference.py).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import pytest
from scipy import integrate

import wearlaw as wl
from tests import reference
from tests.plugins.tassini2010.paper import (
    AREA,
    CONDITIONS,
    FRICTION,
    GLOBAL,
    RADIUS,
    point,
    printed,
    usfd_of,
)
from wearlaw import Q

RIG = wl.TwinDisc.suros()

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

pytestmark = [
    pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning"),  # the global set on cells is the paper's subject
    pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning"),  # 25 % creepage lies above the tests' range
]


def usfd(contact_model: str, percent: float, **options: str) -> wl.Prediction:
    pipeline = RIG | wl.contact_model(contact_model, **options) | wl.wear_law("usfd")
    return pipeline(creepage=Q(percent, "%"), **CONDITIONS)


@pytest.mark.validates(
    "paper",
    "The creepage table: T, Tγ/A and the USFD rate of `exact`, `fastsim` and `global` at nine creepages, 1500 MPa",
    source="the paper's equations evaluated apart with converged integrals",
    held_to="all digits of the table in the test",
)
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


@pytest.mark.validates(
    "paper",
    "The creepage table, with all options of both local models",
    source="tanh-sinh quadrature of the paper's equations, written anew for the tests",
    held_to="{force:g} (T), {rate:g} (wear rate), relative",
    force=1e-14,
    rate=1e-12,
)
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
    contact_model: str,
    options: dict[str, str],
    solve: Callable[[reference.Point], reference.Solution],
    percent: float,
    force: float,
    rate: float,
) -> None:
    solution, got = solve(point(percent)), usfd(contact_model, percent, **options)
    # Both integrals end at rounding: 1e-13 is what the reference is asked for, and 1e-12 leaves room for a
    # zone of 0.05 half widths at 0.1 %, in which positions are exact to 20 roundings.
    assert got.tangential_force.m == pytest.approx(solution.force * 0.01, rel=force)
    assert got.wear_rate.m == pytest.approx(reference.usfd_mean(solution, *GLOBAL), rel=rate)


@pytest.mark.parametrize("percent", [row[0] for row in TABLE])
def test_the_global_column_is_the_law_of_the_mean_wear_index(percent: float) -> None:
    w = reference.exact(point(percent)).force * 10e-3 * percent / 100.0 / AREA
    assert usfd("global", percent).wear_index_density.m == pytest.approx(w, rel=1e-14)
    assert usfd("global", percent).wear_rate.m == pytest.approx(usfd_of(w), rel=1e-13)


@pytest.mark.validates(
    "paper",
    "The quadrature behind the creepage table",
    source="QUADPACK in another variable",
    held_to="{within:g}, relative",
    within=1e-13,
)
def test_the_reference_meets_a_second_integral_in_another_variable(within: float) -> None:
    # QUADPACK over the angle from the leading edge, of the literal eq. (8) in full slip at 15 %.
    a, p0, k = point(15).half_width, point(15).max_pressure, FRICTION / RADIUS

    def rate(angle: float) -> float:
        x = -a * math.cos(angle)
        return usfd_of(FRICTION * p0 * math.sin(angle) * (0.15 + k * x) / 1e6) * 0.5 * math.sin(angle)

    solution = reference.exact(point(15))
    breaks = [math.acos(v - 1.0) for w in (55.0 / 5.3, 77.26) for v in solution.density_crossings(w * 1e6)]
    edges = [0.0, *sorted(breaks), math.pi]
    total = sum(integrate.quad(rate, low, high, epsrel=1e-13)[0] for low, high in itertools.pairwise(edges))
    assert reference.usfd_mean(solution, *GLOBAL) == pytest.approx(total, rel=within)


@pytest.mark.validates(
    "paper",
    "E* = {modulus} GPa, a = {half_width} mm, A = {area} mm², μN = {limit} N, full slip from {exact} %"
    " (`exact`) and {fastsim} % (`fastsim`)",
    source="Johnson 1985, section 4.2, and Carter 1926, by hand; Tassini et al. 2010, section 5.2",
    held_to="all digits shown",
    modulus="112.0212",
    half_width="0.31467",
    area="6.293",
    exact="1.2319",
    fastsim="1.8479",
    limit="3410.6",
)
def test_lengths_areas_and_saturation_creepages_are_the_printed_ones(
    modulus: str, half_width: str, area: str, exact: str, fastsim: str, limit: str
) -> None:
    prediction = usfd("exact", 1.0)
    problem = prediction.problem
    assert float(problem.effective_modulus) / 1e9 == printed(modulus)
    assert prediction.half_width.to("mm").m == printed(half_width)
    assert prediction.patch_area.to("mm^2").m == printed(area)
    saturation = float(problem.friction_coefficient * problem.half_width / problem.relative_radius)
    assert 100.0 * saturation == printed(exact)
    assert 150.0 * saturation == printed(fastsim)
    assert FRICTION * prediction.normal_force.m_as("N") == printed(limit)
    # at the printed creepages the models pass into full slip
    for name, percent in (("exact", float(exact)), ("fastsim", float(fastsim))):
        below, above = (usfd(name, percent + shift).stick_ratio.m for shift in (-0.001, 0.001))
        assert below > 0.0
        assert above == 0.0


@pytest.mark.validates(
    "paper",
    "741.43 kN/m and 1500 MPa are one operating point",
    source="Tassini et al. 2010, section 5.2",
    held_to="{within:g}, relative",
    within=1e-05,
)
def test_the_load_and_the_maximum_pressure_of_the_paper_go_together(within: float) -> None:
    contact = RIG | wl.contact_model("exact")
    other: dict[str, Any] = {"creepage": Q(1, "%"), "friction_coefficient": FRICTION}
    assert contact(max_pressure=Q(1500, "MPa"), **other).normal_force_per_width.to("kN/m").m == printed("741.43")
    assert contact(normal_force_per_width="741.43 kN/m", **other).max_pressure.to("MPa").m == pytest.approx(
        1500.0, rel=within
    )
