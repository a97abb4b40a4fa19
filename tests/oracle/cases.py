"""The predictions of the oracle: every rig with every contact model and law that fit, in their options and ranges."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import product
from typing import Any

import xarray as xr

import wearlaw as wl
from wearlaw import Q
from wearlaw.errors import CompositionError

BRONZE = wl.Material(youngs_modulus="110 GPa", poisson_ratio=0.33, density="8800 kg/m^3")
HOLLOW = wl.Profile.s1002().worn(Q([-20, 0, 20], "mm"), Q([0, 0.5, 0], "mm"))
WHEEL_RAIL, WHEELSET = dict(wl.WheelRail.example_fields), dict(wl.Wheelset.example_fields)

RIGS: dict[str, wl.Rig] = {
    "twin_disc": wl.TwinDisc.suros(),
    "wheel_rail": wl.rig("wheel_rail", **WHEEL_RAIL),
    "wheelset": wl.rig("wheelset", **WHEELSET),
    "wheelset of ellipses": wl.rig("wheelset", **WHEELSET, patch="ellipse"),
}
OTHER_RIGS: dict[str, wl.Rig] = {
    "twin_disc, mean speed": wl.TwinDisc.suros(speed_of="mean", track_width="8 mm"),
    "twin_disc, bronze on flat": wl.TwinDisc.suros(disc_1=wl.Disc(diameter="40 mm", material=BRONZE), disc_2=wl.Disc(
        diameter="inf mm", material=wl.steel()), rotational_speed="50 rad/s"),
    "wheel_rail, hollow": wl.rig("wheel_rail", **WHEEL_RAIL, wheel_profile_radius="-400 mm"),
    "wheel_rail, at an angle": wl.rig("wheel_rail", **WHEEL_RAIL, contact_angle="40 deg"),
    "wheel_rail, on bronze": wl.rig("wheel_rail", **WHEEL_RAIL, rail_material=BRONZE),
    "wheelset, worn": wl.rig("wheelset", **WHEELSET | {"wheel": HOLLOW}),
    "wheelset, on bronze": wl.rig("wheelset", **WHEELSET | {"rail_material": BRONZE, "rail_cant": "1:20"}),
}  # fmt: skip

POINTS: dict[str, dict[str, Any]] = {
    "twin_disc": {
        "max_pressure": Q([400, 1500, 1500, 1200, 2900], "MPa"),
        "creepage": Q([0.02, 0.5, 5, -1.2, 22], "%"),
        "friction_coefficient": [0.3, 0.46, 0.46, 0.4, 0.5],
    },
    "wheel_rail": {
        "normal_force": Q([40, 80, 80, 120, 200], "kN"),
        "longitudinal_creepage": Q([0.01, 0.2, -0.1, 0, 5], "%"),
        "lateral_creepage": Q([0, 0.1, 0.2, 0.05, -1], "%"),
        "spin": Q([0, 0.2, -0.4, 0.8, 0.1], "1/m"),
        "friction_coefficient": [0.3, 0.3, 0.25, 0.3, 0.5],
    },
    "wheelset": {
        "lateral_displacement": Q([0, 3, 5], "mm"),
        "yaw": Q([0, 1, 3], "mrad"),
        "vertical_load": Q([60, 80, 60], "kN"),
        "friction_coefficient": 0.3,
    },
}
POINT: dict[str, dict[str, Any]] = {
    "twin_disc": {"normal_force": "7 kN", "creepage": "1 %", "friction_coefficient": 0.4},
    "wheel_rail": dict(wl.WheelRail.example),
    "wheelset": {"lateral_displacement": "-4 mm", "vertical_load": "50 kN", "friction_coefficient": 0.35},
}
"""Operating points of the rigs and their variants, within and beyond the ranges of laws."""

CONTACTS: dict[str, wl.ContactModel] = {
    name: wl.contact_model(name)
    for name in ("exact", "fastsim", "global", "linear", "polach", "shen_hedrick_elkins", "strip_theory")
}
FITS: dict[str, tuple[str, ...]] = {
    "twin_disc": ("exact", "fastsim", "global"),
    "wheel_rail": ("fastsim", "polach", "linear", "shen_hedrick_elkins", "strip_theory"),
    "wheelset": ("fastsim", "strip_theory"),
    "wheelset of ellipses": ("fastsim", "polach", "linear", "shen_hedrick_elkins", "strip_theory"),
}
OTHER_CONTACTS: dict[str, wl.ContactModel] = {
    "exact, as printed": wl.contact_model("exact", slip="as_printed"),
    "fastsim, elliptic": wl.contact_model("fastsim", bound="elliptic"),
    "fastsim, flexibility of Kalker": wl.contact_model("fastsim", bound="elliptic", flexibility="kalker"),
    "fastsim, adaptive march": wl.contact_model("fastsim", slip="scaled"),
    "fastsim, as CONTACT": wl.contact_model("fastsim", interpolation="contact"),
    "global, total from fastsim": wl.contact_model("global", total_from="fastsim"),
    "linear, as CONTACT": wl.contact_model("linear", interpolation="contact"),
    "polach, wet": wl.contact_model("polach", adhesion_reduction=0.3, slip_reduction=0.1),
}
WLRM = {"threshold": "20 N", "peak": "65 N", "balance": "175 N", "peak_damage": 1e-5, "beyond": "zero"}
ENERGY = {"mass_per_energy": "5 ug/J", "severe_mass_per_energy": "15 ug/J"}
LAWS: dict[str, list[wl.Law]] = {
    "usfd": [wl.wear_law("usfd", fitted_for=model) for model in ("global", "exact", "fastsim")],
    "kth": [
        *(wl.wear_law("kth", coefficient=coefficient) for coefficient in ("mid", "low", "high")),
        wl.wear_law("kth", hardness="3 GPa", coefficient={
            "high_pressure": 0.02, "low_speed": 2e-4, "mid_speed": 3e-3, "high_speed": 4e-4}),
    ],
    "brr": [wl.wear_law("brr")],
    "archard": [wl.wear_law("archard", coefficient=1e-4, hardness="3 GPa")],
    "energy": [
        wl.wear_law("energy", **ENERGY, power_limit="4 W/mm^2"),
        wl.wear_law("energy", **ENERGY, energy_limit="10 N/mm^2"),
        wl.wear_law("energy", mass_per_energy="5 ug/J"),
    ],
    "wlrm": [
        wl.law("wlrm", **WLRM),
        wl.law("wlrm", **WLRM | {"beyond": "falls", "traction": "driving"}),
        wl.law("wlrm", **WLRM | {"traction": "braking"}),
    ],
}  # fmt: skip
TOGETHER: list[tuple[wl.Law, ...]] = [
    (wl.wear_law("usfd", body="wheel"), wl.wear_law("kth", body="rail"), LAWS["wlrm"][0]),
    (LAWS["archard"][0].model_copy(update={"body": "wheel"}), LAWS["energy"][0].model_copy(update={"body": "rail"})),
    (LAWS["brr"][0],),
]
"""Laws in pipelines of several."""

STAGES: dict[str, list[wl.Stage]] = {
    "patch_mean": [wl.patch_mean()],
    "third_body": [wl.stage("third_body", reduction=0.7)],
    "third_body, falling": [wl.stage("third_body", reduction=0.54, limit_reduction=0.0108, reduction_decay=0.62)],
    "thermal": [wl.stage("thermal", hot_ratio=0.4, temperature_range="500 K")],
    "third_body and thermal": [
        wl.stage("third_body", reduction=0.6),
        wl.stage("thermal", hot_ratio=0.3, temperature_range="300 K", onset="20 K"),
    ],
    "thermal and patch_mean": [wl.stage("thermal", hot_ratio=0.4, temperature_range="500 K"), wl.patch_mean()],
}

STAGED = (("twin_disc", "exact"), ("wheel_rail", "fastsim"), ("wheel_rail", "polach"), ("wheelset", "fastsim"))
"""Rigs and contact models that the stages are put around."""

SPECIAL: dict[str, tuple[str, str, dict[str, Any]]] = {
    "twin_disc, normal force": ("twin_disc", "exact", {"normal_force": Q([1, 9], "kN")}),
    "twin_disc, force per width": ("twin_disc", "exact", {"normal_force_per_width": Q([0.2, 1.5], "kN/mm")}),
    "twin_disc, grid": ("twin_disc", "fastsim", {"max_pressure": "1.1 GPa", "creepage": Q([[0.003], [-0.03]], ""),
        "friction_coefficient": [0.2, 0.5]}),
    "twin_disc, measured traction": ("twin_disc", "global", {"traction_coefficient": [0.1, 0.3]}),
    "twin_disc, no creepage": ("twin_disc", "exact", {"creepage": "0 %"}),
    "twin_disc, falling friction": ("twin_disc", "exact", {"creepage": Q([0.5, 5], "%"), "friction_coefficient":
        wl.FallingFriction(static_coefficient=0.5, limit_ratio=0.4, decay="8 s/m")}),
    "wheel_rail, pressure": ("wheel_rail", "fastsim", {"max_pressure": Q([700, 1800], "MPa")}),
    "wheel_rail, braking": ("wheel_rail", "fastsim", {"longitudinal_creepage": "-5 %", "lateral_creepage": "0 %"}),
    "wheel_rail, spin alone": ("wheel_rail", "fastsim", {"longitudinal_creepage": "0 %", "lateral_creepage": "0 %"}),
    "wheel_rail, at angles": ("wheel_rail", "polach", {"contact_angle": Q([-20, 0, 65], "deg"), "spin": None}),
    "wheel_rail, falling friction": ("wheel_rail", "fastsim", {"friction_coefficient":
        wl.FallingFriction(static_coefficient=0.36, limit_ratio=0.38, decay="0.7 s/m")}),
    "wheelset, driven": ("wheelset", "fastsim", {"axle_torque": Q([2, -3], "kN*m")}),
    "wheelset, speed of rotation": ("wheelset", "fastsim", {"angular_speed": "43.6 rad/s"}),
    "wheelset, left curve": ("wheelset", "fastsim", {"curve_radius": "-500 m", "yaw": "-4 mrad"}),
    "wheelset, moving": ("wheelset", "fastsim", {"lateral_velocity": "0.05 m/s", "yaw_velocity": "0.02 rad/s"}),
    "wheelset, rolled": ("wheelset", "fastsim", {"lateral_displacement": "1 mm", "roll": "0.02 mrad"}),
    "wheelset, oiled flange": ("wheelset", "fastsim", {"lateral_displacement": "6.4 mm",
        "flange_friction_coefficient": 0.1}),
    "wheelset, climbing": ("wheelset", "fastsim", {"lateral_displacement": "7 mm"}),
}  # fmt: skip
"""Conditions of a kind of their own, on a rig with a contact model; None leaves a condition of the usual point out."""

LOADS = ("normal_force", "normal_force_per_width", "max_pressure")

OF_CONTACT = (
    "longitudinal_force", "lateral_force", "spin_moment", "traction_coefficient",
    "cell_wear_index", "wear_index_density", "normal_force", "normal_force_per_width",
    "creepage", "lateral_creepage", "spin", "contact_angle", "friction_coefficient", "half_width", "semi_axis_a",
    "semi_axis_b", "max_pressure", "first_yield", "shakedown_limit", "patch_area", "stick_ratio", "mean_slip",
)  # fmt: skip
OF_LAWS = ("tangential_force", "wear_index", "outside_range", "mass_per_distance")
PER_BODY = ("depth_per_distance", "profile_area_rate", "mass_per_cycle")


def seen(prediction: wl.Prediction, contact: bool) -> dict[str, Any]:
    """Return what the oracle records of a prediction: its contact if asked for, its outcomes and where they lie."""
    names = [f"{law.outcome.name}_{law.body}" if law.body else law.outcome.name for law in prediction.laws]
    values = {name: prediction[name] for name in names} | _properties(prediction, OF_LAWS)
    if contact:
        values |= _properties(prediction, OF_CONTACT)
        if prediction.problem.geometry == "line":
            values["averaged_wear_index"] = (prediction.contact | wl.law("averaged_wear_index")).value
    if any(name.startswith("wear_rate") for name in names):
        for body in prediction.problem.bodies:
            for name in PER_BODY:
                with suppress(CompositionError, wl.InputError):  # of a body that does not turn, or has no wear law
                    values[f"{name} of {body}"] = getattr(prediction, name)(body)
            with suppress(CompositionError):  # of a line, or of means over the patch
                values[f"profile of {body} "] = thinned(_middle(prediction).wear_profile(body))
    with suppress(CompositionError):  # of an ellipse or strips
        values["along "] = thinned(_middle(prediction).profile)
    return values


def thinned(dataset: xr.Dataset) -> xr.Dataset:
    """Return a few rows of a dataset, spread over each of its long axes."""
    return dataset.isel({axis: slice(n // 8, None, n // 4) for axis, n in dataset.sizes.items() if n > 8})


def _properties(prediction: wl.Prediction, names: tuple[str, ...]) -> dict[str, Any]:
    values = {}
    for name in names:
        with suppress(CompositionError):  # of another shape of patch, or without a law
            values[name] = getattr(prediction, name)
    return values


def _middle(prediction: wl.Prediction) -> wl.Prediction:
    """Return one of the operating points, of several neither the first nor the last."""
    shape = prediction.problem.batch_shape[: len(prediction.problem.batch_shape) - len(prediction.problem.dims)]
    return prediction[tuple(size // 2 for size in shape)] if shape else prediction


def predictions() -> Iterator[tuple[str, Callable[[], Any]]]:
    """Yield the predictions by name."""
    for rig, contact in product(RIGS, CONTACTS):
        if contact in FITS[rig]:
            yield from _main(rig, contact)
    for rig, contact in product(("twin_disc", "wheel_rail", "wheelset"), OTHER_CONTACTS):
        if contact.partition(",")[0] in FITS[rig]:
            pipeline = RIGS[rig] | OTHER_CONTACTS[contact]
            yield f"{rig} | {contact} | usfd", partial(_predicted, pipeline, LAWS["usfd"][:1], _few(rig))
    for rig, contact in STAGED:
        for name, stages in STAGES.items():
            parts: list[Any] = [*stages, LAWS["usfd"][0]]
            label = f"{rig} | {contact} | {name} | usfd"
            yield label, partial(_predicted, RIGS[rig] | CONTACTS[contact], parts, _few(rig))
    for name, variant in OTHER_RIGS.items():
        kind = name.partition(",")[0]
        for contact in FITS[kind][:2]:
            pipeline = variant | CONTACTS[contact]
            yield f"{name} | {contact} | kth", partial(_predicted, pipeline, LAWS["kth"][:1], POINTS[kind])
    for name, (rig, contact, given) in SPECIAL.items():
        usual = {key: value for key, value in POINT[rig].items() if key not in LOADS or not {*LOADS} & {*given}}
        conditions = {key: value for key, value in (usual | given).items() if value is not None}
        pipeline = RIGS[rig] | CONTACTS[contact]
        yield f"{name} | {contact} | usfd", partial(_predicted, pipeline, LAWS["usfd"][:1], conditions)


def _few(rig: str) -> dict[str, Any]:
    """Return the points of variants: one of a wheelset, which takes long to balance."""
    return (POINT if rig == "wheelset" else POINTS)[rig]


def _main(rig: str, contact: str) -> Iterator[tuple[str, Callable[[], Any]]]:
    """Yield the contact, then the laws; on a wheelset several on one contact, which takes long to balance."""
    pipeline, name, kind = RIGS[rig] | CONTACTS[contact], f"{rig} | {contact}", rig.partition(" ")[0]
    yield name, partial(_predicted, pipeline, (), POINTS[kind])
    yield f"{name}, one point", partial(_predicted, pipeline, (), POINT[kind])
    if kind == "wheelset":
        for laws in TOGETHER:
            label = f"{name} | {' | '.join(law.name for law in laws)}"
            yield label, partial(_predicted, pipeline, laws, POINTS[kind], contact=False)
        return
    for law, options in LAWS.items():
        for number, option in enumerate(options if contact in ("exact", "fastsim") else options[:1], start=1):
            label = f"{name} | {law}" + (f" {number}" if number > 1 else "")
            yield label, partial(_predicted, pipeline, (option,), POINTS[kind], contact=False)
        yield f"{name} | {law}, one point", partial(_predicted, pipeline, options[:1], POINT[kind], contact=False)


def _predicted(
    predict: Any, parts: Sequence[wl.Stage | wl.Law], conditions: dict[str, Any], *, contact: bool = True
) -> dict[str, Any]:
    for part in parts:
        predict = predict | part
    return seen(predict(**conditions), contact)
