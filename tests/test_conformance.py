"""The models that come with wearlaw pass the kit in all combinations of their options."""

from __future__ import annotations

import itertools
from importlib.metadata import distribution

import pytest

import wearlaw as wl
from wearlaw.models import Model
from wearlaw.testing import Check, checks

CONTACT_MODELS: list[wl.ContactModel] = [
    *(wl.contact_model("exact", slip=slip) for slip in ("consistent", "as_printed")),
    *(
        wl.contact_model("fastsim", bound=bound, flexibility=flexibility)
        for bound, flexibility in itertools.product(("parabolic", "elliptic"), ("line", "kalker"))
    ),
    *(
        wl.contact_model("global", total_from=model)
        for model in ("exact", wl.contact_model("fastsim", bound="elliptic", flexibility="kalker"))
    ),
]
WEAR_LAWS: list[wl.WearLaw] = [
    *(wl.wear_law("usfd", fitted_for=fitted_for) for fitted_for in ("global", "exact", "fastsim")),
    *(wl.wear_law("kth", coefficient=coefficient) for coefficient in ("low", "mid", "high")),
    wl.wear_law("brr"),
]


def named(model: Model) -> str:
    options = [str(getattr(value, "name", value)) for _, value in model if isinstance(value, (str, wl.ContactModel))]
    return "-".join([model.name, *options])


CASES = [
    pytest.param(check, id=f"{named(model)}-{check.name}")
    for model in [*CONTACT_MODELS, *WEAR_LAWS]
    for check in checks(model)
]


@pytest.mark.parametrize("check", CASES)
def test_the_model_conforms(check: Check) -> None:
    check()


def test_every_model_that_comes_with_wearlaw_is_checked() -> None:
    own = {entry_point.value for entry_point in distribution("wearlaw").entry_points if entry_point.group == "wearlaw"}
    installed = {**wl.contact_models(), **wl.wear_laws()}
    assert {model.name for model in [*CONTACT_MODELS, *WEAR_LAWS]} == {
        name for name, cls in installed.items() if cls.__module__ in own
    }
