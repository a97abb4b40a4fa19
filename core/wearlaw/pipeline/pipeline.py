"""The `Rig`, which poses contact problems, and the `Pipeline` that a user composes from it.

The order is rig | contact model | stages, if any, | laws.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Generic, ParamSpec, Protocol, Self, cast, overload

import numpy as np
import pint
from pydantic import Field, model_validator

from wearlaw.arrays import Array, read_only, steadily, steady
from wearlaw.configuration import LINE, Configuration
from wearlaw.contact.conditions import (
    Condition,
    FrictionLaw,
    broadcast,
    declared,
    friction_at,
    is_friction_law,
    together,
)
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import Body, CreepForces
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, ConditionsError, ModelError, UnitError, did_you_mean, shown
from wearlaw.fields import RIG, ContactModelField, LawField, StageField
from wearlaw.late import method
from wearlaw.models.contact_model import ContactModel, Scale, Stage
from wearlaw.models.law import WEAR, Law
from wearlaw.models.model import ORDER, Blame, Model, fault
from wearlaw.numerics.integrate import Forces, prepared
from wearlaw.numerics.solving import check_problem
from wearlaw.numerics.staged import staged
from wearlaw.pipeline.composition import (
    check_geometry,
    check_laws,
    check_scale,
    check_traction,
    law_among,
    remarks_on_parameters,
    several_patches,
    warn_of_parameters,
    warn_of_unlike_materials,
)
from wearlaw.pipeline.posed import axes, in_batch, masked, with_conditions, with_same
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.ranges import RangeWatch
from wearlaw.pipeline.solution import Solution
from wearlaw.units.quantities import parse, real_array, with_units
from wearlaw.units.registry import with_magnitude
from wearlaw.units.usual import OneWarning

if TYPE_CHECKING:
    from wearlaw.late import Pipelines

OTHER_NAMES = {"mu": "friction_coefficient", "cof": "friction_coefficient", "load": "normal_force", "slip": "creepage"}
"""What people call conditions, and the names that most rigs have for them."""

TOUCH_NOWHERE = "rig '{}': the bodies touch nowhere, or their loads have no balance; check the conditions"

P = ParamSpec("P")


class Poses(Protocol[P]):
    """A rig as type checkers see it: the conditions that it takes."""

    def problem(self, *args: P.args, **conditions: P.kwargs) -> Problem:
        """Return the problem that the conditions pose."""
        ...


class Declares(Protocol):
    """A stage or a law as type checkers see it if it declares conditions: a pipeline with it takes any."""

    conditions: ClassVar[type[Any]]


class DeclaresAndSolves(Declares, Protocol):
    """A contact model as type checkers see it if it declares conditions."""

    def solve(self, problem: Problem) -> Contact:
        """Return the solved contact."""
        ...


class Rig(Model):
    """Base class for rigs: two bodies that roll on each other under given conditions.

    A rig of your own implements `problem`, with the conditions as keyword arguments. Its fields hold everything that
    stays the same from test to test.
    """

    kind: ClassVar[str] = "rig"

    patch_geometry: ClassVar = cast(Any, None)  # Any: for type checkers, a subclass may make it a property
    """The shape of the patch. A contact model that cannot solve it raises an error at once. None if the shape is known
    only from the problem. A rig with a field that chooses the shape can make it a property."""

    choices: ClassVar[Sequence[tuple[str, ...]]] = ()
    """Names of conditions of which exactly one is given, such as [("normal_force", "max_pressure")]."""

    creepage: ClassVar[str | None] = "creepage"
    """Name of the condition that sets the creepage: `creepage_for` solves for it, and the tables of a case run along
    it. None if no single condition does, as on a rig with two speeds."""

    example: ClassVar[Mapping[str, Any]] = {}
    """Conditions of one test to try the rig with, such as {"mass": "20 kg", "creepage": "1 %"}."""

    @classmethod
    def subject(cls) -> str:
        """Return the name of this rig in messages."""
        return cls.__name__

    @abstractmethod
    def problem(self, *args: Any, **conditions: Any) -> Problem:
        """Return the contact problem that the conditions pose; arrays broadcast against each other."""

    def balanced(self, problem: Problem, forces: Callable[[Problem], CreepForces]) -> Problem:  # noqa: ARG002
        """Return the problem with loads that balance the forces transmitted by its contact.

        On a flange, for example, the normal force depends on the lateral force. A rig whose loads do not depend on the
        forces does not override this method.

        Parameters
        ----------
        problem : Problem
            The result of `problem`.
        forces : callable
            Solves a problem with the contact model of the pipeline and returns the forces.
        """
        return problem

    @property
    def bodies(self) -> Mapping[str, Body]:
        """The two bodies by name; wear is predicted for the first body. {} if the bodies are unknown."""
        return {}

    @classmethod
    def conditions(cls) -> Mapping[str, Condition]:
        """Return the conditions that `problem` takes, by name.

        They come from the `TypedDict` of its ``**conditions: Unpack[...]``, or else from its arguments. If it takes
        ``**conditions`` of any names, the result is {}; override this method to name them.
        """
        return declared(cls.problem)

    @classmethod
    def in_si(
        cls,
        conditions: Mapping[str, object],
        creep_speed: Callable[[dict[str, Array]], Array] | None = None,
        **otherwise: float,
    ) -> dict[str, Array]:
        """Return the conditions as SI arrays of one shape; call it in `problem`.

        Parameters
        ----------
        conditions : mapping
            The conditions as given; None counts as not given.
        creep_speed : callable, optional
            Computes the speed that friction can depend on [m/s] from the other conditions. Without it, friction laws
            are left out, for the rig to evaluate.
        **otherwise : float
            Values of conditions that are not given [SI]; others are left out of the result.

        Raises
        ------
        ConditionsError
            If conditions are missing, unknown or contradictory, or do not broadcast.
        UnitError
            If a condition lacks its unit or is out of bounds.
        """
        declared = _own_conditions(cls)
        arrays: dict[str, Array] = {}
        laws: dict[str, FrictionLaw] = {}
        with OneWarning():
            for name, value in conditions.items():
                condition = declared.get(name)
                if value is None or condition is None or condition.check is None:
                    continue
                if condition.law and is_friction_law(value):
                    laws[name] = value
                else:
                    arrays[name] = condition.check(value, name)
        cls._check_names(declared, conditions)
        for name, si in otherwise.items():
            arrays.setdefault(name, np.float64(si))  # type: ignore[arg-type]
        arrays = broadcast(arrays)
        if creep_speed is None or not laws:
            return arrays
        speed = creep_speed(arrays)
        return {**arrays, **{name: friction_at(law, name, speed) for name, law in laws.items()}}

    @classmethod
    def presets(cls) -> Mapping[str, Callable[..., Rig]]:
        """Return functions that make known rigs of this class, by name; their arguments override the preset's values.

        Case files name the presets, as in ``preset = "suros"``. wearlaw checks the arguments by their annotations.
        """
        return {}

    def checked_problem(self, conditions: Mapping[str, Any], models: Iterable[Model] = ()) -> Problem:
        """Return `problem` of the conditions, or raise an error that says whether the conditions or the rig are wrong.

        Parameters
        ----------
        conditions : mapping
            The conditions of the rig and of the models.
        models : iterable of Model
            Contact models, stages and laws, whose conditions the problem gets.

        Raises
        ------
        ConditionsError
            If a condition is missing or unknown.
        ModelError
            If the rig fails or does not return a problem.
        """
        declared = [condition for model in models for condition in model.own_conditions().values()]
        of_rig, arrays = _parted(self, conditions, declared) if declared else (conditions, {})
        try:
            with Blame(self):
                problem = in_batch(_posed(self, of_rig))
                if declared:
                    problem = with_conditions(problem, arrays)
        except (ModelError, ConditionsError) as error:
            if declared or isinstance(error, ModelError):
                self.check_names(conditions, models)
            raise
        for condition in declared:
            if condition.required and condition.name not in problem.conditions:
                raise ConditionsError(_missing(condition))
        check_problem(self, problem)
        return problem if problem.bodies else problem.replaced(bodies=self.bodies)

    @classmethod
    def check_names(cls, conditions: Mapping[str, object], models: Iterable[Model] = ()) -> None:
        """Check the names of conditions; a rig whose `conditions` are not known takes any name.

        Raises
        ------
        ConditionsError
            If a condition is missing or unknown, or several of one choice are given.
        """
        if cls.conditions():
            cls._check_names(together([cls.conditions(), *(model.own_conditions() for model in models)]), conditions)

    @classmethod
    def _check_names(cls, declared: Mapping[str, Condition], conditions: Mapping[str, object]) -> None:
        if not declared:
            return
        for name in conditions:
            if name not in declared:
                raise ConditionsError(f"{name}: {unknown_condition(name, declared, cls)}")
        for names in cls.choices:
            stated = [name for name in names if conditions.get(name) is not None]
            if len(stated) != 1:
                raise ConditionsError(
                    f"give exactly one of {', '.join(names)}; got {' and '.join(stated) or 'none of them'}"
                )
        for name, condition in declared.items():
            if condition.required and conditions.get(name) is None:
                raise ConditionsError(
                    _missing(condition) if condition.of else f"{name}: is missing; {cls._fix(name, declared)}"
                )

    @classmethod
    def _fix(cls, name: str, declared: Iterable[str]) -> str:
        """Return what to do about a missing condition."""
        example = cls.example.get(name)
        if example is None:
            return f"rig '{cls.name}' takes {', '.join(declared)}"
        if isinstance(example, str) and " " in example:
            example = 'Q({}, "{}")'.format(*example.split(" ", 1))
        return f"give {name}={example}"

    @overload
    def __or__(self, model: DeclaresAndSolves) -> Pipeline[...]: ...
    @overload
    def __or__(self: Poses[P], model: ContactModel) -> Pipeline[P]: ...
    @overload
    def __or__(self: Poses[P], model: Sequence[ContactModel]) -> Pipelines[P]: ...
    def __or__(self, model: Any) -> Any:
        """Return the pipeline that solves this rig's contact with a contact model, or with each of a list of them."""
        if isinstance(model, list | tuple):
            return _several(self, model)
        if not isinstance(model, ContactModel):
            raise CompositionError(f"a rig is followed by a contact model, not by {shown(model)}; {ORDER}")
        return Pipeline(rig=self, contact_model=model)


