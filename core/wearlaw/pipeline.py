"""Composition: rig | contact model | wear law, with the checks that only the whole allows."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Generic, Self, TypeVar, Unpack, overload

from pydantic import model_validator

from wearlaw.arrays import Array
from wearlaw.conditions import TwinDiscConditions
from wearlaw.configuration import Configuration
from wearlaw.errors import CalibrationWarning, CompositionError, ConditionsError
from wearlaw.integrate import integrate_contact, integrate_wear
from wearlaw.line import LineProblem
from wearlaw.models import ContactModel, Scale, WearLaw
from wearlaw.ranges import RangeWatch
from wearlaw.result import ContactSolution, Prediction
from wearlaw.rig import TwinDisc
from wearlaw.specification import ContactModelField, WearLawField
from wearlaw.uncertainty.distributions import Distribution, PublishedRange
from wearlaw.units import Quantity, QuantityLike

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from wearlaw.uncertainty.result import Uncertainty

RigT = TypeVar("RigT", bound=TwinDisc)

ORDER = 'the order is rig | wl.contact_model("exact") | wl.patch_mean(), where it is needed, | wl.wear_law("usfd")'


class PatchMean(Configuration):
    """The stage that replaces a resolved contact by its patch means."""

    if not TYPE_CHECKING:  # checkers reject this order by themselves

        def __or__(self, other: object) -> object:
            raise CompositionError(f"wl.patch_mean() cannot start a pipeline; {ORDER}")


def patch_mean() -> PatchMean:
    """Return the stage that replaces a resolved contact by its patch means, for laws that are stated for them."""
    return PatchMean()


class ContactPipeline(Configuration, Generic[RigT]):
    """A rig with a contact model: predicts traction and slip, and takes a wear law to predict wear."""

    rig: RigT
    """The test rig."""
    contact_model: ContactModelField
    """The theory of the tangential contact."""
    use_patch_mean: bool = False
    """Whether the resolved contact is replaced by its patch means."""

    @property
    def scale(self) -> Scale:
        """Whether what comes out are the means of the patch or its cells."""
        return "patch" if self.use_patch_mean else self.contact_model.scale

    def __repr__(self) -> str:
        mean = " | patch_mean()" if self.use_patch_mean else ""
        return f"{self.rig!r} | {self.contact_model!r}{mean}"

    @overload
    def __or__(self, stage: WearLaw) -> Pipeline[RigT]: ...
    @overload
    def __or__(self, stage: PatchMean) -> ContactPipeline[RigT]: ...
    def __or__(self, stage: WearLaw | PatchMean) -> Pipeline[RigT] | ContactPipeline[RigT]:
        """Return the pipeline with a wear law, or with the contact's patch means."""
        if isinstance(stage, PatchMean):
            return ContactPipeline(rig=self.rig, contact_model=self.contact_model, use_patch_mean=True)
        if not isinstance(stage, WearLaw):
            raise CompositionError(f"a contact model is followed by wl.patch_mean() or a wear law, not by {stage!r}")
        pipeline = Pipeline(contact=self, wear_law=stage)
        _warn_of_calibration(self.scale, self.contact_model, stage)
        return pipeline

    def __call__(self: ContactPipeline[TwinDisc], **conditions: Unpack[TwinDiscConditions]) -> ContactSolution:
        """Return the contact under the given conditions; see `TwinDisc.problem` for these."""
        problem = self.rig.problem(**conditions)
        check_traction(self.contact_model, problem)
        self.rig.warn_of_plasticity(problem, stacklevel=2)
        force = integrate_contact(self.contact_model, problem)
        return ContactSolution(self.rig, self.contact_model, self.scale, problem, force)

    def creepage_for(
        self: ContactPipeline[TwinDisc],
        *,
        tangential_force: QuantityLike | None = None,
        traction_coefficient: ArrayLike | None = None,
        **conditions: QuantityLike | ArrayLike,
    ) -> Quantity:
        """Return the creepage at which the contact transmits a traction [-], of its sign and of the broadcast shape.

        Parameters
        ----------
        tangential_force : Quantity or str, optional
            T [N].
        traction_coefficient : array_like of float, optional
            T/N [-], in place of `tangential_force`.
        **conditions
            The load and the friction coefficient, as in `TwinDisc.problem`.

        Raises
        ------
        ConditionsError
            If no creepage, or more than one, transmits so much: at μN and above.
        """
        from wearlaw.inverse import creepage_for

        return creepage_for(self, tangential_force, traction_coefficient, conditions)


