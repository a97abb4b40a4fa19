"""Repairs of measured points: what the errors about them suggest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wearlaw_models.rigs.wheelset.files import Kind, Points
from wearlaw_models.rigs.wheelset.points import (
    MIRROR_Y,
    MIRROR_Z,
    PointsError,
    Repair,
    check_orientation,
    check_points,
    filled,
)

MOST = 0.1
"""Greatest share of the points that are left out."""


def repaired(points: Points, kind: Kind, every: bool) -> tuple[Points, list[str]]:
    """Return the points of a file, checked and mended, and what was done.

    Without `every`, only what scans have is mended: points that are doubled or run back, and rails with z upwards.

    Raises
    ------
    PointsError
        If they make no profile.
    """
    done: dict[str, list[str]] = {}
    fewest = (1.0 - MOST) * points.y.size

    def name(index: int) -> str:
        return f"line {points.lines[index]}"

    while True:
        try:
            check_points(points.y, points.z, name)
            check_orientation(kind, points.y, points.z, name)
        except PointsError as error:
            repair = error.repair
            upside_down = kind == "rail" and repair is not None and repair.text == MIRROR_Z
            usual = points.scanned and repair is not None and (repair.leave_out.size or upside_down)
            if repair is None or not (every or usual) or repair.text in done:
                raise
            if repair.leave_out.size:
                if points.y.size - repair.leave_out.size < fewest:
                    raise
                done.setdefault("", []).extend(map(name, repair.leave_out))
            else:
                done[repair.text] = []
            points = _mended(points, repair)
            continue
        left_out = done.pop("", None)
        return points, [*done, *([f"left out {', '.join(left_out)}"] if left_out else [])]


def _mended(points: Points, repair: Repair) -> Points:
    """Return the points after a repair."""
    y, z, lines, weights = points.y, points.z, points.lines, points.weights
    if repair.text == MIRROR_Y:
        return replace(points, y=points.mirrored())
    if repair.fill:
        more_values = () if weights is None else (weights,)
        y, z, numbers, *more = filled(y, z, lines.astype(np.float64), *more_values, every=True)
        return replace(points, y=y, z=z, lines=numbers.astype(np.intp), weights=next(iter(more), None))
    (yy, yz), (zy, zz) = repair.matrix
    y, z = yy * y + yz * z + repair.shift_y, zy * y + zz * z
    keep = np.ones(y.size, dtype=np.bool_)
    keep[repair.leave_out] = False
    weights = None if weights is None else weights[keep]
    return replace(points, y=y[keep], z=z[keep], lines=lines[keep], weights=weights)
