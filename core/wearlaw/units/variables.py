"""The table of variables: symbol, unit, name and bounds of each quantity in conditions, results and files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from wearlaw.units.quantities import WEAR_RATE, Unit


@dataclass(frozen=True)
class Variable:
    """A physical quantity.

    Attributes
    ----------
    unit : str
        Unit in results, files and figures; "" for a plain number.
    name : str
        Name on the axis of a figure or at the head of a column.
    symbol : str
        Symbol in formulas, if it has one.
    sign : {"positive", "not negative", "any"}
        Sign of the values.
    limit : float
        Largest magnitude [SI].
    """

    unit: str
    name: str
    symbol: str = ""
    sign: Literal["positive", "not negative", "any"] = "positive"
    limit: float = np.inf

    @cached_property
    def expected(self) -> Unit:
        """Unit and bounds of an argument."""
        return Unit("" if self.unit == "%" else self.unit, positive=self.sign == "positive", limit=self.limit)


VARIABLES: Mapping[str, Variable] = {
    # conditions
    "creepage": Variable("%", "creepage", "ξ", "any", 1.0),
    "longitudinal_creepage": Variable("%", "longitudinal creepage", "ξ", "any", 1.0),
    "lateral_creepage": Variable("%", "lateral creepage", "η", "any", 1.0),
    "spin": Variable("1/m", "spin", "φ", "any"),
    "normal_force": Variable("kN", "normal force", "N"),
    "normal_force_per_width": Variable("kN/m", "normal force per width", "P"),
    "max_pressure": Variable("MPa", "maximum pressure", "p0"),
    "friction_coefficient": Variable("", "friction coefficient", "μ"),
    "traction_coefficient": Variable("", "traction coefficient T/N", "T/N"),
    "rolling_speed": Variable("m/s", "rolling speed", "V"),
    # bodies and patch
    "a": Variable("mm", "half length of the patch a", "a"),
    "b": Variable("mm", "half width of the patch b", "b"),
    "half_width": Variable("mm", "half width of the patch a", "a"),
    "semi_axis_a": Variable("mm", "semi-axis a", "a"),
    "semi_axis_b": Variable("mm", "semi-axis b", "b"),
    "track_width": Variable("mm", "track width"),
    "relative_radius": Variable("mm", "relative radius", "R"),
    "shear_modulus": Variable("GPa", "shear modulus", "G"),
    "density": Variable("kg/m^3", "density", "ρ"),
    # nodes of the patch
    "x": Variable("mm", "position x, leading edge left", "x", "any"),
    "y": Variable("mm", "position y across the patch", "y", "any"),
    "area": Variable("mm^2", "area", "", "not negative"),
    "pressure": Variable("MPa", "pressure p", "p", "not negative"),
    "traction": Variable("MPa", "traction q", "q", "any"),
    "traction_bound": Variable("MPa", "traction bound", "", "not negative"),
    "slip": Variable("%", "relative slip s", "s", "any"),
    "slip_speed": Variable("m/s", "slip speed", "sV", "not negative"),
    "wear_index_density": Variable("N/mm^2", "wear index over area Tγ/A", "Tγ/A", "not negative"),
    # results
    "tangential_force": Variable("N", "tangential force T", "T"),
    "longitudinal_force": Variable("N", "longitudinal force Fx", "Fx", "any"),
    "lateral_force": Variable("N", "lateral force Fy", "Fy", "any"),
    "spin_moment": Variable("N*m", "spin moment Mz", "Mz", "any"),
    "wear_index": Variable("N", "wear index Tγ", "Tγ", "not negative"),
    "cell_wear_index": Variable("N", "wear index over the cells", "", "not negative"),
    "averaged_wear_index": Variable("N", "averaged wear index", "", "not negative"),
    "frictional_heat": Variable("W", "frictional heat"),
    "stick_ratio": Variable("", "stick ratio", "", "not negative"),
    "mean_slip": Variable("%", "mean slip", "", "not negative"),
    "first_yield": Variable("MPa", "maximum pressure at first yield"),
    "shakedown_limit": Variable("MPa", "maximum pressure at shakedown"),
    "outside_range": Variable("", "outside the range of the law", "", "not negative"),
    "wear_rate": Variable(WEAR_RATE, "wear rate", "", "not negative"),
    "wear_rate_low": Variable(WEAR_RATE, "wear rate low", "", "not negative"),
    "wear_rate_high": Variable(WEAR_RATE, "wear rate high", "", "not negative"),
    "wear_rate_error": Variable(WEAR_RATE, "wear rate error", "", "not negative"),
    "wear_rate_uncertainty": Variable(WEAR_RATE, "wear rate uncertainty"),
}
"""The variables by their names in code."""

GIVEN = (
    *("a", "b", "area", "track_width", "relative_radius", "shear_modulus", "density", "rolling_speed"),
    *("frictional_heat", "wear_rate_uncertainty"),
)
"""Variables that are inputs only, never results."""

UNITS: Mapping[str, str] = {name: one.unit for name, one in VARIABLES.items() if name not in GIVEN}
"""Unit of each variable in results."""


def name_of(variable: str) -> str:
    """Return the readable name of a variable; a condition that only its rig knows keeps the rig's name."""
    known = VARIABLES.get(variable)
    return known.name if known else variable.replace("_", " ")


def label(*variables: str, units: Mapping[str, str] = UNITS) -> str:
    """Return the names of variables that share a unit, with the unit, as in "creepage [%]"."""
    unit = units[variables[0]].replace("ug", "µg").replace("um", "µm").replace("mm^2", "mm²").replace("*", "·")
    return f"{', '.join(name_of(variable) for variable in variables)} [{unit or '-'}]"


def expected(*names: str) -> dict[str, Unit]:
    """Return the units and bounds of arguments, by name."""
    return {name: VARIABLES[name].expected for name in names}
