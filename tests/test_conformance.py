"""The models that come with wearlaw pass the kit in their options, and so do the right ones of the kit's own tests."""

from __future__ import annotations

import itertools
import pickle
import tomllib
from importlib.metadata import distribution
from typing import Any

import pytest
import tomli_w

import wearlaw as wl
from tests.plugins.kit.brushes import Brush, BrushOnCells
from tests.plugins.kit.cells import Cells
from tests.plugins.kit.grids import Grid
from tests.plugins.kit.strips import Strips, StripsOnStrips
from tests.plugins.kit.wrong_contacts import Wrapped
from tests.plugins.kit.wrong_laws import HottestNode, Linear, Ramps, Severe, Smooth
from tests.plugins.kit.wrong_rigs import Delegating, Weight
from tests.test_shipped_models import FEW, SHIPPED
from wearlaw_kit import Check, checks
from wearlaw_models.laws.kth import PUBLISHED
from wearlaw_models.rigs.wheelset import Wheelset

OWN = {"high_pressure": 0.02, "low_speed": 2e-4, "mid_speed": 3e-3, "high_speed": 4e-4}
"""Coefficients of one's own for the KTH map, in an order that no published set has."""

CONTACT_MODELS: list[wl.ContactModel] = [
    *(wl.contact_model("exact", slip=slip) for slip in ("consistent", "as_printed")),
    *(
        wl.contact_model("fastsim", bound=bound, flexibility=flexibility)
        for bound, flexibility in itertools.product(("parabolic", "elliptic"), ("line", "kalker"))
    ),
    *(wl.contact_model("fastsim", bound=bound, slip="scaled") for bound in ("parabolic", "elliptic")),
    wl.contact_model("fastsim", interpolation="contact"),
    *(
        wl.contact_model("global", total_from=model)
        for model in (
            "exact",
            "fastsim",
            wl.contact_model("fastsim", bound="elliptic"),
            wl.contact_model("fastsim", bound="elliptic", flexibility="kalker"),
        )
    ),
    wl.contact_model("linear"),
    wl.contact_model("linear", interpolation="contact"),
    wl.contact_model("shen_hedrick_elkins"),
    wl.contact_model("strip_theory", strips=24),
    wl.contact_model("half_space", cells=6),
    *(
        wl.contact_model("polach", adhesion_reduction=adhesion, slip_reduction=slip)
        for adhesion, slip in ((1.0, 1.0), (1.0, 0.4), (0.3, 0.1))
    ),
]
WEAR_LAWS: list[wl.WearLaw] = [
    *(wl.wear_law("usfd", fitted_for=fitted_for) for fitted_for in ("global", "exact", "fastsim")),
    *(wl.wear_law("kth", coefficient=coefficient) for coefficient in ("low", "mid", "high", OWN)),
    *(wl.wear_law("brr", spin=spin) for spin in ("included", "left_out")),
    wl.wear_law("archard", coefficient=1e-4),
    wl.wear_law("archard", coefficient=1e-4, hardness="3 GPa"),
    wl.wear_law("energy", mass_per_energy="5 ug/J"),
    *(
        wl.wear_law("energy", mass_per_energy="5 ug/J", severe_mass_per_energy="15 ug/J", **limit)
        for limit in ({"power_limit": "4 W/mm^2"}, {"energy_limit": "10 N/mm^2"})
    ),
]
LAWS: list[wl.Law] = [
    wl.law("wlrm", threshold="20 N", peak="65 N", balance="175 N", peak_damage=1e-5, beyond=beyond, traction=traction)
    for beyond, traction in itertools.product(("falls", "zero"), ("either", "driving", "braking"))
] + [
    wl.law("wlrm", threshold="20 N", peak="65 N", balance="175 N", peak_damage=1e-5, beyond="falls", spin="left_out"),
    wl.law("averaged_wear_index"),
]

STAGES: list[wl.Stage] = [
    wl.patch_mean(),
    wl.stage("third_body", reduction=0.7),
    wl.stage("third_body", reduction=0.54, limit_reduction=0.0108, reduction_decay=0.62),
    wl.stage("thermal", hot_ratio=0.4, temperature_range="500 K"),
]

