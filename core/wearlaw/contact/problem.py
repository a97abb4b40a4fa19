"""The contact problem of two rolling bodies under load, as SI arrays with one entry for each operating point.

x runs along the rolling direction, from the leading to the trailing edge, and y across it. Creepages are those of body
1, an upper disc or a wheel, relative to body 2. The rigid slip is (ξ - φy, η - φx).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias, cast

import numpy as np

from wearlaw.arrays import Array, extremes, freeze, steady
from wearlaw.contact import hertz
from wearlaw.contact.conditions import broadcast
from wearlaw.contact.parts import Body, CreepForces, Strips
from wearlaw.errors import CompositionError, ConditionsError, InputError, shown
from wearlaw.units.quantities import QuantityLike, coefficient, scalar_si
from wearlaw.units.variables import VARIABLES, Variable, declare

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Geometry: TypeAlias = Literal["line", "ellipse", "strips"]
"""The shape of a contact patch: discs with parallel axes touch in a line, and a wheel and a rail in an ellipse. If the
curvatures vary over the patch, it consists of strips along the rolling direction, with a given pressure."""

PATCHES: Mapping[Geometry, str] = {
    "line": "line contacts",
    "ellipse": "elliptic contacts",
    "strips": "patches of strips",
}
"""Words for the contacts of a geometry in messages."""

TINY = float(np.sqrt(np.finfo(np.float64).tiny))
"""Smallest length, pressure or force in SI whose square is a float of full precision."""

LEAST_FRICTION = 1e-12
"""The smallest coefficient of friction or traction.

