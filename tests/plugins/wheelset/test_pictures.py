"""The picture of a wheelset's geometry: its lines join contact points, and its curves keep jumps."""

from __future__ import annotations

import numpy as np
import pytest

from docs.wheelset_benchmark import wheelset
from wearlaw import Q
from wearlaw_models.rigs import wheelset as ws
from wearlaw_models.rigs.wheelset.pictures import (  # private: one step of the contact, against another way to it
    APART,
    LINES,
)


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