def _missing(condition: Condition) -> str:
    """Return what to do about a missing condition of a model."""
    return f"{condition.name}: is missing; {condition.of} needs it. Give {condition.name}={condition.example!r}"


def unknown_condition(name: str, names: Iterable[str], rig: type[Rig]) -> str:
    """Return what is wrong with a condition that a rig does not have."""
    if name in rig.model_fields:
        return (
            f"is a field of rig '{rig.name}', with one value for all operating points; give it to the rig. The"
            f" conditions are: {', '.join(names)}"
        )
    hint = did_you_mean(name, names)
    if hint == ".":
        hint = did_you_mean(OTHER_NAMES.get(name.lower(), name), names)
    return f"unknown condition{hint} The conditions are: {', '.join(names)}"


@cache
def _own_conditions(rig: type[Rig]) -> Mapping[str, Condition]:
    """Return the conditions of the nearest `problem` with a table; a subclass may hand its conditions on."""
    tables = (declared(base.problem) for base in rig.__mro__ if issubclass(base, Rig))
    return next((conditions for conditions in tables if any(condition.table for condition in conditions.values())), {})


@steady
def _posed(rig: Rig, conditions: Mapping[str, Any]) -> Problem:
    checked = {name: value if type(value) in (str, float) else _read_only(value) for name, value in conditions.items()}
    problem = rig.problem(**checked)
    if not isinstance(problem, Problem):
        raise fault(rig, f"returned {shown(problem)}, not a wearlaw.Problem")
    return problem


