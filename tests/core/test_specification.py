"""Fields that hold a model: a name, a table or an instance."""

from __future__ import annotations

from typing import Any

import pytest

import wearlaw as wl
from wearlaw.fields import specification  # private: the table of a model in a file


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


@pytest.mark.parametrize(
    "model",
    [
        wl.contact_model("exact", slip="as_printed"),
        wl.contact_model("fastsim", bound="elliptic", flexibility="kalker"),
        wl.contact_model("global", total_from=wl.contact_model("fastsim", bound="elliptic")),
        wl.wear_law("usfd", fitted_for="exact", m_m="6 ug/m/N"),
        wl.wear_law(
            "kth", coefficient={"high_pressure": 0.1, "low_speed": 1e-3, "mid_speed": 2e-3, "high_speed": 3e-3}
        ),
        wl.wear_law("brr", plateau="26 mm^3/km"),
    ],
    ids=repr,
)
def test_a_model_can_be_made_again_from_its_specification(model: wl.ContactModel | wl.WearLaw) -> None:
    table = specification(model)
    assert table.pop("model") == model.name
    look_up = wl.contact_model if isinstance(model, wl.ContactModel) else wl.wear_law
    assert look_up(model.name, **table) == model


def test_serialising_keeps_the_name_and_the_options() -> None:
    dumped = held({"model": "fastsim", "bound": "elliptic"}).model_dump(mode="json")
    given = {"model": "fastsim", "bound": "elliptic", "flexibility": "line"}
    assert dumped["contact_model"].items() >= given.items()
    assert held(**dumped) == held({"model": "fastsim", "bound": "elliptic"})


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("exakt", "contact_model: no contact model is called 'exakt'; did you mean 'exact'?"),
        ("usfd", "contact_model: no contact model is called 'usfd'"),
        ({"bound": "elliptic"}, 'contact_model: a model needs its name, as in {model = "exact"}'),
        ({"model": 3}, 'contact_model: a model needs its name, as in {model = "exact"}'),
        ({"model": "fastsim", "bond": 1}, "contact_model.bond: unknown field; did you mean 'bound'?"),
        ({"model": "global", "total_from": {"model": "fastsim", "bond": 1}}, "contact_model.total_from.bond: unknown"),
        (3, "contact_model: input should be"),
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
