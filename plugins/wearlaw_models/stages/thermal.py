"""Friction that falls as the contact heats up."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, field_validator

import wearlaw as wl
from wearlaw import Array

Conductivity = Annotated[wl.Quantity, wl.Unit("W/m/K", usual=(0.05, 3000.0))]
SpecificHeat = Annotated[wl.Quantity, wl.Unit("J/kg/K", usual=(50.0, 10000.0))]
Rise = Annotated[wl.Quantity, wl.Unit("K")]

EPS = float(np.finfo(np.float64).eps)

MOST_STEPS = 120
"""Twice the bisections from 1 to a rounding, and some."""

TOTAL_OF_STRIP: float = (
    (math.pi / 4.0) ** 1.5 * math.gamma(2.5) * math.gamma(0.25) / (math.gamma(1.75) ** 2 * math.gamma(2.75))
)
"""∬ √(1-s²) √(1-t²)/√(t-s) ds dt over -1 < s < t < 1: how a strip under Hertz's pressure heats itself."""

TOTAL_OF_ELLIPSE = math.sqrt(math.pi) * math.gamma(2.75) / math.gamma(3.25)
"""∫ (1-t²)^(7/4) dt from -1 to 1: the sum over the strips of an ellipse."""

HOTTEST = 2.188306673791308
"""The largest ∫ √(1-s²)/√(t-s) ds from -1 to t, at t = 0.652."""

LEAST_PECLET = 5.0
"""Péclet number from which the mean rise is within 6 % of that with conduction in all directions."""


class ThermalProperties(wl.Configuration):
    """How a body conducts and stores heat; the defaults are the steel of Ertz and Knothe (2002)."""

    conductivity: Conductivity = Field(default="50 W/m/K", validate_default=True)
    """Thermal conductivity, λ [W/(m K)]."""
    density: Annotated[wl.Quantity, wl.Unit("kg/m^3", usual=(500.0, 25000.0))] = Field(
        default="7850 kg/m^3", validate_default=True
    )
    """Mass density, ρ [kg/m³]."""
    specific_heat: SpecificHeat = Field(default="450 J/kg/K", validate_default=True)
    """Specific heat capacity, c [J/(kg K)]."""

    if TYPE_CHECKING:  # checkers do not know that a text is accepted for a quantity

        def __init__(
            self,
            *,
            conductivity: wl.QuantityLike = ...,
            density: wl.QuantityLike = ...,
            specific_heat: wl.QuantityLike = ...,
        ) -> None: ...

    @property
    def effusivity(self) -> float:
        """Thermal effusivity, √(λρc) [W√s/(m² K)]."""
        return float(np.sqrt(wl.scalar_si(self.conductivity, "W/m/K") * self._heat_capacity))

    @property
    def diffusivity(self) -> float:
        """Thermal diffusivity, λ/(ρc) [m²/s]."""
        return wl.scalar_si(self.conductivity, "W/m/K") / self._heat_capacity

    @property
    def _heat_capacity(self) -> float:
        return wl.scalar_si(self.density, "kg/m^3") * wl.scalar_si(self.specific_heat, "J/kg/K")


