"""The nomenclature: as the code has it, complete, with units that hold, and without one name for two things."""

from __future__ import annotations

import contextlib
import dataclasses
from collections import defaultdict
from collections.abc import Iterable

import pytest

import wearlaw as wl
from docs import nomenclature
from docs.nomenclature import Documented
from wearlaw.errors import CompositionError

SYMBOLS_OF_SEVERAL_NAMES = {
    "k": "KTH's map has a wear coefficient in each of its four fields",
    "a": "half the width of a line and the semi-axis of an ellipse in the rolling direction",
    "ξ": "the only creepage of discs, the longitudinal one of wheel and rail",
    "Q": "the vertical load of a wheel as a condition, and the one that its rail bears",
    "ρ": "the mass density, and the roll of a wheelset",
    "A": "the area of the patch, and the limit of falling friction in its source",
}
NAMES_OF_SEVERAL_SYMBOLS = {
    "wear_index_density": "q·s at a point, and Tγ/A as its mean over the patch",
    "lateral_force": "that of a patch along its surface, and the condition of a wheelset",
}
OF_OTHER_KINDS = {"geometry", "problem", "strips", "bodies", "dims", "exists", "unloaded", "conditions"}
"""Fields of records that are no numbers with a unit."""


IN_NO_CLASS = {"wear_rate_low", "wear_rate_high", "wear_rate_uncertainty", "frictional_heat", "rcf_damage",
               "averaged_wear_index"}  # fmt: skip
"""Columns of results and of files with tests, which the page explains below its table."""


@pytest.fixture(scope="module")
def documented() -> list[Documented]:
    return list(nomenclature.documented())


def names(documented: list[Documented], where: str) -> set[str]:
    return {one.name for one in documented if one.where == where}


def one_of(text: str) -> wl.Quantity:
    return wl.Q(1.0, "" if text == "-" else text)


def quantities(result: object, cls: type) -> dict[tuple[str, str], wl.Quantity]:
    """Return the properties of a class that are quantities, by its name and theirs, without those of another patch."""
    found = {}
    for name in nomenclature.own(cls):
        with contextlib.suppress(CompositionError):
            if not name.startswith("_") and isinstance(getattr(result, name), wl.Quantity):
                found[cls.__name__, name] = getattr(result, name)
    return found


def several(pairs: Iterable[tuple[str, str]]) -> set[str]:
    """Return the keys that come with more than one value."""
    found = defaultdict(set)
    for key, value in pairs:
        found[key].add(value)
    return {key for key, values in found.items() if len(values) > 1}


def test_the_table_of_the_documentation_is_that_of_the_code() -> None:
    committed = nomenclature.TABLE.read_text(encoding="utf-8")
    assert committed == nomenclature.table(), "renew it with: python docs/nomenclature.py"


def test_all_fields_of_the_records_and_all_conditions_are_in_the_table(documented: list[Documented]) -> None:
    for record in (wl.Problem, wl.Contact, wl.CreepForces):
        numbers = {field.name for field in dataclasses.fields(record)} - OF_OTHER_KINDS
        assert numbers <= names(documented, record.__name__)
    assert names(documented, "conditions") == {
        name for rig in wl.installed("rig").values() for name in rig.conditions()
    }


def test_all_quantities_of_results_are_in_the_table_with_a_unit_of_their_dimension(
    documented: list[Documented],
) -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
    r = predict(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46)
    roll = nomenclature.wheel_rail() | wl.contact_model("fastsim") | wl.wear_law("kth")
    on_rail = roll(normal_force="80 kN", longitudinal_creepage="1 %", friction_coefficient=0.3)
    values = {
        **quantities(r, wl.Prediction),
        **quantities(on_rail, wl.Prediction),
        ("Prediction", "wear_rate_of"): r.wear_rate_of("disc_1"),
        ("Prediction", "depth_per_distance"): r.depth_per_distance("disc_1"),
        ("Prediction", "profile_area_rate"): r.profile_area_rate("disc_1"),
        ("Prediction", "mass_lost"): r.mass_lost("1 km", "disc_1"),
        ("Prediction", "mass_per_cycle"): r.mass_per_cycle("disc_1"),
    }
    results = ("Prediction",)
    units = {(one.where, one.name): one.unit for one in documented if one.where in results}
    of_known_unit = {place: value for place, value in values.items() if place[1] not in nomenclature.OF_ANY_UNIT}
    assert units.keys() == of_known_unit.keys()
    for place, value in of_known_unit.items():
        assert one_of(units[place]).is_compatible_with(value), place


def test_all_numbers_of_rigs_and_models_have_a_unit_of_their_dimension(documented: list[Documented]) -> None:
    units = {(one.where, one.name): one.unit for one in documented}
    found = [*nomenclature.of_configurations()]
    assert {("Disc", "diameter"), ("kth", "mid_speed"), ("thermal", "hot_ratio")} <= {(w, name) for w, _, name in found}
    for where, holder, name in found:
        value = getattr(holder, name)
        due = value if isinstance(value, wl.Quantity) else wl.Q(1.0, "")
        assert name in nomenclature.OF_ANY_UNIT or one_of(units[where, name]).is_compatible_with(due), (where, name)
        inside = {each for each, one in holder if isinstance(one, wl.Quantity)}
        assert inside <= {each for _, other, each in found if other is holder}


def test_the_table_of_variables_has_the_documented_dimensions_and_symbols(documented: list[Documented]) -> None:
    units = {one.name: one.unit for one in documented}
    symbols = {(one.name, one.symbol) for one in documented if one.symbol}
    variables = nomenclature.variables()
    assert variables.keys() - units.keys() == IN_NO_CLASS
    for name, variable in variables.items():
        if name in units:
            assert one_of(variable.unit).is_compatible_with(one_of(units[name])), name
        if variable.symbol and any(name == known for known, _ in symbols):
            assert (name, variable.symbol) in symbols


def test_a_name_has_one_unit_and_one_symbol_and_a_symbol_one_name(documented: list[Documented]) -> None:
    assert several((one.name, one.unit) for one in documented) == set()
    assert several((one.name, one.symbol) for one in documented) == set(NAMES_OF_SEVERAL_SYMBOLS)
    assert several((one.symbol, one.name) for one in documented if one.symbol) == set(SYMBOLS_OF_SEVERAL_NAMES)
