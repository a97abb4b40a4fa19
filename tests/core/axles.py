"""Rigs with several patches: an axle with two wheels, as ellipses or strips, with or without places on the profile."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

import wearlaw as wl
from wearlaw import Array, Q

RADIUS, CONICITY, FLANGE = 0.46, 0.05, 6e-3
WHEEL = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
PATCHES: Mapping[str, tuple[str | int, ...]] = {"side": ("left", "right"), "patch": (1, 2)}
CREEP: Any = {"longitudinal_creepage": "0.2 %", "spin": "0.3 1/m", "friction_coefficient": 0.3}
GIVEN: Any = {"load": "80 kN", "displacement": Q([0.0, 5.0, 7.0], "mm"), **CREEP}
EXISTS = np.array([[[1, 0], [1, 0]], [[1, 0], [1, 0]], [[1, 0], [1, 1]]], dtype=bool)
SHARE = 0.25


def lifted(unit: str, value: wl.QuantityLike, name: str) -> Array:
    """Return a condition in SI with axes of length one for sides and patches."""
    return wl.Unit(unit, positive=False).si(value, name)[..., None, None]


class Axle(wl.Rig):
    """Two wheels; beyond a displacement of 6 mm the right one also touches with its flange, which takes a quarter."""

    name: ClassVar[str] = "axle"
    source: ClassVar[str] = "a test"
    creepage: ClassVar[str] = "longitudinal_creepage"
    example: ClassVar[Mapping[str, Any]] = {**CREEP, "load": "80 kN", "displacement": "7 mm"}
    dims: ClassVar[Mapping[str, tuple[str | int, ...]]] = PATCHES

    @classmethod
    def conditions(cls) -> Mapping[str, wl.Condition]:
        """Return the conditions of the example."""
        return {name: wl.Condition(name, required=True) for name in cls.example}

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """Those of one wheel."""
        return WHEEL.bodies

    def problem(
        self,
        *,
        load: wl.QuantityLike,
        displacement: wl.QuantityLike,
        longitudinal_creepage: wl.QuantityLike,
        spin: wl.QuantityLike,
        friction_coefficient: Any,
    ) -> wl.Problem:
        """Return the problem of four patches, of which there are two or three."""
        place = lifted("mm", displacement, "displacement")
        creepages: Any = {
            "longitudinal_creepage": Q(lifted("", longitudinal_creepage, "longitudinal_creepage"), ""),
            "spin": Q(lifted("1/m", spin, "spin"), "1/m"),
            "friction_coefficient": wl.coefficient(friction_coefficient, "friction_coefficient")[..., None, None],
        }
        flange, right = np.array([0.0, 1.0]), np.array([[-1.0], [1.0]])
        exists = (flange == 0.0) | ((place > FLANGE) & (right > 0.0))
        two = (right > 0.0) & (place > FLANGE)
        share = np.where(two, np.where(flange > 0.0, SHARE, 1.0 - SHARE), 1.0)
        found = WHEEL.problem(normal_force=Q(share * lifted("N", load, "load"), "N"), **creepages)
        exists = np.broadcast_to(exists, found.batch_shape)
        radius = np.broadcast_to(RADIUS + CONICITY * right * place, exists.shape)
        bodies = {"wheel": wl.Body(WHEEL.material, radius), "rail": found.bodies["rail"]}
        return found.replaced(dims=self.dims, exists=exists, bodies=bodies)


KTH = wl.wear_law("kth")
PREDICT: Any = Axle() | wl.contact_model("fastsim") | KTH
ALONE: Any = WHEEL | wl.contact_model("fastsim") | KTH


class Cut(Axle):
    """The patches of the axle cut into strips."""

    name: ClassVar[str] = "cut"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with strips at even angles, with Hertz's pressure in their middles."""
        found = super().problem(**conditions)
        angle = np.pi / (STRIPS + 1) * np.arange(STRIPS, 0, -1)
        root = np.sin(angle)
        strips = wl.Strips(
            y=found.b[..., None] * np.cos(angle),
            width=found.b[..., None] * np.pi / (STRIPS + 1) * root,
            half_length=found.a[..., None] * root,
            max_pressure=found.max_pressure[..., None] * root,
        )
        return found.replaced(geometry="strips", strips=strips, normal_force=strips.normal_force.sum(axis=-1))


class Worn(Cut):
    """The axle with patches of either shape."""

    name: ClassVar[str] = "worn"
    hertzian: bool = True
    """Whether the patches are ellipses."""

    @property
    def patch_geometry(self) -> wl.Geometry:
        """The shape that the field chooses."""
        return "ellipse" if self.hertzian else "strips"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem of ellipses or strips."""
        return (Axle() if self.hertzian else Cut()).problem(**conditions)


class Placed(Worn):
    """The axle with patches of either shape and their places on the profiles; y is to the right, arcs run outwards."""

    name: ClassVar[str] = "placed"
    flange_at: float = -30e-3
    """Position of the flange's patch along the profile of the wheel [m]."""

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with positions, of the rail 1 mm further out."""
        found = super().problem(**conditions)
        place = wl.Unit("mm", positive=False).si(conditions["displacement"], "displacement")[..., None, None]
        outwards = np.array([[-1.0], [1.0]])
        position = outwards * -0.5 * place + np.array([0.0, self.flange_at])
        bodies = {
            name: dataclasses.replace(body, profile_position=position + shift, profile_direction=outwards)
            for (name, body), shift in zip(found.bodies.items(), (0.0, 1e-3), strict=True)
        }
        return found.replaced(bodies=bodies)


STRIPS = 12
CUT: Any = Cut() | wl.contact_model("fastsim") | KTH
LOADS = Q(np.array([[[80.0, np.nan]] * 2] * 2 + [[[80.0, np.nan], [60.0, 20.0]]]), "kN")


def of(prediction: wl.Prediction, name: str) -> Array:
    """Return a property as an array in SI."""
    return np.asarray(getattr(prediction, name).to_base_units().magnitude)


class Warns(Axle):
    """Warns of large displacements."""

    name: ClassVar[str] = "warns"

    def problem(self, *, displacement: wl.QuantityLike, **conditions: Any) -> wl.Problem:
        most = float(wl.Unit("mm", positive=False).si(displacement, "displacement").max())
        if most > 6e-3:
            warnings.warn(f"the wheel climbs at {1e3 * most:g} mm", wl.RangeWarning, stacklevel=2)
        return super().problem(displacement=displacement, **conditions)
