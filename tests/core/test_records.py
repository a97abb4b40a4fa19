"""The records that pass between stages."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Array
from wearlaw.contact.contact import NODE_VARIABLES  # private: the list of variables
from wearlaw.units.variables import UNITS  # private: the list of variables and their units

AREA = np.array([[1.0, 2.0, 3.0], [4.0, 4.0, 4.0]])
SLIP = np.array([[0.0, 0.1, -0.2], [0.0, 0.0, 0.0]])


def contact() -> wl.Contact:
    """Two operating points of three nodes each."""
    traction = np.array([[1.0, 5.0, -7.0], [0.0, 0.0, 0.0]])
    force: Array = (traction * AREA).sum(-1)
    return wl.Contact(
        pressure=np.full((2, 3), 10.0),
        traction=traction,
        slip=SLIP,
        traction_bound=np.full((2, 3), 8.0),
        area=AREA,
        x=np.zeros((2, 3)),
        rolling_speed=np.array([2.0, 3.0]),
        normal_force=10.0 * AREA.sum(-1),
        tangential_force=force,
        wear_index=np.array([1.3, 0.0]),
        density=np.array([7850.0, 7850.0]),
    )


def test_means_are_weighted_with_the_area() -> None:
    # (1·0 + 2·0.1 + 3·0.2)/6, and nothing slips in the second point.
    np.testing.assert_allclose(contact().mean_slip, [0.8 / 6.0, 0.0], rtol=1e-15)
    np.testing.assert_array_equal(contact().patch_area, [6.0, 12.0])


def test_the_stick_ratio_is_the_share_of_area_without_slip() -> None:
    np.testing.assert_allclose(contact().slip_area, [5.0, 0.0], rtol=1e-15)
    np.testing.assert_allclose(contact().stick_ratio, [1.0 / 6.0, 1.0], rtol=1e-15)


def test_node_variables_are_products_of_the_fields() -> None:
    np.testing.assert_allclose(contact().wear_index_density, [[0.0, 0.5, 1.4], [0.0, 0.0, 0.0]], rtol=1e-15)
    np.testing.assert_allclose(contact().slip_speed, [[0.0, 0.2, 0.4], [0.0, 0.0, 0.0]], rtol=1e-15)


@pytest.mark.parametrize("name", NODE_VARIABLES)
def test_every_node_variable_has_the_shape_of_the_nodes_and_a_unit(name: str) -> None:
    assert getattr(contact(), name).shape == (2, 3)
    assert name in UNITS


def test_the_patch_mean_keeps_the_totals_in_one_node() -> None:
    mean = contact().patch_mean()
    for name in ("tangential_force", "wear_index", "normal_force", "patch_area", "rolling_speed", "density"):
        np.testing.assert_array_equal(getattr(mean, name), getattr(contact(), name))
    assert mean.pressure.shape == (2, 1)
    # (1·1 + 2·5 - 3·7)/6 = -10/6, and the slip that dissipates 1.3 N with -10 N.
    np.testing.assert_allclose(mean.traction[:, 0], [-10.0 / 6.0, 0.0], rtol=1e-15)
    np.testing.assert_allclose(mean.slip[:, 0], [-0.13, 0.0], rtol=1e-15)
    np.testing.assert_allclose(mean.pressure[:, 0], [10.0, 10.0], rtol=1e-15)
    np.testing.assert_allclose(mean.traction_bound[:, 0], [8.0, 8.0], rtol=1e-15)


def test_a_solution_on_a_line_stands_for_the_whole_track_width() -> None:
    problem = wl.TwinDisc.suros().problem(normal_force="7 kN", creepage=wl.Q([2], "%"), friction_coefficient=0.4)
    node = np.array([[3.0]])
    fields = wl.LineFields(pressure=node, traction=node, slip=node, traction_bound=node)
    solved = wl.Contact.from_line(problem, fields, x=node, length=node * 1e-4, force_per_width=np.array([2e5]))
    # 2e5 N/m on 10 mm are 2000 N, which dissipate 2 % of that per metre; 0.3 mm by 10 mm are 3 mm².
    np.testing.assert_allclose(solved.tangential_force, [2000.0], rtol=1e-15)
    np.testing.assert_allclose(solved.wear_index, [40.0], rtol=1e-15)
    np.testing.assert_allclose(solved.normal_force, [7000.0], rtol=1e-15)
    np.testing.assert_allclose(solved.area, [[3e-6]], rtol=1e-15)


def test_a_contact_is_frozen() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        contact().density = np.zeros(2)  # type: ignore[misc]