Below it formulas of fourth order in creepage over full-slip creepage overflow.
"""

MOST_FRICTION = 1.0 / LEAST_FRICTION
"""The largest coefficient of friction or traction; above it tractions and energies soon overflow."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Problem:
    """Contact of two rolling bodies: the input of a contact model.

    It is Hertzian on a line or an ellipse; on strips the pressure is given.

    The arrays are read-only. They have one shape, the *batch*, with one entry for each operating point. `Problem.line`
    and `Problem.ellipse` make a problem from quantities. If bodies touch in several places, such as two wheels with up
    to three patches each, the rig adds axes to the batch, names them in `dims` and marks the existing patches in
    `exists`. Unlike materials enter through the effective modulus and Kalker's mean of ν/G. Contact models neglect the
    coupling of normal and tangential displacement between unlike bodies, and wearlaw warns where it matters.

    Attributes
    ----------
    geometry : {"line", "ellipse", "strips"}
        The shape of the patch.
    a : ndarray
        Half the patch's length in the rolling direction [m]; the semi-axis of an ellipse. For strips, the semi-axis of
        the ellipse that stands for the patch in Kalker's coefficients.
    b : ndarray
        Half the patch's width across the rolling direction [m]; the semi-axis of an ellipse. For strips as for a.
    normal_force : ndarray
        Normal force, N [N].
    max_pressure : ndarray
        Hertz's maximum pressure, p0 [Pa].
    effective_modulus : ndarray
        Effective modulus, E* [Pa], 1/E* = (1-ν1²)/E1 + (1-ν2²)/E2.
    poisson_ratio : ndarray
        Poisson's ratio, ν [-].
    friction_coefficient : ndarray
        Friction coefficient, μ [-].
    longitudinal_creepage : ndarray
        Longitudinal creepage, ξ [-], positive if body 1 is the faster one.
    lateral_creepage : ndarray
        Lateral creepage, η [-].
    spin : ndarray
        Spin, φ [1/m], the relative angular velocity about the normal over the rolling speed.
    rolling_speed : ndarray
        Rolling speed, V [m/s]: of two discs the mean of their surface speeds, of a wheel on a rail the vehicle's speed.
    density : ndarray
        Mass density of the body whose wear is predicted, ρ [kg/m³].
    traction_coefficient : ndarray or None
        Measured tangential over normal force, T/N [-], if the test gave one.
    contact_angle : ndarray or None
        Contact angle, δ [rad], of the surface to the axle; None if the surface is level at all operating points.
    conditions : mapping of str to ndarray
        Further conditions by name, which the models of the pipeline declare.
    strips : Strips or None
        The strips and their pressure, if the patch is neither a line nor an ellipse.
    bodies : mapping of str to Body
        The two bodies by name; wear is predicted for the first body. {} if the bodies are unknown.
    dims : mapping of str to tuple
        Names of the last axes of the batch, if the rig adds axes to those of the conditions, each with the labels of
        its entries, such as {"side": ("left", "right"), "patch": (1, 2, 3)}.
    exists : array of bool, or None
        Marks the existing patches; the others are not solved, and their results are NaN. None if all patches exist.
    unloaded : array of bool, or None
        Marks those of the missing patches that bear no load, such as those of a lifted wheel; their results are zero.
        None if there are none.
    """

    geometry: Geometry
    a: Array
    b: Array
    normal_force: Array
    max_pressure: Array
    effective_modulus: Array
    poisson_ratio: Array
    friction_coefficient: Array
    longitudinal_creepage: Array
    lateral_creepage: Array
    spin: Array
    rolling_speed: Array
    density: Array
    traction_coefficient: Array | None = None
    contact_angle: Array | None = None
    conditions: Mapping[str, Array] = field(default_factory=dict)
    strips: Strips | None = None
    bodies: Mapping[str, Body] = field(default_factory=dict)
    dims: Mapping[str, tuple[str | int, ...]] = field(default_factory=dict)
    exists: NDArray[np.bool_] | None = None
    unloaded: NDArray[np.bool_] | None = None

    results: ClassVar[tuple[Variable, ...]] = ()
    """Fields that a subclass adds to the results of predictions: arrays of the batch shape, in SI or of texts."""

    def __init_subclass__(cls) -> None:
        """Put the results of a subclass into the table of variables."""
        if not (isinstance(cls.results, tuple) and all(isinstance(result, Variable) for result in cls.results)):
            raise InputError(
                f'{cls.__name__}.results: must be a tuple of variables, such as (wl.Variable("wheel_load", unit="kN"),)'
            )
        for variable in vars(cls).get("results", ()):
            declare(cls, variable)

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        creepage: object = self.longitudinal_creepage
        if not isinstance(creepage, float):  # one operating point has NumPy's scalars
            freeze(self, ARRAYS)

    @classmethod
    @np.errstate(all="ignore")  # `checked` rejects what overflows
    def line(
        cls,
        *,
        normal_force: QuantityLike,
        track_width: QuantityLike,
        relative_radius: QuantityLike,
        shear_modulus: QuantityLike,
        poisson_ratio: ArrayLike,
        friction_coefficient: ArrayLike,
        creepage: QuantityLike,
        rolling_speed: QuantityLike = "1 m/s",
        density: QuantityLike = "7850 kg/m^3",
    ) -> Self:
        """Return the problem of two bodies of like materials with parallel axes; arguments broadcast.

        Parameters
        ----------
        normal_force : Quantity or str
            Normal force on the whole width, N [N].
        track_width : Quantity or str
            Width of the patch across the rolling direction [m].
        relative_radius : Quantity or str
            R [m], 1/R = 1/R1 + 1/R2.
        shear_modulus : Quantity or str
            G [Pa].
        poisson_ratio, friction_coefficient : array_like of float
            ν and μ [-].
        creepage : Quantity or str
            ξ, a ratio or in percent.
        rolling_speed : Quantity or str
            V [m/s]; only laws that read the slip speed depend on it.
        density : Quantity or str
            Density of the body whose wear is predicted, ρ [kg/m³].

        Raises
        ------
        UnitError
            If an argument lacks its unit or is out of bounds.
        ConditionsError
            If the arguments do not broadcast.
        """
        quantities = {
            "normal_force": normal_force,
            "track_width": track_width,
            "relative_radius": relative_radius,
            "shear_modulus": shear_modulus,
            "creepage": creepage,
            "rolling_speed": rolling_speed,
            "density": density,
        }
        si = _si(quantities, friction_coefficient, poisson_ratio)
        modulus = si.pop("shear_modulus") / (1.0 - si["poisson_ratio"])
        per_width = si.pop("normal_force") / si["track_width"]
        return cls.line_from_si(normal_force_per_width=per_width, effective_modulus=modulus, **si).checked()

    @classmethod
    def of(cls, problem: Problem, **fields: Any) -> Self:
        """Return another problem as one of this class, with the fields that the class adds, and others replaced."""
        return cls(**{field.name: getattr(problem, field.name) for field in dataclasses.fields(Problem)} | fields)

    def checked(self) -> Self:
        """Return the problem, or raise an error if its load or its coefficients are such as no contact has.

        A rig returns ``problem.checked()``, so that a load in a wrong unit is not taken for a fault of a model.

        Raises
        ------
        ConditionsError
            If sizes or coefficients are so extreme that floats overflow or lose their precision.
        """
        there = self
        if self.exists is not None:
            there = self.flatten()
            if not there.size:
                return self
        if self.geometry == "line":
            sizes = {"half width": there.a}
        else:
            sizes = {
                "longer semi-axis": np.maximum(there.a, there.b),
                "shorter semi-axis": np.minimum(there.a, there.b),
            }
        for name, value in {**sizes, "max pressure": there.max_pressure, "normal force": there.normal_force}.items():
            low, high = extremes(value)
            if not (low > TINY and high < 1.0 / TINY):
                spread = f"{low:g}" if low == high else f"{low:g} to {high:g}"
                raise ConditionsError(
                    f"the load gives a {name} of {spread} in SI units,"
                    " which no contact has; check the units of the load and of the rig"
                )
        for name in ("friction_coefficient", "traction_coefficient"):
            if (value := getattr(there, name)) is None:
                continue
            low, high = extremes(value)
            if low < LEAST_FRICTION or high > MOST_FRICTION:
                bound, limit = ("at least", LEAST_FRICTION) if low < LEAST_FRICTION else ("at most", MOST_FRICTION)
                raise ConditionsError(f"{name}: must be {bound} {limit:g}, which no contact comes near")
        return self

    @classmethod
    def line_from_si(
        cls,
        *,
        normal_force_per_width: Array,
        track_width: Array,
        relative_radius: Array,
        effective_modulus: Array,
        creepage: Array,
        **fields: Any,
    ) -> Self:
        """Return the problem of a line contact under P [N/m] by Hertz's theory, from SI arrays of one shape.

        `fields` are the other fields of a `Problem`; lateral creepage, spin and Poisson's ratio are zero by default.
        """
        a = hertz.half_width(normal_force_per_width, relative_radius, effective_modulus)
        none = np.broadcast_to(0.0, creepage.shape)
        return cls(
            geometry="line",
            a=a,
            b=0.5 * track_width,
            normal_force=normal_force_per_width * track_width,
            max_pressure=hertz.max_pressure(normal_force_per_width, a),
            effective_modulus=effective_modulus,
            longitudinal_creepage=creepage,
            **{"lateral_creepage": none, "spin": none, "poisson_ratio": none, **fields},
        )

    @classmethod
    @np.errstate(all="ignore")  # `checked` rejects what overflows
    def ellipse(
        cls,
        *,
        a: QuantityLike,
        b: QuantityLike,
        normal_force: QuantityLike,
        shear_modulus: QuantityLike,
        poisson_ratio: ArrayLike,
        friction_coefficient: ArrayLike,
        longitudinal_creepage: QuantityLike,
        lateral_creepage: QuantityLike,
        spin: QuantityLike,
        rolling_speed: QuantityLike = "1 m/s",
        density: QuantityLike = "7850 kg/m^3",
    ) -> Self:
        """Return the problem of two bodies of like materials that touch in a given ellipse; arguments broadcast.

        Parameters
        ----------
        a, b : Quantity or str
            Semi-axes of the patch in and across the rolling direction [m].
        longitudinal_creepage, lateral_creepage : Quantity or str
            ξ and η, ratios or in percent.
        spin : Quantity or str
            φ [1/m].

        The others, and the errors, are those of `line`.
        """
        quantities = {
            "a": a,
            "b": b,
            "normal_force": normal_force,
            "shear_modulus": shear_modulus,
            "longitudinal_creepage": longitudinal_creepage,
            "lateral_creepage": lateral_creepage,
            "spin": spin,
            "rolling_speed": rolling_speed,
            "density": density,
        }
        return cls.ellipse_from_si(**_si(quantities, friction_coefficient, poisson_ratio)).checked()

    @classmethod
    def ellipse_from_si(cls, *, shear_modulus: Array, poisson_ratio: Array, **fields: Any) -> Self:
        """Return the problem of an elliptic contact from the arguments of `ellipse` as SI arrays of one shape."""
        return cls(
            geometry="ellipse",
            max_pressure=1.5 * fields["normal_force"] / (np.pi * fields["a"] * fields["b"]),
            effective_modulus=shear_modulus / (1.0 - poisson_ratio),
            poisson_ratio=poisson_ratio,
            **fields,
        )

    @classmethod
    def of_strips(cls, strips: Strips, *, shear_modulus: Array, poisson_ratio: Array, **fields: Any) -> Self:
        """Return the problem of a patch of strips with a given pressure, from SI arrays of one shape.

        Parameters
        ----------
        strips : Strips
            The strips, (batch, strips).
        shear_modulus, poisson_ratio : ndarray
            G [Pa] and ν [-].
        **fields
            The other fields of a `Problem`: the semi-axes `a` and `b` of the ellipse that stands for the patch in
            Kalker's coefficients, friction, creepages, spin, rolling speed and density.
        """
        return cls(
            geometry="strips",
            strips=strips,
            normal_force=strips.normal_force.sum(axis=-1),
            max_pressure=strips.max_pressure.max(axis=-1),
            effective_modulus=shear_modulus / (1.0 - poisson_ratio),
            poisson_ratio=poisson_ratio,
            **fields,
        )

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """The shape of the batch, () for one operating point."""
        return self.longitudinal_creepage.shape

    @property
    def size(self) -> int:
        """The number of operating points or, with several patches, of existing patches."""
        return math.prod(self.batch_shape) if self.exists is None else int(self.exists.sum())

    @property
    def resolved(self) -> NDArray[np.bool_] | None:
        """Marks the patches with results: those that exist, and those that bear no load. None if all have."""
        return self.exists if self.unloaded is None or self.exists is None else self.exists | self.unloaded

    @property
    def creepage(self) -> Array:
        """Longitudinal creepage, ξ [-], with its sign; positive if body 1 is the faster one."""
        return self.longitudinal_creepage

    @property
    def half_width(self) -> Array:
        """Half the patch's length in the rolling direction, a [m]."""
        return self.a

    @property
    def track_width(self) -> Array:
        """Width of a line's patch across the rolling direction [m]."""
        return 2.0 * self.b

    @property
    def normal_force_per_width(self) -> Array:
        """Normal force per unit width of a line, P [N/m]."""
        self.needs("line", "normal_force_per_width")
        return 0.5 * self.normal_force / self.b

    @property
    def relative_radius(self) -> Array:
        """Relative radius of curvature of a line contact, R [m], 1/R = 1/R1 + 1/R2, by p0 = a E*/(2 R)."""
        self.needs("line", "relative_radius")
        return 0.5 * self.a * self.effective_modulus / self.max_pressure

    @property
    def shear_modulus(self) -> Array:
        """Shear modulus, G [Pa], E* (1-ν)."""
        return self.effective_modulus * (1.0 - self.poisson_ratio)

    @property
    def patch_area(self) -> Array:
        """Area of the patch, A [m²]: 4ab for a line, πab for an ellipse, the sum of the areas of strips."""
        if self.strips is not None:
            area: Array = self.strips.area.sum(axis=-1)
            return area
        return (4.0 if self.geometry == "line" else np.pi) * self.a * self.b

    @property
    def rigid_slip(self) -> Array:
        """Root mean square of the rigid slip over the patch [-]; for an ellipse √(ξ² + η² + φ²(a² + b²)/4)."""
        if self.geometry == "line":
            return np.abs(self.longitudinal_creepage)
        if self.strips is not None:
            return self._rigid_slip_of_strips(self.strips)
        turning = 0.25 * self.spin**2 * (self.a**2 + self.b**2)
        slip: Array = np.sqrt(self.longitudinal_creepage**2 + self.lateral_creepage**2 + turning)
        return slip

    def _rigid_slip_of_strips(self, strips: Strips) -> Array:
        """Return the root mean square of (ξ, η - φr) of the strips; the mean of r² over a strip is a²/3."""
        along, across, spin = self.creepages_of_strips
        square = along**2 + across**2 + spin**2 * strips.half_length**2 / 3.0
        mean: Array = (square * strips.area).sum(axis=-1) / strips.area.sum(axis=-1)
        return np.sqrt(mean)

    @property
    def creepages_of_strips(self) -> tuple[Array, Array, Array]:
        """ξ, η and φ in the middle of each strip, (batch, strips): its own, or those of the problem there."""
        self.needs("strips", "creepages_of_strips")
        strips = cast(Strips, self.strips)
        along, across, spin = self.longitudinal_creepage, self.lateral_creepage, self.spin[..., None]
        at_middle = along[..., None] - spin * strips.y, across[..., None] - spin * strips.x, spin + 0.0 * strips.y
        of_strips = strips.longitudinal_creepage, strips.lateral_creepage, strips.spin
        pairs = zip(at_middle, of_strips, strict=True)
        along, across, spin = (at if creepage is None else creepage for at, creepage in pairs)
        return along, across, spin

    def body(self, name: str | None) -> Body:
        """Return the body with a name.

        Raises
        ------
        InputError
            If no body has that name.
        """
        if not isinstance(name, str) or name not in self.bodies:
            names = " and ".join(repr(name) for name in self.bodies) or "not named"
            wrong = "is missing" if name is None else f"this rig has no {shown(name)}"
            raise InputError(f"body: {wrong}; its bodies are {names}")
        return self.bodies[name]

    def worn_on(self, body: str | None) -> Self:
        """Return the problem for the wear of a body, which is then the first one; `self` if that changes nothing."""
        if body is None:
            return self
        worn, first = self.body(body), next(iter(self.bodies.values()))
        density = scalar_si(worn.material.density, "kg/m^3")
        same = (self.density == density) | np.isnan(self.density)  # NaN where there is no patch
        if same.all() and (worn is first or worn.material == first.material):
            return self
        return self.replaced(density=np.full_like(self.density, density), bodies={body: worn, **self.bodies})

    def needs(self, geometry: Geometry, what: str) -> None:
        """Raise an error if `what` belongs to patches of another shape."""
        if self.geometry != geometry:
            raise CompositionError(f"{what}: belongs to {PATCHES[geometry]}, not to {PATCHES[self.geometry]}")

    @steady
    def power(self, forces: CreepForces) -> Array:
        """Return the energy dissipated per metre rolled, Tγ = ξFx + ηFy + φMz [N], or the power of the forces."""
        if forces.power is not None:
            return forces.power
        along = self.longitudinal_creepage * forces.longitudinal
        if self.geometry == "line":
            return along
        return along + self.lateral_creepage * forces.lateral + self.spin * forces.spin_moment

    def forward(self) -> Self:
        """Return the problem with the magnitude of the longitudinal creepage."""
        creepage = self.longitudinal_creepage
        lowest = creepage.min() if creepage.ndim else creepage
        return self if lowest >= 0.0 else self.replaced(longitudinal_creepage=np.abs(creepage))

    def with_normal_force(self, normal_force: Array) -> Self:
        """Return the problem under another normal force [N], of the batch shape, with the patch by Hertz's theory.

        a, b and p0 of an ellipse grow with the cube root of the force. a and p0 of a line grow with its square root.

        Raises
        ------
        CompositionError
            If the patch consists of strips, whose pressure is given.
        """
        if self.strips is not None:
            raise CompositionError("with_normal_force: the pressure of strips is given; make them for another load")
        ratio = normal_force / self.normal_force
        if self.geometry == "line":
            scale, b = np.sqrt(ratio), self.b
        else:
            scale = np.cbrt(ratio)
            b = scale * self.b
        return self.replaced(normal_force=normal_force, a=scale * self.a, b=b, max_pressure=scale * self.max_pressure)

    def with_creepages(self, longitudinal: Array, lateral: Array, spin: Array) -> Self:
        """Return the problem at other ξ [-], η [-] and φ [1/m], of the batch shape; strips lose their own."""
        creepages: dict[str, Any] = {"longitudinal_creepage": longitudinal, "lateral_creepage": lateral, "spin": spin}
        none: dict[str, Any] = dict.fromkeys(creepages)
        return self.replaced(**creepages, strips=self.strips and dataclasses.replace(self.strips, **none))

    def replaced(self, **fields: Any) -> Self:
        """Return the problem with some of its fields replaced."""
        return dataclasses.replace(self, **fields)

    def __getitem__(self, index: Any) -> Self:
        """Return the problem at some operating points of the batch; `index` is any NumPy index."""

        def chosen(array: Array) -> Array:
            return array[index]  # type: ignore[no-any-return]

        first_axes = isinstance(index, slice | np.ndarray)  # another index may count axes from the last
        return self.mapped(chosen, chosen if first_axes else None)

    def broadcast_to(self, shape: tuple[int, ...]) -> Self:
        """Return the problem broadcast to a larger batch shape; the new axes come first."""
        return self.mapped(lambda array: np.broadcast_to(array, shape))

    def flatten(self) -> Self:
        """Return the problem with a batch of one axis that holds the existing patches."""
        if self.longitudinal_creepage.ndim == 1 and not self.dims and self.exists is None:
            return self
        if self.exists is not None:
            return self[self.exists].replaced(dims={}, exists=None, unloaded=None)
        flat = self.mapped(_flat, _flat_strips)
        return flat.replaced(dims={}) if flat.dims else flat

    def existing(self) -> Self:
        """Return the problem of the existing patches, which is `self` if all patches exist."""
        return self if self.exists is None else self.flatten()

    def unflatten(self, values: Array) -> Array:
        """Return values of the flattened problem in the shape of the batch, with NaN or "" for missing patches.

        Axes after the axis of the flattened problem stay.
        """
        shape = self.batch_shape + values.shape[1:]
        if self.exists is None:
            return values.reshape(shape)
        whole = np.full(shape, np.nan if values.dtype.kind == "f" else "", values.dtype)
        whole[self.exists] = values
        return whole

    def mapped(self, function: Callable[[Array], Array], of_strips: Callable[[Array], Array] | None = None) -> Self:
        """Return the problem with a function applied to each of its arrays; `of_strips` as in `Strips.mapped`."""
        fields: dict[str, Any] = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        for name in (*ARRAYS, *(variable.name for variable in self.results)):
            if fields[name] is not None:
                fields[name] = function(fields[name])
        if self.strips is not None:
            fields["strips"] = self.strips.mapped(function, of_strips)
        fields["bodies"] = {name: body.mapped(function) for name, body in self.bodies.items()}
        fields["conditions"] = {name: function(array) for name, array in self.conditions.items()}
        return type(self)(**fields)


