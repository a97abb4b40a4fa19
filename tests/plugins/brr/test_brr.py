"""The BRR law, against Table 1 of Tassini et al. (2010)."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.ellipses import of_ratio
from tests.plugins.laws import around, contact_of
from tests.strategies import EPS

BRR = wl.wear_law("brr")


def rate(law: wl.WearLaw, wear_index: float, *, nodes: int = 1, density: float = 7850.0) -> float:
    """Return the rate [kg/m/m²] of Tγ [N] on a patch of 1 mm² a node."""
    contact = contact_of(pressure=np.ones(nodes), density=density)
    rates = law.checked_rate(dataclasses.replace(contact, wear_index=np.array(wear_index)))
    assert rates.shape == (nodes,)
    assert (rates == rates[0]).all()
    return float(rates[0])


def section(wear_index: float) -> float:
    """Return D times the section lost [mm²·mm/km], Table 1 of Tassini et al. 2010."""
    if wear_index < 100.0:
        return 0.25 * wear_index
    return 25.0 if wear_index < 200.0 else 1.19 * wear_index - 154.0


@pytest.mark.validates(
    "wear-laws",
    "BRR as a rate: area of the section times πD and the density",
    source="Tassini et al. 2010, Table 1; Pearce and Sherratt 1991",
    held_to="{roundings} ε, relative",
    roundings=32,
)
@given(st.floats(0.0, 2000.0))
def test_the_rate_is_the_section_of_table_1_around_the_wheel(roundings: int, wear_index: float) -> None:
    # area × πD is the volume per km rolled; mm³/km × kg/m³ is 1e-12 kg/m, on 1e-6 m²
    expected = 7850.0 * math.pi * section(wear_index) * 1e-12 / 1e-6
    assert rate(BRR, wear_index) == pytest.approx(expected, rel=roundings * EPS, abs=1e-300)


def test_the_plateau_may_have_no_width() -> None:
    law = wl.wear_law("brr", severe_limit="100 N", severe_offset="90 mm^3/km")
    below, at = (rate(law, float(w)) / (7850.0 * math.pi * 1e-6) for w in around(100.0))
    assert below == pytest.approx(25.0, rel=32 * EPS)
    assert at == pytest.approx(1.19 * 100.0 - 90.0, rel=64 * EPS)


@pytest.mark.parametrize(
    ("options", "jumps"),
    [
        ({}, [200.0]),
        ({"plateau": "30 mm^3/km"}, [100.0, 200.0]),
        ({"plateau": "84 mm^3/km", "mild_slope": "0.84 mm^3/km/N"}, []),
        ({"mild_limit": "80 N", "mild_slope": "0.3125 mm^3/km/N"}, [200.0]),
    ],
)
def test_the_declared_jumps_are_where_the_rate_jumps(options: dict[str, str], jumps: list[float]) -> None:
    law = wl.wear_law("brr", **options)
    found = []
    for border in (law.breakpoints(law.numbers) or {})["wear_index"]:
        below, at = (rate(law, float(w)) for w in around(border))
        if at - below > 1e-9 * at:
            found.append(border)
    assert found == pytest.approx(jumps, rel=2 * EPS)
    assert law.jumps(law.numbers)["wear_index"] == pytest.approx(tuple(jumps), rel=2 * EPS)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"mild_limit": 100}, r"brr: mild_limit: .*100"),
        ({"mild_limit": "100 m"}, r"mild_limit: got 100\.0 m.*'N'"),
        ({"plateau": "-25 mm^3/km"}, r"plateau: must be greater than zero"),
        ({"mild_limit": "300 N"}, r"severe_limit must not lie below mild_limit"),
        ({"severe_limit": "140 N"}, r"the wear must not fall where a regime begins"),
        ({"mild_slope": "0.3 mm^3/km/N"}, r"the wear must not fall where a regime begins"),
        ({"plato": "25 mm^3/km"}, r"unknown field; did you mean 'plateau'"),
    ],
)
def test_a_wrong_value_is_one_clear_error(options: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=message):
        wl.wear_law("brr", **options)


def test_the_published_law_names_its_materials_and_no_range() -> None:
    calibration = BRR.calibration
    assert calibration is not None
    assert calibration.materials == "R8T wheel steel on BS11 rail steel"
    assert calibration.stated_range == ()
    assert "prints no range" in calibration.source
    assert BRR.valid_range == {}
    assert BRR.monotone_in == ("wear_index",)
    assert wl.wear_law("brr", plateau="26 mm^3/km").calibration is None


@pytest.mark.parametrize("lateral_creepage", [1e-4, 0.0, -1e-4])
def test_without_spin_tgamma_is_that_of_the_creepages_in_kalkers_linear_theory(lateral_creepage: float) -> None:
    # Fx = G ab C11 ξ and Fy = G ab (C22 η + √(ab) C23 φ). The last case has Fy against η, and ξFx + ηFy below zero.
    xi, eta, phi = (2e-5 if lateral_creepage else 1e-4), lateral_creepage, 0.2
    problem = of_ratio(1.5, 0.28, longitudinal_creepage=xi, lateral_creepage=eta, spin=phi)
    found = wl.contact_model("linear").solve(problem)
    size, c = np.sqrt(problem.a * problem.b), wl.kalker.coefficients(problem.a / problem.b, problem.poisson_ratio)
    due = problem.shear_modulus * size**2 * (c.c11 * xi**2 + eta * (c.c22 * eta + size * c.c23 * phi))
    assert found.wear_index_without_spin == pytest.approx(due, rel=1e-12)
    assert (due < 0.0) == (lateral_creepage < 0.0)
    with_spin, without = (wl.wear_law("brr", spin=spin) for spin in ("included", "left_out"))
    means = found.patch_mean()
    assert without.checked_rate(means) * means.patch_area == pytest.approx(  # in mild wear, volume per km π × 0.25 Tγ
        7850.0 * math.pi * 0.25 * max(due, 0.0) * 1e-12, rel=1e-12
    )
    assert with_spin.checked_rate(means).item() > without.checked_rate(means).item()


@pytest.mark.parametrize("spin", ["included", "left_out"])
def test_the_declared_borders_are_those_of_tgamma_as_chosen(spin: str) -> None:
    law = wl.wear_law("brr", spin=spin)
    variable = "wear_index" if spin == "included" else "wear_index_without_spin"
    assert list(law.breakpoints(law.numbers) or {}) == list(law.jumps(law.numbers)) == [variable]
    law.check_variables()  # or a pipeline with the law would raise a ModelError
