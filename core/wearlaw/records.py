"""The records that pass from stage to stage: `LineProblem` into a contact model, `Contact` out of it.

Both are frozen and hold SI float64 arrays. Their first axes are the *batch*, one entry an operating point;
a scalar prediction has no batch axis. The axes of `Contact` behind the batch are the *nodes* of the patch.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from wearlaw.arrays import Array

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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineProblem:
    """Hertzian line contact between two rolling bodies: what a contact model is asked to solve.

    All arrays are of the batch shape. Lengths lie along the rolling direction x, which runs from the leading
    edge at x = -half_width to the trailing edge at x = half_width.

    Attributes
    ----------
    normal_force_per_width : ndarray
        P [N/m].
    half_width : ndarray
        Half the patch's length in the rolling direction, a [m].
    max_pressure : ndarray
        Hertz's maximum pressure, p0 [Pa].
    relative_radius : ndarray
        R [m], 1/R = 1/R1 + 1/R2.
    effective_modulus : ndarray
        E* [Pa], 1/E* = (1-ν1²)/E1 + (1-ν2²)/E2.
    friction_coefficient : ndarray
        μ [-].
    creepage : ndarray
        ξ [-], with its sign; positive where disc 1 is the faster one.
    rolling_speed : ndarray
        V [m/s].
    track_width : ndarray
        Width of the patch across the rolling direction [m].
    density : ndarray
        Mass density of the body whose wear is predicted [kg/m³].
    traction_coefficient : ndarray or None
        Measured tangential over normal force [-], where the test gave one.
    """

    normal_force_per_width: Array
    half_width: Array
    max_pressure: Array
    relative_radius: Array
    effective_modulus: Array
    friction_coefficient: Array
    creepage: Array
    rolling_speed: Array
    track_width: Array
    density: Array
    traction_coefficient: Array | None = None

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """The shape of the batch, () for one operating point."""
        return self.creepage.shape

    @property
    def normal_force(self) -> Array:
        """Normal force on the whole width [N]."""
        return self.normal_force_per_width * self.track_width

    @property
    def patch_area(self) -> Array:
        """Area of the patch, 2 a × width [m²]."""
        return 2.0 * self.half_width * self.track_width

    def __getitem__(self, index: Any) -> Self:
        """Return the problem at some operating points of the batch; `index` is any NumPy index."""
        return self._map(lambda array: array[index])

    def flatten(self) -> Self:
        """Return the problem with its batch as one axis."""
        return self._map(lambda array: array.reshape(-1))

    def _map(self, function: Callable[[Array], Array]) -> Self:
        fields = ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))
        mapped: dict[str, Any] = {name: function(array) for name, array in fields if array is not None}
        return type(self)(**mapped)


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
        Normal pressure p [Pa].
    traction : ndarray, (batch, nodes)
        Tangential traction q [Pa], with the sign of the creepage.
    slip : ndarray, (batch, nodes)
        Relative slip s = slip velocity over rolling speed [-], with the sign of the creepage; zero in stick.
    traction_bound : ndarray, (batch, nodes)
        The largest magnitude that the model allows for the traction [Pa].
    area : ndarray, (batch, nodes)
        Area of the patch that the node stands for [m²].
    x : ndarray, (batch, nodes)
        Position along the rolling direction, from the leading to the trailing edge [m].
    rolling_speed : ndarray, (batch)
        V [m/s].
    normal_force : ndarray, (batch)
        N [N].
    tangential_force : ndarray, (batch)
        T [N], with the sign of the creepage.
    wear_index : ndarray, (batch)
        Tγ [N], the energy dissipated per metre rolled.
    density : ndarray, (batch)
        Mass density of the body whose wear is predicted [kg/m³].
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
        cls, problem: LineProblem, fields: LineFields, *, x: Array, length: Array, force_per_width: Array
    ) -> Self:
        """Return the contact that a solution of a line problem makes over the whole track width.

        Parameters
        ----------
        problem : LineProblem
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

    @property
    def wear_index_density(self) -> Array:
        """Energy dissipated per metre rolled and area, q·s [N/m²], of shape (batch, nodes)."""
        return self.traction * self.slip

    @property
    def slip_speed(self) -> Array:
        """Magnitude of the slip velocity, s V [m/s], of shape (batch, nodes)."""
        return np.abs(self.slip) * self.per_node(self.rolling_speed)

    @property
    def patch_area(self) -> Array:
        """Area of the whole patch [m²], of the batch shape."""
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

    def with_batch(self, shape: tuple[int, ...]) -> Contact:
        """Return the contact with its one batch axis reshaped."""
        fields = ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))
        return Contact(**{name: value.reshape(shape + value.shape[1:]) for name, value in fields})

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
            traction_bound=self.mean(self.traction_bound)[..., None],
            area=area[..., None],
            x=np.zeros_like(area)[..., None],
            rolling_speed=self.rolling_speed,
            normal_force=self.normal_force,
            tangential_force=force,
            wear_index=self.wear_index,
            density=self.density,
        )
