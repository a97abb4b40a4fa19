"""A third body between the two that roll: it makes the contact more flexible."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, model_validator

import wearlaw as wl
from wearlaw import Array


class ThirdBody(wl.Stage):
    """A contact made more flexible by a third body, such as wear debris, oxides, water or the tips of roughness.

    The contact model inside has the tangential stiffness times k, or Kalker's flexibilities over k, with

        k = k∞ + (k0 - k∞)/(1 + βε),  ε = (π/4) k0 F'/(μN).

    k0 is the `reduction`: the traction curve starts with k0 times the slope of the model. By default k = k0 at any
    creepage. The force in full slip is then μN as without the stage, and full slip begins at 1/k0 times the creepage.

    With k∞, the `limit_reduction`, and β, the `reduction_decay`, k falls as the patch begins to slip; with k∞ = 0 the
    force stays below μN. F' is the force of the linear theory: on an ellipse F' = G ab C11 s with s² = ξ² + η_C², where
    η_C is the larger in magnitude of η and η + φa, the lateral creepage at the leading edge. On a line F' is
    (π/2) E*a |ξ| times the width, an interpretation: the source leaves it open.

    Notes
    -----
    Prefer this where tests show a traction curve that rises less steeply than the theory, and fit its numbers to them.
    For a locomotive at 10 m/s the example of CONTACT has k0 = 0.54, k∞ = 0.0108 and β = 0.62, together with friction
    that falls with the creep speed. It can't change a measured traction, which replaces the force of the model.

    The stage changes E* of the problem alone, to k E*. The patch, its pressure and μ stay as they are. Of the solved
    contact's problem, do not read E* and what follows from it, such as `relative_radius`.
    """

    name: ClassVar[str] = "third_body"
    source: ClassVar[str] = (
        "M. Spiryagin, O. Polach, C. Cole, Vehicle System Dynamics 51 (2013) 1765-1783, after the user guide and the"
        " source of the program CONTACT (E. A. H. Vollebregt)"
    )
    example_fields: ClassVar[Mapping[str, Any]] = {"reduction": 0.7}

    reduction: Annotated[float, Field(gt=0.0, le=1.0, strict=True)]
    """Reduction factor of the initial slope, k0 [-]."""
    limit_reduction: Annotated[float, Field(ge=0.0, le=1.0, strict=True)] | None = None
    """Reduction factor at infinite creepage, k∞ [-], below k0. None for a factor that does not fall."""
    reduction_decay: Annotated[float, Field(gt=0.0, strict=True, allow_inf_nan=False)] | None = None
    """Coefficient of the fall of the reduction factor, β [-]. None for a factor that does not fall."""

    @model_validator(mode="after")
    def _both_or_neither(self) -> ThirdBody:
        if (self.limit_reduction is None) != (self.reduction_decay is None):
            raise ValueError("limit_reduction and reduction_decay: give both for a factor that falls, or none of them")
        if self.limit_reduction is not None and self.limit_reduction >= self.reduction:
            raise ValueError(
                f"limit_reduction must lie below reduction = {self.reduction!r}; got {self.limit_reduction!r}"
            )
        return self

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:  # noqa: ARG002
        """Return the problem with a lower E*."""
        return problem.replaced(effective_modulus=self.factor(problem) * problem.effective_modulus)

    def factor(self, problem: wl.Problem) -> Array:
        """Return k [-], of the batch shape."""
        if self.limit_reduction is None or self.reduction_decay is None:
            return np.full(problem.batch_shape, self.reduction)
        bound = problem.friction_coefficient * problem.normal_force
        gradient = 0.25 * np.pi * self.reduction * _linear_force(problem) / bound  # ε
        fallen = (self.reduction - self.limit_reduction) / (1.0 + self.reduction_decay * gradient)
        return self.limit_reduction + fallen


def _linear_force(problem: wl.Problem) -> Array:
    """Return the force of the linear theory at the creepage of the leading edge, F' [N]."""
    if problem.geometry == "line":
        slope = 0.5 * np.pi * problem.effective_modulus * problem.a * problem.track_width
        force: Array = slope * np.abs(problem.longitudinal_creepage)
        return force
    lateral = problem.lateral_creepage
    leading = np.maximum(np.abs(lateral), np.abs(lateral + problem.spin * problem.a))
    c11 = wl.kalker.coefficients(problem.a / problem.b, problem.poisson_ratio).c11
    stiffness = problem.shear_modulus * problem.a * problem.b * c11
    return stiffness * np.hypot(problem.longitudinal_creepage, leading)


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Stage]]:
    """Return the stage of this plugin."""
    return [ThirdBody]
