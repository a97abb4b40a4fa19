"""Predictions of some patches or operating points, selected by label or by position."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.axles import (
    ALONE,
    CREEP,
    CUT,
    EXISTS,
    GIVEN,
    PATCHES,
    PREDICT,
    STRIPS,
    Axle,
    of,
)
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.numerics import integrate  # private: integrals at the size of blocks

EVERY = (
    "wear_rate", "wear_rate_error", "longitudinal_force", "lateral_force", "spin_moment", "tangential_force",
    "traction_coefficient", "wear_index", "cell_wear_index", "wear_index_density",
    "normal_force", "creepage", "friction_coefficient", "semi_axis_a", "semi_axis_b", "max_pressure", "first_yield",
    "shakedown_limit", "outside_range", "patch_area", "stick_ratio", "mean_slip", "mass_per_distance",
)  # fmt: skip
"""All properties of an ellipse."""

SELECTIONS: list[tuple[dict[str, Any], dict[str, Any], Any, dict[str, Any]]] = [
    ({"side": "right"}, {}, np.s_[:, 1], {"patch": (1, 2)}),
    ({"patch": 1}, {}, np.s_[:, :, 0], {"side": ("left", "right")}),
    ({"side": "right", "patch": 2}, {}, np.s_[:, 1, 1], {}),
    ({"side": ["right"]}, {}, np.s_[:, [1]], {"side": ("right",), "patch": (1, 2)}),
    ({"side": ["right", "left"], "patch": [2, 1]}, {}, np.s_[:, ::-1, ::-1],
     {"side": ("right", "left"), "patch": (2, 1)}),
    ({}, {"point_0": 2}, np.s_[2], dict(PATCHES)),
    ({}, {"point_0": -1, "side": 0}, np.s_[2, 0], {"patch": (1, 2)}),
    ({}, {"point_0": [2, 0], "patch": slice(1, None)}, np.s_[[2, 0], :, 1:],
     {"side": ("left", "right"), "patch": (2,)}),
    ({"side": "right", "patch": 2}, {"point_0": 2}, np.s_[2, 1, 1], {}),
    ({"side": "left", "patch": 2}, {}, np.s_[:, 0, 1], {}),  # which never touches
    ({"side": "left", "patch": 2}, {"point_0": 0}, np.s_[0, 0, 1], {}),
]  # fmt: skip


@pytest.mark.parametrize(("labels", "positions", "index", "dims"), SELECTIONS)
@pytest.mark.parametrize("kept", [True, False])
def test_a_prediction_of_some_patches_has_their_values(
    monkeypatch: pytest.MonkeyPatch, kept: bool, labels: Any, positions: Any, index: Any, dims: Any
) -> None:
    if not kept:  # in several blocks, whose contacts are not kept
        monkeypatch.setattr(integrate, "FEW", 2)
        monkeypatch.setattr(integrate, "ELLIPSE_NODES", 1)
    whole = PREDICT(**GIVEN)
    part = whole.sel(**labels).isel(**positions)
    assert part.problem.dims == dims
    for name in EVERY:
        np.testing.assert_array_equal(of(part, name), of(whole, name)[index], err_msg=name)
    for name in ("mass_per_cycle", "depth_per_distance", "profile_area_rate"):
        value = getattr(part, name)("wheel").magnitude
        np.testing.assert_array_equal(value, getattr(whole, name)("wheel").magnitude[index], err_msg=name)
    np.testing.assert_array_equal(part.wear_rate_of("rail").magnitude, whole.wear_rate_of("rail").magnitude[index])
    np.testing.assert_array_equal(part.contact.traction, whole.contact.traction[index])
    np.testing.assert_array_equal(part["wear_rate_error"].magnitude, whole["wear_rate_error"].magnitude[index])
    found, expected = part.wear_profile("wheel"), whole.wear_profile("wheel")
    for name in ("depth", "sliding_distance", "y"):
        np.testing.assert_array_equal(found[name].values, expected[name].values[index], err_msg=name)
    for dim, those in dims.items():
        assert found[dim].values.tolist() == list(those)
    of_101 = part.wear_profile("rail", strips=5).depth.values
    np.testing.assert_allclose(of_101, whole.wear_profile("rail", strips=5).depth.values[index], rtol=64 * EPS)


def test_selecting_solves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = PREDICT(**GIVEN)
    monkeypatch.setattr(type(wl.contact_model("fastsim")), "solve_ellipse", lambda *_: pytest.fail("solved again"))
    part = whole.sel(side="right")
    _ = part.wear_rate, part.longitudinal_force, part.contact, part.mean_slip, part.wear_profile("wheel")


def test_patches_of_strips_can_be_selected() -> None:
    whole = CUT(**GIVEN)
    part = whole.sel(side="right")
    found, expected = part.wear_profile("wheel"), whole.wear_profile("wheel")
    assert found.depth.dims == ("point_0", "patch", "strip")
    assert found.sizes["strip"] == STRIPS
    np.testing.assert_array_equal(found.depth.values, expected.depth.values[:, 1])
    np.testing.assert_array_equal(found.y.values, expected.y.values[:, 1])
    assert (np.isnan(found.depth.values).all(axis=-1) == ~EXISTS[:, 1]).all()
    missing = whole.sel(side="left", patch=2)
    assert np.isnan(missing.wear_profile("wheel").depth.values).all()
    for name in ("wear_rate", "patch_area", "max_pressure", "mean_slip", "wear_index", "first_yield", "outside_range"):
        np.testing.assert_array_equal(of(part, name), of(whole, name)[:, 1], err_msg=name)
        assert np.isnan(of(missing, name)).all()


def test_a_prediction_without_laws_can_be_selected_from() -> None:
    whole = (Axle() | wl.contact_model("fastsim"))(**GIVEN)
    part = whole.sel(side="right")
    for name in ("longitudinal_force", "mean_slip", "patch_area", "wear_index_density", "stick_ratio"):
        np.testing.assert_array_equal(of(part, name), of(whole, name)[:, 1], err_msg=name)
    np.testing.assert_array_equal(part.contact.traction, whole.contact.traction[:, 1])


@pytest.mark.parametrize("law", ["usfd", "kth"])
def test_operating_points_of_discs_are_selected_by_position(law: str) -> None:
    predict = (wl.TwinDisc.suros() | wl.contact_model("exact")).with_law(wl.wear_law(law))
    whole = predict(creepage=Q([[0.1], [1.0]], "%"), max_pressure=Q([1.0, 1.5, 2.0], "GPa"), friction_coefficient=0.4)
    part = whole.isel(point_0=1, point_1=[0, 2])
    for name in ("wear_rate", "wear_rate_error", "tangential_force", "mean_slip", "patch_area", "half_width"):
        np.testing.assert_array_equal(of(part, name), of(whole, name)[1, [0, 2]], err_msg=name)
    np.testing.assert_array_equal(part.profile.traction.values, whole.profile.traction.values[1, [0, 2]])
    assert part.profile.traction.dims == ("point_0", "cell")
    assert np.isfinite(part.isel(point_0=0).wear_rate.magnitude)
    one = predict(creepage="1 %", max_pressure="1 GPa", friction_coefficient=0.4)
    np.testing.assert_array_equal(one.isel().contact.traction, one.contact.traction)


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"sid": "left"}, r"sel: no labels for an axis 'sid'.* did you mean 'side'\? Axes with labels: side"
         r" \('left', 'right'\) and patch \(1, 2\)"),
        ({"point_0": 0}, r"sel: no labels for an axis 'point_0'.* isel takes"),
        ({"side": "top"}, r"sel: axis 'side' has no label 'top', only \('left', 'right'\)"),
        ({"patch": [1, 3]}, r"sel: axis 'patch' has no label 3, only \(1, 2\)"),
    ],
)  # fmt: skip
def test_a_wrong_label_is_named_with_those_there_are(chosen: Any, said: str) -> None:
    with pytest.raises(wl.InputError, match=said):
        PREDICT(**GIVEN).sel(**chosen)


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"point_1": 0}, r"isel: no axis 'point_1'.* Axes \(with sizes\): point_0 \(3\), side \(2\), patch \(2\)"),
        ({"point_0": 3}, "isel: axis 'point_0' has 3 entries, 0 to 2; give an integer, .* or a slice, got 3"),
        ({"point_0": [0, -4]}, r"isel: axis 'point_0' has 3 entries, 0 to 2; .* got \[0, -4\]"),
        ({"side": "left"}, "isel: axis 'side' has 2 entries, 0 to 1; .* got 'left'"),
        ({"side": [0.5]}, r"isel: axis 'side' has .* got \[0.5\]"),
    ],
)  # fmt: skip
def test_a_wrong_position_is_named_with_those_there_are(chosen: Any, said: str) -> None:
    with pytest.raises(wl.InputError, match=said):
        PREDICT(**GIVEN).isel(**chosen)


def test_one_operating_point_has_no_axes_to_select_from() -> None:
    with pytest.raises(wl.InputError, match=r"isel: no axis 'point_0'.* none at one operating point"):
        ALONE(normal_force="80 kN", **CREEP).isel(point_0=0)
