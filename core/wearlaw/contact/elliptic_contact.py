"""The solved elliptic contact: a `Contact` whose traction and slip are vectors, on strips in rolling direction."""

# Fields stand here for properties of `Contact`, which frozen records may: neither can be written to.
# pyright: reportIncompatibleMethodOverride=false

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact import hertz_ellipse
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.errors import InputError

TOTALS = (
    "rolling_speed", "normal_force", "tangential_force", "wear_index", "density",
    "force_x", "force_y", "moment_z", "rigid_slip",
)  # fmt: skip
"""The arrays of an `EllipticContact` that are of the batch shape."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EllipticContact(Contact):
    """A solved elliptic contact.

    The nodes have two axes, along a strip and from strip to strip; strips lie along the rolling direction, the last
    axis counts them. `traction` and `slip` are the magnitudes of the vectors, `wear_index_density` is their scalar
    product, and `wear_index` is Tγ = ξFx + ηFy + φMz.

    Attributes
    ----------
    traction_x : ndarray, (batch, nodes, strips)
        Longitudinal component of the traction, q_x [Pa], positive in the rolling direction, against x.
    traction_y : ndarray, (batch, nodes, strips)
        Lateral component of the traction, q_y [Pa].
    slip_x : ndarray, (batch, nodes, strips)
        Longitudinal component of the relative slip, s_x [-], positive in the rolling direction, against x.
    slip_y : ndarray, (batch, nodes, strips)
        Lateral component of the relative slip, s_y [-].
    y : ndarray, (batch, nodes, strips)
        Position across the rolling direction [m].
    strip_width : ndarray, (batch, strips)
        Width of the patch that a strip stands for [m].
    force_x : ndarray, (batch)
        Longitudinal force [N], with the sign of the longitudinal creepage.
    force_y : ndarray, (batch)
        Lateral force [N], with the sign of the lateral creepage and of the spin.
    moment_z : ndarray, (batch)
        Spin moment [N m], with the sign of the spin.
    rigid_slip : ndarray, (batch)
        Root mean square of the rigid slip over the patch [-].
    """

    # `field()`, or the properties of `Contact` would be taken for defaults
    traction_x: Array = field()
    traction_y: Array = field()
    slip_x: Array = field()
    slip_y: Array = field()
    y: Array = field()
    strip_width: Array
    force_x: Array = field()
    force_y: Array = field()
    moment_z: Array = field()
    rigid_slip: Array

    @classmethod
    def from_strips(
        cls,
        problem: Problem,
        forces: CreepForces,
        *,
        x: Array,
        y: Array,
        length: Array,
        strip_width: Array,
        traction: tuple[Array, Array],
        slip: tuple[Array, Array],
        traction_bound: Array,
    ) -> Self:
        """Return the contact that a model found on strips; the pressure is Hertz's.

        Parameters
        ----------
        problem : Problem
            The problem that was solved.
        forces : CreepForces
            The totals.
        x, length : ndarray, (batch, nodes, strips)
            Position of each node and the length along its strip that it stands for [m].
        y, strip_width : ndarray, (batch, strips)
            Position of each strip and the width that it stands for [m].
        traction, slip : pair of ndarray, (batch, nodes, strips)
            Their components along x and y [Pa], [-].
        traction_bound : ndarray, (batch, nodes, strips)
            The largest magnitude that the model allows for the traction [Pa].
        """
        a, b = problem.a[..., None, None], problem.b[..., None, None]
        across = y[..., None, :]
        return cls(
            pressure=hertz_ellipse.pressure(x, across, a, b, problem.max_pressure[..., None, None]),
            traction=_magnitude(*traction),
            slip=_magnitude(*slip),
            traction_bound=traction_bound,
            area=length * strip_width[..., None, :],
            x=x,
            y=np.broadcast_to(across, x.shape),
            strip_width=strip_width,
            traction_x=traction[0],
            traction_y=traction[1],
            slip_x=slip[0],
            slip_y=slip[1],
            **_totals(problem, forces),
        )

    @classmethod
    def of_patch(cls, problem: Problem, forces: CreepForces) -> Self:
        """Return the contact of one node that holds the patch means, of a model that knows the forces alone.

        Its slip is the root mean square of the rigid slip, its components those in the centre, and its
        `wear_index_density` is Tγ/A.
        """
        area = problem.patch_area
        bound = problem.friction_coefficient * problem.normal_force / area
        creepages = problem.longitudinal_creepage, problem.lateral_creepage
        return cls._of_one_node(_totals(problem, forces), area, bound, creepages, 2.0 * problem.b)

    def patch_mean(self) -> EllipticContact:
        """Return the contact of one node that holds the patch means, as `of_patch` does; its slip has no direction."""
        totals = {name: getattr(self, name) for name in TOTALS}
        nowhere = np.zeros_like(self.force_x)
        width = self.strip_width.sum(axis=-1)
        bound = self.mean(self.traction_bound)
        return self._of_one_node(totals, self.patch_area, bound, (nowhere, nowhere), width)

    @classmethod
    def _of_one_node(
        cls, totals: dict[str, Array], area: Array, bound: Array, creepages: tuple[Array, Array], width: Array
    ) -> Self:
        nodes = {
            "pressure": totals["normal_force"] / area,
            "traction": totals["tangential_force"] / area,
            "slip": totals["rigid_slip"],
            "traction_bound": bound,
            "area": area,
            "traction_x": totals["force_x"] / area,
            "traction_y": totals["force_y"] / area,
            "slip_x": creepages[0],
            "slip_y": creepages[1],
            "x": np.zeros_like(area),
            "y": np.zeros_like(area),
        }
        return cls(
            **{name: value[..., None, None] for name, value in nodes.items()}, strip_width=width[..., None], **totals
        )

    @property
    def wear_index_density(self) -> Array:
        """Energy dissipated per metre rolled and area, q·s [N/m²], of shape (batch, nodes, strips).

        Of one node that stands for the patch it is Tγ/A.
        """
        if self.pressure.shape[self.rolling_speed.ndim :] == (1, 1):
            return self.per_node(self.wear_index / self.patch_area)
        return self.traction_x * self.slip_x + self.traction_y * self.slip_y

    def scaled_to_wear_index(self) -> Self:
        """Return the contact with slips scaled so that what the nodes dissipate is Tγ.

        Raises
        ------
        InputError
            If no node dissipates energy where Tγ is not zero.
        """
        dissipated = self.cell_wear_index
        if ((dissipated == 0) & (self.wear_index != 0)).any():
            raise InputError("scaled_to_wear_index: no node of the contact dissipates energy, but Tγ is not zero")
        factor = np.divide(self.wear_index, dissipated, out=np.ones_like(dissipated), where=dissipated > 0)
        over_nodes = factor[..., None, None]
        return self.replaced(
            slip=self.slip * over_nodes, slip_x=self.slip_x * over_nodes, slip_y=self.slip_y * over_nodes
        )

    def over_strip(self, value: Array) -> Array:
        """Return ∫ value dx along each strip, of shape (batch, strips)."""
        length = self.area / self.strip_width[..., None, :]
        integral: Array = (value * length).sum(axis=-2)
        return integral


def _magnitude(x: Array, y: Array) -> Array:
    """Return √(x² + y²), five times as fast as `np.hypot`, whose care no traction or slip needs."""
    magnitude: Array = np.sqrt(x * x + y * y)
    return magnitude


def _totals(problem: Problem, forces: CreepForces) -> dict[str, Array]:
    return {
        "rolling_speed": problem.rolling_speed,
        "normal_force": problem.normal_force,
        "tangential_force": forces.tangential,
        "wear_index": problem.power(forces),
        "density": problem.density,
        "force_x": forces.longitudinal,
        "force_y": forces.lateral,
        "moment_z": forces.spin_moment,
        "rigid_slip": problem.rigid_slip,
    }
