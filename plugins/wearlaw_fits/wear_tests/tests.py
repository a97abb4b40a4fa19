"""Wear tests of a lab: conditions and measurements, with an entry for each test and NaN for missing measurements.

`read_tests` reads them from a CSV file, and `WearTests.from_arrays` takes arrays. They are independent of rigs: tests
only provide the conditions of contact problems.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import LOADS
from wearlaw.errors import ConditionsError, DataError, UnitError, shown
from wearlaw.units.quantities import Q, Quantity, QuantityLike, from_si, parse, real_array
from wearlaw.units.registry import si_factor, symbol
from wearlaw_fits.wear_tests.columns import COLUMNS, factor, faulty, faulty_columns, head, with_traction

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import ArrayLike

    from wearlaw.models.contact_model import ContactModel
    from wearlaw.pipeline.pipeline import Rig

DIGEST = 16
"""Hexadecimal digits of the digest of a test; two of a million tests share one with a probability below 1e-7."""


@dataclass(frozen=True, eq=False, repr=False)
class WearTests:
    """Immutable set of tests on one rig, made by `read_tests` or `WearTests.from_arrays`.

    Attributes
    ----------
    columns : mapping of str to ndarray, (tests,)
        Values in SI by name: `creepage`, one of the loads, and any of `friction_coefficient`, `traction_coefficient`,
        `wear_rate` and `wear_rate_uncertainty`. NaN for a missing measurement.
    labels : tuple of str
        The name of each test, "" if it has none.
    source : str
        The source of the numbers.
    other_conditions : mapping of str to Quantity or ndarray, (tests,)
        Conditions of the rig that are not in `columns`, as given: with their unit, or plain numbers. A column of a file
        whose name no plugin knows is here too, until `measuring` says that it is an outcome.
    outcomes : mapping of str to Quantity or ndarray, (tests,)
        Measured outcomes of laws other than `wear_rate`, as given; NaN for a missing measurement.
    """

    columns: Mapping[str, Array]
    labels: tuple[str, ...]
    source: str = ""
    other_conditions: Mapping[str, Quantity | Array] = field(default_factory=dict)
    outcomes: Mapping[str, Quantity | Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for values in (*self.columns.values(), *map(_magnitude, {**self.other_conditions, **self.outcomes}.values())):
            values.flags.writeable = False
        for name in ("columns", "other_conditions", "outcomes"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @classmethod
    def from_arrays(
        cls,
        *,
        creepage: QuantityLike | None = None,
        normal_force: QuantityLike | None = None,
        normal_force_per_width: QuantityLike | None = None,
        max_pressure: QuantityLike | None = None,
        friction_coefficient: ArrayLike | None = None,
        traction_coefficient: ArrayLike | None = None,
        tangential_force: QuantityLike | None = None,
        frictional_heat: QuantityLike | None = None,
        rolling_speed: QuantityLike | None = None,
        wear_rate: QuantityLike | None = None,
        wear_rate_uncertainty: QuantityLike | None = None,
        other_conditions: Mapping[str, QuantityLike | ArrayLike] | None = None,
        outcomes: Mapping[str, QuantityLike | ArrayLike] | None = None,
        labels: Sequence[str] | None = None,
        source: str = "",
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
        other_conditions : mapping of str to Quantity, str or array_like, (tests,), optional
            Further conditions of the rig by name, such as {"mass": Q([20, 40], "kg")}. With these, creepage and load
            may be missing, and the rig checks whether it needs them.
        outcomes : mapping of str to Quantity, str or array_like, (tests,), optional
            Measured outcomes of laws by their names in results, such as {"heat_flux": Q([2, 5], "W/mm^2")}, or
            "wear_rate_rail" for a law of one body; the wear rate is an argument of its own.
        labels : sequence of str, optional
            The name of each test.
        source : str, optional
            The source of the numbers.

        Raises
        ------
        DataError
            If columns are missing or exclude each other, or a value has the wrong unit, sign or size.
        """
        given = {name: value for name, value in locals().items() if name in COLUMNS and value is not None}
        others = {name: _as_given(name, value) for name, value in (other_conditions or {}).items()}
        measured = {name: _as_given(name, value) for name, value in (outcomes or {}).items()}
        faults = faulty_columns([*given, *others], bool(measured))
        faults += [f"other_conditions: {name} is an argument of its own" for name in others if name in COLUMNS]
        faults += [f"outcomes: {name} is an argument of its own" for name in measured if name in COLUMNS]
        faults += [f"outcomes: {name} is among other_conditions too" for name in measured if name in others]
        if faults:
            raise DataError("the tests are wrong in:", faults)
        as_given = others | measured
        units = {name: str(value.units) for name, value in as_given.items() if isinstance(value, pint.Quantity)}
        arrays = _same_length(
            {name: _si(name, value) for name, value in given.items()}
            | {name: real_array(_magnitude(value)) for name, value in as_given.items()}
        )
        as_given = {
            name: Q(np.array(arrays[name]), units[name]) if name in units else np.array(arrays[name])
            for name in as_given
        }
        others, measured = ({name: as_given[name] for name in some} for some in (others, measured))
        faults = [
            f"{name}: {arrays[name][i] if name in as_given else _shown(name, arrays[name][i])} at index {i} {rule}"
            for i, name, rule in faulty(arrays, measured)
        ]
        count = len(next(iter(arrays.values())))
        if labels is not None and (isinstance(labels, str) or len(labels) != count):
            faults.append(f"labels: give one text for each of the {count} tests, got {shown(labels)}")
        if faults:
            raise DataError("the tests are wrong in:", faults)
        named = tuple(map(str, [""] * count if labels is None else labels))
        return cls(with_traction(arrays), named, source, others, measured)

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
        moved = {name: value for name, value in self.other_conditions.items() if name in outcomes}
        if not moved:
            return self
        kept = {name: value for name, value in self.other_conditions.items() if name not in moved}
        return replace(self, other_conditions=kept, outcomes={**self.outcomes, **moved})

    def measured(self, name: str, unit: str) -> Array:
        """Return measurements in SI, of shape (tests,); NaN where there is none.

        Parameters
        ----------
        name : str
            Name of an outcome or of a column.
        unit : str
            Unit of the outcome.

        Raises
        ------
        DataError
            If the tests give the outcome in a unit of another dimension.
        """
        if name not in self.outcomes:
            return self.columns.get(name, np.full(len(self), np.nan))
        value = self.outcomes[name]
        quantity = value if isinstance(value, pint.Quantity) else Q(value, "")
        try:
            return _magnitude(quantity) * si_factor(quantity, unit)
        except UnitError as error:
            need = f"in {unit} or another unit of that dimension" if unit else "as a plain number"
            raise DataError(
                "the tests are wrong in:", [f"{name}: got {_unit(quantity) or '-'}, {error}; give it {need}"]
            ) from None

    def digests(self, name: str, unit: str) -> tuple[str, ...]:
        """Return a digest of each test: of its conditions and one measurement, without labels and source.

        Parameters
        ----------
        name, unit : str
            The measurement, as for `measured`.
        """
        known = (*LOADS, "creepage", "friction_coefficient")
        given = {column: self._quantity(column) for column in known if column in self.columns}
        in_si = {
            condition: np.asarray(value.to_base_units().magnitude if isinstance(value, pint.Quantity) else value)
            for condition, value in sorted({**given, **self.other_conditions}.items())
        }
        in_si["measured"] = self.measured(name, unit)
        texts = (
            # Nine digits, so that the rounding of units does not matter.
            ";".join(f"{column}={values[i]:.8e}" for column, values in in_si.items())
            for i in range(len(self))
        )
        return tuple(hashlib.sha256(text.encode()).hexdigest()[:DIGEST] for text in texts)

    def conditions(
        self, model: ContactModel, friction_coefficient: ArrayLike | None = None, rig: Rig | None = None
    ) -> dict[str, Any]:
        """Return the conditions of the tests as arguments of ``rig.problem(**conditions)``.

        Parameters
        ----------
        model : ContactModel
            The contact model. If it can use a measured traction and all tests have one, the conditions include it.
        friction_coefficient : array_like of float, optional
            μ [-] for tests without a friction coefficient.
        rig : Rig, optional
            The rig for the conditions. If it takes no `traction_coefficient`, they leave the measured traction out.

        Raises
        ------
        ConditionsError
            If the friction coefficient is unknown, and there are only conditions of discs.
        """
        taken = () if rig is None else rig.conditions()
        friction = friction_coefficient if self.friction_coefficient is None else self.friction_coefficient
        if friction is None and not self.other_conditions and (not taken or "friction_coefficient" in taken):
            raise ConditionsError(
                "friction_coefficient: the tests do not hold it; add a column of that name, or give it:"
                " friction_coefficient=0.46 in Python, --friction 0.46 on the command line"
            )
        conditions: dict[str, Any] = {
            name: self._quantity(name) for name in (*LOADS, "creepage") if name in self.columns
        }
        if friction is not None:
            conditions["friction_coefficient"] = friction
        conditions |= self.other_conditions
        traction = self.columns.get("traction_coefficient")
        useful = model.uses_measured_traction and (not taken or "traction_coefficient" in taken)
        if useful and traction is not None and not np.isnan(traction).any():
            conditions["traction_coefficient"] = traction
        return conditions

    def to_dataframe(self) -> pd.DataFrame:
        """Return the tests as a table with units in its header. `read_tests` can read it as CSV."""
        import pandas as pd

        named = {"label": self.labels} if any(self.labels) else {}
        columns = {head(name): self._quantity(name).magnitude for name in self.columns}
        others, outcomes = (
            {f"{name} [{_unit(value) or '-'}]": _magnitude(value) for name, value in some.items()}
            for some in (self.other_conditions, self.outcomes)
        )
        return pd.DataFrame(named | others | columns | outcomes)

    def __len__(self) -> int:
        return len(self.labels)

    def __getitem__(self, key: Any) -> Self:
        """Return the tests selected by an index, a slice or a mask."""
        index = np.atleast_1d(np.arange(len(self))[key])
        if not index.size:
            raise DataError(f"none of the {len(self)} tests is selected")
        columns = {name: values[index] for name, values in self.columns.items()}
        others: dict[str, Any] = {name: value[index] for name, value in self.other_conditions.items()}
        outcomes: dict[str, Any] = {name: value[index] for name, value in self.outcomes.items()}
        return type(self)(columns, tuple(self.labels[i] for i in index), self.source, others, outcomes)

    def __iter__(self) -> Iterator[Self]:
        return (self[i] for i in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, WearTests):
            return NotImplemented
        one, two = self._arrays(), other._arrays()
        return ((self.labels, self.source, one.keys()) == (other.labels, other.source, two.keys())) and all(
            np.array_equal(values, two[name], equal_nan=True) for name, values in one.items()
        )

    def _arrays(self) -> dict[tuple[str, str], Array]:
        """Return all numbers by name and unit, "" for SI."""
        every = {**self.other_conditions, **self.outcomes}
        others = {(name, _unit(value)): _magnitude(value) for name, value in every.items()}
        return {(name, ""): values for name, values in self.columns.items()} | others

    def __reduce__(self) -> tuple[Any, ...]:
        # A copy's arrays are read-only again.
        others, outcomes = dict(self.other_conditions), dict(self.outcomes)
        return type(self), (dict(self.columns), self.labels, self.source, others, outcomes)

    def __repr__(self) -> str:
        lines = [
            f"{len(self)} tests" if len(self) > 1 else "1 test",
            *(self._summary(name, value) for name, value in self.other_conditions.items()),
            *(self._summary(name, self._quantity(name)) for name in self.columns),
            *(self._summary(name, value) for name, value in self.outcomes.items()),
        ]
        return "\n  ".join(lines) + (f"\nfrom {self.source}" if self.source else "")

    def _summary(self, name: str, column: Quantity | Array) -> str:
        """Return the range of a column, and the number of tests with a value unless all have one."""
        values = _magnitude(column)
        there = values[~np.isnan(values)]
        if not there.size:
            return f"{name:22} none"
        ends = " to ".join(f"{value:.4g}" for value in dict.fromkeys((there.min(), there.max())))
        unit = symbol(column.units, "~P") if isinstance(column, pint.Quantity) else ""
        counted = f" in {there.size}" if there.size < len(self) else ""
        return f"{name:22} {ends} {unit}".rstrip() + counted

    def _quantity(self, name: str) -> Quantity:
        missing = np.full(len(self), np.nan)
        return from_si(self.columns.get(name, missing), COLUMNS[name].unit)


