"""The global contact model, one cell that holds the patch means."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from pydantic import Field, field_validator

import wearlaw as wl


class Global(wl.ContactModel):
    """The patch as one cell: p = P/(2a), s = ξ, q = T/(2a).

    T is the measured force if the conditions hold a traction coefficient. Otherwise T is the total of a local model.
    """

    name: ClassVar[str] = "global"
    source: ClassVar[str] = "Tassini et al., Wear 268 (2010) 660-667, section 3.1"
    scale: ClassVar = "patch"
    uses_measured_traction: ClassVar[bool] = True

    total_from: wl.ContactModelField = Field(default="exact", validate_default=True)
    """The contact model that gives T if there is no measured traction coefficient."""

    @field_validator("total_from")
    @classmethod
    def _solves_lines(cls, model: wl.ContactModel) -> wl.ContactModel:
        if "line" not in model.geometries():
            raise ValueError(f'must be a contact model that solves line contacts, such as "exact"; got {model.name!r}')
        return model

    @property
    def accuracy(self) -> float:
        """Accuracy of the model that gives T."""
        return self.total_from.accuracy

    @property
    def exemptions(self) -> Mapping[wl.Claim, str | wl.Exempt]:
        """The one cell slips at any creepage; other exemptions are those of the model that gives T."""
        stick = "the one cell slips as a whole, with a traction below its bound"
        kept = ("saturation", "initial_slope")
        return {"stick": stick, **{c: r for c, r in self.total_from.exemptions.items() if c in kept}}

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        """Return the patch means as a contact of one node, of shape (batch, 1)."""
        length = 2.0 * problem.half_width
        pressure = problem.normal_force_per_width / length
        if problem.traction_coefficient is None:
            force = self.total_from.tangential_force(problem) / problem.track_width
            bound = problem.friction_coefficient * pressure
        else:
            force = np.sign(problem.creepage) * problem.traction_coefficient * problem.normal_force_per_width
            bound = np.abs(force) / length
        fields = wl.LineFields(
            pressure=pressure[..., None],
            traction=(force / length)[..., None],
            slip=problem.creepage[..., None],
            traction_bound=bound[..., None],
        )
        centre = np.zeros_like(length)
        return wl.Contact.from_line(
            problem, fields, x=centre[..., None], length=length[..., None], force_per_width=force
        )


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Global]
