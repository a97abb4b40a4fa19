"""Names and units of the variables in results, tables and figures."""

from __future__ import annotations

from wearlaw import records
from wearlaw.units import WEAR_RATE

UNITS = {
    "wear_rate": WEAR_RATE,
    "wear_rate_low": WEAR_RATE,
    "wear_rate_high": WEAR_RATE,
    "wear_rate_error": WEAR_RATE,
    "tangential_force": "N",
    "traction_coefficient": "",
    "averaged_wear_index": "N",
    "stick_ratio": "",
    "mean_slip": "%",
    "half_width": "mm",
    "max_pressure": "MPa",
    "normal_force": "N",
    "normal_force_per_width": "kN/m",
    "creepage": "%",
    "friction_coefficient": "",
    **records.UNITS,
}
"""The unit in which each variable is written and drawn."""

NAMES = {
    "wear_rate": "wear rate",
    "wear_index": "wear index Tγ",
    "averaged_wear_index": "averaged wear index",
    "wear_index_density": "wear index over area Tγ/A",
    "tangential_force": "tangential force T",
    "stick_ratio": "stick ratio",
    "mean_slip": "mean slip",
    "half_width": "half width of the patch a",
    "creepage": "creepage",
    "normal_force": "normal force",
    "normal_force_per_width": "normal force per width",
    "max_pressure": "maximum pressure",
    "friction_coefficient": "friction coefficient",
    "traction_coefficient": "traction coefficient T/N",
    "x": "position x, leading edge left",
    "pressure": "pressure p",
    "traction": "traction q",
    "traction_bound": "traction bound",
    "slip": "relative slip s",
}
"""What an axis of a figure or the head of a column calls a variable."""

OF_CONTACT = (
    "tangential_force",
    "traction_coefficient",
    "wear_index",
    "averaged_wear_index",
    "wear_index_density",
    "stick_ratio",
    "mean_slip",
)
"""Variables that differ from contact model to contact model, but not from law to law."""

OF_POINT = ("half_width", "max_pressure", "normal_force", "normal_force_per_width", "creepage", "friction_coefficient")
"""Variables of the operating point alone."""


def label(*variables: str) -> str:
    """Return the names of variables of one unit, with it, as in "creepage [%]"."""
    unit = UNITS[variables[0]].replace("ug", "µg").replace("mm^2", "mm²")
    return f"{', '.join(NAMES[variable] for variable in variables)} [{unit or '-'}]"
