"""`wear_coefficient`: each form against its definition, for a worn pin with all quantities known."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given

import wearlaw as wl
from tests.strategies import EPS, log_uniform
from wearlaw import Q
from wearlaw_models.laws.archard import FORMS

FULL: dict[str, Any] = {"hardness": "2.625 GPa", "density": "7850 kg/m^3", "friction_coefficient": 0.45}


def published(volume: float, force: float, distance: float, hardness: float, density: float, friction: float) -> Any:
    """Return what papers in each form would print of one test, from the definitions of the forms, in SI."""
    energy, mass = friction * force * distance, density * volume
    return {
        "k": volume * hardness / (force * distance),
        "k_of_3h": 3.0 * volume * hardness / (force * distance),
        "volume_per_load": Q(volume / (force * distance), "m^2/N"),
        "mass_per_load": Q(mass / (force * distance), "kg/N/m"),
        "volume_per_energy": Q(volume / energy, "m^3/J"),
        "mass_per_energy": Q(mass / energy, "kg/J"),
    }


def in_si(value: Any) -> float:
    return float(value.to_base_units().magnitude if isinstance(value, wl.Quantity) else value)


@pytest.mark.validates(
    "wear-laws",
    "`wear_coefficient` between all pairs of its six forms",
    source="the definitions, for tests of which volume, load, distance, hardness, density and friction are known",
    held_to="{roundings} ε, relative",
    roundings=32,  # either side multiplies at most six numbers, and converts their units
)
@given(
    volume=log_uniform(1e-12, 1e-6),
    force=log_uniform(1.0, 1e5),
    distance=log_uniform(1.0, 1e6),
    hardness=log_uniform(1e8, 1e10),
    density=log_uniform(1e3, 2e4),
    friction=log_uniform(0.01, 1.5),
)
def test_all_forms_convert_into_all_forms(
    volume: float, force: float, distance: float, hardness: float, density: float, friction: float, roundings: int
) -> None:
    of_test = published(volume, force, distance, hardness, density, friction)
    assert of_test.keys() == FORMS.keys()
    given_values: Any = {
        "hardness": Q(hardness, "Pa"),
        "density": Q(density, "kg/m^3"),
        "friction_coefficient": friction,
    }
    for form, to in itertools.product(of_test, repeat=2):
        found: Any = wl.wear_coefficient(of_test[form], form, to=to, **given_values)
        assert in_si(found) == pytest.approx(in_si(of_test[to]), rel=roundings * EPS), (form, to)


@pytest.mark.parametrize(
    ("form", "to", "needed"),
    [
        ("k", "k_of_3h", set()),
        ("volume_per_energy", "mass_per_energy", {"density"}),
        ("mass_per_load", "mass_per_energy", {"friction_coefficient"}),
        ("k_of_3h", "volume_per_load", {"hardness"}),
        ("mass_per_energy", "k", {"hardness", "density", "friction_coefficient"}),
    ],
)
def test_only_what_the_conversion_needs_must_be_given(form: Any, to: Any, needed: set[str]) -> None:
    value: Any = published(1e-9, 100.0, 1e3, 2e9, 7850.0, 0.5)[form]
    found = wl.wear_coefficient(value, form, to=to, **{name: FULL[name] for name in needed})
    assert found == wl.wear_coefficient(value, form, to=to, **FULL)
    for name in needed:
        less: Any = {other: FULL[other] for other in needed - {name}}
        with pytest.raises(wl.InputError, match=f"^{to}, .*{name}="):
            wl.wear_coefficient(value, form, to=to, **less)


def test_the_mild_steel_of_an_encyclopedia() -> None:
    # Wikipedia, "Wear coefficient": K = 7e-3 of V = K P L/(3H), with 120 HB. A kgf is 9.80665 N.
    found = wl.wear_coefficient(7e-3, "k_of_3h", to="volume_per_load", hardness="120 kgf/mm^2")
    assert found.m_as("mm^3/N/m") == pytest.approx(7e-3 / (3.0 * 120.0 * 9.80665) * 1e3, rel=16 * EPS)
    assert found.units == Q(1.0, "mm^3/N/m").units


@pytest.mark.validates(
    "wear-laws",
    "The lowest k of KTH in mass per energy, at the μ of a test: the mass that KTH predicts over the energy",
    source="a prediction in full slip, where s is the creepage and T = μN",
    held_to="{within:g}, relative",
    within=1e-13,  # the mean over the patch is a quadrature, exact to a few dozen roundings
)
def test_a_coefficient_of_kth_per_energy_is_its_mass_over_the_energy(within: float) -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth", coefficient="low")
    found = predict(max_pressure="1200 MPa", creepage="5 %", friction_coefficient=0.45)
    per_energy = wl.wear_coefficient(1e-4, "k", to="mass_per_energy", **FULL)
    assert (found.mass_per_distance / found.wear_index / per_energy).m_as("") == pytest.approx(1.0, rel=within)


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"form": "k/H"}, "form"),
        ({"to": "volume_per_loads"}, "to"),
        ({"form": "volume_per_load"}, "volume_per_load"),  # whose value has a unit
        ({"value": "5 ug/m/N", "form": "volume_per_load"}, "volume_per_load"),
        ({"value": -1e-4}, "value"),
        ({"value": "0 m^2/N", "form": "volume_per_load"}, "value"),
        ({"value": np.array([1e-4, 2e-4])}, "value"),
        ({"hardness": 2.6}, "hardness"),
        ({"hardness": "260 kg"}, "hardness"),
        ({"density": "7850 g"}, "density"),
        ({"friction_coefficient": -0.3}, "friction_coefficient"),
        ({"hardness": Q([2.0, 3.0], "GPa")}, "hardness"),
    ],
)
def test_a_wrong_argument_is_an_error_that_names_it(wrong: dict[str, Any], field: str) -> None:
    arguments: Any = {"value": 1e-4, "form": "k", "to": "mass_per_energy", **FULL, **wrong}
    with pytest.raises(wl.InputError, match=rf"\b{field}\b"):
        wl.wear_coefficient(**arguments)
