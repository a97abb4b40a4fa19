"""The table of variables: name, symbol, unit, words and bounds of each quantity in conditions, results and files."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from wearlaw.errors import InputError, UnitError, shown
from wearlaw.units.quantities import WEAR_RATE, Q, Unit
from wearlaw.units.registry import unit_in_si


@dataclass(frozen=True)
class Variable:
    """A physical quantity in results.

    Attributes
    ----------
    name : str
        Name in code and at the head of a column, such as "wheel_load".
    unit : str
        Unit in results, files and figures, such as "kN"; "" for a plain number. Models compute in SI.
    long_name : str
        Name on axes and in sentences, such as "wheel load Q". Default: the name with spaces.
    meaning : str
        A phrase that says what it is, such as "Vertical force of a wheel on its rail". Default: the long name.
    symbol : str
        Symbol in formulas, if it has one.
    sign : {"positive", "not negative", "any"}
        Sign of the values.
    limit : float
        Largest magnitude [SI].
    text : bool
        Whether the values are texts, not numbers.

    Raises
    ------
    InputError
        If the name is not made of letters, digits and underscores.
    """

    name: str
    unit: str
    long_name: str = ""
    meaning: str = ""
    symbol: str = ""
    sign: Literal["positive", "not negative", "any"] = "positive"
    limit: float = np.inf
    text: bool = False

    def __post_init__(self) -> None:
        """Check the name, and fill in the words."""
        if not (isinstance(self.name, str) and self.name.isidentifier()):
            kind = type(self).__name__.lower()
            raise InputError(
                f"{kind}: its name must be made of letters, digits and underscores, got {shown(self.name)}"
            )
        if not self.long_name:
            object.__setattr__(self, "long_name", self.name.replace("_", " "))
        if not self.meaning:
            object.__setattr__(self, "meaning", self.long_name[:1].upper() + self.long_name[1:])

    @cached_property
    def expected(self) -> Unit:
        """Unit and bounds of an argument."""
        return Unit("" if self.unit == "%" else self.unit, positive=self.sign == "positive", limit=self.limit)

    def _check_unit(self) -> None:
        """Raise a `UnitError` if the unit is unknown; the table of wearlaw does without, so as not to load pint."""
        try:
            unit_in_si(self.unit)
        except UnitError as error:
            raise UnitError(f"{type(self).__name__.lower()} '{self.name}': {error}") from None


VARIABLES: dict[str, Variable] = {
    variable.name: variable
    for variable in (
        # conditions
        Variable(
            "creepage", "%", "creepage", "Longitudinal creepage, positive if body 1 is the faster one", "ξ", "any", 1.0
        ),
        Variable(
            "longitudinal_creepage",
            "%",
            "longitudinal creepage",
            "Longitudinal creepage, positive if body 1 is the faster one",
            "ξ",
            "any",
            1.0,
        ),
        Variable("lateral_creepage", "%", "lateral creepage", "Lateral creepage", "η", "any", 1.0),
        Variable("spin", "1/m", "spin", "Spin", "φ", "any"),
        Variable("contact_angle", "deg", "contact angle", "Contact angle", "δ", "any"),
        Variable("normal_force", "kN", "normal force", "Normal force", "N"),
        Variable("normal_force_per_width", "kN/m", "normal force per width", "Normal force per unit width", "P"),
        Variable("max_pressure", "MPa", "maximum pressure", "Hertz's maximum pressure", "p0"),
        Variable("friction_coefficient", "", "friction coefficient", "Friction coefficient", "μ"),
        Variable("traction_coefficient", "", "traction coefficient T/N", "Tangential over normal force", "T/N"),
        Variable("rolling_speed", "m/s", "rolling speed", "Rolling speed", "V"),
        Variable(
            "rolled_distance",
            "km",
            "distance rolled",
            "Distance that the bodies have rolled since they were new",
            "",
            "not negative",
        ),
        # bodies and patch
        Variable("a", "mm", "half length of the patch a", "Half the patch's length in the rolling direction", "a"),
        Variable("b", "mm", "half width of the patch b", "Half the patch's width across the rolling direction", "b"),
        Variable(
            "half_width", "mm", "half width of the patch a", "Half the patch's length in the rolling direction", "a"
        ),
        Variable("semi_axis_a", "mm", "semi-axis a", "Semi-axis of an ellipse in the rolling direction", "a"),
        Variable("semi_axis_b", "mm", "semi-axis b", "Semi-axis of an ellipse across the rolling direction", "b"),
        Variable("track_width", "mm", "track width", "Width of a line's patch across the rolling direction"),
        Variable(
            "relative_radius",
            "mm",
            "relative radius",
            "Relative radius of curvature of a line contact, 1/R = 1/R1 + 1/R2",
            "R",
        ),
        Variable("shear_modulus", "GPa", "shear modulus", "Shear modulus, E* (1-ν)", "G"),
        Variable("density", "kg/m^3", "density", "Mass density", "ρ"),
        # nodes of the patch
        Variable(
            "x",
            "mm",
            "position x, leading edge left",
            "Position along the rolling direction, from the leading to the trailing edge",
            "x",
            "any",
        ),
        Variable("y", "mm", "position y across the patch", "Position across the rolling direction", "y", "any"),
        Variable(
            "profile_position", "mm", "position along the profile", "Arc length along the body's profile", "", "any"
        ),
        Variable("area", "mm^2", "area", "Area of the patch that the node represents", "", "not negative"),
        Variable("pressure", "MPa", "pressure p", "Normal pressure", "p", "not negative"),
        Variable("traction", "MPa", "traction q", "Tangential traction, with the sign of the creepage", "q", "any"),
        Variable(
            "traction_bound",
            "MPa",
            "traction bound",
            "The largest magnitude that the model allows for the traction",
            "",
            "not negative",
        ),
        Variable("slip", "%", "relative slip s", "Relative slip, the slip velocity over the rolling speed", "s", "any"),
        Variable("slip_speed", "m/s", "slip speed", "Magnitude of the slip velocity", "sV", "not negative"),
        Variable(
            "wear_index_density",
            "N/mm^2",
            "wear index over area Tγ/A",
            "Wear index over the area of the patch",
            "Tγ/A",
            "not negative",
        ),
        Variable(
            "frictional_power_density",
            "W/mm^2",
            "frictional power over area",
            "Frictional power over area",
            "qsV",
            "not negative",
        ),
        # results
        Variable("tangential_force", "N", "tangential force T", "Tangential force", "T"),
        Variable(
            "longitudinal_force",
            "N",
            "longitudinal force Fx",
            "Longitudinal force, with the sign of the longitudinal creepage",
            "Fx",
            "any",
        ),
        Variable(
            "lateral_force",
            "N",
            "lateral force Fy",
            "Lateral force, with the sign of the lateral creepage and of the spin",
            "Fy",
            "any",
        ),
        Variable("spin_moment", "N*m", "spin moment Mz", "Spin moment, with the sign of the spin", "Mz", "any"),
        Variable(
            "wear_index",
            "N",
            "wear index Tγ",
            "Wear index, ξFx + ηFy + φMz: the energy dissipated per metre rolled",
            "Tγ",
            "not negative",
        ),
        Variable(
            "cell_wear_index",
            "N",
            "wear index over the cells",
            "Energy dissipated per metre rolled, ∑ q·s dA over the nodes",
            "",
            "not negative",
        ),
        Variable(
            "averaged_wear_index",
            "N",
            "averaged wear index",
            "The averaged wear index of Tassini et al. 2010, section 3.2.3",
            "",
            "not negative",
        ),
        Variable(
            "frictional_heat",
            "W",
            "frictional heat",
            "Frictional power in a test, the tangential force times the slip velocity",
        ),
        Variable("stick_ratio", "", "stick ratio", "Share of the patch that sticks", "", "not negative"),
        Variable(
            "mean_slip",
            "%",
            "mean slip",
            "Mean magnitude of the relative slip over the whole patch",
            "",
            "not negative",
        ),
        Variable(
            "first_yield",
            "MPa",
            "maximum pressure at first yield",
            "Maximum pressure at which a body first yields under this traction",
        ),
        Variable(
            "shakedown_limit",
            "MPa",
            "maximum pressure at shakedown",
            "Maximum pressure at the shakedown limit under this traction",
        ),
        Variable(
            "outside_range",
            "",
            "outside the range of the law",
            "1 where a point lies outside the range or the materials that a law was fitted to, otherwise 0",
            "",
            "not negative",
        ),
        Variable(
            "wear_rate",
            WEAR_RATE,
            "wear rate",
            "Mass lost per metre rolled and contact area, mean over the patch",
            "",
            "not negative",
        ),
        Variable(
            "wear_rate_low",
            WEAR_RATE,
            "wear rate low",
            "Wear rate at the low end of the law's published range",
            "",
            "not negative",
        ),
        Variable(
            "wear_rate_high",
            WEAR_RATE,
            "wear rate high",
            "Wear rate at the high end of the law's published range",
            "",
            "not negative",
        ),
        Variable(
            "wear_rate_error", WEAR_RATE, "wear rate error", "Estimate of the error in `wear_rate`", "", "not negative"
        ),
        Variable(
            "mass_per_distance",
            "ug/m",
            "mass lost per metre rolled",
            "Mass that a body loses per metre rolled",
            "",
            "not negative",
        ),
        Variable(
            "wear_rate_uncertainty", WEAR_RATE, "wear rate uncertainty", "Standard uncertainty of a measured wear rate"
        ),
    )
}
"""The variables by their names in code."""

GIVEN = (
    *("a", "b", "area", "track_width", "relative_radius", "shear_modulus", "density", "rolling_speed"),
    *("rolled_distance", "frictional_heat", "wear_rate_uncertainty"),
)
"""Variables that are inputs only, never results."""

UNITS = {name: variable.unit for name, variable in VARIABLES.items() if name not in GIVEN}
"""Unit of each variable in results."""

OWNERS: dict[str, str] = {}
"""Module and class of each variable that a class of models or problems has declared, by its name."""


def declare(cls: type, variable: Variable) -> None:
    """Put a variable of a class of models or problems into the table, so that all results and files show it.

    If several classes have a variable of one name, the words of the first are shown.

    Raises
    ------
    UnitError
        If its unit is unknown, or the name is in the table with another dimension.
    InputError
        If the name is that of an outcome, and the variable is none, or the other way round.
    """
    place = f"{cls.__module__}.{cls.__qualname__}"  # the same for a class that is defined again, as in a notebook
    known, owner = VARIABLES.get(variable.name), OWNERS.get(variable.name)
    if known is None or variable.unit != known.unit:
        variable._check_unit()
    if known is not None and owner != place:
        both = f"variable '{variable.name}': {{}} in {place}, and {{}} in {owner or 'wearlaw'}; choose another name"
        if not _alike(variable.unit, known.unit):
            raise UnitError(both.format(*(f"it has the unit {shown(one.unit)}" for one in (variable, known))))
        if owner is not None and type(variable) is not type(known):
            kinds = ("an outcome" if type(one) is not Variable else "a result of a rig" for one in (variable, known))
            raise InputError(both.format(*(f"it is {kind}" for kind in kinds)))
        return
    VARIABLES[variable.name], UNITS[variable.name], OWNERS[variable.name] = variable, variable.unit, place


def _alike(unit: str, other: str) -> bool:
    """Return whether units have one dimension."""
    try:
        return unit == other or Unit(unit, positive=False).si(Q(1.0, other), "unit") is not None
    except UnitError:
        return False


def is_text(variable: str) -> bool:
    """Return whether the values of a variable are texts."""
    return variable in VARIABLES and VARIABLES[variable].text


def name_of(variable: str) -> str:
    """Return the readable name of a variable; a condition that only its rig knows keeps the rig's name."""
    known = VARIABLES.get(variable)
    return known.long_name if known else variable.replace("_", " ")


def meaning_of(variable: str) -> str:
    """Return the meaning of a variable; for a condition that only its rig knows, its name."""
    known = VARIABLES.get(variable)
    return known.meaning if known else name_of(variable)


def expected(*names: str) -> dict[str, Unit]:
    """Return the units and bounds of arguments, by name."""
    return {name: VARIABLES[name].expected for name in names}
