"""The published and recomputed numbers of the creepage table of Tassini et al., Wear 268 (2010) 660-667.

The printed numbers are those of the paper's equations, evaluated once with converged integrals; each is also met
by an integral that the test computes on its own (tests/reference.py).
"""

from __future__ import annotations

from typing import Any

import pytest

import wearlaw as wl
from tests.plugins.tassini2010.paper import CONDITIONS, FRICTION, printed
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
