"""The variables that results, tables and figures show."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

import pint

from wearlaw.contact.problem import Geometry, Problem
from wearlaw.errors import CompositionError
from wearlaw.models.law import Law, named_outcomes
from wearlaw.units.quantities import Quantity

ERROR = "_error"
"""Ending of the name of an outcome's numerical error in results."""

OF_CONTACT = (
    "tangential_force", "longitudinal_force", "lateral_force", "spin_moment", "traction_coefficient", "wear_index",
    "cell_wear_index", "wear_index_density", "stick_ratio", "mean_slip", "first_yield",
    "shakedown_limit",
)  # fmt: skip
"""Variables that depend on the contact model but not on the wear law; no prediction has all of them."""

OF_POINT = (
    "half_width", "semi_axis_a", "semi_axis_b", "max_pressure", "normal_force", "normal_force_per_width",
    "creepage", "friction_coefficient",
)  # fmt: skip
"""Variables that depend on the operating point alone; no prediction has all of them."""

_FORCES = ("longitudinal_force", "lateral_force", "spin_moment", "wear_index")

SHOWN: Mapping[Geometry, tuple[str, ...]] = {
    "line": ("tangential_force", "wear_index", "half_width", "max_pressure", "stick_ratio", "mean_slip"),
    "ellipse": (*_FORCES, "semi_axis_a", "semi_axis_b", "max_pressure"),
    "strips": (*_FORCES, "patch_area", "max_pressure"),
}
"""Variables that a prediction prints besides its outcomes."""

OF_PATCH = ("lateral_creepage", "spin", "contact_angle")
"""Variables of one of several patches, which differ in them; with one patch they repeat the conditions."""

MASS = "mass_per_distance"
"""The variable of a wear law that can be added over several patches, unlike the wear rate."""

OUTSIDE_RANGE = "outside_range"
"""The variable that marks points outside the range of a law."""

MORE = ("patch_area", OUTSIDE_RANGE)
"""Further variables of predictions and sweeps."""

OF_OTHERS: Mapping[Geometry, frozenset[str]] = {
    "line": frozenset({"longitudinal_force", "lateral_force", "spin_moment", "cell_wear_index"}),
    "ellipse": frozenset({"creepage"}),
    "strips": frozenset({"creepage"}),
}
"""Variables that results leave out for a shape of patch because they repeat another one or say nothing."""


class Predicted(Protocol):
    """A prediction: a contact problem, laws, and variables by name."""

    problem: Problem
    laws: tuple[Law, ...]

    def __getitem__(self, name: str, /) -> Quantity:
        """Return a variable."""
        ...


def default_variables(
    prediction: Predicted, without: Iterable[str] = (), several_patches: bool | None = None
) -> list[str]:
    """Return the variables of datasets and sweeps for which no names are given: the outcomes of laws come first.

    Conditions, which are coordinates, are `without`. `several_patches` says whether the rig makes several patches, if
    the prediction does not show it.
    """
    of_rig = (variable.name for variable in prediction.problem.results)
    names = (MASS, *OF_CONTACT, *OF_POINT, *OF_PATCH, *of_rig, *MORE)
    every = (*named_outcomes(prediction.laws), *offered(prediction, names, several_patches))
    left_out = {*without}
    return [name for name in dict.fromkeys(every) if name not in left_out]


def offered(prediction: Predicted, variables: Iterable[str], several_patches: bool | None = None) -> tuple[str, ...]:
    """Return the variables that the results of a prediction show; for `several_patches` see `default_variables`."""
    problem = prediction.problem
    others = OF_OTHERS[problem.geometry]
    several = bool(problem.dims) if several_patches is None else several_patches
    if several and problem.geometry != "line":
        others = (others - {"creepage"}) | ({"contact_angle"} if problem.contact_angle is None else set())
    else:
        others |= {*OF_PATCH}
    return tuple(name for name in variables if name not in others and _has(prediction, name))


def _has(prediction: Predicted, name: str) -> bool:
    if any(name == variable.name for variable in prediction.problem.results):
        return True
    try:
        return isinstance(getattr(prediction, name, None), pint.Quantity)
    except CompositionError:  # of another shape of patch
        return False


def outcome_units(laws: Sequence[Law]) -> dict[str, str]:
    """Return the unit of each outcome of laws, and of the errors of means over the patch, by name."""
    units = {}
    for name, index in named_outcomes(laws).items():
        outcome = laws[index].outcome
        units[name] = outcome.unit
        if outcome.of == "area mean":
            units[f"{name}{ERROR}"] = outcome.unit
    return units