def _si(name: str, value: object) -> Array:
    """Return an argument as SI floats, NaN included."""
    try:
        quantity = parse(value) if isinstance(value, str) else value
        if isinstance(quantity, pint.Quantity):
            with np.errstate(over="ignore"):  # an overflow is reported as not finite
                return real_array(quantity.magnitude) * factor(name, str(quantity.units))
        if COLUMNS[name].unit:
            raise UnitError(f"has no unit; give it such as Q([1.0, 2.0], '{COLUMNS[name].unit}')")
        return real_array(value)
    except UnitError as error:
        raise DataError("the tests are wrong in:", [f"{name}: {error}"]) from None


def _as_given(name: str, value: object) -> Quantity | Array:
    """Return another condition as a quantity, or as plain numbers."""
    try:
        quantity = parse(value) if isinstance(value, str) else value
        if isinstance(quantity, pint.Quantity):
            return Q(real_array(quantity.magnitude), str(quantity.units))
        return real_array(quantity)
    except UnitError as error:
        raise DataError("the tests are wrong in:", [f"{name}: {error}"]) from None


def _magnitude(value: Quantity | Array) -> Array:
    plain: Any = value.magnitude if isinstance(value, pint.Quantity) else value
    array: Array = plain
    return array


def _unit(value: Quantity | Array) -> str:
    return symbol(value.units, "~C") if isinstance(value, pint.Quantity) else ""


def _same_length(arrays: dict[str, Array]) -> dict[str, Array]:
    try:
        shape = np.broadcast_shapes((1,), *(array.shape for array in arrays.values()))
    except ValueError:
        shape = ()
    if len(shape) != 1 or 0 in shape:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise DataError(f"give arrays with one entry for each test, all of one length; got {shapes}")
    return {name: np.broadcast_to(array, shape) for name, array in arrays.items()}


def _shown(name: str, si: float) -> str:
    return repr(from_si(float(si), COLUMNS[name].unit))