FLAT = wl.Disc(diameter="inf mm", material=wl.steel(youngs_modulus="70 GPa", poisson_ratio=0.33))
RIGS: dict[str, wl.Rig] = {
    "suros": wl.TwinDisc.suros(),
    "disc_on_flat": wl.TwinDisc.suros(disc_2=FLAT),
    "mean_speed": wl.TwinDisc.suros(speed_of="mean"),
    "conical_wheel": wl.rig("wheel_rail", **wl.WheelRail.example_fields),
    "hollow_wheel": wl.rig("wheel_rail", **wl.WheelRail.example_fields, wheel_profile_radius="-400 mm"),
    "profile_contact": wl.rig("profile_contact", **wl.ProfileContact.example_fields),
    "wheelset": wl.rig("wheelset", **Wheelset.example_fields),
    "wheelset_of_ellipses": wl.rig("wheelset", **Wheelset.example_fields, patch="ellipse"),
    "wheelset_on_rollers": wl.rig("wheelset", **Wheelset.example_fields, roller_radius="500 mm"),
}


def named(model: Any) -> str:
    options = (
        named(value) if isinstance(value, wl.ContactModel) else str(value)
        for _, value in model
        if isinstance(value, (str, float, wl.ContactModel))
    )
    own = ["own"] if getattr(model, "coefficient", "") not in ("", *PUBLISHED) else []
    name = type(model).__name__ if model in RIGHT else model.name  # of which some share one
    name = next((key for key, rig in RIGS.items() if rig is model), name)
    return "-".join([name, *options, *own])


RIGHT: list[Any] = [
    *(Cells(), Strips(), StripsOnStrips(), Grid(), Wrapped(), Brush(), BrushOnCells()),
    *(Linear(), Smooth(), Ramps(), Severe(), HottestNode(), Weight(), Delegating()),
]
MODELS = [*CONTACT_MODELS, *WEAR_LAWS, *LAWS, *STAGES, *RIGS.values(), *RIGHT]

USUAL = {name: cls(**cls.example_fields) for name, cls in SHIPPED.items()}

CASES = [
    pytest.param(check, id=f"{named(model)}-{check.name}")
    for model in MODELS
    for check in checks(model)
    if model != USUAL.get(getattr(model, "name", "")) or check.name not in FEW.get(model.name, {check.name})
]
"""Those that `test_shipped_models.py` does not run."""


@pytest.mark.validates(
    "invariants",
    (
        "Every rig, contact model, stage and law, in all its options, passes the conformance kit: signs, units, "
        "limits, energy, jumps, slopes, full slip, batches"
    ),
    source="what must hold of any model (see the page on the kit)",
    held_to="the bounds that each check states",
)
@pytest.mark.parametrize("check", CASES)
def test_the_model_conforms(check: Check) -> None:
    check()


@pytest.mark.parametrize("model", [*CONTACT_MODELS, *WEAR_LAWS, *LAWS, *STAGES, *RIGS.values()], ids=named)
def test_a_model_is_the_same_after_toml_json_and_pickle(model: Any) -> None:
    fields = model.model_dump(mode="json", exclude_none=True, by_alias=True)
    assert type(model).model_validate(tomllib.loads(tomli_w.dumps(fields))) == model
    assert type(model).model_validate_json(model.model_dump_json(by_alias=True)) == model
    assert pickle.loads(pickle.dumps(model)) == model


def test_every_model_that_comes_with_wearlaw_is_checked() -> None:
    own = {entry_point.value for entry_point in distribution("wearlaw").entry_points if entry_point.group == "wearlaw"}
    installed = {
        **wl.installed("contact model"),
        **wl.installed("stage"),
        **wl.installed("wear law"),
        **wl.installed("law"),
        **wl.installed("rig"),
    }
    assert {model.name for model in [*CONTACT_MODELS, *WEAR_LAWS, *LAWS, *STAGES, *RIGS.values()]} == {
        name for name, cls in installed.items() if cls.__module__ in own or cls.__module__.rpartition(".")[0] in own
    }
