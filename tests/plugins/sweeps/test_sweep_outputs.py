"""What a sweep can keep of predictions: every quantity of an operating point that is none of the conditions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.cases import Linear
from tests.core.stages import RAILS
from wearlaw import Q

CREEPAGE = Q([0.1, 0.3], "%")
LINE: dict[str, Any] = {"creepage": CREEPAGE, "normal_force": "8 kN", "friction_coefficient": 0.3}
ELLIPSE: dict[str, Any] = {"longitudinal_creepage": CREEPAGE, "normal_force": "80 kN", "friction_coefficient": 0.3}
LAW = Linear(slope=Q(1.0, "mm"))
ON_DISCS, ON_RAILS = (rig | wl.contact_model("fastsim") | LAW for rig in (wl.TwinDisc.suros(), RAILS))
MEANS = RAILS | wl.contact_model("polach") | LAW


def test_what_only_a_wheel_on_a_rail_has_has_its_unit() -> None:
    units = {
        "longitudinal_force": "N",
        "lateral_force": "N",
        "semi_axis_a": "mm",
        "semi_axis_b": "mm",
        "cell_wear_index": "N",
        "mass_per_distance": "ug/m",
        "patch_area": "mm^2",
    }
    ds = wl.sweep(ON_RAILS, **ELLIPSE, outputs=list(units))
    assert {name: one.attrs["units"] for name, one in ds.data_vars.items()} == units


@pytest.mark.parametrize(("predict", "given"), [(ON_DISCS, LINE), (ON_RAILS, ELLIPSE), (MEANS, ELLIPSE)])
def test_the_contact_alone_is_swept_without_a_law(predict: wl.Pipeline[...], given: dict[str, Any]) -> None:
    contact = predict.without_law()
    alone, both = (wl.sweep(one, **given, outputs=["tangential_force"]) for one in (contact, predict))
    # The same forces by another way: fastsim's in closed form on a line, else the same sums.
    np.testing.assert_allclose(alone.tangential_force, both.tangential_force, rtol=64 * np.finfo(np.float64).eps)
    every = wl.sweep(contact, **given)
    assert not {name for name in every if every[name].isnull().any()}
    assert "tangential_force" in every
    assert not {"wear_rate", "wear_rate_error", "mass_per_distance"} & set(every)
