"""The solved contact: the record that a contact model returns and a wear law reads.

The record is frozen and holds SI float64 arrays, which are read-only, because all laws read the same ones. Its first
axes are the *batch*, with one entry for each operating point; a scalar prediction has no batch axis. The axes after the
batch are the *nodes* of the patch. An ellipse has two of them, along a strip and from strip to strip.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
import pint

from wearlaw.arrays import Array, freeze
from wearlaw.contact import hertz_ellipse
from wearlaw.contact.conditions import broadcast
from wearlaw.contact.parts import Body, CreepForces, LineFields
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError
from wearlaw.units.quantities import Q, QuantityLike, parse, real_array, with_units
from wearlaw.units.registry import with_magnitude
from wearlaw.units.variables import expected

ONE_SIGN = 1e-9
"""Share of traction of the other sign that counts as rounding; it changes the mean slip by no more."""

SLIDING = 1e-9
"""Share of the rolling speed that counts as rounding in the slip of a body that slides without turning."""


_DERIVED: Any = None
"""Default of the fields that a line contact derives from other fields."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contact:
    """A solved contact: pressure, traction and slip at the nodes of the patch, and the totals.

    A node is a point with an area weight. Uniform cells, the nodes of a quadrature and the single cell of a global
    model all use this record, so that a wear law is written once for all of them. In a line contact, traction and slip
    lie along x, and their components across it are zero. On an ellipse, they are vectors. `Contact.from_line`,
    `Contact.from_strips` and `Contact.of_patch` make the record from a model's solution, `Contact.from_arrays` from
    the solution of another program.

    Attributes
    ----------
    pressure : ndarray, (batch, nodes)
        Normal pressure, p [Pa].
    traction : ndarray, (batch, nodes)
        Tangential traction, q [Pa], with the sign of the creepage; on an ellipse its magnitude.
    slip : ndarray, (batch, nodes)
        Relative slip, s [-], the slip velocity over the rolling speed, with the sign of the creepage, on an ellipse its
        magnitude; zero in the stick zone.
    traction_bound : ndarray, (batch, nodes)
        The largest magnitude that the model allows for the traction [Pa].
    area : ndarray, (batch, nodes)
        Area of the patch that the node represents [m²].
    x : ndarray, (batch, nodes)
        Position along the rolling direction, from the leading to the trailing edge, x [m].
    rolling_speed : ndarray, (batch)
        Rolling speed, V [m/s].
    normal_force : ndarray, (batch)
        Normal force, N [N].
    tangential_force : ndarray, (batch)
        Tangential force, T [N], with the sign of the creepage; on an ellipse √(Fx² + Fy²).
    wear_index : ndarray, (batch)
        Wear index, Tγ [N], ξFx + ηFy + φMz, the energy dissipated per metre rolled.
    density : ndarray, (batch)
        Mass density of the body whose wear is predicted, ρ [kg/m³].
    traction_x : ndarray, (batch, nodes)
        Longitudinal component of the traction, q_x [Pa], positive in the rolling direction, against x; on a line the
        traction.
    traction_y : ndarray, (batch, nodes)
        Lateral component of the traction, q_y [Pa]; on a line zero.
    slip_x : ndarray, (batch, nodes)
        Longitudinal component of the relative slip, s_x [-], positive in the rolling direction, against x; on a line
        the slip.
    slip_y : ndarray, (batch, nodes)
        Lateral component of the relative slip, s_y [-]; on a line zero.
    y : ndarray, (batch, nodes)
        Position across the rolling direction [m]; on a line zero, its middle.
    force_x : ndarray, (batch)
        Longitudinal force [N], with the sign of the longitudinal creepage; on a line the tangential force.
    force_y : ndarray, (batch)
        Lateral force [N], with the sign of the lateral creepage and of the spin; on a line zero.
    moment_z : ndarray, (batch)
        Spin moment [N m], with the sign of the spin; on a line zero.
    strip_width : ndarray, (batch, strips)
        Width of the patch that a strip of an ellipse represents [m]; a line has no strips.
    problem : Problem or None
        The solved problem; None for a contact solved elsewhere.
    conditions : mapping of str to ndarray, (batch)
        Further conditions in SI by name, which the models of the pipeline declare. Those of a contact solved elsewhere
        are quantities until a law reads them.
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
    traction_x: Array = _DERIVED
    traction_y: Array = _DERIVED
    slip_x: Array = _DERIVED
    slip_y: Array = _DERIVED
    y: Array = _DERIVED
    force_x: Array = _DERIVED
    force_y: Array = _DERIVED
    moment_z: Array = _DERIVED
    strip_width: Array = _DERIVED
    problem: Problem | None = None
    conditions: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Make the arrays read-only, and fill in the vector components of a contact without strips."""
        freeze(self, self.__slots__)
        fill = object.__setattr__  # the record is frozen
        if self.problem is not None and self.problem.conditions:
            fill(self, "conditions", {**self.conditions, **self.problem.conditions})
        if self.on_strips:
            return
        nothing, none = np.zeros(np.shape(self.traction)), np.zeros(np.shape(self.tangential_force))
        fill(self, "traction_x", self.traction)
        fill(self, "slip_x", self.slip)
        fill(self, "force_x", self.tangential_force)
        fill(self, "traction_y", nothing)
        fill(self, "slip_y", nothing)
        fill(self, "y", nothing)
        fill(self, "force_y", none)
        fill(self, "moment_z", none)
        fill(self, "strip_width", np.zeros((*none.shape, 0)))

    @property
    def on_strips(self) -> bool:
        """Whether the nodes lie on strips of an ellipse, where traction and slip are vectors."""
        return self.strip_width is not None and np.shape(self.strip_width)[-1:] != (0,)

    @classmethod
    def from_line(
        cls, problem: Problem, fields: LineFields, *, x: Array, length: Array, force_per_width: Array
    ) -> Self:
        """Return the contact for a solution of a line problem, over the whole track width.

        Parameters
        ----------
        problem : Problem
            The solved problem.
        fields : LineFields
            The solution at the nodes, each of shape (batch, nodes).
        x, length : ndarray, (batch, nodes)
            Position of each node and the length that it represents [m].
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
            problem=problem,
        )

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
        pressure: Array | None = None,
    ) -> Self:
        """Return the contact for a model's solution on strips of an ellipse, or on the strips of the problem.

        Parameters
        ----------
        problem : Problem
            The solved problem.
        forces : CreepForces
            The totals.
        x, length : ndarray, (batch, nodes, strips)
            Position of each node and the length along its strip that it represents [m].
        y, strip_width : ndarray, (batch, strips)
            Position of each strip and the width that it represents [m].
        traction, slip : pair of ndarray, (batch, nodes, strips)
            Components along x and y [Pa], [-].
        traction_bound : ndarray, (batch, nodes, strips)
            The largest magnitude that the model allows for the traction [Pa].
        pressure : ndarray, (batch, nodes, strips), optional
            The model's own normal pressure [Pa]; by default Hertz's, or the given one of the strips.
        """
        across = y[..., None, :]
        if pressure is None and problem.strips is not None:
            pressure = problem.strips.pressure(x)
        elif pressure is None:
            a, b, p0 = (array[..., None, None] for array in (problem.a, problem.b, problem.max_pressure))
            pressure = hertz_ellipse.pressure(x, across, a, b, p0)
        return cls(
            pressure=pressure,
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
            problem=problem,
            **_totals(problem, forces),
        )

    @classmethod
    def of_patch(cls, problem: Problem, forces: CreepForces) -> Self:
        """Return a contact of one node, (batch, 1, 1), with the means of an ellipse, for a model of forces alone.

        The slip of the node is the root mean square of the rigid slip. Its slip components are those at the centre. Its
        `wear_index_density` is Tγ/A.
        """
        area = problem.patch_area
        nodes: dict[str, Any] = {
            "pressure": problem.normal_force / area,
            "traction": forces.tangential / area,
            "slip": problem.rigid_slip,
            "traction_bound": problem.friction_coefficient * problem.normal_force / area,
            "area": area,
            "traction_x": forces.longitudinal / area,
            "traction_y": forces.lateral / area,
            "slip_x": problem.longitudinal_creepage,
            "slip_y": problem.lateral_creepage,
            "x": np.zeros_like(area),
            "y": np.zeros_like(area),
        }
        return cls(
            **{name: value[..., None, None] for name, value in nodes.items()},
            strip_width=2.0 * problem.b[..., None],
            problem=problem,
            **_totals(problem, forces),
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
        **conditions: Any,
    ) -> Self:
        """Return a contact solved elsewhere, such as by a multibody or boundary-element program.

        Parameters
        ----------
        pressure, traction, slip, area : Quantity, (batch, nodes)
            Pressure [Pa], traction [Pa], relative slip [-] and area [m²] of each node; they broadcast against each
            other. The slip is the slip velocity over the rolling speed, of magnitude at most 1. Traction and slip have
            the same sign, or are magnitudes. There can be several axes of nodes.
        rolling_speed, density : Quantity, (batch)
            Rolling speed [m/s] and mass density of the body whose wear is predicted [kg/m³].
        **conditions : Quantity, str or array_like, (batch)
            Further conditions that laws declare, such as ``relative_humidity="40 %"``.

        Raises
        ------
        UnitError
            If a value lacks its unit or is out of bounds.
        InputError
            If the shapes do not broadcast, the slip exceeds 1 or has the opposite sign of the traction anywhere, or
            traction has both signs in one contact.
        """
        nodal = {"pressure": pressure, "traction": traction, "slip": slip, "area": area}
        units = expected(*nodal, "rolling_speed", "density")
        speed = units["rolling_speed"].si(rolling_speed, "rolling_speed")
        nodes = broadcast({name: units[name].si(value, name) for name, value in nodal.items()})
        p, q, s, a = nodes.values()
        if p.ndim <= speed.ndim:
            raise InputError(
                f"pressure: must have axes of nodes after the {speed.ndim} of rolling_speed, got {p.shape}"
            )
        axes = tuple(range(speed.ndim, p.ndim))
        if (p < 0).any():
            raise InputError("pressure: must not be negative; a pressure that presses the bodies together is positive")
        if (a < 0).any() or not (a.sum(axis=axes) > 0).all():
            raise InputError("area: must not be negative, and not zero at all nodes of a contact")
        worst = np.unravel_index(np.abs(s).argmax(), s.shape)
        if np.abs(s[worst]) > 1.0 + SLIDING:
            raise InputError(
                f"slip: must not exceed 1 in magnitude, got {s[worst]:.4g} at index {[int(i) for i in worst]}; it is"
                ' the slip velocity over the rolling speed. Give percent as Q(..., "%"), divide a slip velocity by'
                " rolling_speed, and a shift by the distance rolled in its time step"
            )
        if (q * s < 0).any():
            raise InputError("traction and slip: must have the same sign at every node; turn the sign of one of them")
        force, magnitude = (q * a).sum(axis=axes), (np.abs(q) * a).sum(axis=axes)
        if (magnitude - np.abs(force) > ONE_SIGN * magnitude).any():
            raise InputError(
                "traction: has both signs in one contact, so its sum is not the force that dissipates energy; give"
                " traction and slip as magnitudes"
            )
        return cls(
            pressure=p,
            traction=q,
            slip=s,
            area=a,
            traction_bound=np.full(p.shape, np.inf),
            x=np.zeros(p.shape),
            rolling_speed=speed,
            normal_force=(p * a).sum(axis=axes),
            tangential_force=force,
            wear_index=(q * s * a).sum(axis=axes),
            density=np.broadcast_to(units["density"].si(density, "density"), speed.shape),
        ).at(**conditions)

    def at(self, **conditions: Any) -> Self:
        """Return the contact with further conditions, each one value or of the batch shape; a law checks their units.

        Raises
        ------
        UnitError
            If a value is no number with or without a unit.
        InputError
            If its shape is not that of the batch.
        """
        added = {}
        for name, value in conditions.items():
            condition: Any = parse(value) if isinstance(value, str) or with_units(value) else value
            if not isinstance(condition, pint.Quantity):
                condition = Q(real_array(condition), "")
            try:
                added[name] = with_magnitude(condition, np.broadcast_to(condition.magnitude, self.rolling_speed.shape))
            except ValueError:
                raise InputError(
                    f"{name}: must be one value or of the shape of the contacts, {self.rolling_speed.shape}, got"
                    f" {np.shape(condition.magnitude)}"
                ) from None
        return self.replaced(conditions={**self.conditions, **added})

    @property
    def half_width(self) -> Array:
        """Half the patch's length in the rolling direction, a [m], of the batch shape.

        Raises
        ------
        InputError
            If the contact was solved elsewhere, and has no `problem`.
        """
        return self._solved_problem("half_width").half_width

    def body(self, name: str | None = None) -> Body:
        """Return one of the two bodies, with its material and its rolling radius.

        Parameters
        ----------
        name : str, optional
            Name of the body, such as "disc_2"; by default it is the body whose wear is predicted.

        Raises
        ------
        InputError
            If the contact was solved elsewhere, or the rig has no such body.
        """
        problem = self._solved_problem("body")
        if name is not None:
            return problem.body(name)
        if not problem.bodies:
            raise InputError("body: the rig does not name its bodies, so their materials are not known")
        return next(iter(problem.bodies.values()))

    def _solved_problem(self, what: str) -> Problem:
        if self.problem is None:
            raise InputError(
                f"{what}: is not known, because this contact was solved elsewhere and has no problem; give it one with"
                " contact.replaced(problem=...)"
            )
        return self.problem

    @property
    def wear_index_density(self) -> Array:
        """Energy dissipated per metre rolled and area, q·s [N/m²], of shape (batch, nodes).

        On a single node that represents an ellipse, it is Tγ/A.
        """
        if not self.on_strips:
            return self.traction * self.slip
        if self.pressure.shape[self.rolling_speed.ndim :] == (1, 1):
            return self.per_node(self.wear_index / self.patch_area)
        return self.traction_x * self.slip_x + self.traction_y * self.slip_y

    @property
    def wear_index_without_spin(self) -> Array:
        """Wear index without the part of the spin, ξFx + ηFy = Tγ - φMz [N], of the batch shape.

        It is negative where spin, against the creepages, turns the forces.

        Raises
        ------
        InputError
            If an ellipse was solved elsewhere, and has no `problem`.
        """
        if not self.on_strips:
            return self.wear_index
        return self.wear_index - self._solved_problem("wear_index_without_spin").spin * self.moment_z

    @property
    def slip_speed(self) -> Array:
        """Magnitude of the slip velocity, sV [m/s], of shape (batch, nodes)."""
        return np.abs(self.slip) * self.per_node(self.rolling_speed)

    @property
    def frictional_power_density(self) -> Array:
        """Frictional power over area, qsV [W/m²], of shape (batch, nodes)."""
        return self.wear_index_density * self.per_node(self.rolling_speed)

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

    def integral(self, *factors: Array) -> Array:
        """Return the integral over the patch of a value at the nodes, or of a product of values, of the batch shape."""
        nodes = "..." + "abcdefgh"[: self.pressure.ndim - self.rolling_speed.ndim]
        total: Array = np.einsum(f"{','.join([nodes] * (len(factors) + 1))}->...", *factors, self.area)
        return total

    def mean(self, value: Array) -> Array:
        """Return the area mean of a value at the nodes, of the batch shape."""
        return self.integral(value) / self.patch_area

    @property
    def mean_slip(self) -> Array:
        """Area mean of the magnitude of the slip over the patch, stick included [-], of the batch shape."""
        return self.mean(self.slip if self.on_strips else np.abs(self.slip))  # on strips it is a magnitude

    @property
    def slip_area(self) -> Array:
        """Area of the part of the patch that slips [m²], of the batch shape."""
        return self.sum_over_nodes(np.where(self.slip != 0, self.area, 0.0))  # in full slip to the bit `patch_area`

    @property
    def stick_ratio(self) -> Array:
        """Share of the patch's area that sticks [-], of the batch shape."""
        return 1.0 - self.slip_area / self.patch_area

    @property
    def cell_wear_index(self) -> Array:
        """Energy dissipated per metre rolled, ∑ q·s dA over the nodes [N], of the batch shape."""
        if self.pressure.size > self.rolling_speed.size and self.on_strips:
            return self.integral(self.traction_x, self.slip_x) + self.integral(self.traction_y, self.slip_y)
        return self.integral(self.wear_index_density)

    @property
    def forces(self) -> CreepForces:
        """The forces and the moment transmitted by the contact."""
        strips = self.problem and self.problem.strips
        power = self.wear_index if strips and strips.has_creepages else None
        return CreepForces(longitudinal=self.force_x, lateral=self.force_y, spin_moment=self.moment_z, power=power)

    def over_strip(self, value: Array) -> Array:
        """Return ∫ value dx along each strip of an ellipse, of shape (batch, strips)."""
        integral: Array = np.einsum("...ij,...ij->...j", value, self.area)
        return integral / np.where(integral == 0.0, 1.0, self.strip_width)  # zero on strips that fill up a batch

    def scaled_to_wear_index(self) -> Self:
        """Return the contact with slips scaled so that the nodes dissipate Tγ in total.

        Raises
        ------
        InputError
            If Tγ is not zero, but no node dissipates energy.
        """
        dissipated = self.cell_wear_index
        if ((dissipated == 0) & (self.wear_index != 0)).any():
            raise InputError("scaled_to_wear_index: no node of the contact dissipates energy, but Tγ is not zero")
        factor = self.per_node(
            np.divide(self.wear_index, dissipated, out=np.ones_like(dissipated), where=dissipated > 0)
        )
        return self.replaced(slip=self.slip * factor, slip_x=self.slip_x * factor, slip_y=self.slip_y * factor)

    def unflattened(self, problem: Problem) -> Self:
        """Return the contact of a flattened problem in the shape of its batch, with NaN for missing patches."""
        if problem.exists is None and problem.batch_shape == self.rolling_speed.shape:
            return self
        return self.mapped(problem.unflatten, problem)

    def __getitem__(self, index: Any) -> Self:
        """Return the contact at some operating points of the batch; `index` is any NumPy index."""
        return self.mapped(lambda array: array[index])

    def mapped(self, function: Callable[[Array], Array], problem: Problem | None = None) -> Self:
        """Return the contact with a function applied to each of its arrays and, if none is given, of its problem."""
        names = [name for name in self.__slots__ if name not in ("problem", "conditions")]
        arrays = {name: function(getattr(self, name)) for name in names}
        conditions = {
            name: with_magnitude(value, function(value.magnitude))
            if isinstance(value, pint.Quantity)
            else function(value)
            for name, value in self.conditions.items()
        }
        problem = problem or (self.problem and self.problem.mapped(function))
        return type(self)(**arrays, problem=problem, conditions=conditions)

    def replaced(self, **fields: Any) -> Self:
        """Return the contact with some of its fields replaced."""
        return dataclasses.replace(self, **fields)

    def patch_mean(self) -> Self:
        """Return a contact of one node with the patch means.

        Pressure and traction are area means. The slip of a line is s = Tγ / T, which dissipates the same energy and
        equals the creepage. The slip of an ellipse is the root mean square of the rigid slip, without a direction.
        """
        force, area = self.tangential_force, self.patch_area
        slip = np.divide(self.wear_index, force, out=np.zeros_like(force), where=force != 0)
        nowhere = np.zeros_like(area)
        nodes = {
            "pressure": self.normal_force / area,
            "traction": force / area,
            "slip": slip,
            "traction_bound": self.mean(np.where(self.area > 0.0, self.traction_bound, 0.0)),
            "area": area,
            "x": nowhere,
        }
        across: dict[str, Any] = {}
        if self.on_strips:
            if self.problem is not None:
                nodes["slip"] = self.problem.rigid_slip
            nodes |= {
                "y": nowhere,
                "slip_x": nowhere,
                "slip_y": nowhere,
                "traction_x": self.force_x / area,
                "traction_y": self.force_y / area,
            }
            across = {"strip_width": self.strip_width.sum(axis=-1)[..., None]}
        axes = (..., *[None] * (2 if across else 1))
        return self.replaced(**{name: value[axes] for name, value in nodes.items()}, **across)


TOTALS = (
    "rolling_speed", "normal_force", "tangential_force", "wear_index", "density", "force_x", "force_y", "moment_z",
)  # fmt: skip
"""The arrays of a `Contact` with the batch shape."""


def _magnitude(x: Array, y: Array) -> Array:
    """Return √(x² + y²), five times as fast as `np.hypot`, which guards against overflow that cannot happen here."""
    magnitude: Array = np.sqrt(x * x + y * y)
    return magnitude


def _totals(problem: Problem, forces: CreepForces) -> dict[str, Any]:
    return {
        "rolling_speed": problem.rolling_speed,
        "normal_force": problem.normal_force,
        "tangential_force": forces.tangential,
        "wear_index": problem.power(forces),
        "density": problem.density,
        "force_x": forces.longitudinal,
        "force_y": forces.lateral,
        "moment_z": forces.spin_moment,
    }
