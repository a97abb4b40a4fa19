"""Contacts that were solved elsewhere, and the wear in them."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import CompositionError, ModelError

FOUR_NODES: Any = {
    "pressure": Q([100, 800, 900, 300], "MPa"),
    "traction": Q([30, 200, 350, 120], "MPa"),
    "slip": Q([0, 0, 0.4, 1.1], "%"),
    "area": Q([1, 1, 1, 0.5], "mm^2"),
    "rolling_speed": Q(1.2, "m/s"),
}
NODES = ("pressure", "traction", "slip", "area")


def test_the_totals_are_the_sums_over_the_nodes() -> None:
    contact = wl.Contact.from_arrays(**FOUR_NODES)
    assert contact.normal_force == pytest.approx(100 + 800 + 900 + 150, rel=8 * EPS)  # [N]
    assert contact.tangential_force == pytest.approx(30 + 200 + 350 + 60, rel=8 * EPS)
    assert contact.wear_index == pytest.approx(350 * 0.004 + 120 * 0.011 * 0.5, rel=8 * EPS)
    assert contact.density == 7850


def test_kth_on_given_arrays_is_archards_law_at_each_node() -> None:
    wear = wl.Contact.from_arrays(**FOUR_NODES) | wl.wear_law("kth", coefficient="mid")
    # ρ k p s / H with k = 5.5e-4, H = 2.625 GPa; 1 kg/m³ is 1000 µg/m/mm².
    expected = 7850 * 5.5e-4 * np.array([100, 800, 900, 300]) * np.array([0, 0, 0.004, 0.011]) / 2625 * 1000
    np.testing.assert_allclose(wear.local_value.magnitude, expected, rtol=16 * EPS)
    mean = expected @ [1, 1, 1, 0.5] / 3.5
    assert wear.value.magnitude == pytest.approx(mean, rel=16 * EPS)
    assert repr(wear) == f"LocalOutcome with wear_rate {wear.value!r}"


def test_the_fields_of_a_model_given_as_arrays_wear_as_in_a_pipeline() -> None:
    prediction = (wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact"))(
        max_pressure="1500 MPa", creepage=Q([0.3, 1, 10], "%"), friction_coefficient=0.46
    )
    solved = prediction.contact
    contact = wl.Contact.from_arrays(
        pressure=Q(solved.pressure, "Pa"),
        traction=Q(solved.traction, "Pa"),
        slip=Q(solved.slip, ""),
        area=Q(solved.area, "m^2"),
        rolling_speed=Q(solved.rolling_speed, "m/s"),
    )
    wear = contact | wl.wear_law("usfd", fitted_for="exact")
    # Sums of a few hundred products.
    np.testing.assert_allclose(wear.value.magnitude, prediction.wear_rate.magnitude, rtol=300 * EPS)
    np.testing.assert_allclose(contact.wear_index, prediction.wear_index.m_as("N"), rtol=300 * EPS)


def test_a_patch_with_two_axes_of_nodes_and_a_batch() -> None:
    shape = (2, 3, 4)
    contact = wl.Contact.from_arrays(
        pressure=Q(np.full(shape, 500.0), "MPa"),
        traction=Q(100, "MPa"),
        slip=Q(np.linspace(0, 1, 24).reshape(shape), "%"),
        area=Q(0.25, "mm^2"),
        rolling_speed=Q([1, 2], "m/s"),
    )
    assert contact.patch_area.shape == (2,)
    np.testing.assert_allclose(contact.patch_area, 3e-6, rtol=16 * EPS)
    wear = contact | wl.wear_law("kth")
    assert wear.value.magnitude.shape == (2,)
    assert wear.local_value.magnitude.shape == shape


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"pressure": [1.0, 2, 3, 4]}, wl.UnitError, "pressure: got .* which has no unit"),
        ({"slip": Q(0.1, "mm")}, wl.UnitError, "slip: got 0.1000 mm, which is not a ratio"),
        (
            {"slip": Q([0, 0, 0.6, 2.2], "")},
            wl.InputError,
            r"slip: must not exceed 1 in magnitude, got 2.2 at index \[3\]; .* percent as Q\(\.\.\., \"%\"\), divide",
        ),
        ({"traction": -FOUR_NODES["traction"], "slip": Q([0, 0, -60, -100.1], "%")}, wl.InputError, "got -1.001 at"),
        ({"area": Q(0, "mm^2")}, wl.InputError, "area: must not be negative, and not zero at all nodes"),
        ({"area": Q([1, 1, -1, 1], "mm^2")}, wl.InputError, "area: must not be negative"),
        ({"rolling_speed": Q(-1, "m/s")}, wl.UnitError, "rolling_speed: must be greater than zero"),
        ({"traction": Q([1, np.nan, 1, 1], "MPa")}, wl.UnitError, "traction: must be a number"),
        ({"pressure": Q([1, -2, 3, 4], "MPa")}, wl.InputError, "pressure: must not be negative"),
        ({"slip": Q(-0.1, "%")}, wl.InputError, "traction and slip: must have the same sign"),
        ({"pressure": Q(-0.5, "Pa")}, wl.InputError, "pressure: must not be negative"),
        ({"slip": Q([0, 0, 0, -1e-9], "%")}, wl.InputError, "traction and slip: must have the same sign"),
        ({name: FOUR_NODES[name][:0] for name in NODES}, wl.InputError, "pressure: is empty"),
        ({"area": Q([1, 2], "mm^2")}, wl.InputError, r"do not broadcast: pressure \(4,\), .* area \(2,\)"),
        (
            {"rolling_speed": Q([1, 1], "m/s")},
            wl.InputError,
            "pressure: must have axes of nodes after the 1 of rolling_speed",
        ),
    ],
)
def test_wrong_arrays_are_refused(changes: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        wl.Contact.from_arrays(**{**FOUR_NODES, **changes})


def test_a_locked_wheel_slides_by_its_rolling_speed() -> None:
    contact = wl.Contact.from_arrays(**{**FOUR_NODES, "slip": Q(1.0 + EPS, "")})
    assert contact.wear_index == pytest.approx(contact.tangential_force, rel=8 * EPS)


def test_a_law_of_the_patch_is_refused_on_nodes_and_taken_on_their_mean() -> None:
    contact = wl.Contact.from_arrays(**FOUR_NODES)
    with pytest.raises(CompositionError, match=r"use contact\.patch_mean\(\) \| law"):
        contact | wl.wear_law("brr")
    wear = contact.patch_mean() | wl.wear_law("brr")
    # 6.165 µg/m per N of Tγ below 100 N: ρ π 0.25 mm³/km/N.
    expected = 7850 * np.pi * 0.25e-12 * 1e9 * float(contact.wear_index)
    assert (wear.value * Q(contact.patch_area, "m^2")).m_as("ug/m") == pytest.approx(expected, rel=16 * EPS)


def test_traction_of_both_signs_is_refused_and_its_magnitude_taken() -> None:
    node: Any = {"pressure": "1 GPa", "area": "1 mm^2", "rolling_speed": "1 m/s"}
    with pytest.raises(wl.InputError, match=r"traction: has both signs .* give traction and slip as magnitudes"):
        wl.Contact.from_arrays(**node, traction=Q([300.0, -299.0], "MPa"), slip=Q([1.0, -1.0], "%"))
    mean = wl.Contact.from_arrays(**node, traction=Q([300.0, 299.0], "MPa"), slip="1 %").patch_mean()
    assert mean.slip == pytest.approx(0.01, rel=4 * EPS)


def test_no_traction_is_no_contradiction_and_rounding_about_zero_none_either() -> None:
    node: Any = {"pressure": "1 GPa", "area": "1 mm^2", "rolling_speed": "1 m/s"}
    rolling = wl.Contact.from_arrays(**node, traction=Q([0.0, 0.0], "MPa"), slip=Q([0.0, 0.0], "%"))
    assert rolling.tangential_force == 0.0
    # A share e of either sign leaves 2 e / (1 + e) of the magnitudes out of the force, of which 1e-9 are allowed.
    slip = Q([1.0, -1.0], "%")
    assert wl.Contact.from_arrays(**node, traction=Q([300.0, -300 * 0.4e-9], "MPa"), slip=slip).wear_index > 0.0
    with pytest.raises(wl.InputError, match="traction: has both signs"):
        wl.Contact.from_arrays(**node, traction=Q([300.0, -300 * 0.6e-9], "MPa"), slip=slip)


def test_a_node_without_area_has_no_part_in_the_mean() -> None:
    with_one = {**FOUR_NODES, "area": Q([1.0, 1.0, 1.0, 0.0], "mm^2")}
    mean = wl.Contact.from_arrays(**with_one).patch_mean()
    assert mean.traction_bound == np.inf
    assert mean.area == pytest.approx(3e-6, rel=4 * EPS)


def test_parameters_of_a_line_are_warned_of_on_an_ellipse() -> None:
    wheel = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    conditions: Any = {"normal_force": "80 kN", "longitudinal_creepage": "0.1 %", "friction_coefficient": 0.3}
    contact = wl.contact_model("fastsim").solve(wheel.problem(**conditions))
    with pytest.warns(wl.CalibrationWarning, match="the contact holds its cells, of an ellipse") as caught:
        contact | wl.wear_law("usfd", fitted_for="fastsim")
    assert caught[0].filename == __file__


def test_parameters_of_another_scale_are_warned_of() -> None:
    contact = wl.Contact.from_arrays(**FOUR_NODES)
    with pytest.warns(wl.CalibrationWarning, match="fitted for patch means .* holds its cells"):
        contact | wl.wear_law("usfd", fitted_for="global")
    with pytest.warns(wl.CalibrationWarning, match="holds the means of the patch"):
        contact.patch_mean() | wl.wear_law("usfd", fitted_for="exact")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contact.patch_mean() | wl.wear_law("usfd", fitted_for="global")


def test_negative_wear_is_refused() -> None:
    class Gain(wl.WearLaw):
        name = "gain"

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            return -contact.pressure

    contact = wl.Contact.from_arrays(**{**FOUR_NODES, "slip": "1 %"})
    with pytest.raises(ModelError, match="gives a negative wear rate"):
        contact | Gain()


def test_only_a_contact_comes_before_a_law() -> None:
    with pytest.raises(CompositionError, match="a wear law takes a contact, not 3"):
        3 | wl.wear_law("kth")  # type: ignore[operator]


def test_the_patch_mean_keeps_the_totals_in_one_node() -> None:
    traction, area = np.array([[1.0, 5.0, -7.0], [0.0, 0.0, 0.0]]), np.array([[1.0, 2.0, 3.0], [4.0, 4.0, 4.0]])
    contact = wl.Contact(
        pressure=np.full((2, 3), 10.0),
        traction=traction,
        slip=np.array([[0.0, 0.1, -0.2], [0.0, 0.0, 0.0]]),
        traction_bound=np.full((2, 3), 8.0),
        area=area,
        x=np.zeros((2, 3)),
        rolling_speed=np.array([2.0, 3.0]),
        normal_force=10.0 * area.sum(-1),
        tangential_force=(traction * area).sum(-1),
        wear_index=np.array([1.3, 0.0]),
        density=np.array([7850.0, 7850.0]),
    )
    mean = contact.patch_mean()
    for name in ("tangential_force", "wear_index", "normal_force", "patch_area", "rolling_speed", "density"):
        np.testing.assert_array_equal(getattr(mean, name), getattr(contact, name))
    assert mean.pressure.shape == (2, 1)
    # (1·1 + 2·5 - 3·7)/6 = -10/6, and the slip that dissipates 1.3 N with -10 N.
    np.testing.assert_allclose(mean.traction[:, 0], [-10.0 / 6.0, 0.0], rtol=1e-15)
    np.testing.assert_allclose(mean.slip[:, 0], [-0.13, 0.0], rtol=1e-15)
    np.testing.assert_allclose(mean.pressure[:, 0], [10.0, 10.0], rtol=1e-15)
    np.testing.assert_allclose(mean.traction_bound[:, 0], [8.0, 8.0], rtol=1e-15)
