"""The fields of a profile from its file, moved and repaired."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw_models.rigs.wheelset.curve import through_points
from wearlaw_models.rigs.wheelset.fields import CONVEX, Angle, Fields, Shift
from wearlaw_models.rigs.wheelset.files import Kind, points_of
from wearlaw_models.rigs.wheelset.points import filled
from wearlaw_models.rigs.wheelset.repairs import repaired


class File(wl.Configuration):
    """A table that names the file of a profile, with the options of `read_profile`."""

    file: str
    kind: Kind | None = None
    units: str = "mm"
    sep: str | None = None
    decimal: str = "."
    part: int | None = None
    sheet: str | None = None
    mirror_y: Annotated[bool, Field(strict=True)] = False
    mirror_z: Annotated[bool, Field(strict=True)] = False
    turn: Angle = Field(default="0 deg", validate_default=True)
    shift_y: Shift = Field(default="0 mm", validate_default=True)
    shift_z: Shift = Field(default="0 mm", validate_default=True)
    smoothing: Shift = Field(default="0 mm", validate_default=True)
    repair: Annotated[bool, Field(strict=True)] = False


def fields_of(path: Path, file: File) -> Fields:
    """Return the fields of the profile in a file; see `read_profile`."""
    points, told = points_of(path, file.kind, file.units, file.sep, file.decimal, file.part, file.sheet)
    y, z = (points.mirrored() if file.mirror_y else points.y), (-points.z if file.mirror_z else points.z)
    angle = wl.scalar_si(file.turn, "rad")
    if angle:
        y, z = np.cos(angle) * y - np.sin(angle) * z, np.sin(angle) * y + np.cos(angle) * z
    y = y + wl.scalar_si(file.shift_y, "m")
    points, mended = repaired(replace(points, y=y, z=z), told, file.repair)
    if mended:
        wl.errors.warn(f"profile {wl.shown(path)}, repaired: {'; '.join(mended)}", wl.UnusualWarning)
    y, z = points.y, points.z
    if points.taping is not None and y.min() <= 0.0 <= y.max():
        way = slice(None, None, -1 if y[-1] < y[0] else 1)
        across, down = filled(y[way], z[way])
        width = wl.scalar_si(file.smoothing, "m")
        z = z - float(through_points(across, down, width, None, CONVEX[told]).at(0.0)[1])
    z = z + wl.scalar_si(file.shift_z, "m")
    fields = Fields(kind=told, y=wl.Q(1e3 * y, "mm"), z=wl.Q(1e3 * z, "mm"), smoothing=file.smoothing)
    if points.weights is not None:
        fields["weights"] = tuple(points.weights.tolist())
    if points.diameter is not None:
        fields["diameter"] = wl.Q(1e3 * points.diameter, "mm")
    fields.lines = points.lines
    return fields
