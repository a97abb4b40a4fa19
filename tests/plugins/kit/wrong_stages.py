"""Stages, and laws of other outcomes than wear or with variables of their own, right ones and wrong ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, ClassVar, TypedDict

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw import Array


class Lubricated(wl.Stage):
    """Friction that falls to a share."""

    name: ClassVar[str] = "lubricated"
    source: ClassVar[str] = "test"
    share: float = 0.5
    """Share of the friction coefficient that is left [-]."""

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return problem.replaced(friction_coefficient=self.share * problem.friction_coefficient)


def divided_by_creepage(problem: wl.Problem) -> Any:
    with np.errstate(all="ignore"):
        return problem.longitudinal_creepage / problem.longitudinal_creepage * problem.friction_coefficient


WRONG_FRICTIONS: dict[str, tuple[str, Callable[[wl.Problem], Any]]] = {
    "OfTheBatch": (
        "points_are_independent",
        lambda problem: problem.friction_coefficient / (1.0 + np.ptp(problem.friction_coefficient)),
    ),
    "Sided": (
        "opposite_creepages_have_opposite_forces",  # less forwards than backwards
        lambda problem: np.where(problem.longitudinal_creepage > 0.0, 0.5, 1.0) * problem.friction_coefficient,
    ),
    "AtRest": ("contact_is_finite", divided_by_creepage),
    "HalfTheDigits": (
        "contact_is_in_double_precision",
        lambda problem: problem.friction_coefficient.astype(np.float32).astype(np.float64),
    ),
}
"""Friction after wrong stages by their names, each with the check that must catch it."""


def of_friction(name: str, friction: Callable[[wl.Problem], Any]) -> Any:
    """Return the class of a stage with another friction than the right one."""

    def altered(self: Any, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:  # noqa: ARG001
        return problem.replaced(friction_coefficient=friction(problem))

    return type(name, (Lubricated,), {"altered": altered, "__module__": __name__, "__doc__": "Wrong."})


WRONG_PROBLEMS: dict[str, tuple[str, Callable[[wl.Problem], wl.Problem]]] = {
    "Denser": ("stages_keep_what_is_not_theirs", lambda problem: problem.replaced(density=1.1 * problem.density)),
    "WithoutBodies": ("stages_keep_what_is_not_theirs", lambda problem: problem.replaced(bodies={})),
    "OnLinesAlone": (
        "stages_act_on_each_shape",
        lambda problem: Lubricated().altered(problem, None) if problem.geometry == "line" else problem,  # type: ignore[arg-type]
    ),
    "OnEllipsesAlone": (
        "stages_act_on_each_shape",
        lambda problem: problem if problem.geometry == "line" else Lubricated().altered(problem, None),  # type: ignore[arg-type]
    ),
    "FallsAtACreepage": (
        "stages_do_not_jump",
        lambda problem: problem.replaced(
            friction_coefficient=np.where(problem.rigid_slip > 3e-3, 0.97, 1.0) * problem.friction_coefficient
        ),
    ),
}
"""Problems after wrong stages by their names, each with the check that must catch it."""


def of_problem(name: str, change: Callable[[wl.Problem], wl.Problem]) -> Any:
    """Return the class of a stage that gives the contact model another problem."""
    methods = {"altered": lambda _, problem, __: change(problem), "__module__": __name__, "__doc__": "Wrong."}
    return type(name, (Lubricated,), methods)


class SinglePressure(Lubricated):
    """Returns the pressure in single precision."""

    name: ClassVar[str] = "single_pressure"

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Contact:
        contact = super().solve(problem, inner)
        return contact.replaced(pressure=contact.pressure.astype(np.float32).astype(np.float64))


class Reversed(Lubricated):
    """Turns the creepages, so that forces drive the creep."""

    name: ClassVar[str] = "reversed"

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return problem.replaced(longitudinal_creepage=-problem.longitudinal_creepage)

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Contact:
        contact = inner(self.altered(problem, lambda one: inner(one).forces))
        return contact.replaced(wear_index=-contact.wear_index)


class Forgets(Lubricated):
    """Returns one operating point only."""

    name: ClassVar[str] = "forgets"

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return problem[:1]


class Slower(Lubricated):
    """A speed that the contact does not feel, from a parameter without its unit."""

    name: ClassVar[str] = "slower"
    speed: Annotated[wl.Quantity, wl.Unit("km/h")] = Field(default="7 km/h", validate_default=True)
    """Speed of the film [m/s]."""

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return problem.replaced(rolling_speed=problem.rolling_speed + float(self.speed.magnitude))


class Damage(wl.Law):
    """Damage beyond a threshold, with the sign of the traction."""

    name: ClassVar[str] = "damage"
    source: ClassVar[str] = "test"
    outcome = wl.Outcome("rcf_damage", unit="", of="patch", sign="any")
    threshold: Annotated[wl.Quantity, wl.Unit("N")] = Field(default="15 N", validate_default=True)
    """Threshold of Tγ [N]."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return np.sign(contact.tangential_force) * np.maximum(contact.wear_index - p["threshold"], 0.0)