class Thermal(wl.Stage):
    """Friction that falls linearly as the surfaces heat up in the contact, solved together with the force.

    The friction coefficient of the whole patch is

        μ = μ0 [1 - (1 - h) min(max((θ - θ0)/Δθ, 0), 1)],

    with μ0 of the conditions, and θ a mean rise of the surface temperature. Bulk temperatures do not enter: μ0 is the
    friction of the bodies as they roll in.

    Both surfaces pass the heat of friction q·s V at the rolling speed V, so fast that heat flows into the depth alone.
    A point at x then has the rise

        θ(x, y) = V/((β1 + β2) √(πV)) ∫ q·s(x', y)/√(x - x') dx' from the leading edge to x,

    with the effusivities β = √(λρc) of the bodies, which share the heat in proportion to them. `flash_temperature` and
    `mean_rise` are the greatest θ of a solved contact and its mean, weighted by the pressure p.

    In the source, friction falls at each point with the temperature there, which counts only where the bodies slip. So
    the θ of the friction is the mean over the points that slip, weighted by p: in full slip it gives the force of
    friction that falls linearly at each point. For this mean alone the heat Tγ V is taken for spread like p, as it is
    in full slip. In partial slip the two differ: in Carter's theory the mean over the points that slip is 0.82 of that
    where all of the patch begins to slip, 1.14 at half that creepage and 1.84, of little heat, at a fifth.

    This θ depends on μ through Tγ, and μ on θ. A bracketing method finds the μ from h μ0 to μ0 that satisfies both, to
    rounding. It exists, because θ is continuous in μ and the right side stays in that range. It is the only one if Tγ
    does not fall as μ grows, because μ minus the right side then grows. So it is with the contact models that ship with
    wearlaw, at pure longitudinal or lateral creepage.

    Notes
    -----
    Prefer this where friction falls at high speed or creepage and its dependence on temperature is known. It can't tell
    apart the friction of points in the patch. `mean_rise` and `flash_temperature` leave out the bulk temperature, the
    heat of earlier passages and the roughness, whose summits become hotter.

    wearlaw warns where the Péclet number Va/(2κ), with the larger diffusivity κ = λ/(ρc) of the bodies, is below 5, or
    below 5 (a/b)² on a long patch. From there on the mean rise of like bodies under heat that is spread like p is
    within 6 % of that with conduction in all directions. The greatest rise on a line is within 1.2 % if Va/(2κ) is at
    least 5 with half the length of the zone that slips for a.
    """

    name: ClassVar[str] = "thermal"
    source: ClassVar[str] = (
        "temperature: M. Ertz, K. Knothe, Wear 253 (2002) 498-508, and friction: piecewise linear in it, both after the"
        " user guide and the source of the program CONTACT (E. A. H. Vollebregt)"
    )
    example_fields: ClassVar[Mapping[str, Any]] = {"hot_ratio": 0.4, "temperature_range": "500 K"}

    hot_ratio: Annotated[float, Field(gt=0.0, le=1.0, strict=True)]
    """Friction coefficient of the hot contact over that of the cold one, h [-]."""
    temperature_range: Rise
    """Rise over which the friction falls, Δθ [K]."""
    onset: Annotated[wl.Quantity, wl.Unit("K", positive=False)] = Field(default="0 K", validate_default=True)
    """Rise at which the friction begins to fall, θ0 [K]."""
    body_1: ThermalProperties = ThermalProperties()
    """Thermal properties of the first body, such as the wheel."""
    body_2: ThermalProperties = ThermalProperties()
    """Thermal properties of the second body, such as the rail."""

    @field_validator("onset")
    @classmethod
    def _not_negative(cls, onset: wl.Quantity) -> wl.Quantity:
        if onset.magnitude < 0.0:
            raise ValueError(f"must not be negative, got {onset!r}")
        return onset

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        """Return the problem with the friction coefficient of the hot contact."""
        cold = problem.friction_coefficient

        def excess(friction: Array) -> Array:
            """Return μ minus the friction at the temperature that μ leads to."""
            part = problem.replaced(friction_coefficient=friction)
            difference: Array = friction - cold * self._share(self._spread_rise(part, part.power(forces(part))))
            return difference

        hot = _root(excess, self.hot_ratio * cold, cold)
        heated = problem.replaced(friction_coefficient=hot)
        self._warn_if_slow(heated, hot < cold)
        return heated

    def mean_rise(self, contact: wl.Contact) -> wl.Quantity:
        """Return the mean rise of the surface temperature over the patch, weighted by the pressure [K].

        Of a contact that holds the means of the patch in one node, the heat is spread like Hertz's pressure. So the θ
        of the friction is `mean_rise(contact.patch_mean())`.
        """
        problem = self._warned(contact)
        if _is_mean(contact):
            return wl.Q(self._spread_rise(problem, contact.wear_index), "K")
        heated = contact.integral(self._rises(contact, problem), contact.pressure)
        return wl.Q(heated / problem.normal_force, "K")

    def flash_temperature(self, contact: wl.Contact) -> wl.Quantity:
        """Return the largest rise of the surface temperature at the nodes of a solved contact [K].

        On a line it lies at most 1 % below the largest rise of all points, on an ellipse of 10 strips 4 %, and of 20
        strips 1.3 %. With spin the root mean square is 3.5 and 1 %, and single points are four times further off. Of a
        contact that holds the means of the patch in one node, the heat is spread like Hertz's pressure.
        """
        problem = self._warned(contact)
        if not _is_mean(contact):
            nodes = tuple(range(contact.rolling_speed.ndim, contact.pressure.ndim))
            return wl.Q(self._rises(contact, problem).max(axis=nodes), "K")
        if problem.strips is None:
            sharpest = problem.max_pressure * np.sqrt(problem.a)
        else:
            sharpest = (problem.strips.max_pressure * np.sqrt(problem.strips.half_length)).max(axis=-1)
        return wl.Q(HOTTEST * sharpest * self._spread(problem, contact.wear_index), "K")

    def _warned(self, contact: wl.Contact) -> wl.Problem:
        """Return the problem of a contact, after a warning if it is slow."""
        if contact.problem is None:
            raise wl.InputError("temperature: the contact has no problem, and so no size and speed of its patch")
        self._warn_if_slow(contact.problem, contact.wear_index > 0.0)
        return contact.problem

    def _rises(self, contact: wl.Contact, problem: wl.Problem) -> Array:
        """Return θ [K] at the nodes, each with its heat spread evenly over the length that it represents."""
        width = contact.strip_width[..., None, :] if contact.on_strips else problem.track_width[..., None]
        half = 0.5 * contact.area / np.where(width > 0.0, width, 1.0)  # of strips that fill up a batch it is zero
        along = contact.rolling_speed.ndim  # the axis of the nodes of a strip
        begin, end = contact.x - half, contact.x + half
        heat = 2.0 * contact.wear_index_density
        rises = np.empty(heat.shape)
        for node in range(heat.shape[along]):
            here = (slice(None),) * along + (slice(node, node + 1),)
            reach = np.sqrt(np.maximum(contact.x[here] - begin, 0.0)) - np.sqrt(np.maximum(contact.x[here] - end, 0.0))
            rises[here] = (heat * reach).sum(axis=along, keepdims=True)
        return rises * contact.per_node(np.sqrt(contact.rolling_speed / np.pi)) / self._effusivity

    def _share(self, rise: Array) -> Array:
        """Return μ/μ0."""
        fallen = (rise - wl.scalar_si(self.onset, "K")) / wl.scalar_si(self.temperature_range, "K")
        share: Array = np.maximum(1.0 - (1.0 - self.hot_ratio) * np.maximum(fallen, 0.0), self.hot_ratio)
        return share

    def _spread_rise(self, problem: wl.Problem, power: Array) -> Array:
        """Return the integral of θ p over the patch, over N [K], for Tγ [N] that is spread like the pressure."""
        if problem.strips is not None:
            strips = problem.strips
            heated: Array = (strips.width * strips.max_pressure**2 * strips.half_length**1.5).sum(axis=-1)
        else:
            width = 2.0 if problem.geometry == "line" else TOTAL_OF_ELLIPSE
            heated = width * problem.b * problem.max_pressure**2 * problem.a**1.5
        return TOTAL_OF_STRIP * heated / problem.normal_force * self._spread(problem, power)

    def _spread(self, problem: wl.Problem, power: Array) -> Array:
        """Return TγV/(N (β1 + β2) √(πV)) [K/(Pa √m)]."""
        return power * np.sqrt(problem.rolling_speed / np.pi) / (self._effusivity * problem.normal_force)

    @property
    def _effusivity(self) -> float:
        """Sum of the effusivities, β1 + β2 [W√s/(m² K)]."""
        return self.body_1.effusivity + self.body_2.effusivity

    def _warn_if_slow(self, problem: wl.Problem, counts: NDArray[np.bool_]) -> None:
        diffusivity = max(self.body_1.diffusivity, self.body_2.diffusivity)
        slender = np.maximum(problem.a / problem.b, 1.0) ** 2
        peclet = (0.5 * problem.rolling_speed * problem.a / (diffusivity * slender))[counts]
        slow = peclet < LEAST_PECLET
        if slow.any():
            wl.errors.warn(
                f"stage 'thermal' assumes heat that flows into the depth alone, with a Péclet number Va/(2κ), over"
                f" (a/b)² on a long patch, of at least {LEAST_PECLET:g}; {slow.sum()} of {counts.size} contacts have"
                f" less, down to {peclet.min():.2g}. Their temperature may be off by more than 6 %; check against data",
                wl.RangeWarning,
            )


