"""The stages that ship with wearlaw, in pipelines."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.ellipses import line
from wearlaw import Q

HOT = wl.stage("thermal", hot_ratio=0.5, temperature_range="600 K")
THIRD_BODY = wl.stage("third_body", reduction=0.6, limit_reduction=0.1, reduction_decay=0.7)


@pytest.mark.parametrize("stage", [HOT, THIRD_BODY])
def test_a_measured_traction_stays(stage: wl.Stage) -> None:
    measured = line(0.002).replaced(traction_coefficient=np.float64(0.1))
    model = wl.contact_model("global")
    altered = stage.altered(measured, lambda one: wl.CreepForces.of_line(np.asarray(model.tangential_force(one))))
    assert altered.effective_modulus != measured.effective_modulus or altered.friction_coefficient < 0.46
    assert model.solve(altered).tangential_force == 0.1 * measured.normal_force


def test_slow_rolling_warns_once_a_prediction() -> None:
    slow = wl.TwinDisc.suros(rolling_speed="0.1 m/s")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        predict = slow | wl.contact_model("exact") | HOT | wl.wear_law("kth")
        _ = predict(
            max_pressure="1500 MPa", creepage=Q([0.0, 0.1, 0.5, -1.0, 3.0, 20.0], "%"), friction_coefficient=0.4
        ).wear_rate
    assert sum("Péclet" in str(warning.message) for warning in caught) == 1
