"""A wheelset with a lifted wheel: the other one carries its load, and rolls without driving it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Q

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")

PLACES = np.array([0.0, 2.0, 5.8, 3.0])
LEFT = np.array([60.0, 0.0, 0.0, 0.0])
RIGHT = np.array([60.0, 60.0, 60.0, 0.0])
TABLE = pd.DataFrame({"lateral_displacement [mm]": PLACES, "vertical_load_left [kN]": LEFT})
TABLE["vertical_load_right [kN]"] = RIGHT
AT = Q(np.arange(-45.0, 30.0, 0.5), "mm")


def pipeline() -> wl.Pipeline[...]:
    return wheelset() | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")


@pytest.fixture(scope="module")
def r() -> wl.Prediction:
    loads: dict[str, Any] = {"vertical_load_left": Q(LEFT, "kN"), "vertical_load_right": Q(RIGHT, "kN")}
    return pipeline()(lateral_displacement=Q(PLACES, "mm"), friction_coefficient=0.3, **loads)


def test_results_of_a_lifted_wheel_are_zero(r: wl.Prediction) -> None:
    lifted = np.stack([LEFT, RIGHT], axis=-1) == 0.0
    found = r.to_dataset()
    for name in ("mass_per_distance", "normal_force", "max_pressure", "wheel_load", "wear_index"):
        values = found[name].values
        assert not values[lifted].any(), name
        assert (values[~lifted][:, 0] > 0.0).all(), name
    assert found["wheel_load"].values[..., 0] == pytest.approx(np.stack([LEFT, RIGHT], axis=-1), rel=1e-3)


def test_the_other_wheel_rolls_freely(r: wl.Prediction) -> None:
    """Torque of a free axle is zero, which both wheels share at 2 mm, but a single wheel has to itself.

    The lifted wheel is taken to bear a thousandth of the load, and thus at most friction times that.
    """
    alone = r[1].longitudinal_force.m_as("kN")[1]
    assert abs(np.nansum(alone)) < 0.3 * 60.0 * 2e-3
    both = pipeline()(lateral_displacement="2 mm", vertical_load="60 kN", friction_coefficient=0.3)
    assert abs(both.longitudinal_force.m_as("kN")[1, 0]) > 1.0


def test_sums_and_lives_leave_lifted_wheels_out(r: wl.Prediction) -> None:
    given: dict[str, Any] = {"friction_coefficient": 0.3}
    table = TABLE.assign(share=0.25)
    mass = np.nansum(r.mass_lost("1 km", "wheel").m_as("mg"), axis=-1).mean(axis=0)
    total = wl.wear_profiles(pipeline(), table, share="share", at=AT, **given)
    assert total["mass"].values == pytest.approx(mass, rel=1e-12)
    rows = wl.wear_profiles(pipeline(), TABLE, at=AT, **given)
    assert not rows["depth"].values[3].any()
    life = wl.wear_out(pipeline(), table.iloc[::-1], over="10 km", **given)
    lost = life.table[["mass_left [kg]", "mass_right [kg]"]].iloc[-1].to_numpy()
    assert lost == pytest.approx(10e-6 * mass, rel=1e-9)