def _parted(
    rig: Rig, conditions: Mapping[str, Any], declared: Iterable[Condition]
) -> tuple[Mapping[str, Any], dict[str, Array]]:
    """Return the conditions of a rig, and those that models declare as SI arrays.

    One condition of the rig gets the axes of those of models, so that the rig makes a batch with room for them.
    """
    arrays: dict[str, Array] = {}
    for condition in declared:  # each checks its own bounds
        if (value := conditions.get(condition.name)) is not None:
            arrays[condition.name] = read_only(condition.in_si(value)) if np.ndim(value) else condition.in_si(value)
    names, taken = {condition.name for condition in declared}, rig.conditions()
    of_rig = {name: value for name, value in conditions.items() if name in taken or name not in names}
    shape = broadcast(arrays)[next(iter(arrays))].shape if arrays else ()
    for name, value in of_rig.items() if shape else ():
        try:
            quantity = parse(value) if isinstance(value, str) or with_units(value) else value
            plain = not isinstance(quantity, pint.Quantity)
            numbers = real_array(quantity if plain else quantity.magnitude)
        except UnitError:  # no number, such as a law of friction
            continue
        wide = np.broadcast_to(numbers, broadcast({name: numbers, **arrays})[name].shape)
        return {**of_rig, name: wide if plain else with_magnitude(quantity, wide)}, arrays
    return of_rig, arrays


