"""The columns of a table of wear tests: units, permitted values, and permitted combinations."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import LOADS
from wearlaw.errors import UnitError, shown
from wearlaw.units.quantities import Q
from wearlaw.units.registry import si_factor
from wearlaw.units.variables import VARIABLES, Variable

if TYPE_CHECKING:
    from numpy.typing import NDArray


COLUMNS = {
    name: VARIABLES[name]
    for name in (
        *("creepage", "normal_force", "normal_force_per_width", "max_pressure", "friction_coefficient"),
        *("traction_coefficient", "tangential_force", "frictional_heat", "rolling_speed"),
        *("wear_rate", "wear_rate_uncertainty"),
    )
}
"""All numeric columns."""

OTHER = Variable("", "", "", sign="any")
"""A condition that is not in `COLUMNS`."""

DERIVED = ("tangential_force", "frictional_heat")
"""Columns from which a traction coefficient follows."""

TRACTIONS = ("traction_coefficient", *DERIVED)
"""Columns of measured traction."""

COMPLETE = ("creepage", *LOADS, "friction_coefficient")
"""Columns that need a value for every test."""


def head(name: str) -> str:
    """Return the head of a column with its usual unit, as in "creepage [%]"."""
    unit = COLUMNS[name].unit
    return f"{name} [{unit}]" if unit else name


def wrong_values(column: Variable, si: Array) -> Iterator[tuple[NDArray[np.bool_], str]]:
    """Yield a mask of the values that break a rule, and the rule, for each rule; missing values break none."""
    yield np.isinf(si), "must be finite"
    if column.sign == "positive":
        yield si <= 0, "must be greater than zero"
    if column.sign == "not negative":
        yield si < 0, "must not be negative"
    yield abs(si) > column.limit, f"must not exceed {100.0 * column.limit:g} % in magnitude; is its unit right?"


def factor(name: str, unit: str) -> float:
    """Return the factor from a unit to the SI unit of a column.

    Raises
    ------
    UnitError
        If the unit is unknown, or of another dimension than the column.
    """
    expected = COLUMNS[name].unit
    advice = f"give it in {expected} or another unit of that dimension" if expected else "give it as a plain number"
    try:
        return si_factor(Q(1.0, unit), expected)
    except UnitError as error:
        reason = str(error) if str(error).startswith("'") else f"got {shown(unit)}, {error}"
        raise UnitError(f"{reason}; {advice}") from None


def faulty_columns(names: Sequence[str] | Mapping[str, object], outcome: bool = False) -> list[str]:
    """Return the faults of a combination of columns, regardless of their values.

    Names that are not in `COLUMNS` are other conditions of a rig. The rig then checks itself whether creepage or load
    are missing. `outcome` says that there is, or may be, a measured outcome beside these columns.
    """
    others = any(name not in COLUMNS for name in names)
    loads, tractions = ([name for name in kind if name in names] for kind in (LOADS, TRACTIONS))
    derived = [name for name in DERIVED if name in names]
    faults = []
    if "creepage" not in names and not others:
        faults.append(f"creepage: is missing; add a column '{head('creepage')}'")
    if len(loads) > 1 or not (loads or others):
        choice = ", ".join(map(head, LOADS))
        faults.append(f"give exactly one load of {choice}; got {' and '.join(loads) or 'none of them'}")
    if len(tractions) > 1:
        faults.append(f"{' and '.join(tractions)}: all give the traction; keep one of them")
    if derived and (loads or others) and loads != ["normal_force"]:
        instead = f", not {loads[0]}, which takes a track width" if loads else ""
        faults.append(
            f"{derived[0]}: T/N follows from it only where the load is normal_force{instead}; give normal_force or"
            " traction_coefficient"
        )
    if "frictional_heat" in names and "creepage" not in names and others:
        faults.append(f"frictional_heat: is T × creepage × rolling speed; add a column '{head('creepage')}' beside it")
    if "frictional_heat" in names and "rolling_speed" not in names:
        faults.append(
            f"frictional_heat: is T × creepage × rolling speed; add a column '{head('rolling_speed')}' beside it"
        )
    if "rolling_speed" in names and "frictional_heat" not in names:
        faults.append("rolling_speed: belongs to the rig; it is only needed beside frictional_heat; leave it out")
    if "wear_rate_uncertainty" in names and "wear_rate" not in names:
        faults.append("wear_rate_uncertainty: there is no wear_rate beside it")
    if "wear_rate" not in names and not tractions and not outcome:
        faults.append(f"nothing is measured; add a column '{head('wear_rate')}' or 'traction_coefficient'")
    return faults


def faulty(columns: Mapping[str, Array], outcomes: Collection[str] = ()) -> list[tuple[int, str, str]]:
    """Return the test, the column and the broken rule of each impossible value.

    Columns that are not in `COLUMNS` are measured `outcomes`, or other conditions, in any unit.
    """
    faults = []
    for name, values in columns.items():
        for wrong, rule in wrong_values(COLUMNS.get(name, OTHER), values):
            faults += [(int(i), name, rule) for i in np.flatnonzero(wrong)]
        if name in COMPLETE or name not in (*COLUMNS, *outcomes):
            faults += [(int(i), name, "is missing; every test needs it") for i in np.flatnonzero(np.isnan(values))]
    heat = columns.get("frictional_heat")
    if heat is not None:
        without = ~np.isnan(heat) & np.isnan(columns.get("rolling_speed", heat))
        faults += [(int(i), "rolling_speed", "is missing; frictional_heat needs it") for i in np.flatnonzero(without)]
    return faults or _faulty_traction(columns)


def _faulty_traction(columns: Mapping[str, Array]) -> list[tuple[int, str, str]]:
    """Return the measurements from which no traction coefficient follows, such as at zero creepage."""
    derived = [name for name in DERIVED if name in columns]
    needed = {"creepage", "normal_force", *(["rolling_speed"] if "frictional_heat" in derived else [])}
    if len(derived) != 1 or not columns.keys() >= needed:
        return []
    traction = with_traction(columns)["traction_coefficient"]
    wrong = ~np.isnan(columns[derived[0]]) & ~((traction > 0) & np.isfinite(traction))
    rule = "gives a traction coefficient of {:g}; check the creepage and the units"
    return [(int(i), derived[0], rule.format(traction[i])) for i in np.flatnonzero(wrong)]


def with_traction(columns: Mapping[str, Array]) -> dict[str, Array]:
    """Replace the columns from which the traction coefficient follows by the traction coefficient."""
    kept = {name: values for name, values in columns.items() if name not in (*DERIVED, "rolling_speed")}
    with np.errstate(divide="ignore", over="ignore", under="ignore"):  # `faulty` reports the result
        force = columns.get("tangential_force")
        if "frictional_heat" in columns:
            force = columns["frictional_heat"] / (abs(columns["creepage"]) * columns["rolling_speed"])
        if force is not None:
            kept["traction_coefficient"] = force / columns["normal_force"]
    return {name: np.array(kept[name]) for name in COLUMNS if name in kept}
