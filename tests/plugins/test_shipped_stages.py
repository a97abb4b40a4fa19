"""The stages that ship with wearlaw, in pipelines."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.axles import EXISTS, GIVEN, Axle
from wearlaw import Q

SUROS = wl.TwinDisc.suros()
WHEEL = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
DISCS: Any = {
    "max_pressure": Q(1500, "MPa"),
    "creepage": Q([0.0, 0.1, 0.5, -1.0, 3.0, 20.0], "%"),
    "friction_coefficient": 0.4,
}
RAIL: Any = {
    "normal_force": Q(80, "kN"),
    "longitudinal_creepage": Q([0.0, 0.1, 0.5, -1.0, 3.0, 20.0], "%"),
    "spin": Q(0.3, "1/m"),
    "friction_coefficient": 0.4,
}
STAGES: dict[str, wl.Stage] = {
    "constant": wl.stage("third_body", reduction=0.6),
    "falling": wl.stage("third_body", reduction=0.6, limit_reduction=0.1, reduction_decay=0.7),
    "hot": wl.stage("thermal", hot_ratio=0.5, temperature_range="600 K"),
    "late": wl.stage("thermal", hot_ratio=0.5, temperature_range="600 K", onset="50 K", body_1={"density": "8 g/cm^3"}),
}
every_stage = pytest.mark.parametrize("stage", STAGES.values(), ids=STAGES.keys())
every_pair = pytest.mark.parametrize(
    ("rig", "model", "conditions"),
    [(SUROS, name, DISCS) for name in ("exact", "fastsim", "global")]
    + [(WHEEL, name, RAIL) for name in ("fastsim", "linear", "polach", "shen_hedrick_elkins")],
)


def magnitudes(result: wl.Prediction) -> dict[str, Any]:
    names = ("tangential_force", "wear_index", "cell_wear_index", "mean_slip", "wear_rate")
    return {name: getattr(result, name).to_base_units().magnitude for name in names}


@every_stage
@every_pair
def test_a_batch_agrees_with_one_point_at_a_time(rig: Any, model: str, conditions: dict[str, Any], stage: Any) -> None:
    predict = rig | wl.contact_model(model) | stage | wl.wear_law("kth")
    batch = magnitudes(predict(**conditions))
    along = "creepage" if rig is SUROS else "longitudinal_creepage"
    for index, creepage in enumerate(conditions[along]):
        single = magnitudes(predict(**{**conditions, along: creepage}))
        for name, value in single.items():
            assert np.isfinite(value)
            # Friction of a fixed point that is a few roundings off moves FASTSIM's nodes as much.
            assert batch[name][index] == pytest.approx(value, rel=1e-12, abs=1e-300), name


@every_stage
def test_energy_and_bound_hold_in_a_pipeline(stage: wl.Stage) -> None:
    r = (SUROS | wl.contact_model("exact") | stage | wl.wear_law("usfd", fitted_for="exact"))(**DISCS)
    force = r.tangential_force.to("N").magnitude
    friction = r.contact.problem.friction_coefficient  # type: ignore[union-attr]
    assert (np.abs(force) <= friction * r.problem.normal_force * (1.0 + 1e-15)).all()
    assert (friction <= 0.4).all()
    energy = DISCS["creepage"].to("").magnitude * force
    assert r.wear_index.to("N").magnitude == pytest.approx(energy, rel=1e-14)
    assert r.cell_wear_index.to("N").magnitude == pytest.approx(energy, rel=5e-8)  # the accuracy of the nodes
    # The wear is integrated in closed form, as without the stage.
    assert (r.wear_rate_error <= 1e-12 * r.wear_rate.max()).all()


@every_stage
def test_missing_patches_stay_missing(stage: wl.Stage) -> None:
    found = (Axle() | wl.contact_model("fastsim") | stage | wl.wear_law("kth"))(**GIVEN)
    assert (np.isnan(found.wear_rate.magnitude) == ~EXISTS).all()
    assert (np.isnan(found.longitudinal_force.magnitude) == ~EXISTS).all()


def test_slow_rolling_warns_once_a_prediction() -> None:
    slow = wl.TwinDisc.suros(rolling_speed="0.1 m/s")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        _ = (slow | wl.contact_model("exact") | STAGES["hot"] | wl.wear_law("kth"))(**DISCS).wear_rate
    assert sum("Péclet" in str(warning.message) for warning in caught) == 1