ARRAYS = tuple(field.name for field in dataclasses.fields(Problem) if "Array" in str(field.type).partition("[")[0])
"""The fields of a `Problem` that are arrays, some of them None if they do not apply."""


def _flat(array: Array) -> Array:
    """Return an array with one axis; if one number is broadcast to all entries, it is not copied."""
    if array.ndim > 1 and not any(array.strides) and array.size:
        return np.broadcast_to(array[(0,) * array.ndim], array.size)
    return array.reshape(-1)


def _flat_strips(array: Array) -> Array:
    """Return an array of strips with one axis for the batch."""
    return array.reshape(-1, array.shape[-1])


def _si(
    quantities: Mapping[str, QuantityLike], friction_coefficient: ArrayLike, poisson_ratio: ArrayLike
) -> dict[str, Array]:
    arrays = {name: VARIABLES[name].expected.si(value, name) for name, value in quantities.items()}
    arrays["friction_coefficient"] = coefficient(friction_coefficient, "friction_coefficient")
    arrays["poisson_ratio"] = ratio = coefficient(poisson_ratio, "poisson_ratio", positive=False)
    if not ((ratio >= 0.0) & (ratio <= 0.5)).all():
        raise InputError(f"poisson_ratio: must lie between 0 and 0.5, got {shown(poisson_ratio)}")
    return broadcast(arrays)
