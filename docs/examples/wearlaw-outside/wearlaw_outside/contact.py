"""A contact model of rigid bodies."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

import wearlaw as wl


class Rigid(wl.LineContactModel):
    """The whole patch slips with the creepage under the traction μp."""

    name: ClassVar[str] = "rigid"
    source: ClassVar[str] = "Amontons' law of friction"

    @property
    def exemptions(self) -> Mapping[wl.Claim, str]:
        """Return the claims that the model does not make."""
        return {"initial_slope": "rigid bodies slip at any creepage"}

    def slip_length(self, problem: wl.Problem) -> wl.Array:
        """Return the length of the whole patch, or nothing at zero creepage."""
        return np.where(problem.creepage > 0, 2.0 * problem.half_width, 0.0)

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        """Return traction at its bound and slip equal to the creepage."""
        pressure = wl.hertz.pressure(nodes.x, problem.half_width, problem.max_pressure)
        bound = problem.friction_coefficient * pressure
        traction = np.where(problem.creepage > 0, bound, 0.0)
        slip = np.broadcast_to(problem.creepage, pressure.shape)
        return wl.LineFields(pressure=pressure, traction=traction, slip=slip, traction_bound=bound)

    def tangential_force_per_width(self, problem: wl.Problem) -> wl.Array:
        """Return μP [N/m]."""
        return np.where(problem.creepage > 0, problem.friction_coefficient * problem.normal_force_per_width, 0.0)
