"""The solved contact: the record that a contact model returns and a wear law reads.

It is frozen and holds SI float64 arrays. Its first axes are the *batch*, one entry an operating point; a scalar
prediction has no batch axis. The axes behind the batch are the *nodes* of the patch.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Self

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.errors import InputError
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, from_si

NODE_VARIABLES = ("pressure", "traction", "slip", "slip_speed", "wear_index_density")
"""The variables of a `Contact` that differ from node to node."""

UNITS = {
    "pressure": "MPa",
    "traction": "MPa",
    "traction_bound": "MPa",
    "slip": "%",
    "slip_speed": "m/s",
    "wear_index": "N",
    "wear_index_density": "N/mm^2",
    "x": "mm",
}
"""The units in which variables of a `Contact` are shown; the record itself holds SI."""

_FROM_ARRAYS = {
    "pressure": Unit("MPa", positive=False),
    "traction": Unit("MPa", positive=False),
    "slip": Unit("", positive=False),
    "area": Unit("mm^2", positive=False),
}


ONE_SIGN = 1e-9
"""Share of traction of the other sign that passes for rounding; it moves the mean slip by no more."""


def _broadcast(arrays: dict[str, Array], batch_axes: int) -> dict[str, Array]:
    """Return the arrays of nodes in one shape, which has the batch axes and at least one more."""
    shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        raise InputError(f"the shapes of the arrays do not broadcast: {shapes}") from None
    if len(shape) <= batch_axes or 0 in shape:
        raise InputError(f"there must be at least one node behind the {batch_axes} axes of rolling_speed; got {shapes}")
    return {name: np.broadcast_to(array, shape) for name, array in arrays.items()}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineFields:
    """Pressure, traction, slip and traction bound at points of a line contact, as in `Contact`."""

    pressure: Array
    traction: Array
    slip: Array
    traction_bound: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contact:
    """A solved contact: pressure, traction and slip at the nodes of the patch, and the totals.

    A node is a point with an area weight. Uniform cells, the nodes of a quadrature and the single cell of a
    global model are all this one record, so that a wear law is written once for all of them.

    Attributes
    ----------
    pressure : ndarray, (batch, nodes)
        Normal pressure, p [Pa].
    traction : ndarray, (batch, nodes)
        Tangential traction, q [Pa], with the sign of the creepage.
    slip : ndarray, (batch, nodes)
        Relative slip, s [-], the slip velocity over the rolling speed, with the sign of the creepage; zero in stick.
    traction_bound : ndarray, (batch, nodes)
        The largest magnitude that the model allows for the traction [Pa].
    area : ndarray, (batch, nodes)
        Area of the patch that the node stands for [m²].
    x : ndarray, (batch, nodes)
        Position along the rolling direction, from the leading to the trailing edge, x [m].
    rolling_speed : ndarray, (batch)
        Rolling speed, V [m/s].
    normal_force : ndarray, (batch)
        Normal force, N [N].
    tangential_force : ndarray, (batch)
        Tangential force, T [N], with the sign of the creepage.
    wear_index : ndarray, (batch)
        Wear index, Tγ [N], the energy dissipated per metre rolled.
    density : ndarray, (batch)
        Mass density of the body whose wear is predicted, ρ [kg/m³].
    """

    pressure: Array
    traction: Array
    slip: Array
    traction_bound: Array
    area: Array
    x: Array
    rolling_speed: Array
    normal_force: Array
    tangential_force: Array
    wear_index: Array
    density: Array

    @classmethod
    def from_line(
        cls, problem: Problem, fields: LineFields, *, x: Array, length: Array, force_per_width: Array
    ) -> Self:
        """Return the contact that a solution of a line problem makes over the whole track width.

        Parameters
        ----------
        problem : Problem
            The problem that was solved.
        fields : LineFields
            The solution at the nodes, each of shape (batch, nodes).
        x, length : ndarray, (batch, nodes)
            Position of each node and the length that it stands for [m].
        force_per_width : ndarray, (batch)
            T [N/m], with the sign of the creepage.
        """
        force = force_per_width * problem.track_width
        return cls(
            pressure=fields.pressure,
            traction=fields.traction,
            slip=fields.slip,
            traction_bound=fields.traction_bound,
            area=length * problem.track_width[..., None],
            x=x,
            rolling_speed=problem.rolling_speed,
            normal_force=problem.normal_force,
            tangential_force=force,
            wear_index=force * problem.creepage,
            density=problem.density,
        )

    @classmethod
    def from_arrays(
        cls,
        *,
        pressure: QuantityLike,
        traction: QuantityLike,
        slip: QuantityLike,
        area: QuantityLike,
        rolling_speed: QuantityLike,
        density: QuantityLike = "7850 kg/m^3",
    ) -> Self:
        """Return a contact that was solved elsewhere, by a multibody or boundary-element program.

        Parameters
        ----------
        pressure, traction, slip, area : Quantity, (batch, nodes)
            Pressure [Pa], traction [Pa], relative slip [-] and area [m²] of each node; they broadcast against each
            other. Traction and slip have one sign, or are magnitudes, and there may be several axes of nodes.
        rolling_speed, density : Quantity, (batch)
            Rolling speed [m/s] and mass density of the body whose wear is predicted [kg/m³].

        Raises
        ------
        UnitError
            If a value lacks its unit or is out of bounds.
        InputError
            If the shapes do not broadcast, traction and slip have opposite signs anywhere, or traction has both signs
            in one contact.
        """
        given = {"pressure": pressure, "traction": traction, "slip": slip, "area": area}
        speed = Unit("m/s").si(rolling_speed, "rolling_speed")
        nodes = _broadcast({name: _FROM_ARRAYS[name].si(value, name) for name, value in given.items()}, speed.ndim)
        p, q, s, a = nodes.values()
        axes = tuple(range(speed.ndim, p.ndim))
        if (p < 0).any():
            raise InputError("pressure: must not be negative; a pressure that presses the bodies together is positive")
        if (a < 0).any() or not (a.sum(axis=axes) > 0).all():
            raise InputError("area: must not be negative, and not zero at all nodes of a contact")
        if (q * s < 0).any():
            raise InputError("traction and slip: must have the same sign at every node; turn the sign of one of them")
        force, magnitude = (q * a).sum(axis=axes), (np.abs(q) * a).sum(axis=axes)
        if (magnitude - np.abs(force) > ONE_SIGN * magnitude).any():
            raise InputError(
                "traction: has both signs in one contact, so that its sum is not the force that dissipates; give"
                " traction and slip as magnitudes"
            )
        return cls(
            **nodes,
            traction_bound=np.full(p.shape, np.inf),
            x=np.zeros(p.shape),
            rolling_speed=speed,
            normal_force=(p * a).sum(axis=axes),
            tangential_force=force,
            wear_index=(q * s * a).sum(axis=axes),
            density=np.broadcast_to(Unit("kg/m^3").si(density, "density"), speed.shape),
        )

    @property
    def wear_index_density(self) -> Array:
        """Energy dissipated per metre rolled and area, q·s [N/m²], of shape (batch, nodes)."""
        return self.traction * self.slip

    @property
    def slip_speed(self) -> Array:
        """Magnitude of the slip velocity, sV [m/s], of shape (batch, nodes)."""
        return np.abs(self.slip) * self.per_node(self.rolling_speed)

    @property
    def patch_area(self) -> Array:
        """Area of the whole patch, A [m²], of the batch shape."""
        return self.sum_over_nodes(self.area)

    def per_node(self, value: Array) -> Array:
        """Return a value of the batch shape with axes of length one for the nodes, to broadcast over them."""
        return value.reshape(value.shape + (1,) * (self.pressure.ndim - value.ndim))

    def sum_over_nodes(self, value: Array) -> Array:
        """Return the plain sum over the nodes, of the batch shape."""
        total: Array = value.sum(axis=tuple(range(self.rolling_speed.ndim, value.ndim)))
        return total

    def mean(self, value: Array) -> Array:
        """Return the area mean of a value at the nodes, of the batch shape."""
        return self.sum_over_nodes(value * self.area) / self.patch_area

    @property
    def mean_slip(self) -> Array:
        """Area mean of the magnitude of the slip over the patch, stick included [-], of the batch shape."""
        return self.mean(np.abs(self.slip))

    @property
    def slip_area(self) -> Array:
        """Area of the part of the patch that slips [m²], of the batch shape."""
        return self.sum_over_nodes(np.where(self.slip != 0, self.area, 0.0))

    @property
    def stick_ratio(self) -> Array:
        """Share of the patch's area that sticks [-], of the batch shape."""
        return 1.0 - self.slip_area / self.patch_area

    @property
    def cell_wear_index(self) -> Array:
        """Energy dissipated per metre rolled, ∑ q·s dA over the nodes [N], of the batch shape."""
        return self.sum_over_nodes(self.wear_index_density * self.area)

    @property
    def traction_x(self) -> Array:
        """Longitudinal component of the traction, q_x [Pa]; on a line the traction."""
        return self.traction

    @property
    def traction_y(self) -> Array:
        """Lateral component of the traction, q_y [Pa]; on a line zero."""
        return np.zeros_like(self.traction)

    @property
    def slip_x(self) -> Array:
        """Longitudinal component of the relative slip, s_x [-]; on a line the slip."""
        return self.slip

    @property
    def slip_y(self) -> Array:
        """Lateral component of the relative slip, s_y [-]; on a line zero."""
        return np.zeros_like(self.slip)

    @property
    def y(self) -> Array:
        """Position across the rolling direction [m]; on a line zero, its middle."""
        return np.zeros_like(self.x)

    @property
    def force_x(self) -> Array:
        """Longitudinal force [N], with the sign of the longitudinal creepage; on a line the tangential force."""
        return self.tangential_force

    @property
    def force_y(self) -> Array:
        """Lateral force [N]; on a line zero."""
        return np.zeros_like(self.tangential_force)

    @property
    def moment_z(self) -> Array:
        """Spin moment [N m]; on a line zero."""
        return np.zeros_like(self.tangential_force)

    @property
    def forces(self) -> CreepForces:
        """The forces and the moment that the contact transmits."""
        return CreepForces(longitudinal=self.force_x, lateral=self.force_y, spin_moment=self.moment_z)

    @property
    def longitudinal_force(self) -> Quantity:
        """Longitudinal force, Fx [N], with the sign of the creepage."""
        return from_si(self.force_x, "N")

    @property
    def lateral_force(self) -> Quantity:
        """Lateral force, Fy [N], with the sign of the creepage."""
        return from_si(self.force_y, "N")

    @property
    def spin_moment(self) -> Quantity:
        """Spin moment, Mz [N m], with the sign of the spin."""
        return from_si(self.moment_z, "N*m")

    def with_batch(self, shape: tuple[int, ...]) -> Self:
        """Return the contact with its one batch axis reshaped."""
        fields = ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))
        return self.replaced(**{name: value.reshape(shape + value.shape[1:]) for name, value in fields})

    def replaced(self, **arrays: Array) -> Self:
        """Return the contact with some of its arrays replaced."""
        return dataclasses.replace(self, **arrays)

    def patch_mean(self) -> Contact:
        """Return the contact of one node that holds the patch means.

        Pressure and traction are area means; the slip is the one that dissipates the same energy,
        s = Tγ / T, which is the creepage.
        """
        force = self.tangential_force
        slip = np.divide(self.wear_index, force, out=np.zeros_like(force), where=force != 0)
        area = self.patch_area
        return Contact(
            pressure=(self.normal_force / area)[..., None],
            traction=(force / area)[..., None],
            slip=slip[..., None],
            traction_bound=self.mean(np.where(self.area > 0.0, self.traction_bound, 0.0))[..., None],
            area=area[..., None],
            x=np.zeros_like(area)[..., None],
            rolling_speed=self.rolling_speed,
            normal_force=self.normal_force,
            tangential_force=force,
            wear_index=self.wear_index,
            density=self.density,
        )
