"""Fields that hold a model: a name, a table or an instance."""

from __future__ import annotations

from typing import Any

import pytest

import wearlaw as wl


class Holder(wl.Configuration):
    contact_model: wl.ContactModelField
    wear_law: wl.WearLawField


def held(contact_model: Any = "exact", wear_law: Any = "usfd") -> Holder:
    return Holder(contact_model=contact_model, wear_law=wear_law)


def test_a_name_a_table_and_an_instance_make_the_same_model() -> None:
    instance = wl.contact_model("fastsim", bound="elliptic")
    assert held({"model": "fastsim", "bound": "elliptic"}).contact_model == instance
    assert held(instance).contact_model is instance
    assert held("fastsim").contact_model == wl.contact_model("fastsim")


def test_serialising_keeps_the_name_and_the_options() -> None:
    dumped = held({"model": "fastsim", "bound": "elliptic"}).model_dump(mode="json")
    given = {"model": "fastsim", "bound": "elliptic", "flexibility": "line"}
    assert dumped["contact_model"].items() >= given.items()
    assert held(**dumped) == held({"model": "fastsim", "bound": "elliptic"})


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("exakt", "contact_model: no contact model is called 'exakt'; did you mean 'exact'?"),
        ({"bound": "elliptic"}, 'contact_model: a model needs its name, as in {model = "exact"}'),
        ({"model": "fastsim", "bond": 1}, "contact_model.bond: unknown field; did you mean 'bound'?"),
        ({"model": "global", "total_from": {"model": "fastsim", "bond": 1}}, "contact_model.total_from.bond: unknown"),
        (wl.wear_law("usfd"), "contact_model: input should be"),
    ],
)
def test_a_wrong_model_is_named_with_its_path(value: Any, message: str) -> None:
    with pytest.raises(wl.ConfigurationError) as caught:
        held(value)
    assert message in str(caught.value)


def test_a_wrong_option_of_a_law_is_named_with_its_path() -> None:
    with pytest.raises(wl.ConfigurationError, match=r"Holder: wear_law\.m_m: got the bare number 5\.3"):
        held(wear_law={"model": "usfd", "m_m": 5.3})
