"""The variables that results, tables and figures show."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import pint

from wearlaw.contact.problem import Geometry
from wearlaw.errors import CompositionError

if TYPE_CHECKING:
    from wearlaw.pipeline.prediction import Prediction

OF_CONTACT = (
    "tangential_force",
    "longitudinal_force",
    "lateral_force",
    "spin_moment",
    "traction_coefficient",
    "wear_index",
    "cell_wear_index",
    "averaged_wear_index",
    "wear_index_density",
    "stick_ratio",
    "mean_slip",
    "first_yield",
    "shakedown_limit",
)
"""Variables that depend on the contact model but not on the wear law; no prediction has all of them."""

OF_POINT = (
    "half_width",
    "semi_axis_a",
    "semi_axis_b",
    "max_pressure",
    "normal_force",
    "normal_force_per_width",
    "creepage",
    "friction_coefficient",
)
"""Variables that depend on the operating point alone; no prediction has all of them."""

OF_PATCH = ("lateral_creepage", "spin", "contact_angle")
"""Variables of one of several patches, which differ in them; with one patch they repeat the conditions."""

MASS = "mass_per_distance"
"""The variable of a wear law that can be added over several patches, unlike the wear rate."""

OF_OTHERS: Mapping[Geometry, frozenset[str]] = {
    "line": frozenset({"longitudinal_force", "lateral_force", "spin_moment", "cell_wear_index"}),
    "ellipse": frozenset({"averaged_wear_index", "creepage"}),
    "strips": frozenset({"averaged_wear_index", "creepage"}),
}
"""Variables that results leave out for a shape of patch because they repeat another one or say nothing."""


def offered(prediction: Prediction, variables: Iterable[str]) -> tuple[str, ...]:
    """Return the variables that the results of a prediction show."""
    problem = prediction.problem
    others = OF_OTHERS[problem.geometry]
    if problem.dims and problem.geometry != "line":
        others = (others - {"creepage"}) | ({"contact_angle"} if problem.contact_angle is None else set())
    else:
        others |= {*OF_PATCH}
    return tuple(name for name in variables if name not in others and _has(prediction, name))


def _has(prediction: Prediction, name: str) -> bool:
    try:
        return isinstance(getattr(prediction, name), pint.Quantity)
    except CompositionError:  # of another shape of patch
        return False
