"""What a plugin implements that sets two bodies rolling: `Rig`. It turns the conditions of a test into a problem."""

from __future__ import annotations

import inspect
from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, ParamSpec, Protocol

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.arrays.extremes import extremes
from wearlaw.contact.elastic_limit import Overload, overload
from wearlaw.contact.material import Material
from wearlaw.contact.problem import Geometry, Problem
from wearlaw.errors import CompositionError, ConditionsError, InputError, ModelError, did_you_mean
from wearlaw.models.contact_model import Blame, ContactModel, Model
from wearlaw.units.quantities import scalar_si

if TYPE_CHECKING:
    from wearlaw.pipeline.pipeline import Pipeline

P = ParamSpec("P")

TINY = float(np.sqrt(np.finfo(np.float64).tiny))
"""The least length or pressure in SI whose square is a float of full precision."""

LEAST_FRICTION = 1e-12
"""The least friction coefficient; below it creepage over that of full slip overflows in formulas of fourth order."""


@dataclass(frozen=True)
class Body:
    """One of the two bodies of a rig.

    Attributes
    ----------
    material : Material
        What it is made of.
    rolling_radius : float
        Radius of the surface that rolls [m]; infinite where the body is flat or straight, as a rail is.
    """

    material: Material
    rolling_radius: float


class Poses(Protocol[P]):
    """What type checkers see of a rig: the conditions that it takes."""

    def problem(self, *args: P.args, **conditions: P.kwargs) -> Problem:
        """Return the problem that the conditions pose."""
        ...


class Rig(Model):
    """Two bodies that roll on each other under given conditions.

    A rig of your own implements `problem`, with the conditions as keyword arguments. Its fields are what stays the same
    from test to test.
    """

    kind: ClassVar[str] = "rig"

    geometry: ClassVar[Geometry | None] = None
    """The shape of the patch, by which a contact model that cannot solve it is refused at once; None where only the
    problem tells."""

    creepage: ClassVar[str] = "creepage"
    """The condition that is the creepage: `creepage_for` looks for it, and the tables of a case run along it."""

    example: ClassVar[Mapping[str, Any]] = {}
    """Conditions of one test, to try the rig with, such as {"mass": "20 kg", "creepage": "1 %"}."""

    example_fields: ClassVar[Mapping[str, Any]] = {}
    """Values of the fields without a default, to try the rig with."""

    @classmethod
    def subject(cls) -> str:
        """Return what messages call this rig."""
        return cls.__name__

    @abstractmethod
    def problem(self, *args: Any, **conditions: Any) -> Problem:
        """Return the contact problem that the conditions pose; arrays broadcast against each other."""

    @property
    def bodies(self) -> Mapping[str, Body]:
        """The two bodies by name, of which the first is the one whose wear is predicted; {} where they are unknown."""
        return {}

    def body(self, name: str) -> Body:
        """Return the body of a name.

        Raises
        ------
        InputError
            If there is none.
        """
        known = self.bodies
        if name not in known:
            names = " and ".join(repr(one) for one in known) or "not named"
            raise InputError(f"body: this rig has no '{name}'; its bodies are {names}")
        return known[name]

    @classmethod
    def conditions(cls) -> tuple[str, ...]:
        """Return the names of the conditions that `problem` takes; a rig that takes `**conditions` overrides this."""
        parameters = list(inspect.signature(cls.problem).parameters.values())[1:]
        return tuple(one.name for one in parameters if one.kind is not one.VAR_KEYWORD)

    @classmethod
    def needed(cls) -> tuple[str, ...]:
        """Return the names of the conditions that must always be given: those of `problem` without a default."""
        known = cls.conditions()
        parameters = inspect.signature(cls.problem).parameters.values()
        return tuple(one.name for one in parameters if one.default is one.empty and one.name in known)

    @classmethod
    def presets(cls) -> Mapping[str, Callable[..., Rig]]:
        """Return functions that make known rigs of this class, by name; their arguments are what may be overridden.

        Case files name them, as in ``preset = "suros"``. The arguments are checked by their annotations.
        """
        return {}

    def checked_problem(self, conditions: Mapping[str, Any]) -> Problem:
        """Return `problem` of the conditions, or raise an error that says whether they or the rig are wrong.

        Raises
        ------
        ConditionsError
            If a condition is missing or unknown.
        ModelError
            If the rig fails, or returns no problem.
        """
        try:
            with Blame(self):
                problem = self.problem(**conditions)
        except ModelError:
            self.check_names(conditions)
            raise
        if not isinstance(problem, Problem):
            raise ModelError(f"rig '{self.name}' returned {problem!r}, not a wearlaw.Problem")
        return problem

    def check_names(self, conditions: Mapping[str, Any]) -> None:
        """Check the names of conditions; a rig whose `conditions` are not known takes any.

        Raises
        ------
        ConditionsError
            If a condition is missing or unknown.
        """
        known = self.conditions()
        for name in conditions if known else ():
            if name not in known:
                raise ConditionsError(
                    f"{name}: unknown condition{did_you_mean(name, known)} The conditions are: {', '.join(known)}"
                )
        for name in self.needed():
            if name not in conditions:
                raise ConditionsError(f"{name}: is missing; rig '{self.name}' takes {', '.join(known)}")

    def __or__(self: Poses[P], model: ContactModel) -> Pipeline[P]:
        """Return the pipeline that solves this rig's contact with a contact model."""
        from wearlaw.pipeline.pipeline import Pipeline

        if not isinstance(model, ContactModel):
            raise CompositionError(
                f"a rig is followed by a contact model, not by {model!r};"
                ' for example rig | wl.contact_model("fastsim") | wl.wear_law("usfd")'
            )
        assert isinstance(self, Rig)
        return Pipeline(rig=self, contact_model=model)

    def overload(self, problem: Problem, tangential_force: Array) -> Overload | None:
        """Return the operating point furthest beyond first yield of a body, or None if all are elastic.

        Parameters
        ----------
        problem : Problem
        tangential_force : ndarray
            Its magnitude [N], of the batch shape.
        """
        if not self._strengths:
            return None
        return overload(
            self._strengths,
            problem.max_pressure,
            tangential_force / problem.normal_force,
            problem.friction_coefficient,
            None if problem.geometry == "line" else problem.a / problem.b,
        )

    @cached_property
    def _strengths(self) -> set[tuple[float, float]]:
        """Yield stress in shear [Pa] and Poisson's ratio of the bodies for which they are known."""
        materials = (body.material for body in self.bodies.values())
        return {
            (scalar_si(one.shear_yield_stress, "Pa"), one.poisson_ratio)
            for one in materials
            if one.shear_yield_stress is not None
        }


def check_sizes(sizes: dict[str, Array], friction_coefficient: Array) -> None:
    """Refuse loads and sizes [SI] so far from any contact that floats overflow or lose their precision."""
    for name, value in sizes.items():
        low, high = extremes(value)
        if not (low > TINY and high < 1.0 / TINY):
            spread = f"{low:g}" if low == high else f"{low:g} to {high:g}"
            raise ConditionsError(
                f"the load gives a {name} of {spread} in SI units,"
                " which no contact has; check the units of the load and of the rig"
            )
    if extremes(friction_coefficient)[0] < LEAST_FRICTION:
        raise ConditionsError(f"friction_coefficient: must be at least {LEAST_FRICTION:g}, which no contact comes near")
