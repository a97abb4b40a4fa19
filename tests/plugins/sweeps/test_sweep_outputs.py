"""What a sweep can keep of predictions: every quantity of an operating point that is none of the conditions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.cases import Linear
from tests.core.stages import RAILS
from wearlaw import Q

CREEPAGE = Q([0.1, 0.3], "%")
LINE: dict[str, Any] = {"creepage": CREEPAGE, "normal_force": "8 kN", "friction_coefficient": 0.3}
ELLIPSE: dict[str, Any] = {"longitudinal_creepage": CREEPAGE, "normal_force": "80 kN", "friction_coefficient": 0.3}
LAW = Linear(slope=Q(1.0, "mm"))
ON_DISCS, ON_RAILS = (rig | wl.contact_model("fastsim") | LAW for rig in (wl.TwinDisc.suros(), RAILS))
MEANS = RAILS | wl.contact_model("polach") | LAW


def offered(predict: wl.Pipeline[...], given: dict[str, Any], wrong: str = "none") -> tuple[str, list[str]]:
    """Return the message about an unknown output, with the known ones."""
    with pytest.raises(wl.InputError, match=f"outputs: there is no '{wrong}'") as refusal:
        wl.sweep(predict, **given, outputs=[wrong])
    message, _, known = str(refusal.value).partition("There are: ")
    return message, known.split(", ")


@pytest.mark.parametrize(("predict", "given"), [(ON_DISCS, LINE), (ON_RAILS, ELLIPSE), (MEANS, ELLIPSE)])
def test_every_output_that_is_offered_is_taken(predict: wl.Pipeline[...], given: dict[str, Any]) -> None:
    _, known = offered(predict, given)
    ds = wl.sweep(predict, **given, outputs=known)
    assert list(ds.data_vars) == known
    assert {"wear_rate", "tangential_force", "wear_index_density", "patch_area"} <= set(known)
    assert not {"contact", "friction_coefficient", "normal_force"} & set(known)


def test_what_only_a_wheel_on_a_rail_has_is_offered_with_its_unit() -> None:
    message, known = offered(ON_RAILS, ELLIPSE, "longitudinal_forces")
    assert "did you mean 'longitudinal_force'?" in message
    units = {
        "longitudinal_force": "N",
        "lateral_force": "N",
        "semi_axis_a": "mm",
        "semi_axis_b": "mm",
        "cell_wear_index": "N",
        "mass_per_distance": "ug/m",
        "patch_area": "mm^2",
    }
    assert {*units, "spin_moment"} <= set(known)
    ds = wl.sweep(ON_RAILS, **ELLIPSE, outputs=list(units))
    assert {name: one.attrs["units"] for name, one in ds.data_vars.items()} == units


@pytest.mark.parametrize("outputs", [["friction_coefficient"], ["longitudinal_creepage"]])
def test_conditions_are_no_outputs(outputs: list[str]) -> None:
    with pytest.raises(wl.InputError, match=f"'{outputs[0]}' is one of the conditions"):
        wl.sweep(ON_RAILS, **ELLIPSE, outputs=outputs)


@pytest.mark.parametrize(("predict", "given"), [(ON_DISCS, LINE), (ON_RAILS, ELLIPSE)])
def test_the_contact_alone_is_swept_without_a_law(predict: wl.Pipeline[...], given: dict[str, Any]) -> None:
    contact = predict.without_law()
    alone, both = (wl.sweep(one, **given, outputs=["tangential_force"]) for one in (contact, predict))
    # The same forces by another way: fastsim's in closed form on a line, else the same sums.
    np.testing.assert_allclose(alone.tangential_force, both.tangential_force, rtol=64 * np.finfo(np.float64).eps)
    _, known = offered(contact, given)
    every = wl.sweep(contact, **given)
    assert set(every) <= set(known)
    assert not {name for name in every if every[name].isnull().any()}
    assert "tangential_force" in known
    assert not {"wear_rate", "wear_rate_error", "mass_per_distance"} & {*known}
