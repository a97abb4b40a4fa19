"""Composition: rig | contact model | patch mean, where it is needed, | wear law."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, Literal, Self

from pydantic import model_validator

from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, ConditionsError, InputError
from wearlaw.models.contact_model import Scale
from wearlaw.models.rig import P
from wearlaw.models.wear_law import WearLaw
from wearlaw.numerics.blocks import Columns
from wearlaw.numerics.integrate import integrate_forces, integrate_wear
from wearlaw.pipeline.composition import (
    check_geometry,
    check_scale,
    check_traction,
    warn_of_calibration,
    warn_of_geometry,
)
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.ranges import RangeWatch
from wearlaw.plugins.fields import ContactModelField, RigField, WearLawField
from wearlaw.settings.configuration import Configuration

ORDER = 'the order is rig | wl.contact_model("exact") | wl.patch_mean(), where it is needed, | wl.wear_law("usfd")'


class PatchMean(Configuration):
    """The stage that replaces a resolved contact by its patch means."""

    stage: Literal["patch_mean"] = "patch_mean"
    """Its name, by which files tell stages apart."""

    def __repr__(self) -> str:
        return "patch_mean()"

    if not TYPE_CHECKING:  # checkers reject this order by themselves

        def __or__(self, other: object) -> object:
            raise CompositionError(f"wl.patch_mean() cannot start a pipeline; {ORDER}")


def patch_mean() -> PatchMean:
    """Return the stage that replaces a resolved contact by its patch means, for laws that are stated for them."""
    return PatchMean()


class Pipeline(Configuration, Generic[P]):
    """A rig and a contact model, followed by stages and a wear law: predicts the contact, and with a law the wear.

    A pipeline is frozen: it prints, compares, hashes, pickles, and serialises with
    ``model_dump_json()`` to what ``Pipeline.model_validate_json(...)`` reads.
    """

    rig: RigField
    """The two bodies that roll on each other."""
    contact_model: ContactModelField
    """The theory of the tangential contact."""
    stages: tuple[PatchMean, ...] = ()
    """What changes the contact before a law sees it."""
    laws: tuple[WearLawField, ...] = ()
    """The law of wear; empty where only the contact is predicted."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        check_geometry(self.rig, self.contact_model)
        if len(self.laws) > 1:
            raise CompositionError(f"a pipeline has one wear law, got {' and '.join(law.name for law in self.laws)}")
        for law in self.laws:
            check_scale(self.scale, self.contact_model, law)
        return self

    @property
    def scale(self) -> Scale:
        """Whether a law sees the means of the patch or its cells."""
        return "patch" if self.stages else self.contact_model.scale

    def without_law(self) -> Pipeline[P]:
        """Return the pipeline that predicts the contact alone."""
        return Pipeline(rig=self.rig, contact_model=self.contact_model, stages=self.stages) if self.laws else self

    @property
    def wear_law(self) -> WearLaw:
        """The law of wear.

        Raises
        ------
        CompositionError
            If the pipeline has none.
        """
        if not self.laws:
            raise CompositionError(
                f"the pipeline has no wear law; give one, as in rig | {self.contact_model!r} | wl.wear_law('usfd')"
            )
        return self.laws[0]

    def with_law(self, law: WearLaw) -> Pipeline[P]:
        """Return the pipeline with this law in place of its own, without a warning of what it was fitted for."""
        return Pipeline(rig=self.rig, contact_model=self.contact_model, stages=self.stages, laws=(law,))

    def __repr__(self) -> str:
        return " | ".join(map(repr, (self.rig, self.contact_model, *self.stages, *self.laws)))

    def __or__(self, stage: WearLaw | PatchMean) -> Pipeline[P]:
        """Return the pipeline with a wear law, or with the contact's patch means."""
        if self.laws:
            raise CompositionError(f"a pipeline ends with its wear law, nothing follows it, not {stage!r}; {ORDER}")
        if isinstance(stage, PatchMean):
            return Pipeline(rig=self.rig, contact_model=self.contact_model, stages=(stage,))
        if not isinstance(stage, WearLaw):
            raise CompositionError(f"a contact model is followed by wl.patch_mean() or a wear law, not by {stage!r}")
        pipeline = self.with_law(stage)
        warn_of_calibration(self.rig.geometry, self.contact_model, self.scale, stage)
        return pipeline

    def __call__(self, *positional: P.args, **conditions: P.kwargs) -> Prediction:
        """Return the contact and the wear under the given conditions; see the `problem` of the rig for these."""
        if positional:
            raise ConditionsError(f"{positional[0]!r}: is given without a name; write creepage=..., for example")
        problem: Problem = self.rig.checked_problem(conditions)
        return self.predict(problem, stacklevel=3)

    def predict(
        self,
        problem: Problem,
        *,
        on_block: Callable[[int], None] | None = None,
        stacklevel: int = 2,
    ) -> Prediction:
        """Return the contact and the wear for a contact problem that the rig has made.

        Parameters
        ----------
        problem : Problem
            From the `problem` of the rig.
        on_block : callable, optional
            Called with the number of operating points done after each block of them, to show progress.
        stacklevel : int
            Which caller warnings name; 2 is the caller of this method.
        """
        if self.rig.geometry not in (None, problem.geometry):
            raise InputError(f"problem: {type(problem).__name__} is not what a {type(self.rig).__name__} makes")
        for law in self.laws:
            warn_of_geometry(self.rig, self.contact_model, self.scale, law, problem, stacklevel + 1)
        watch = self.range_watch()
        found = self.watched(problem, watch, on_block)
        watch.warn(stacklevel)
        return found

    def range_watch(self) -> RangeWatch:
        """Return what sees whether operating points stay elastic, and in the range of the law, if there is one."""
        return RangeWatch(self.laws[0] if self.laws else None)

    def watched(self, problem: Problem, watch: RangeWatch, on_block: Callable[[int], None] | None = None) -> Prediction:
        """Return what `predict` does, without its warnings; `watch` sees the operating points."""
        model, scale = self.contact_model, self.scale
        if problem.geometry == "line":
            check_traction(model, problem)
        if not self.laws:
            return self._without_wear(problem, watch, on_block)
        law = self.laws[0]

        def see(part: Problem, columns: Columns) -> None:
            watch.see_block(self.rig, part, columns)
            if on_block is not None:
                on_block(part.size)

        wear = integrate_wear(model, law, problem, scale, see)
        found = Prediction(self, problem, wear.forces, wear)
        law.check_not_negative(wear.wear_rate, lambda: found.wear_rate_error.to("kg/m^3").magnitude)
        return found

    def _without_wear(self, problem: Problem, watch: RangeWatch, on_block: Callable[[int], None] | None) -> Prediction:
        forces = integrate_forces(self.contact_model, problem)
        watch.points += problem.size
        watch.see_overload(self.rig.overload(problem, forces.tangential))
        if on_block is not None:
            on_block(problem.size)
        return Prediction(self, problem, forces)
