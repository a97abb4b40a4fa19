"""A wheelset gives the same results under any `np.errstate` of the caller."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
import wearlaw_wheelset as ws
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Array, Q

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")


def predicted(displacement: wl.Quantity) -> dict[str, Array]:
    predict = wheelset() | wl.contact_model("fastsim") | wl.wear_law("usfd")
    found = predict(
        lateral_displacement=displacement,
        vertical_load="80 kN",
        friction_coefficient=0.3,
        yaw="0.5 mrad",
        lateral_velocity="1e-200 m/s",
    )
    data = found.to_dataset()
    worn = found.wear_profile("wheel")
    return {str(name): values.values for name, values in [*data.items(), *worn.items()]}


def test_errors_of_floats_end_no_prediction_of_a_wheelset() -> None:
    displacements = Q([0.0, 1.0, 5.0, 7.0], "mm")
    expected = predicted(displacements)
    with np.errstate(all="raise"):
        found = predicted(displacements)
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values, err_msg=name)


def test_errors_of_floats_end_no_work_on_profiles() -> None:
    s = Q(np.linspace(-20.0, 20.0, 81), "mm")
    depth = Q(0.5 * np.exp(-((s.magnitude / 0.75) ** 2)), "mm")  # as small as 1e-309 mm

    def worked() -> dict[str, Array]:
        rail = ws.Profile.uic60()
        worn = rail.worn(s, depth, smoothing="3 mm").turned("1e-300 rad").shifted(y="1e-310 mm").mirrored()
        rig = wheelset(rail=rail.worn(s, depth, smoothing="3 mm"))
        geometry = rig.geometry(lateral_displacement=Q([0.0, 3.0], "mm")).dataset
        return {
            "points": np.stack([one.magnitude for one in worn.points]),
            "conicity": np.asarray(rig.equivalent_conicity(amplitude="3 mm").magnitude),
            **{str(name): values.values for name, values in geometry.items()},
        }

    expected = worked()
    with np.errstate(all="raise"):
        found = worked()
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values, err_msg=name)