def _root(function: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Return where a continuous function that is not above zero at `low`, nor below zero at `high`, is zero.

    An inverse quadratic interpolation where it is safe, or else a bisection, after T. R. Chandrupatla, Advances in
    Engineering Software 28 (1997) 145-149. All points take part in each step, those that are done with their result.
    """
    x, last = np.array(high), np.array(low)
    f, f_last = function(x[()]), function(last[()])
    before, f_before, share = x, f, np.full(x.shape, 0.5)
    best = np.where(np.abs(f) <= np.abs(f_last), x, last)
    done = (f == 0.0) | (f_last == 0.0)
    for _ in range(MOST_STEPS):
        if done.all():
            break
        new = np.where(done, best, x + share * (last - x))
        f_new = function(new[()])
        same = np.sign(f_new) == np.sign(f)
        before, f_before = np.where(same, x, last), np.where(same, f, f_last)
        last, f_last = np.where(same, last, x), np.where(same, f_last, f)
        x, f = new, f_new
        best, smallest = np.where(np.abs(f) < np.abs(f_last), x, last), np.minimum(np.abs(f), np.abs(f_last))
        with np.errstate(divide="ignore", invalid="ignore"):  # where an interval or a difference is zero
            least = 2.0 * EPS * np.abs(best) / np.abs(last - x)
            place, height = (x - last) / (before - last), (f - f_last) / (f_before - f_last)
            curved = f / (f_last - f) * f_before / (f_last - f_before)
            curved += (before - x) / (last - x) * f / (f_before - f) * f_last / (f_before - f_last)
            safe = (height**2 < place) & ((1.0 - height) ** 2 < 1.0 - place)
        done = done | (smallest == 0.0) | ~(least <= 0.5)
        share = np.clip(np.where(safe & ~done, curved, 0.5), least, 1.0 - least)
    return best[()]


def _is_mean(contact: wl.Contact) -> bool:
    """Return whether a contact holds the means of the patch in one node."""
    return contact.pressure.size == contact.rolling_speed.size


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Stage]]:
    """Return the stage of this plugin."""
    return [Thermal]
