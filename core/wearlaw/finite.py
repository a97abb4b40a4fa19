"""Refusing what a contact model gives that is no finite number."""

from __future__ import annotations

import math
from collections.abc import Mapping

from wearlaw.arrays import Array
from wearlaw.ellipse import EllipticProblem
from wearlaw.errors import ModelError
from wearlaw.extremes import extremes
from wearlaw.line import LineProblem
from wearlaw.tangential import ContactModel


def check_finite(model: ContactModel, values: Mapping[str, Array], problem: LineProblem | EllipticProblem) -> None:
    """Raise a `ModelError` that names the operating points, if one of a model's values is not finite."""
    for name, value in values.items():
        low, high = extremes(value)
        if not (math.isfinite(low) and math.isfinite(high)):
            raise ModelError(
                f"contact model '{model.name}' gave a {name.replace('_', ' ')} that is not finite"
                f" for {_ranges(problem)}"
            )


def _ranges(problem: LineProblem | EllipticProblem) -> str:
    """Return what tells the operating points apart from others."""
    if isinstance(problem, EllipticProblem):
        subject, creepage = "longitudinal creepages", problem.longitudinal_creepage
    else:
        subject, creepage = "creepages", problem.creepage
    pressure = problem.max_pressure
    return (
        f"{subject} from {creepage.min():g} to {creepage.max():g}"
        f" and maximum pressures from {pressure.min():g} to {pressure.max():g} Pa"
    )