def _read_only(value: Any) -> Any:
    """Return a condition whose array, if it has one, cannot be written to; the next contact model reads it too."""
    if isinstance(value, np.ndarray):
        return read_only(value)
    if isinstance(value, pint.Quantity) and isinstance(value.magnitude, np.ndarray):
        return with_magnitude(value, read_only(value.magnitude))
    return value


RigField = Annotated[Rig, *RIG]
"""A field that takes a rig, its name, or a table of its fields with its name as `type` or the name of a `preset`."""


class Pipeline(Configuration, Generic[P]):
    """A rig, a contact model, and stages and laws if given; predicts the contact and the outcomes of the laws.

    A pipeline is frozen and can be printed, compared, hashed and pickled. ``model_dump_json()`` writes it as JSON, and
    ``Pipeline.model_validate_json(...)`` reads it back.
    """

    rig: RigField
    """The two bodies that roll on each other."""
    contact_model: ContactModelField
    """The theory of the tangential contact."""
    stages: tuple[StageField, ...] = ()
    """Stages around the contact model, the first of them next to the model."""
    laws: tuple[LawField, ...] = ()
    """The laws, of different outcomes or for different bodies; empty if the pipeline predicts the contact alone."""
    compared_with: tuple[Any, ...] = Field(default=(), exclude=True, repr=False)
    """Models of other pipelines of the same comparison, whose conditions are taken, too."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.models:
            self.conditions  # noqa: B018  raises if those of two models contradict each other
        check_geometry(self.rig, self.contact_model, self.rig.patch_geometry)
        for law in self.laws:
            check_scale(self.scale, self.contact_model, law)
            law.check_variables()
        if self.laws:
            check_laws(self.laws, self.rig.bodies)
        return self

    @cached_property
    def staged_model(self) -> ContactModel:
        """The contact model with the stages around it, as one contact model."""
        return staged(self.contact_model, self.stages)

    @cached_property
    def models(self) -> tuple[Model, ...]:
        """The models that declare conditions, among the pipeline's own and those that it is compared with."""
        every = (self.contact_model, *self.stages, *self.laws, *self.compared_with)
        return tuple(model for model in every if model.conditions is not None)

    def among(self, models: Iterable[Model]) -> Pipeline[P]:
        """Return the pipeline with the models that it is compared with, whose conditions its predictions take, too."""
        declaring = tuple(model for model in models if model.conditions is not None)
        return self.model_copy(update={"compared_with": declaring}) if declaring else self

    @cached_property
    def conditions(self) -> Mapping[str, Condition]:
        """The conditions that a prediction takes, by name: those of the rig and those that its models declare."""
        return together([self.rig.conditions(), *(model.own_conditions() for model in self.models)])

    @property
    def scale(self) -> Scale:
        """Whether a law sees the means of the patch or its cells."""
        scale: Scale = self.staged_model.scale
        return scale

    def without_law(self) -> Pipeline[P]:
        """Return the pipeline that predicts the contact alone."""
        return self.with_law() if self.laws else self

    @property
    def wear_law(self) -> Law:
        """The wear law.

        Raises
        ------
        CompositionError
            If the pipeline has none, or one for each body.
        """
        return self.laws[law_among(self.laws, self.contact_model, WEAR)]

    def with_law(self, *laws: Law) -> Pipeline[P]:
        """Return the pipeline with these laws in place of its own, without the warnings about their calibration."""
        return Pipeline(
            rig=self.rig,
            contact_model=self.contact_model,
            stages=self.stages,
            laws=laws,
            compared_with=self.compared_with,
        )

    def __repr__(self) -> str:
        parts = [repr(part) for part in (self.rig, self.contact_model, *self.stages, *self.laws)]
        line = " | ".join(parts)
        return line if len(line) <= LINE else "({})".format("\n | ".join(parts))

    @overload
    def __or__(self, part: Declares) -> Pipeline[...]: ...
    @overload
    def __or__(self, part: Law | Stage) -> Pipeline[P]: ...
    @overload
    def __or__(self, part: Sequence[Law]) -> Pipelines[P]: ...
    def __or__(self, part: Any) -> Any:
        """Return the pipeline with one more law or stage around the contact model, or with each of a list of laws."""
        if isinstance(part, list | tuple) and not self.laws:
            return _several(self.rig, [self.contact_model], self.stages, part, dims=["law"])
        if isinstance(part, Stage):
            if self.laws:
                raise CompositionError(f"a stage stands before the laws, not after them: {shown(part)}; {ORDER}")
            return Pipeline(rig=self.rig, contact_model=self.contact_model, stages=(*self.stages, part))
        before, after = ("law", "another law") if self.laws else ("contact model", "a stage or a law")
        if not isinstance(part, Law):
            raise CompositionError(f"a {before} is followed by {after}, not by {shown(part)}; {ORDER}")
        pipeline = self.with_law(*self.laws, part)
        warn_of_parameters(part, self.contact_model, self.scale, self.rig.patch_geometry, self.rig.bodies)
        return pipeline

    def __call__(self, /, *positional: P.args, **conditions: P.kwargs) -> Prediction:
        """Return the contact and the wear under the given conditions; see the rig's `problem` for the conditions."""
        if positional:
            first = next(iter(self.rig.conditions()), "creepage")
            raise ConditionsError(f"{shown(positional[0])}: is given without a name; write {first}=..., for example")
        with OneWarning():
            return self._predicted(self.posed(conditions), RangeWatch(*self.laws), conditions)

    def posed(self, conditions: Mapping[str, Any], of_one_patch: str = "") -> Problem:
        """Return the rig's problem for these conditions, with loads that balance the forces.

        Parameters
        ----------
        conditions : mapping
            As for the `problem` of the rig.
        of_one_patch : str
            Name of the application that needs one patch at each operating point, such as "fit".

        Raises
        ------
        CompositionError
            If the application needs one patch and the rig makes several.
        """
        rig, problem = self.rig, self.rig.checked_problem(conditions, self.models)
        if of_one_patch and (several := several_patches(problem, rig)):
            raise CompositionError(f"{of_one_patch}: {several}")
        if type(rig).balanced is Rig.balanced:
            return problem
        with Blame(rig), steadily():
            forces = Forces(self.staged_model)
            names = {name for model in self.models if not isinstance(model, Law) for name in model.own_conditions()}
            names &= problem.conditions.keys()
            balanced = rig.balanced(problem, lambda part: forces(with_same(part, problem, names) if names else part))
            if not isinstance(balanced, Problem) or axes(balanced) != axes(problem):
                raise ValueError("`balanced` must return a problem like the one given, as from `Problem.replaced`")
            if problem.conditions and not balanced.conditions:
                balanced = balanced.replaced(conditions=problem.conditions)
            if balanced.exists is not None and balanced.exists is not problem.exists:
                balanced = masked(balanced)
        check_problem(rig, balanced)
        return balanced

    def predict(self, problem: Problem, *, on_block: Callable[[int], None] | None = None) -> Prediction:
        """Return the contact and the wear for a contact problem made by the rig.

        Parameters
        ----------
        problem : Problem
            From the `problem` of the rig.
        on_block : callable, optional
            Called after each block with the number of its operating points, to show progress.
        """
        return self._predicted(problem, RangeWatch(*self.laws, on_block=on_block))

    def _predicted(
        self, problem: Problem, watch: RangeWatch, conditions: Mapping[str, Any] | None = None
    ) -> Prediction:
        resolved = None if problem.exists is None else problem.resolved
        if resolved is not None and not resolved.any():
            raise ConditionsError(TOUCH_NOWHERE.format(self.rig.name))
        self.warn_of_problem(problem)
        prediction = self.watched(problem, watch, conditions)
        warn_of_unlike_materials(self.contact_model, problem)
        watch.warn()
        return prediction

    def warn_of_problem(self, problem: Problem) -> None:
        """Warn of parameters fitted for another shape of patch or other materials if only the problem shows them.

        If the rig declares its geometry or its bodies, composing the pipeline gave the warning.
        """
        geometry, bodies = self.rig.patch_geometry, self.rig.bodies
        for law in self.laws if geometry is None or not bodies else ():
            told = [*remarks_on_parameters(law, self.contact_model, self.scale, geometry, bodies)]
            warn_of_parameters(law, self.contact_model, self.scale, problem.geometry, problem.bodies, told)

    def watched(self, problem: Problem, watch: RangeWatch, conditions: Mapping[str, Any] | None = None) -> Prediction:
        """Return the result of `predict` without its warnings; `watch` sees the operating points."""
        if problem.geometry == "line":
            check_traction(self.contact_model, problem)
        if problem.dims:
            watch.counted = "patches"
        model, problem = prepared(self.staged_model, problem)
        return Prediction(Solution.of(model, self.laws, problem, watch, conditions))


def _several(*parts: Any, **more: Any) -> Any:
    """Return the pipelines of lists of models, which give a dataset and need what sweeps need."""
    return method("Pipelines", "a list of models")(*parts, **more)
