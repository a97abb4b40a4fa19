"""Archard's law with a hardness of the material, against energies in contacts where all of the slip zone is at μp."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.laws import contact_of
from tests.strategies import EPS
from wearlaw import Q
from wearlaw_models.laws.archard import SteelWithHardness

SOFT, HARD = SteelWithHardness(hardness="2 GPa"), SteelWithHardness(hardness="4 GPa")
ON_DISCS: dict[str, Any] = {"max_pressure": Q(1200, "MPa"), "friction_coefficient": 0.4}
ON_RAIL: dict[str, Any] = {
    "normal_force": Q(20, "kN"),
    "longitudinal_creepage": Q([0.05, 0.3, 2.0], "%"),
    "friction_coefficient": 0.3,
}


def archard(coefficient: float = 1e-4, **fields: Any) -> Any:
    return wl.wear_law("archard", coefficient=coefficient, **fields)


def discs(**fields: Any) -> Any:
    return wl.TwinDisc.suros(**fields)


def rail(**fields: Any) -> Any:
    given_fields = {"wheel_radius": "460 mm", "rail_head_radius": "300 mm", "rolling_speed": "30 m/s", "material": SOFT}
    return wl.rig("wheel_rail", **{**given_fields, **fields})


@given(
    pressure=st.floats(0.0, 4e9),
    slip=st.floats(-1.0, 1.0),
    coefficient=st.floats(1e-8, 1.0),
    hardness=st.floats(1e8, 1e10),
    density=st.floats(1e3, 2e4),
)
@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # whatever k
def test_the_rate_is_the_volume_of_the_definition_times_the_density(
    pressure: float, slip: float, coefficient: float, hardness: float, density: float
) -> None:
    law = archard(coefficient, hardness=Q(hardness, "Pa"))
    # V = k N s/H with N = p dA and s = |slip| for each metre rolled, over dA
    volume = coefficient * pressure * abs(slip) / hardness
    rate = float(law.checked_rate(contact_of(pressure=pressure, slip=slip, density=density))[0])
    assert rate == pytest.approx(density * volume, rel=16 * EPS, abs=1e-290)


@pytest.mark.validates(
    "wear-laws",
    "`archard` on Carter's line contact, from partial to full slip: ρ k/(H μ) times Tγ/A in closed form",
    source="p = q/μ wherever the bodies slip, so ∫ p s dA = Tγ/μ; T after Carter 1926",
    held_to="{within:g}, relative",
    within=1e-12,  # some hundred roundings in the quadrature and in the conditions
)
@pytest.mark.parametrize("percent", [0.01, 0.1, 0.6, 1.0, 1.5, 10.0])
def test_on_a_line_it_is_the_energy_over_friction_and_hardness(percent: float, within: float) -> None:
    predict = discs(material=SOFT) | wl.contact_model("exact") | archard(3e-4)
    found = predict(creepage=Q(percent, "%"), **ON_DISCS)
    problem = found.contact.problem
    load, half_width, radius = (float(x) for x in (problem.normal_force, problem.half_width, problem.relative_radius))
    share = min(percent / 100.0 / (0.4 * half_width / radius), 1.0)
    index = 0.4 * load * (1.0 - (1.0 - share) ** 2) * percent / 100.0
    expected = 7850.0 * 3e-4 / (2e9 * 0.4) * index / (2.0 * half_width * 0.01)
    assert found.wear_rate.m_as("kg/m/m^2") == pytest.approx(expected, rel=within)


@pytest.mark.validates(
    "wear-laws",
    "`archard` on an ellipse with one creepage: ρ k/(H μ) times the energy of the cells over the area",
    source="p = q/μ wherever the bodies slip, under a traction bound like the pressure; slip and traction are parallel",
    held_to="{within:g}, relative",
    within=1e-12,  # both sides are sums over the same cells, of some thousand
)
def test_on_an_ellipse_it_is_the_energy_over_friction_and_hardness(within: float) -> None:
    predict = rail() | wl.contact_model("fastsim", bound="elliptic") | archard(3e-4)
    found = predict(**ON_RAIL)
    energy = found.cell_wear_index / found.patch_area
    expected = 7850.0 * 3e-4 / (2e9 * 0.3) * energy.m_as("N/m^2")
    assert (expected > 0).all()
    assert found.wear_rate.m_as("kg/m/m^2") == pytest.approx(expected, rel=within)


def test_each_body_wears_by_the_hardness_of_its_own_material() -> None:
    both = (
        rail(material=SOFT, rail_material=HARD)
        | wl.contact_model("fastsim", bound="elliptic")
        | archard(body="wheel")
        | archard(body="rail")
    )
    found = both(**ON_RAIL)
    assert found.wear_rate_of("wheel").m == pytest.approx(2.0 * found.wear_rate_of("rail").m, rel=8 * EPS)


def test_any_material_with_a_hardness_will_do_and_that_of_the_law_goes_before() -> None:
    class RailSteel(wl.Material):
        hardness: Annotated[wl.Quantity, wl.Unit("GPa")]

    own = RailSteel(**{**dict(wl.steel()), "hardness": "2 GPa"})

    def rate(material: wl.Material, law: Any) -> Any:
        return (discs(material=material) | wl.contact_model("exact") | law)(creepage=Q(1, "%"), **ON_DISCS).wear_rate.m

    assert rate(own, archard()) == rate(SOFT, archard())
    of_law = archard(hardness="3 GPa")
    assert rate(wl.steel(), of_law) == rate(SOFT, of_law) == rate(HARD, of_law)


def test_a_steel_with_a_hardness_is_the_steel_but_for_its_hardness() -> None:
    fields = dict(SOFT)
    assert fields.pop("hardness") == Q(2, "GPa")
    assert fields.pop("source") is None
    assert fields == dict(wl.steel())
    assert wl.material("SteelWithHardness", hardness="2 GPa") == SOFT
    assert SteelWithHardness(hardness="260 kgf/mm^2").hardness.to("GPa").m == pytest.approx(2.549729, rel=1e-9)


RAILS = {"R200": 200, "R220": 220, "R260": 260, "R260Mn": 260, "R320Cr": 320, "R350HT": 350, "R350LHT": 350}
"""Least Brinell numbers of EN 13674-1:2008."""


@pytest.mark.parametrize("name", RAILS)
def test_a_rail_steel_has_the_least_hardness_of_the_standard_and_the_yield_stress_that_tabor_estimates_from_it(
    name: str,
) -> None:
    grade: Any = wl.material(name)
    assert grade.hardness.m_as("MPa") == pytest.approx(9.80665 * RAILS[name], rel=1e-12)
    tension = np.sqrt(3.0) * grade.shear_yield_stress.m_as("MPa")  # von Mises
    assert 2.8 * tension == pytest.approx(grade.hardness.m_as("MPa"), rel=2e-4)
    assert f"EN 13674-1:2008, {RAILS[name]} to {RAILS[name] + 40} HBW" in grade.source
    assert grade.youngs_modulus == wl.steel().youngs_modulus
    assert grade.density == wl.steel().density


def test_a_changed_hardness_or_yield_stress_has_no_source_of_the_grade() -> None:
    for changed in ({"hardness": "3 GPa"}, {"shear_yield_stress": "300 MPa"}):
        assert getattr(wl.material("R260", **changed), "source") is None  # noqa: B009
    assert "EN 13674-1" in getattr(wl.material("R260", density="7800 kg/m^3"), "source")  # noqa: B009
    table = wl.material("R260").model_dump(mode="json")
    assert wl.material(table.pop("type"), **table) == wl.material("R260")


def test_a_material_without_a_hardness_is_an_error_that_says_what_to_do() -> None:
    at: Any = {"creepage": Q(1, "%"), **ON_DISCS}
    with pytest.raises(wl.InputError, match=r"hardness: .* material of disc_1, .* or give the law its field hardness"):
        (discs() | wl.contact_model("exact") | archard())(**at)
    unlike = discs(disc_1=wl.Disc(diameter="47 mm", material=SOFT)) | wl.contact_model("exact")
    unlike | archard(body="disc_1")
    with pytest.raises(wl.InputError, match="the material of disc_2, a Material, has none"):
        (unlike | archard(body="disc_2"))(**at)


def test_a_hardness_that_is_not_a_stress_is_an_error_that_names_the_material() -> None:
    class Numbered(wl.Material):
        hardness: float

    at: Any = {"creepage": Q(1, "%"), **ON_DISCS}
    numbered = Numbered(**{**dict(wl.steel()), "hardness": 260.0})
    with pytest.raises(wl.UnitError, match=r"hardness of the material of disc_1: got the bare number 260\.0, which"):
        (discs(material=numbered) | wl.contact_model("exact") | archard())(**at)


def test_a_contact_from_elsewhere_needs_the_hardness_of_the_law() -> None:
    contact = wl.Contact.from_arrays(
        pressure=Q([900.0], "MPa"), traction="300 MPa", slip="1 %", area="1 mm^2", rolling_speed="10 m/s"
    )
    with pytest.raises(wl.InputError, match=r"hardness: .* this contact was solved elsewhere, .*; give the law its"):
        contact | archard()
    found = (contact | archard(hardness="2 GPa")).value
    assert found.m_as("kg/m/m^2") == pytest.approx(7850.0 * 1e-4 * 9e8 * 0.01 / 2e9, rel=16 * EPS)


def test_it_is_smooth_and_needs_no_estimate() -> None:
    law = archard(hardness="2 GPa")
    assert law.breakpoints(law.numbers) == {}
    assert law.jumps(law.numbers) == {}
    assert law.numbers == {"coefficient": 1e-4, "hardness": 2e9}
    rates = law.checked_rate(contact_of(pressure=np.array([0.0, 1e9, 2e9])))
    assert rates[0] == 0.0
    assert rates[2] == 2.0 * rates[1]


@pytest.mark.parametrize(
    ("law", "fields", "field"),
    [
        ("archard", {"coefficient": 0.0}, "coefficient"),
        ("archard", {"coefficient": "1e-4"}, "coefficient"),
        ("archard", {"coefficient": 1e-4, "hardness": 2.6}, "hardness"),
        ("archard", {"coefficient": 1e-4, "hardness": "-2 GPa"}, "hardness"),
        ("SteelWithHardness", {"hardness": "2 GPa", "poisson_ratio": -0.1}, "poisson_ratio"),
        ("SteelWithHardness", {"hardness": "2 GPa", "poisson_ratio": 0.51}, "poisson_ratio"),
        ("SteelWithHardness", {"hardness": "2 GPa", "poisson_ratio": "0.28"}, "poisson_ratio"),
        ("SteelWithHardness", {}, "hardness"),
    ],
)
def test_a_wrong_value_is_an_error_that_names_the_field(law: str, fields: dict[str, Any], field: str) -> None:
    make = wl.wear_law if law == "archard" else wl.material
    with pytest.raises(wl.ConfigurationError, match=f"{law}: {field}: "):
        make(law, **fields)
