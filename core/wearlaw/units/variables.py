"""The table of variables: name, symbol, unit, meaning and bounds of each quantity in conditions, results and files."""

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
    meaning : str
        Meaning on the page of symbols and in the schema of case files.
    symbol : str
        Symbol in formulas, if it has one.
    sign : {"positive", "not negative", "any"}
        Sign of the values.
    limit : float
        Largest magnitude [SI].
    """

    unit: str
    name: str
    meaning: str
    symbol: str = ""
    sign: Literal["positive", "not negative", "any"] = "positive"
    limit: float = np.inf

    @cached_property
    def expected(self) -> Unit:
        """Unit and bounds of an argument."""
        return Unit("" if self.unit == "%" else self.unit, positive=self.sign == "positive", limit=self.limit)


VARIABLES: Mapping[str, Variable] = {
    # conditions
    "creepage": Variable(
        "%", "creepage", "Longitudinal creepage, positive if body 1 is the faster one", "ξ", "any", 1.0
    ),
    "longitudinal_creepage": Variable(
        "%", "longitudinal creepage", "Longitudinal creepage, positive if body 1 is the faster one", "ξ", "any", 1.0
    ),
    "lateral_creepage": Variable("%", "lateral creepage", "Lateral creepage", "η", "any", 1.0),
    "spin": Variable("1/m", "spin", "Spin", "φ", "any"),
    "contact_angle": Variable("deg", "contact angle", "Contact angle", "δ", "any"),
    "normal_force": Variable("kN", "normal force", "Normal force", "N"),
    "normal_force_per_width": Variable("kN/m", "normal force per width", "Normal force per unit width", "P"),
    "max_pressure": Variable("MPa", "maximum pressure", "Hertz's maximum pressure", "p0"),
    "friction_coefficient": Variable("", "friction coefficient", "Friction coefficient", "μ"),
    "traction_coefficient": Variable("", "traction coefficient T/N", "Tangential over normal force", "T/N"),
    "rolling_speed": Variable("m/s", "rolling speed", "Rolling speed", "V"),
    "rolled_distance": Variable(
        "km", "distance rolled", "Distance that the bodies have rolled since they were new", "", "not negative"
    ),
    # bodies and patch
    "a": Variable("mm", "half length of the patch a", "Half the patch's length in the rolling direction", "a"),
    "b": Variable("mm", "half width of the patch b", "Half the patch's width across the rolling direction", "b"),
    "half_width": Variable("mm", "half width of the patch a", "Half the patch's length in the rolling direction", "a"),
    "semi_axis_a": Variable("mm", "semi-axis a", "Semi-axis of an ellipse in the rolling direction", "a"),
    "semi_axis_b": Variable("mm", "semi-axis b", "Semi-axis of an ellipse across the rolling direction", "b"),
    "track_width": Variable("mm", "track width", "Width of a line's patch across the rolling direction"),
    "relative_radius": Variable(
        "mm", "relative radius", "Relative radius of curvature of a line contact, 1/R = 1/R1 + 1/R2", "R"
    ),
    "shear_modulus": Variable("GPa", "shear modulus", "Shear modulus, E* (1-ν)", "G"),
    "density": Variable("kg/m^3", "density", "Mass density", "ρ"),
    # nodes of the patch
    "x": Variable(
        "mm",
        "position x, leading edge left",
        "Position along the rolling direction, from the leading to the trailing edge",
        "x",
        "any",
    ),
    "y": Variable("mm", "position y across the patch", "Position across the rolling direction", "y", "any"),
    "profile_position": Variable("mm", "position along the profile", "Arc length along the body's profile", "", "any"),
    "area": Variable("mm^2", "area", "Area of the patch that the node represents", "", "not negative"),
    "pressure": Variable("MPa", "pressure p", "Normal pressure", "p", "not negative"),
    "traction": Variable("MPa", "traction q", "Tangential traction, with the sign of the creepage", "q", "any"),
    "traction_bound": Variable(
        "MPa", "traction bound", "The largest magnitude that the model allows for the traction", "", "not negative"
    ),
    "slip": Variable("%", "relative slip s", "Relative slip, the slip velocity over the rolling speed", "s", "any"),
    "slip_speed": Variable("m/s", "slip speed", "Magnitude of the slip velocity", "sV", "not negative"),
    "wear_index_density": Variable(
        "N/mm^2", "wear index over area Tγ/A", "Wear index over the area of the patch", "Tγ/A", "not negative"
    ),
    "frictional_power_density": Variable(
        "W/mm^2", "frictional power over area", "Frictional power over area", "qsV", "not negative"
    ),
    # results
    "tangential_force": Variable("N", "tangential force T", "Tangential force", "T"),
    "longitudinal_force": Variable(
        "N", "longitudinal force Fx", "Longitudinal force, with the sign of the longitudinal creepage", "Fx", "any"
    ),
    "lateral_force": Variable(
        "N", "lateral force Fy", "Lateral force, with the sign of the lateral creepage and of the spin", "Fy", "any"
    ),
    "spin_moment": Variable("N*m", "spin moment Mz", "Spin moment, with the sign of the spin", "Mz", "any"),
    "wear_index": Variable(
        "N",
        "wear index Tγ",
        "Wear index, ξFx + ηFy + φMz: the energy dissipated per metre rolled",
        "Tγ",
        "not negative",
    ),
    "cell_wear_index": Variable(
        "N",
        "wear index over the cells",
        "Energy dissipated per metre rolled, ∑ q·s dA over the nodes",
        "",
        "not negative",
    ),
    "averaged_wear_index": Variable(
        "N", "averaged wear index", "The averaged wear index of Tassini et al. 2010, section 3.2.3", "", "not negative"
    ),
    "frictional_heat": Variable(
        "W", "frictional heat", "Frictional power in a test, the tangential force times the slip velocity"
    ),
    "stick_ratio": Variable("", "stick ratio", "Share of the patch that sticks", "", "not negative"),
    "mean_slip": Variable(
        "%", "mean slip", "Mean magnitude of the relative slip over the whole patch", "", "not negative"
    ),
    "guiding_force": Variable(
        "kN", "guiding force Y", "Lateral force of a wheel on its rail, positive to the right", "Y", "any"
    ),
    "wheel_load": Variable("kN", "wheel load Q", "Vertical force of a wheel on its rail", "Q"),
    "derailment_quotient": Variable("", "derailment quotient Y/Q", "Guiding force over wheel load", "Y/Q", "any"),
    "status": Variable("", "status", 'Why a position of a wheelset has no result, or "balanced"', "", "any"),
    "lateral_displacement": Variable(
        "mm", "lateral displacement", "Lateral displacement of the wheelset in the track", "", "any"
    ),
    "first_yield": Variable(
        "MPa", "maximum pressure at first yield", "Maximum pressure at which a body first yields under this traction"
    ),
    "shakedown_limit": Variable(
        "MPa", "maximum pressure at shakedown", "Maximum pressure at the shakedown limit under this traction"
    ),
    "outside_range": Variable(
        "",
        "outside the range of the law",
        "1 where a point lies outside the range or the materials that a law was fitted to, otherwise 0",
        "",
        "not negative",
    ),
    "wear_rate": Variable(
        WEAR_RATE, "wear rate", "Mass lost per metre rolled and contact area, mean over the patch", "", "not negative"
    ),
    "wear_rate_low": Variable(
        WEAR_RATE, "wear rate low", "Wear rate at the low end of the law's published range", "", "not negative"
    ),
    "wear_rate_high": Variable(
        WEAR_RATE, "wear rate high", "Wear rate at the high end of the law's published range", "", "not negative"
    ),
    "wear_rate_error": Variable(
        WEAR_RATE, "wear rate error", "Estimate of the error in `wear_rate`", "", "not negative"
    ),
    "mass_per_distance": Variable(
        "ug/m", "mass lost per metre rolled", "Mass that a body loses per metre rolled", "", "not negative"
    ),
    "wear_rate_uncertainty": Variable(
        WEAR_RATE, "wear rate uncertainty", "Standard uncertainty of a measured wear rate"
    ),
}
"""The variables by their names in code."""

GIVEN = (
    *("a", "b", "area", "track_width", "relative_radius", "shear_modulus", "density", "rolling_speed"),
    *("rolled_distance", "frictional_heat", "wear_rate_uncertainty"),
)
"""Variables that are inputs only, never results."""

UNITS: Mapping[str, str] = {name: one.unit for name, one in VARIABLES.items() if name not in GIVEN}
"""Unit of each variable in results."""


def name_of(variable: str) -> str:
    """Return the readable name of a variable; a condition that only its rig knows keeps the rig's name."""
    known = VARIABLES.get(variable)
    return known.name if known else variable.replace("_", " ")


def meaning_of(variable: str) -> str:
    """Return the meaning of a variable; for a condition that only its rig knows, its name."""
    known = VARIABLES.get(variable)
    return known.meaning if known else name_of(variable)


def expected(*names: str) -> dict[str, Unit]:
    """Return the units and bounds of arguments, by name."""
    return {name: VARIABLES[name].expected for name in names}
