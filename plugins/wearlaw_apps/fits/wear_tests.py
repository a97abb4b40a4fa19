"""Wear tests of a lab: conditions and measurements, with an entry for each test and NaN for missing measurements.

`read_tests` reads them from a table, and `WearTests.from_arrays` takes arrays. They are independent of rigs: tests only
provide the conditions of contact problems.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self, TypedDict, Unpack

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.contact.conditions import Condition
from wearlaw.errors import ConditionsError, DataError, UnitError, did_you_mean, shown
from wearlaw.models.model import CONDITIONS
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.units.quantities import WEAR_RATE, Q, Quantity, QuantityLike, Unit, from_si, parse, real_array
from wearlaw.units.registry import si_factor, symbol
from wearlaw.units.variables import VARIABLES, Variable

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import ArrayLike

    from wearlaw.models.contact_model import ContactModel

LOADS = ("normal_force", "normal_force_per_width", "max_pressure")
"""Columns that give the load."""

MEASURED_FORCES = ("tangential_force", "frictional_heat")
"""Columns from which a traction coefficient follows."""

TRACTIONS = ("traction_coefficient", *MEASURED_FORCES)
"""Columns of measured traction."""

WAYS = {
    variable.name: variable
    for variable in (
        Variable("mass_loss", "mg", meaning="Mass that a body lost in the test", sign="not negative"),
        Variable("wear_volume", "mm^3", meaning="Volume that a body lost in the test", sign="not negative"),
        Variable("wear_depth", "um", meaning="Radial depth that a disc lost in the test", sign="not negative"),
        VARIABLES["mass_per_distance"],
        Variable("mass_per_cycle", "ug", meaning="Mass that a body lost per revolution", sign="not negative"),
    )
}
"""Columns of wear measured in other ways than as the outcome of a law."""

TOTALS = ("mass_loss", "wear_volume", "wear_depth")
"""Those of `WAYS` that need to know how far the test rolled."""

ROLLED = {
    variable.name: variable
    for variable in (
        Variable("distance", "km", meaning="Distance rolled in the test"),
        Variable("revolutions", "", meaning="Revolutions of the weighed body in the test"),
        Variable("cycles", "", meaning="The same as revolutions"),
        Variable("duration", "h", meaning="Duration of the test, at the rig's rolling speed"),
    )
}
"""Columns that tell how far a test rolled, the first that a test has."""

BALANCE = Variable("balance_resolution", "mg", meaning="Smallest step of the balance")
"""The column that gives `mass_loss` a standard uncertainty."""

UNCERTAIN = ("_uncertainty", "_scatter")
"""What follows the name of a measurement in the head of its standard uncertainty."""

COLUMNS = {
    **{
        name: VARIABLES[name]
        for name in (
            *("creepage", *LOADS, "friction_coefficient"),
            *(*TRACTIONS, "rolling_speed", "wear_rate", "wear_rate_uncertainty"),
        )
    },
    **WAYS,
    **ROLLED,
    BALANCE.name: BALANCE,
}
"""All columns of tests of discs."""

USUAL: Mapping[str, Unit] = {
    "creepage": Unit("%", usual=(0.1, 60.0)),  # 1 to 10 % as ratios stay below
    "normal_force": Unit("kN", usual=(0.01, 300.0)),
    "normal_force_per_width": Unit("kN/m", usual=(1.0, 30000.0)),
    "max_pressure": Unit("MPa", usual=(5.0, 10000.0)),
    "friction_coefficient": Unit("%", usual=(0.01, 200.0)),
    "traction_coefficient": Unit("%", usual=(0.01, 200.0)),
    "wear_rate": Unit(WEAR_RATE, usual=(1e-4, 1e4)),
}
"""Usual medians of columns, by magnitude."""

NEEDED = ("creepage", *LOADS, "friction_coefficient")
"""Columns that need a value for every test."""

Values = Quantity | Array
"""Values of a column with their unit, or plain numbers."""


class Arrays(TypedDict, total=False):
    """The columns of `WearTests.from_arrays`."""

    creepage: QuantityLike
    normal_force: QuantityLike
    normal_force_per_width: QuantityLike
    max_pressure: QuantityLike
    friction_coefficient: ArrayLike
    traction_coefficient: ArrayLike
    tangential_force: QuantityLike
    frictional_heat: QuantityLike
    rolling_speed: QuantityLike
    wear_rate: QuantityLike
    wear_rate_uncertainty: QuantityLike
    mass_loss: QuantityLike
    wear_volume: QuantityLike
    wear_depth: QuantityLike
    mass_per_distance: QuantityLike
    mass_per_cycle: QuantityLike
    distance: QuantityLike
    revolutions: QuantityLike | ArrayLike
    cycles: QuantityLike | ArrayLike
    duration: QuantityLike
    balance_resolution: QuantityLike


@dataclass(frozen=True, eq=False, repr=False)
class WearTests:
    """A set of tests on one rig, made by `read_tests` or `WearTests.from_arrays`.

    Attributes
    ----------
    columns : dict of str to ndarray, (tests,)
        Values in SI by name: `creepage`, one of the loads, and any of `friction_coefficient`, `traction_coefficient`,
        `wear_rate`, `wear_rate_uncertainty`, and what measures wear in another way. NaN for a missing measurement.
    labels : tuple of str
        The name of each test, "" if it has none.
    source : str
        The source of the numbers.
    other_conditions : dict of str to Quantity or ndarray, (tests,)
        Conditions of the rig that are not in `columns`, as given: with their unit, or plain numbers. A column of a file
        whose name no plugin knows is here too, until `measuring` says that it is an outcome.
    outcomes : dict of str to Quantity or ndarray, (tests,)
        Measured outcomes of laws other than `wear_rate`, as given; NaN for a missing measurement.
    units : dict of str to str
        The units in which `columns` were given.
    """

    columns: Mapping[str, Array]
    labels: tuple[str, ...]
    source: str = ""
    other_conditions: Mapping[str, Values] = field(default_factory=dict)
    outcomes: Mapping[str, Values] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def from_arrays(
        cls,
        *,
        other_conditions: Mapping[str, QuantityLike | ArrayLike] | None = None,
        outcomes: Mapping[str, QuantityLike | ArrayLike] | None = None,
        labels: Sequence[str] | None = None,
        source: str = "",
        **columns: Unpack[Arrays],
    ) -> Self:
        """Make tests from arrays. A single value stands for all tests, NaN for a missing measurement.

        Parameters
        ----------
        creepage : Quantity or str, (tests,)
            ξ, of magnitude at most 1.
        normal_force, normal_force_per_width, max_pressure : Quantity or str, (tests,)
            The load, exactly one of them: N [N], P [N/m] or p0 [Pa].
        friction_coefficient : array_like of float, (tests,), optional
            μ [-].
        traction_coefficient, tangential_force, frictional_heat : (tests,), optional
            The measured traction, at most one of them: T/N [-], magnitude of T [N], or the power T ξ V [W]. The last
            two need `normal_force` as the load, and `frictional_heat` needs `rolling_speed`.
        rolling_speed : Quantity or str, (tests,), optional
            V of the tests whose heat is given [m/s].
        wear_rate, wear_rate_uncertainty : Quantity or str, (tests,), optional
            Mass lost per distance rolled and area [kg/m³], and its standard uncertainty.
        mass_loss, wear_volume, wear_depth, mass_per_distance, mass_per_cycle : (tests,), optional
            Wear in other measures, which a fit and a comparison convert on their rig: mass [kg], volume [m³] or radial
            depth [m] lost in the test, or mass per distance rolled [kg/m] or per revolution [kg].
        distance, revolutions, cycles, duration : (tests,), optional
            How far the test rolled, for the first three of these [m], [-], [-] or [s].
        balance_resolution : Quantity or str, (tests,), optional
            Smallest step of the balance [kg], from which the standard uncertainty of `mass_loss` follows.
        other_conditions : mapping of str to Quantity, str or array_like, (tests,), optional
            Further conditions of the rig by name, such as {"mass": Q([20, 40], "kg")}. With these, creepage and load
            may be missing, and the rig checks whether it needs them.
        outcomes : mapping of str to Quantity, str or array_like, (tests,), optional
            Measured outcomes of laws by their names in results, such as {"heat_flux": Q([2, 5], "W/mm^2")}, or
            "wear_rate_rail" for a law of one body; the wear rate is an argument of its own. Also "mass_loss_rail" and
            the like, and standard uncertainties such as "mass_loss_uncertainty".
        labels : sequence of str, optional
            The name of each test.
        source : str, optional
            The source of the numbers.

        Raises
        ------
        DataError
            If columns are missing or exclude each other, or a value has the wrong unit, sign or size.
        """
        others, measured = dict(other_conditions or {}), dict(outcomes or {})
        wrong = [f"{name} is unknown{did_you_mean(name, COLUMNS)}" for name in columns if name not in COLUMNS]
        wrong += [f"{name}: is an argument of its own" for name in (*others, *measured) if name in COLUMNS]
        arrays: dict[str, Values] = {}
        for name, value in {**columns, **others, **measured}.items():
            try:
                if value is not None:
                    arrays[name] = _values(value)
            except UnitError as error:
                wrong.append(f"{name}: {error}")
        if wrong:
            raise DataError("the tests are wrong in:", wrong)
        same = _same_length(arrays)
        count = len(plain(next(iter(same.values()))))
        if labels is not None and (isinstance(labels, str) or len(labels) != count):
            raise DataError(f"labels: give one text for each of the {count} tests, got {shown(labels)}")
        named = [""] * count if labels is None else labels
        return cls.checked(same, named, source, measured, "the tests", lambda name, i: f"{name}: at index {i}")

    @classmethod
    def checked(
        cls,
        raw: Mapping[str, Values],
        labels: Sequence[str],
        source: str,
        outcomes: Collection[str],
        subject: str,
        place: Callable[[str, int], str],
    ) -> Self:
        """Return tests from columns of one length, with the names of those that are outcomes."""
        outcomes = {*outcomes, *(name for name in raw if is_way(name))}
        wrong = faulty_names(raw, outcomes)
        columns: dict[str, Array] = {}
        for name in COLUMNS:
            try:
                if name in raw:
                    columns[name] = _in_si(name, COLUMNS[name].unit, raw[name])
            except UnitError as error:
                wrong.append(f"{name}: {error}")
        others = {name: values for name, values in raw.items() if name not in COLUMNS}
        wrong = wrong or [
            f"{place(name, int(i))}: {rule}, got {plain(raw[name])[i]:g}"
            for name, faulty, rule in _faulty_values(columns, others, outcomes)
            for i in np.flatnonzero(faulty)
        ]
        if wrong:
            raise DataError(f"{subject} are wrong in:", wrong)
        columns = _with_traction(columns)
        measured = {name: others.pop(name) for name in list(others) if name in outcomes}
        units = {name: _unit(raw[name]) for name in columns if name in raw}
        return cls(columns, tuple(map(str, labels)), source, others, measured, units)

    @property
    def creepage(self) -> Quantity:
        """ξ, of shape (tests,); NaN if other conditions take its place."""
        return self._quantity("creepage")

    @property
    def friction_coefficient(self) -> Array | None:
        """μ as plain numbers, of shape (tests,); None if the tests have none."""
        return self.columns.get("friction_coefficient")

    @property
    def traction_coefficient(self) -> Quantity:
        """Measured T/N, of shape (tests,); NaN if it was not measured."""
        return self._quantity("traction_coefficient")

    @property
    def wear_rate(self) -> Quantity:
        """Measured mass lost per distance rolled and area, of shape (tests,); NaN if it was not measured."""
        return self._quantity("wear_rate")

    @property
    def wear_rate_uncertainty(self) -> Quantity | None:
        """Standard uncertainty of the wear rate, of shape (tests,); None if the tests have none."""
        return self._quantity("wear_rate_uncertainty") if "wear_rate_uncertainty" in self.columns else None

    def measuring(self, outcomes: Collection[str]) -> WearTests:
        """Return the tests with the columns of these names as measured outcomes, not as conditions of the rig."""
        names = {*outcomes, *(f"{name}_uncertainty" for name in outcomes)}
        moved = {name: value for name, value in self.other_conditions.items() if name in names}
        kept = {name: value for name, value in self.other_conditions.items() if name not in moved}
        return replace(self, other_conditions=kept, outcomes={**self.outcomes, **moved})

    @property
    def ways(self) -> list[str]:
        """Columns that measure wear in other ways than as the outcome of a law, with their uncertainties."""
        return [name for name in (*self.columns, *self.outcomes) if name in WAYS or is_way(name)]

    def measured(self, name: str, unit: str) -> Array:
        """Return measurements of an outcome or a column in SI, of shape (tests,); NaN where there is none.

        Raises
        ------
        DataError
            If the tests give the outcome in a unit of another dimension than `unit`.
        """
        if name not in self.outcomes:
            return self.columns.get(name, np.full(len(self), np.nan))
        try:
            return _in_si(name, unit, self.outcomes[name])
        except UnitError as error:
            raise DataError(f"{name}: {error}") from None

    def unusual(self, predict: Pipeline[...]) -> dict[str, str]:
        """Return the columns with an unusual median or coefficient, each with what a warning says of it."""
        units = {name: condition.unit for name, condition in predict.conditions.items() if condition.unit is not None}
        columns: dict[str, Quantity] = {
            name: from_si(values, self.units.get(name, COLUMNS[name].unit)) for name, values in self.columns.items()
        }
        columns |= {
            name: condition for name, condition in self.other_conditions.items() if isinstance(condition, pint.Quantity)
        }
        medians: dict[str, tuple[Unit, float, str]] = {}
        for name, values in columns.items():
            sizes = np.abs(values.magnitude[~np.isnan(values.magnitude)])
            unit = USUAL.get(name, units.get(name))
            if sizes.size and unit is not None:
                medians[name] = unit, float(np.median(sizes)), str(values.units)
        remarks: dict[str, str] = {}
        for name, (unit, median, shown_in) in medians.items():
            sizes = {"median": median}
            if name in ("friction_coefficient", "traction_coefficient"):  # no test of dry friction passes their range
                sizes["greatest value"] = float(np.nanmax(np.abs(columns[name].magnitude)))
            for which, size in sizes.items():
                if text := unit.unusual(name, Q(size, shown_in)):
                    remarks[f"column {name}"] = f"its {which} {text}{_swapped(name, medians, text)}"
                    break
        return remarks

    def digests(self, name: str, unit: str) -> tuple[str, ...]:
        """Return a digest of each test: of its conditions and one measurement as in `measured`."""
        in_si: dict[str, Any] = {column: self.columns[column] for column in NEEDED if column in self.columns}
        for condition, value in self.other_conditions.items():
            in_si[condition] = value.to_base_units().magnitude if isinstance(value, pint.Quantity) else value
        in_si = dict(sorted(in_si.items())) | {"measured": self.measured(name, unit)}
        texts = (
            # Nine digits, so that the rounding of units does not matter.
            ";".join(f"{column}={values[i]:.8e}" for column, values in in_si.items())
            for i in range(len(self))
        )
        # Of a million tests, two share 16 digits with a probability below 1e-7.
        return tuple(hashlib.sha256(text.encode()).hexdigest()[:16] for text in texts)

    def conditions(
        self, model: ContactModel, friction_coefficient: ArrayLike | None = None, rig: Rig | Pipeline[...] | None = None
    ) -> dict[str, Any]:
        """Return the conditions of the tests as arguments of ``rig.problem(**conditions)`` or of a pipeline.

        Parameters
        ----------
        model : ContactModel
            The contact model. If it can use a measured traction and all tests have one, the conditions include it.
        friction_coefficient : array_like of float, optional
            μ [-] for tests without a friction coefficient.
        rig : Rig or Pipeline, optional
            The rig for the conditions, or the pipeline. If it takes no `traction_coefficient`, they leave the measured
            traction out, and conditions that only other models declare.

        Raises
        ------
        DataError
            If the tests lack a condition that a model of the pipeline declares.
        ConditionsError
            If the friction coefficient is unknown, and there are only conditions of discs.
        """
        taken: Mapping[str, Condition] = {}
        if rig is not None:
            taken = rig.conditions() if isinstance(rig, Rig) else rig.conditions
        for name, condition in taken.items():
            if condition.of and condition.required and name not in self.other_conditions:
                unit = f" [{condition.unit.unit}]" if condition.unit else ""
                raise DataError(f"the tests have no column '{name}{unit}', which {condition.of} needs")
        friction = friction_coefficient if self.friction_coefficient is None else self.friction_coefficient
        if friction is None and not self.other_conditions and (not taken or "friction_coefficient" in taken):
            raise ConditionsError(
                "friction_coefficient: is missing; add a column of that name, or give"
                " friction_coefficient=0.46 in Python, --friction 0.46 on the command line"
            )
        conditions: dict[str, Any] = {
            name: self._quantity(name) for name in (*LOADS, "creepage") if name in self.columns
        }
        if friction is not None:
            conditions["friction_coefficient"] = friction
        conditions |= {
            name: values
            for name, values in self.other_conditions.items()
            if not taken or name in taken or name not in CONDITIONS
        }
        traction = self.columns.get("traction_coefficient")
        useful = model.uses_measured_traction and (not taken or "traction_coefficient" in taken)
        if useful and traction is not None and not np.isnan(traction).any():
            conditions["traction_coefficient"] = traction
        return conditions

    def to_dataframe(self) -> pd.DataFrame:
        """Return the tests as a table with units in its header, which `read_tests` can read."""
        import pandas as pd

        named = {"label": self.labels} if any(self.labels) else {}
        columns = {
            head(name) if name in COLUMNS else f"{name} [{_unit(values) or '-'}]": plain(values)
            for name, values in self._values().items()
        }
        return pd.DataFrame(named | columns)

    def __len__(self) -> int:
        return len(self.labels)

    def __getitem__(self, key: Any) -> Self:
        """Return the tests selected by an index, a slice or a mask."""
        index = np.atleast_1d(np.arange(len(self))[key])
        if not index.size:
            raise DataError(f"none of the {len(self)} tests is selected")
        chosen: dict[str, Any] = {
            kind: {name: values[index] for name, values in getattr(self, kind).items()}
            for kind in ("columns", "other_conditions", "outcomes")
        }
        return replace(self, labels=tuple(self.labels[i] for i in index), **chosen)

    def __iter__(self) -> Iterator[Self]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        every = self._values().items()
        lines = [f"{len(self)} test{'s' if len(self) > 1 else ''}", *(self._range(*item) for item in every)]
        return "\n  ".join(lines) + (f"\nfrom {self.source}" if self.source else "")

    def _range(self, name: str, values: Values) -> str:
        """Return the range of a column, and the number of tests with a value unless all have one."""
        there = plain(values)[~np.isnan(plain(values))]
        if not there.size:
            return f"{name:22} none"
        ends = " to ".join(f"{value:.4g}" for value in dict.fromkeys((there.min(), there.max())))
        unit = symbol(values.units, "~P") if isinstance(values, pint.Quantity) else ""
        counted = f" in {there.size}" if there.size < len(self) else ""
        return f"{name:22} {ends} {unit}".rstrip() + counted

    def _values(self) -> dict[str, Values]:
        """Return all columns: the conditions of discs in their usual units, the others as given."""
        of_discs = {name: self._quantity(name) for name in self.columns}
        return {**self.other_conditions, **of_discs, **self.outcomes}

    def _quantity(self, name: str) -> Quantity:
        missing = np.full(len(self), np.nan)
        return from_si(self.columns.get(name, missing), COLUMNS[name].unit)


def _swapped(name: str, medians: Mapping[str, tuple[Unit, float, str]], text: str) -> str:
    """Return the question whether an unusual column is another one, if both are usual with each other's numbers.

    Where the text says that a unit explains them, only a column of the same dimension is asked about.
    """
    (unit, median, shown_in), explained = medians[name], text.endswith("?")
    for other, (its_unit, its_median, its) in medians.items():
        unlike = unit.unusual(name, Q(its_median, shown_in)) or its_unit.unusual(other, Q(median, its))
        if other != name and not unlike and (not explained or unit.unit == its_unit.unit):
            return f"{' Or' if explained else ';'} are the columns {name} and {other} swapped?"
    return ""


def is_way(name: str) -> bool:
    """Return whether a column other than `WAYS` measures wear, such as "mass_loss_rail", or its uncertainty."""
    return name not in COLUMNS and any(name.startswith(f"{way}_") for way in WAYS)


def head(name: str) -> str:
    """Return the head of a column with its usual unit, as in "creepage [%]"."""
    unit = COLUMNS[name].unit
    return f"{name} [{unit}]" if unit else name


def plain(values: Values) -> Array:
    """Return values without their unit."""
    array: Any = values.magnitude if isinstance(values, pint.Quantity) else values
    return array  # type: ignore[no-any-return]


def faulty_names(names: Collection[str], outcomes: Collection[str]) -> list[str]:
    """Return what is wrong with a combination of columns, of which some are `outcomes`, regardless of their values.

    If there are other conditions of a rig, it checks itself whether creepage or load are missing.
    """
    others = any(name not in COLUMNS and name not in outcomes for name in names)
    loads, tractions, forces = (
        [name for name in kind if name in names] for kind in (LOADS, TRACTIONS, MEASURED_FORCES)
    )
    wrong = []
    if "creepage" not in names and (not others or "frictional_heat" in names):
        wrong.append(f"creepage: is missing; add a column '{head('creepage')}'")
    if len(loads) > 1 or not (loads or others):
        wrong.append(f"give exactly one load of {', '.join(map(head, LOADS))}; got {' and '.join(loads) or 'none'}")
    if len(tractions) > 1:
        wrong.append(f"{' and '.join(tractions)}: all give the traction; keep one of them")
    if forces and "normal_force" not in names:
        wrong.append(f"{forces[0]}: T/N follows from it only beside a column '{head('normal_force')}'")
    if ("frictional_heat" in names) != ("rolling_speed" in names):
        wrong.append(
            f"frictional_heat is T × creepage × rolling speed; '{head('rolling_speed')}' stands beside it only"
        )
    if "wear_rate_uncertainty" in names and "wear_rate" not in names:
        wrong.append("wear_rate_uncertainty: there is no wear_rate beside it")
    totals = [name for name in names if name.startswith(TOTALS)]
    if totals and not any(name in names for name in ROLLED):
        wrong.append(f"{totals[0]}: add how far the test rolled, as a column {' or '.join(map(head, ROLLED))}")
    if all(name in (*NEEDED, *ROLLED, BALANCE.name, "rolling_speed") for name in names):
        wrong.append(f"nothing is measured; add a column such as '{head('mass_loss')}' or 'traction_coefficient'")
    return wrong


def _faulty_values(
    columns: Mapping[str, Array], others: Mapping[str, Values], outcomes: Collection[str]
) -> Iterator[tuple[str, Any, str]]:
    """Yield a column, a mask of its values that break a rule, and the rule; missing measurements break none."""
    for name, values in columns.items():
        about = COLUMNS[name]
        yield name, np.isinf(values), "must be finite"
        if about.sign == "positive":
            yield name, values <= 0.0, "must be greater than zero"
        if about.sign == "not negative":
            yield name, values < 0.0, "must not be negative"
        yield name, np.abs(values) > about.limit, f"must not exceed {100.0 * about.limit:g} %; is its unit right?"
        if name in NEEDED:
            yield name, np.isnan(values), "every test needs it"
    for name, measured in others.items():
        yield name, np.isinf(plain(measured)), "must be finite"
        if name not in outcomes:
            yield name, np.isnan(plain(measured)), "every test needs it"
    for name in MEASURED_FORCES:
        if name in columns:
            traction = _with_traction(columns)["traction_coefficient"]
            wrong = ~(np.isnan(columns[name]) | ((traction > 0.0) & np.isfinite(traction)))
            yield name, wrong, "gives no traction coefficient; check creepage, rolling speed and units"


def _with_traction(columns: Mapping[str, Array]) -> dict[str, Array]:
    """Replace the columns from which the traction coefficient follows by the traction coefficient."""
    kept = {name: values for name, values in columns.items() if name not in (*MEASURED_FORCES, "rolling_speed")}
    with np.errstate(divide="ignore"):  # `_faulty_values` reports the result
        force = columns.get("tangential_force")
        if "frictional_heat" in columns:
            force = columns["frictional_heat"] / (abs(columns["creepage"]) * columns["rolling_speed"])
        if force is not None:
            kept["traction_coefficient"] = force / columns["normal_force"]
    return {name: kept[name] for name in COLUMNS if name in kept}


def _in_si(name: str, unit: str, values: Values) -> Array:
    """Return a column as SI floats, NaN included, or raise a `UnitError` if `unit` is of another dimension."""
    if unit and not isinstance(values, pint.Quantity):
        raise UnitError(
            f"has no unit; give it in {unit} or another unit of that dimension, in a file as '{name} [{unit}]'"
        )
    if name in ("revolutions", "cycles") and isinstance(values, pint.Quantity) and "turn" in str(values.units):
        return np.asarray(values.m_as("turn"))  # to pint an angle
    try:
        factor = si_factor(Q(1.0, _unit(values)), unit)
    except UnitError as error:
        raise UnitError(f"got {_unit(values) or 'no unit'}, {error}; give it in {unit or 'plain numbers'}") from None
    return plain(values) * factor


def _values(value: object) -> Values:
    """Return an argument as a quantity or as plain numbers."""
    quantity = parse(value) if isinstance(value, str) else value
    if isinstance(quantity, pint.Quantity):
        return Q(real_array(quantity.magnitude), str(quantity.units))
    return real_array(quantity)


def _unit(values: Values) -> str:
    return symbol(values.units, "~C") if isinstance(values, pint.Quantity) else ""


def _same_length(columns: Mapping[str, Values]) -> dict[str, Values]:
    try:
        shape = np.broadcast_shapes((1,), *(np.shape(plain(values)) for values in columns.values()))
    except ValueError:
        shape = ()
    if len(shape) != 1 or 0 in shape:
        shapes = ", ".join(f"{name} {np.shape(plain(values))}" for name, values in columns.items())
        raise DataError(f"give arrays with one entry for each test, all of one length; got {shapes}")
    arrays: dict[str, Values] = {}
    for name, values in columns.items():
        copied = np.array(np.broadcast_to(plain(values), shape))
        arrays[name] = Q(copied, str(values.units)) if isinstance(values, pint.Quantity) else copied
    return arrays
