"""The picture of a wheelset's geometry: its lines join contact points, and its curves keep jumps."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw_wheelset as ws
from docs.wheelset_benchmark import wheelset
from wearlaw import Q
from wearlaw_wheelset._pictures import APART, LINES  # private: one step of the contact, against another way to it


@pytest.fixture(scope="module")
def geometry() -> ws.Geometry:
    return wheelset().geometry(lateral_displacement=Q(np.linspace(-8, 8, 161), "mm"), yaw=Q([0, 20], "mrad"))


def test_lines_join_the_points_of_wheel_and_rail_that_touch(geometry: ws.Geometry) -> None:
    profiles, *joins = geometry.plot().axes[0].get_lines()
    rail, *joins = joins
    ends = np.concatenate([np.asarray(line.get_xydata()) for line in joins], axis=0)
    ends = ends[np.isfinite(ends).all(axis=-1)]
    upper, lower = ends[::2], ends[1::2]
    for points, curve in ((upper, profiles), (lower, rail)):
        x, y = np.asarray(curve.get_data())
        order = np.argsort(x)
        # Drawn profiles are polygons with points at most 0.05 mm apart, on radii of 12 mm or more and slopes up to 3.
        assert np.interp(points[:, 0], x[order], y[order]) == pytest.approx(points[:, 1], abs=2e-3)
    found = geometry.dataset.sel(side="right")
    touching = {*np.round(found.y.values[np.isfinite(found.y.values)], 9)}
    assert {*np.round(lower[:, 0], 9)} <= touching
    assert (upper[:, 1] > -APART - 5.0).all()
    rows = -(-161 // -(-161 // LINES))
    shown = [line for line in joins if line.get_color() != "black"]
    assert len({line.get_color() for line in shown}) == rows


def test_curves_are_points_that_keep_jumps_with_a_colour_for_each_yaw(geometry: ws.Geometry) -> None:
    figure = geometry.plot()
    _, radius, angle, _ = figure.axes
    for axes, name in ((radius, "rolling_radius_difference"), (angle, "contact_angle")):
        assert axes.get_ylabel().endswith("]")
        assert all(line.get_linestyle() == "None" for line in axes.get_lines())
        found = geometry.dataset[name]
        found = found.sel(side="right", patch=1) if name == "contact_angle" else found
        first = [line for line in axes.get_lines() if not str(line.get_label()).startswith("_")]
        assert np.stack([np.asarray(line.get_ydata()) for line in first], axis=-1) == pytest.approx(found.values)
        assert len({line.get_color() for line in first}) == 2
    legend = radius.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["0", "20"]


def test_a_single_position_and_a_sweep_of_the_yaw_are_drawn_too() -> None:
    rig = wheelset()
    one = rig.geometry(lateral_displacement="4.85 mm").plot()
    assert one.axes[2].get_xlabel() == "patch"
    assert len(one.axes) == 3  # no bar of colours
    turned = rig.geometry(lateral_displacement="5 mm", yaw=Q(np.linspace(0, 40, 5), "mrad")).plot()
    assert turned.axes[1].get_xlabel() == "yaw [mrad]"
