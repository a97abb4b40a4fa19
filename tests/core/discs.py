"""A rig of two unlike discs, with its contact once more by hand."""

from __future__ import annotations

from typing import Any

import wearlaw as wl
from tests import reference
from wearlaw import Q

RIG = wl.TwinDisc.suros(
    disc_2=wl.Disc(diameter="60 mm", material=wl.steel(density="7100 kg/m^3", youngs_modulus="190 GPa")),
    track_width="8 mm",
)
LAW = wl.wear_law("usfd", fitted_for="exact")
PREDICT = RIG | wl.contact_model("exact") | LAW
FORCE, FRICTION = 6000.0, 0.4
CONDITIONS: Any = {"normal_force": Q(FORCE, "N"), "friction_coefficient": FRICTION}

# The rig again, by hand.
WIDTH, DIAMETERS, DENSITIES = 8e-3, {"disc_1": 47e-3, "disc_2": 60e-3}, {"disc_1": 7850.0, "disc_2": 7100.0}
RADIUS = 23.5e-3 * 30e-3 / 53.5e-3
MODULUS = 1.0 / ((1 - 0.28**2) / 206.47742e9 + (1 - 0.28**2) / 190e9)
TABLE_4 = (5.3, 55.0, 83.7, 95.0)
"""The parameters of the law, of Tassini et al. (2010), exact."""


def solved(creepage: float) -> reference.Solution:
    """Return Carter's solution."""
    return reference.exact(reference.Point(FORCE / WIDTH, RADIUS, MODULUS, FRICTION, creepage))


HALF_WIDTH = solved(1.0).point.half_width
