"""Composition of a rig with a contact model: rig | contact model, which takes a wear law."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar, Unpack, overload

from pydantic import field_validator, model_validator

from wearlaw.composition import check_geometry, check_traction, needs_discs, warn_of_calibration
from wearlaw.conditions import TwinDiscConditions, WheelRailConditions
from wearlaw.configuration import Configuration
from wearlaw.elliptic_wear import creep_forces
from wearlaw.errors import CompositionError
from wearlaw.integrate import integrate_contact
from wearlaw.models import WearLaw
from wearlaw.result import ContactSolution
from wearlaw.rig import TwinDisc
from wearlaw.specification import ContactModelField
from wearlaw.tangential import Scale
from wearlaw.units import Quantity, QuantityLike, shortened
from wearlaw.wheel_rail import WheelRail
from wearlaw.wheel_rail_result import WheelRailContact

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from wearlaw.pipeline import Pipeline

RigT = TypeVar("RigT", bound=TwinDisc | WheelRail)

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
    """The two bodies that roll on each other."""
    contact_model: ContactModelField
    """The theory of the tangential contact."""
    use_patch_mean: bool = False
    """Whether the resolved contact is replaced by its patch means."""

    @field_validator("rig", mode="before")
    @classmethod
    def _of_its_fields(cls, value: Any) -> Any:
        if isinstance(value, dict):
            return (WheelRail if "wheel_radius" in value else TwinDisc)(**value)
        if not isinstance(value, (TwinDisc, WheelRail)):
            raise ValueError(f"must be a TwinDisc or a WheelRail, got {shortened(value)}")
        return value

    @model_validator(mode="after")
    def _solves(self) -> Self:
        check_geometry(self.rig, self.contact_model)
        return self

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
        from wearlaw.pipeline import Pipeline

        if isinstance(stage, PatchMean):
            return ContactPipeline(rig=self.rig, contact_model=self.contact_model, use_patch_mean=True)
        if not isinstance(stage, WearLaw):
            raise CompositionError(f"a contact model is followed by wl.patch_mean() or a wear law, not by {stage!r}")
        pipeline = Pipeline(contact=self, wear_law=stage)
        warn_of_calibration(self.rig, self.contact_model, self.scale, stage)
        return pipeline

    @overload
    def __call__(self: ContactPipeline[TwinDisc], **conditions: Unpack[TwinDiscConditions]) -> ContactSolution: ...
    @overload
    def __call__(self: ContactPipeline[WheelRail], **conditions: Unpack[WheelRailConditions]) -> WheelRailContact: ...
    def __call__(self, **conditions: Any) -> ContactSolution | WheelRailContact:
        """Return the contact under the given conditions; see the `problem` of the rig for these."""
        rig, model = self.rig, self.contact_model
        if isinstance(rig, WheelRail):
            ellipse = rig.problem(**conditions)
            rig.warn_of_plasticity(ellipse.max_pressure, stacklevel=2)
            return WheelRailContact(rig, model, self.scale, ellipse, creep_forces(model, ellipse))
        problem = rig.problem(**conditions)
        check_traction(model, problem)
        rig.warn_of_plasticity(problem.max_pressure, stacklevel=2)
        return ContactSolution(rig, model, self.scale, problem, integrate_contact(model, problem))

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
            If no creepage, or more than one, transmits so much: at μN and above; or if friction falls with the creep
            speed.
        """
        from wearlaw.inverse import creepage_for

        needs_discs(self.rig, "creepage_for")
        return creepage_for(self, tangential_force, traction_coefficient, conditions)