class Pipeline(Configuration, Generic[RigT]):
    """A rig, a contact model and a wear law: predicts wear.

    A pipeline is frozen: it prints, compares, hashes, pickles, and serialises with
    ``model_dump_json()`` to what ``Pipeline.model_validate_json(...)`` reads.
    """

    contact: ContactPipeline[RigT]
    """The rig with its contact model."""
    wear_law: WearLawField
    """The law of wear."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        _check_scale(self.contact.scale, self.contact.contact_model, self.wear_law)
        return self

    def __repr__(self) -> str:
        return f"{self.contact!r} | {self.wear_law!r}"

    if not TYPE_CHECKING:  # checkers reject this order by themselves

        def __or__(self, other: object) -> object:
            raise CompositionError(f"a pipeline ends with its wear law, nothing follows it, not {other!r}; {ORDER}")

    def __call__(self: Pipeline[TwinDisc], **conditions: Unpack[TwinDiscConditions]) -> Prediction:
        """Return the contact and the wear under the given conditions; see `TwinDisc.problem` for these."""
        return self.predict(self.contact.rig.problem(**conditions), stacklevel=3)

    def predict(
        self, problem: LineProblem, *, on_block: Callable[[int], None] | None = None, stacklevel: int = 2
    ) -> Prediction:
        """Return the contact and the wear for a contact problem that the rig has made.

        Parameters
        ----------
        problem : LineProblem
            From `TwinDisc.problem`.
        on_block : callable, optional
            Called with the number of operating points done after each block of them, to show progress.
        stacklevel : int
            Which caller warnings name; 2 is the caller of this method.
        """
        rig, model, scale = self.contact.rig, self.contact.contact_model, self.contact.scale
        check_traction(model, problem)
        rig.warn_of_plasticity(problem, stacklevel=stacklevel)
        watch = RangeWatch(self.wear_law)

        def see(part: LineProblem, force: Array) -> None:
            watch.see(part, force)
            if on_block is not None:
                on_block(part.creepage.size)

        wear = integrate_wear(model, self.wear_law, problem, scale, see)
        watch.warn(stacklevel)
        return Prediction(rig, model, scale, problem, self.wear_law, wear)

    def uncertainty(
        self: Pipeline[TwinDisc],
        *,
        law: Mapping[str, Distribution | PublishedRange] | None = None,
        samples: int = 2**14,
        seed: int = 0,
        **conditions: QuantityLike | ArrayLike | Distribution,
    ) -> Uncertainty:
        """Return how uncertain the wear rate is where conditions and parameters are.

        Parameters
        ----------
        law : mapping of str to distribution, optional
            Parameters of the wear law by name, such as {"q_s": wl.normal("55 ug/m/mm^2", "5 ug/m/mm^2")} or
            {"coefficient": wl.published_range()}.
        samples : int
            How many samples to take, rounded up to a power of two.
        seed : int
            The same seed gives the same samples.
        **conditions
            Those of a prediction, of which any may be a distribution: `uniform`, `normal` or `lognormal`.

        Raises
        ------
        InputError
            If nothing is distributed, or a distribution is not possible there.
        """
        from wearlaw.uncertainty.result import Uncertainty

        return Uncertainty(self, conditions, law or {}, samples, seed)


def _check_scale(scale: Scale, model: ContactModel, law: WearLaw) -> None:
    """Refuse a law of the whole patch on a contact that is resolved into cells."""
    if law.scale == "patch" and scale != "patch":
        raise CompositionError(
            f"wear law '{law.name}' is stated for the means of the whole patch, but contact model '{model.name}'"
            f' resolves it into cells; put wl.patch_mean() between them, or use wl.contact_model("global")'
        )


def _warn_of_calibration(scale: Scale, model: ContactModel, law: WearLaw) -> None:
    """Warn of parameters that were fitted for another contact."""
    calibration = law.calibration
    if calibration is not None and not calibration.covers(model, scale):
        used = "its patch means" if scale == "patch" else "its cells"
        warnings.warn(
            f"the parameters of wear law '{law.name}' were fitted for {calibration}, but are used with"
            f" {model!r} and {used}; check them against data, or choose parameters fitted for that contact",
            CalibrationWarning,
            stacklevel=3,
        )


def check_traction(model: ContactModel, problem: LineProblem) -> None:
    """Refuse a measured traction for a contact model that has no use for it."""
    if problem.traction_coefficient is not None and not model.uses_measured_traction:
        raise ConditionsError(
            f"traction_coefficient: contact model '{model.name}' computes the traction itself; leave"
            ' traction_coefficient out, or use wl.contact_model("global")'
        )
