"""Names and units of the variables in results, tables and figures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import pint

from wearlaw.contact import contact as records
from wearlaw.contact.problem import Geometry
from wearlaw.errors import CompositionError
from wearlaw.units.quantities import WEAR_RATE

if TYPE_CHECKING:
    from wearlaw.pipeline.prediction import Prediction

UNITS = {
    "wear_rate": WEAR_RATE,
    "wear_rate_low": WEAR_RATE,
    "wear_rate_high": WEAR_RATE,
    "wear_rate_error": WEAR_RATE,
    "tangential_force": "N",
    "longitudinal_force": "N",
    "lateral_force": "N",
    "spin_moment": "N*m",
    "traction_coefficient": "",
    "cell_wear_index": "N",
    "averaged_wear_index": "N",
    "stick_ratio": "",
    "mean_slip": "%",
    "half_width": "mm",
    "semi_axis_a": "mm",
    "semi_axis_b": "mm",
    "max_pressure": "MPa",
    "normal_force": "N",
    "normal_force_per_width": "kN/m",
    "creepage": "%",
    "longitudinal_creepage": "%",
    "lateral_creepage": "%",
    "spin": "1/m",
    "friction_coefficient": "",
    "y": "mm",
    **records.UNITS,
}
"""The unit in which each variable is written and drawn."""

NAMES = {
    "wear_rate": "wear rate",
    "wear_index": "wear index Tγ",
    "cell_wear_index": "wear index over the cells",
    "averaged_wear_index": "averaged wear index",
    "wear_index_density": "wear index over area Tγ/A",
    "tangential_force": "tangential force T",
    "longitudinal_force": "longitudinal force Fx",
    "lateral_force": "lateral force Fy",
    "spin_moment": "spin moment Mz",
    "stick_ratio": "stick ratio",
    "mean_slip": "mean slip",
    "half_width": "half width of the patch a",
    "semi_axis_a": "semi-axis a",
    "semi_axis_b": "semi-axis b",
    "creepage": "creepage",
    "longitudinal_creepage": "longitudinal creepage",
    "lateral_creepage": "lateral creepage",
    "spin": "spin",
    "normal_force": "normal force",
    "normal_force_per_width": "normal force per width",
    "max_pressure": "maximum pressure",
    "friction_coefficient": "friction coefficient",
    "traction_coefficient": "traction coefficient T/N",
    "x": "position x, leading edge left",
    "y": "position y across the patch",
    "pressure": "pressure p",
    "traction": "traction q",
    "traction_bound": "traction bound",
    "slip": "relative slip s",
}
"""What an axis of a figure or the head of a column calls a variable."""

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
)
"""Variables that differ from contact model to contact model, but not from law to law; no prediction has all of them."""

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
"""Variables of the operating point alone; no prediction has all of them."""


OF_OTHERS: Mapping[Geometry, frozenset[str]] = {
    "line": frozenset({"longitudinal_force", "lateral_force", "spin_moment", "cell_wear_index"}),
    "ellipse": frozenset({"averaged_wear_index", "creepage"}),
}
"""Variables that results of a shape of patch leave out, as another one says the same, or they say nothing."""


def offered(prediction: Prediction, variables: Iterable[str]) -> tuple[str, ...]:
    """Return those variables that results of a prediction show."""
    others = OF_OTHERS[prediction.problem.geometry]
    return tuple(name for name in variables if name not in others and _has(prediction, name))


def _has(prediction: Prediction, name: str) -> bool:
    try:
        return isinstance(getattr(prediction, name), pint.Quantity)
    except CompositionError:  # of another shape of patch
        return False


def name_of(variable: str) -> str:
    """Return what readers see of a variable; conditions of other people's rigs are named as they name them."""
    return NAMES.get(variable, variable.replace("_", " "))


def label(*variables: str, units: Mapping[str, str] = UNITS) -> str:
    """Return the names of variables of one unit, with it, as in "creepage [%]"."""
    unit = units[variables[0]].replace("ug", "µg").replace("um", "µm").replace("mm^2", "mm²").replace("*", "·")
    return f"{', '.join(name_of(variable) for variable in variables)} [{unit or '-'}]"