class ReadsItself(Damage):
    """Reads its own number in place of the one it is given."""

    name: ClassVar[str] = "reads_itself"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return contact.wear_index - self.threshold.m_as("N")


class Unsigned(Damage):
    """States an outcome without sign, but has one."""

    name: ClassVar[str] = "unsigned"
    outcome = wl.Outcome("rcf_damage", unit="", of="patch")


class PlainMean(Damage):
    """The mean pressure over the nodes, whatever their areas."""

    name: ClassVar[str] = "plain_mean"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        nodes = tuple(range(contact.rolling_speed.ndim, contact.pressure.ndim))
        damage: Array = contact.pressure.mean(axis=nodes) / (p["threshold"] * 1e6)
        return damage


class FirstNode(Damage):
    """The pressure of the first node."""

    name: ClassVar[str] = "first_node"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        first: Array = contact.pressure.reshape(*contact.rolling_speed.shape, -1)[..., 0]
        return first / (p["threshold"] * 1e6)


class AreaMean(Damage):
    """A right one: the mean pressure over the patch."""

    name: ClassVar[str] = "area_mean"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return contact.mean(contact.pressure) / (p["threshold"] * 1e6)


class SingleDamage(Damage):
    """Damage in single precision."""

    name: ClassVar[str] = "single_damage"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return super().rate(contact, p).astype(np.float32).astype(np.float64)


class Power(wl.Law):
    """Frictional power over area."""

    name: ClassVar[str] = "power"
    source: ClassVar[str] = "test"
    outcome = wl.Outcome("heat_flux", unit="W/mm^2", of="area mean")
    zero_in_stick: ClassVar[bool] = True

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return contact.frictional_power_density


class Distance(TypedDict):
    """The distance rolled."""

    rolled_distance: Annotated[wl.QuantityLike, wl.Unit("km", positive=False, negative=False)]


class RunningIn(wl.WearLaw):
    """Wear that falls with the distance rolled."""

    name: ClassVar[str] = "running_in"
    source: ClassVar[str] = "test"
    conditions: ClassVar = Distance

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        share = np.exp(-contact.per_node(contact.conditions["rolled_distance"]) / 2e3)
        return 1e-9 * (1.0 + share) * contact.wear_index_density


class Behind(wl.WearLaw):
    """Twice the wear far behind the leading edge; a right one."""

    name: ClassVar[str] = "behind"
    source: ClassVar[str] = "test"

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"x": (1e-3,)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return 5e-9 * contact.wear_index_density * np.where(contact.x < 1e-3, 1.0, 2.0)


RIGHT: list[Any] = [
    *(Lubricated(), Lubricated(share=0.9), wl.patch_mean(), Damage(), AreaMean(), Power(), RunningIn(), Behind())
]
"""Stages and laws that pass."""


class Unread(Lubricated):
    """Does not read its field."""

    half_speed: Annotated[wl.Quantity, wl.Unit("m/s")] = wl.Q(20, "m/s")
    """Speed at which friction should be half as high [m/s]."""


CAUGHT: dict[Any, str] = {
    Unread: "each_field_of_a_stage_matters",
    **{of_friction(name, friction): check for name, (check, friction) in WRONG_FRICTIONS.items()},
    **{of_problem(name, change): check for name, (check, change) in WRONG_PROBLEMS.items()},
    SinglePressure: "contact_is_in_double_precision",
    Reversed: "pipelines_take_the_contact",
    Forgets: "pipelines_take_the_contact",
    Slower: "units_of_parameters_do_not_matter",
    ReadsItself: "parameters_may_vary",
    Unsigned: "rate_is_never_negative",
    PlainMean: "listing_of_nodes_does_not_matter",
    FirstNode: "listing_of_nodes_does_not_matter",
    SingleDamage: "precision_is_double",
}
"""The check that must catch each."""
