"""Patches of contact of wheels, and the contact problem that they pose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.motion import Creepages
from wearlaw_models.rigs.wheelset.task import Elastic, Patch, Task


@dataclass(frozen=True)
class Patches:
    """Patches of wheels, as arrays with one entry for each; on strips also with an axis of these.

    Attributes
    ----------
    point, side, number : ndarray of int
        Index of the position, of the side (0 left, 1 right) and of the patch on its side.
    force : ndarray
        Normal force [N].
    across, upright : ndarray
        Resultants of the pressure outwards and down, over the force [-]; on a patch that bends they are less than the
        negative sine and the cosine of its angle.
    arc, rail_arc, radius, rail_z : ndarray
        Arc lengths of both profiles in the middle of the patch, and the rolling radius and z of the rail there [m].
    approach : ndarray
        Vertical approach from first touching [m].
    flange : ndarray
        Share of the force on rows of the flange [-].
    sliding : Creepages
        Means over the rows.
    a, b : ndarray
        Semi-axes of the ellipse with the length and the area of the patch [m].
    strips : dict of str to ndarray, (patches, strips)
        Rows as strips, with y and x from the middle of the patch; those behind the last row have no width.
    rows : Creepages
        Creepages of the rows, (patches, strips).
    """

    point: NDArray[np.intp]
    side: NDArray[np.intp]
    number: NDArray[np.intp]
    force: Array
    across: Array
    upright: Array
    arc: Array
    rail_arc: Array
    radius: Array
    rail_z: Array
    approach: Array
    flange: Array
    sliding: Creepages
    a: Array
    b: Array
    strips: dict[str, Array]
    rows: Creepages

    @property
    def angle(self) -> Array:
        """Contact angle, outward coordinates [rad]."""
        return np.arctan2(-self.across, self.upright)

    @property
    def sign(self) -> Array:
        """1 on the right and -1 on the left."""
        return np.where(self.side == 1, 1.0, -1.0)

    def part(self, some: NDArray[np.bool_]) -> Patches:
        """Return some of the patches."""
        parts: dict[str, Any] = {
            name: array[some] for name, array in vars(self).items() if isinstance(array, np.ndarray)
        }
        parts["strips"] = {name: array[some] for name, array in self.strips.items()}
        parts |= {name: getattr(self, name).part(some) for name in ("sliding", "rows")}
        return Patches(**parts)

    def posed(self, task: Task, elastic: Elastic, rotation: Array, patch: Patch) -> wl.Problem:
        """Return the contact problem of the patches at speeds of rotation, (positions,) [rad/s]."""
        longitudinal, lateral, spin = self.sliding.at(rotation[self.point])
        speed = task.speed[self.point]
        fields: dict[str, Any] = {
            "a": self.a,
            "b": self.b,
            "shear_modulus": np.full(self.a.shape, elastic.shear_modulus),
            "poisson_ratio": np.full(self.a.shape, elastic.poisson_ratio),
            "density": np.full(self.a.shape, elastic.density),
            "friction_coefficient": task.friction_of(self.point, self.flange, speed * np.hypot(longitudinal, lateral)),
            "longitudinal_creepage": longitudinal,
            "lateral_creepage": lateral,
            "spin": spin,
            "rolling_speed": speed,
            "contact_angle": self.sign * self.angle,
            "conditions": {name: array[self.point] for name, array in task.conditions.items()},
        }
        if patch == "ellipse":
            return wl.Problem.ellipse_from_si(normal_force=self.force, **fields)
        slips = zip(
            ("longitudinal_creepage", "lateral_creepage", "spin"),
            self.rows.at(rotation[self.point][:, None]),
            strict=True,
        )
        strips = self.strips | dict(slips)
        return wl.Problem.of_strips(strips=wl.Strips(**strips), **fields)


def joined(parts: list[Patches]) -> Patches:
    """Return patches one after the other, with as many strips as the one with most of them."""
    if len(parts) == 1:
        return parts[0]
    most = max(part.strips["y"].shape[1] for part in parts)

    def together(arrays: list[Array]) -> Array:
        if arrays[0].ndim > 1:
            arrays = [np.pad(array, ((0, 0), (0, most - array.shape[1]))) for array in arrays]
        return np.concatenate(arrays)

    def moved(name: str) -> Creepages:
        still, turning = (
            tuple(
                together(list(arrays)) for arrays in zip(*(getattr(part, name)[which] for part in parts), strict=True)
            )
            for which in (0, 1)
        )
        return Creepages(still, turning)

    whole: dict[str, Any] = {
        name: together([getattr(part, name) for part in parts])
        for name, array in vars(parts[0]).items()
        if isinstance(array, np.ndarray)
    }
    strips = {name: together([part.strips[name] for part in parts]) for name in parts[0].strips}
    return Patches(**whole, strips=strips, sliding=moved("sliding"), rows=moved("rows"))
