"""A contact model with stages around it, as one contact model."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import reduce

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError
from wearlaw.models.contact_model import ContactModel, Forces, Scale, Solve, Stage
from wearlaw.models.model import Blame, Claim, Exempt, fault
from wearlaw.numerics.solving import Solver, check_problem


class Staged(ContactModel):
    """A contact model with one stage around it; the model may have stages of its own."""

    model: ContactModel
    """The contact model inside."""
    stage: Stage
    """The stage."""

    @property
    def kind(self) -> str:  # type: ignore[override]
        """Word for the stage in messages about the contact that it returns."""
        return self.stage.kind

    @property
    def name(self) -> str:  # type: ignore[override]
        """Name of the stage."""
        return self.stage.name

    def _origin(self) -> str:
        return self.stage._origin()

    @property
    def scale(self) -> Scale:
        """Whether laws see the means of the patch or its cells."""
        inside: Scale = self.model.scale
        return "patch" if self.stage.gives_means else inside

    @property
    def accuracy(self) -> float:
        """That of the model inside."""
        return self.model.accuracy

    @property
    def elliptic_accuracy(self) -> float:
        """That of the model inside."""
        return self.model.elliptic_accuracy

    @property
    def exemptions(self) -> Mapping[Claim, str | Exempt]:
        """Those of the model inside."""
        return self.model.exemptions

    def altered(self, problem: Problem, forces: Forces) -> Problem:
        """Return the problem that the stage makes of another one; it sees existing patches only.

        Raises
        ------
        ModelError
            If the stage fails, or its problem has another geometry or shape.
        """
        there = problem.existing()
        with Blame(self.stage):
            posed = self.stage.altered(there, forces)
            returned = (posed.geometry, posed.batch_shape) if isinstance(posed, Problem) else type(posed).__name__
        if returned != (due := (there.geometry, there.batch_shape)):
            raise fault(self.stage, f"returned {returned} from `altered`; it must return a wearlaw.Problem of {due}")
        check_problem(self, posed)
        if there is problem:
            return posed
        texts = {variable.name: getattr(problem, variable.name) for variable in problem.results if variable.text}
        return posed.mapped(problem.unflatten, problem.unflatten).replaced(
            dims=problem.dims, exists=problem.exists, unloaded=problem.unloaded, **texts
        )

    def refined(self) -> ContactModel | None:
        """Return the stage around the refined model, or None if the model cannot be refined."""
        fine = self.model.refined()
        return None if fine is None else Staged(model=fine, stage=self.stage)

    def solve_line(self, problem: Problem) -> Contact:
        """Return the contact after the stage."""
        return self._around(problem, Solver(self.model).solve)

    solve_ellipse = solve_line
    solve_strips = solve_line

    def on_strips(self, problem: Problem, shares: Array) -> Contact | None:
        """Return the contact after the stage on chosen strips, or None if the model cannot choose them."""

        def inner(part: Problem) -> Contact:
            with Blame(self.model):
                contact = self.model.on_strips(part, shares)
            if contact is None:
                raise _CannotChooseError
            return contact

        try:
            return self._around(problem, inner)
        except _CannotChooseError:
            return None

    def _around(self, problem: Problem, inner: Solve) -> Contact:
        def checked(part: Problem) -> Contact:
            if part is not problem:
                check_problem(self, part)
            return inner(part)

        with Blame(self.stage):
            return self.stage.solve(problem, checked)


class _CannotChooseError(CompositionError):
    """The model cannot choose its strips."""


def staged(model: ContactModel, stages: Iterable[Stage]) -> ContactModel:
    """Return a contact model with stages around it, the first of them next to the model."""
    return reduce(lambda inner, stage: Staged(model=inner, stage=stage), stages, model)


def without_stages(model: ContactModel) -> ContactModel:
    """Return a contact model without the stages around it."""
    while isinstance(model, Staged):
        model = model.model
    return model
