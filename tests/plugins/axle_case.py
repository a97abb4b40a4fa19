"""A rig whose bodies touch in several places, and a case of it; `install(*AXLES)` makes it a plugin."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

import wearlaw as wl
from tests.cases import Table
from tests.core.axles import CONICITY, FLANGE, RADIUS, WHEEL

LEFT_OR_RIGHT = np.array([[-1.0], [1.0]])
TREAD_OR_FLANGE = np.array([False, True])
SIDES, PATCHES = ("left", "right"), (1, 2)


class Axle(wl.Rig):
    """Two wheels with a cone of 1 in 20; beyond a displacement of 6 mm the flange takes a quarter of a wheel's load."""

    name: ClassVar[str] = "axle"
    source: ClassVar[str] = "a test"
    creepage: ClassVar[str] = "displacement"
    example: ClassVar[Mapping[str, Any]] = {
        "load": "80 kN",
        "displacement": "6.5 mm",
        "driving": "0.1 %",
        "friction_coefficient": 0.3,
    }

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """Those of one wheel."""
        return WHEEL.bodies

    def problem(
        self,
        *,
        load: wl.QuantityLike,
        displacement: wl.QuantityLike,
        driving: wl.QuantityLike = "0 %",
        friction_coefficient: ArrayLike = 0.3,
    ) -> wl.Problem:
        """Return the problem of four patches, of which there are two or three."""
        moved = wl.Unit("mm", positive=False).si(displacement, "displacement")[..., None, None]
        slip = wl.Unit("", positive=False, limit=0.9).si(driving, "driving")[..., None, None]
        on_wheel = wl.Unit("kN").si(load, "load")[..., None, None]
        friction = wl.coefficient(friction_coefficient, "friction_coefficient")[..., None, None]
        both = moved * LEFT_OR_RIGHT > FLANGE
        share = np.where(both, np.where(TREAD_OR_FLANGE, 0.25, 0.75), 1.0)
        found = WHEEL.problem(
            normal_force=wl.Q(share * on_wheel, "N"),
            longitudinal_creepage=wl.Q(slip - CONICITY * LEFT_OR_RIGHT * moved / RADIUS, ""),
            friction_coefficient=friction,
        )
        exists = np.broadcast_to(~TREAD_OR_FLANGE | both, found.batch_shape).copy()
        radius = np.broadcast_to(RADIUS + CONICITY * LEFT_OR_RIGHT * moved, found.batch_shape)
        bodies = {"wheel": wl.Body(WHEEL.material, radius), "rail": found.bodies["rail"]}
        return found.replaced(dims={"side": SIDES, "patch": PATCHES}, exists=exists, bodies=bodies)


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Rig]]:
    """Return the rig."""
    return [Axle]


AXLES = ("axles", "from tests.plugins.axle_case import wearlaw_models")
"""Name and source of the plugin."""

MOVED = np.array([-7.0, -3.0, 0.0, 3.0, 7.0])
"""Displacements of the case [mm]; each flange touches at one end."""

EXISTS = np.stack([np.stack([np.full(5, True), side * MOVED > 6.0], axis=-1) for side in (-1.0, 1.0)], axis=1)
"""Which patches exist, (displacements, sides, patches)."""

MOVING: Table = {
    "load": "80 kN",
    "displacement": [f"{one:g} mm" for one in MOVED],
    "driving": "0.05 %",
    "friction_coefficient": 0.3,
}
FLANGING: Table = {**MOVING, "displacement": "7 mm"}
ON_AXLE: Table = {
    "title": "A small study of an axle",
    "rig": {"type": "axle"},
    "contact_models": ["fastsim", "polach"],
    "wear_laws": ["usfd", "kth"],
    "sweeps": {"moving": MOVING, "flanging": FLANGING},
    "profiles": {"flanging": FLANGING},
}
