"""The base class of laws of any outcome, `Law`, its `Outcome`, and the record of the fit of its parameters."""

import math
from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, cast, get_args

import numpy as np
import pint
from pydantic import Field, model_validator

from wearlaw.arrays import Array, extremes, type_name
from wearlaw.configuration import Configuration
from wearlaw.contact.contact import Contact
from wearlaw.contact.material import Material
from wearlaw.contact.problem import Geometry
from wearlaw.errors import CalibrationWarning, CompositionError, InputError, did_you_mean, shown, warn
from wearlaw.models.contact_model import ContactModel, Scale
from wearlaw.models.model import Blame, Model, check_scale, fault
from wearlaw.parameters import numbers_in_si
from wearlaw.units.quantities import WEAR_RATE, Quantity, Unit, from_si
from wearlaw.units.variables import UNITS, VARIABLES, Variable, declare

NODE_VARIABLES = ("pressure", "traction", "slip", "slip_speed", "wear_index_density", "frictional_power_density")
"""The variables of a `Contact` with a value at each node."""

PATCH_VARIABLES = (*NODE_VARIABLES, "wear_index")
"""The variables of a `Contact` with a mean over the patch."""

LawVariable: TypeAlias = Literal[
    "pressure", "traction", "slip", "slip_speed", "wear_index_density", "frictional_power_density", "wear_index",
    "traction_bound", "x",
]  # fmt: skip
"""A variable of a `Contact` in which a law can branch, jump or be monotone."""

LAW_VARIABLES: tuple[str, ...] = get_args(LawVariable)

Numbers: TypeAlias = Mapping[str, float | Array]
"""A law's numbers in SI, by the names of its fields; a number of a record within a law as "coefficient.low_speed".

Each number is a float. If it differs between operating points, it is an array of shape (points, 1), on an ellipse
(points, 1, 1), which broadcasts over the nodes. For an outcome of the patch, its shape is (points,).
"""

BreakpointMap: TypeAlias = Mapping[str, tuple[Any, ...]]
"""Variables of a `Contact` with the SI values at which a law branches, each a float or an array as in `Numbers`."""

SCALES = ("patch", "any")
"""What a law can declare as its `scale`."""

WEAR = "wear_rate"
"""Name of the outcome of wear laws."""


class Calibration(Configuration):
    """Record of the contact, materials and tests that the parameters of a wear law were fitted to."""

    contact_model: str
    """Name of the contact model in the fit, or "any" if the parameters are not tied to one."""
    scale: Scale | Literal["any"]
    """Whether the fit used patch means or cells, or "any"."""
    options: tuple[tuple[str, str], ...] = ()
    """Relevant settings of that contact model, as pairs of field and value."""
    geometry: Geometry | Literal["any"] = "line"
    """Shape of the contact patch, or "any"."""
    materials: str
    """Materials of the two bodies, in words."""
    bodies: tuple[Material, ...] = ()
    """Materials of the body that wore and of the other one. wearlaw compares them with those of the rig, and warns if
    you ask for the wear of the other body. Empty if they are not known."""
    stated_range: tuple[tuple[str, str, str], ...] = ()
    """Range of the tests: patch means of `Contact` variables with lowest and highest value, such as
    ("wear_index_density", "0 N/mm^2", "108.4 N/mm^2")."""
    tests: tuple[str, ...] = Field(default=(), repr=False)
    """Digests of the tests of a fit, by which `wl.compare` knows them again; see `WearTests.digests`."""
    source: str
    """Literature on the parameters and on their range."""

    @model_validator(mode="after")
    def _range_has_units(self) -> "Calibration":
        self.range_in_si  # noqa: B018  raises if it is wrong
        return self

    @cached_property
    def range_in_si(self) -> dict[str, tuple[float, float]]:
        """The stated range in SI."""
        ends = {}
        for variable, low, high in self.stated_range:
            if variable not in LAW_VARIABLES:
                raise InputError(
                    f"stated_range: unknown variable {shown(variable)}{did_you_mean(variable, LAW_VARIABLES)}"
                )
            unit = Unit(UNITS[variable], positive=False)
            ends[variable] = float(unit.si(low, variable)), float(unit.si(high, variable))
        return ends

    def __str__(self) -> str:
        if self.scale == "patch":
            return "patch means (the global model)"
        if self.contact_model == "any":
            return "any contact"
        options = "".join(f", {field}={value!r}" for field, value in self.options)
        return f"the cells of contact_model({self.contact_model!r}{options})"

    def covers(self, model: ContactModel, scale: Scale, geometry: Geometry = "line") -> bool:
        """Return whether the parameters were fitted for this contact model, scale and shape of patch."""
        if self.scale not in ("any", scale) or self.geometry not in ("any", geometry):
            return False
        if scale == "patch" or self.contact_model == "any":
            return True
        return model.name == self.contact_model and all(
            getattr(model, field, None) == value for field, value in self.options
        )


@dataclass(frozen=True)
class Outcome(Variable):
    """What a law predicts: a `Variable`, such as "rcf_damage", not negative unless `sign` is "any".

    Attributes
    ----------
    of : {"area mean", "patch"}
        "area mean" if the law gives a value at each node; the result is its mean over the area of the patch. "patch" if
        it gives one value for the whole patch, such as the damage by one passage. Such a value is never averaged over
        the area and never summed over several patches.
    wear : bool
        Whether it is the wear of a body, which tests can also measure as mass, volume or depth. Its unit says what of:
        mass or volume, by distance rolled and area, by distance, or by revolution.
    """

    sign: Literal["positive", "not negative", "any"] = "not negative"
    of: Literal["area mean", "patch"] = field(kw_only=True)
    wear: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        """Check the fields, and fill in the words."""
        super().__post_init__()
        if self.of not in ("area mean", "patch"):
            raise InputError(f"outcome '{self.name}': of must be 'area mean' or 'patch', got {shown(self.of)}")
        entry = VARIABLES.get(self.name)
        if entry is None:
            self._check_unit()
        elif self.name != WEAR and not isinstance(entry, Outcome):
            raise InputError(f"outcome '{self.name}': this name has a meaning, {entry.long_name}; choose another one")


@dataclass(frozen=True, slots=True, eq=False)
class LocalOutcome:
    """The outcome of a law in a contact solved elsewhere.

    Attributes
    ----------
    contact : Contact
        The contact.
    rate : ndarray, (batch, nodes), or (batch) for an outcome of the patch
        The law's values in SI.
    outcome : Outcome
        What the law predicts.
    """

    contact: Contact
    rate: Array
    outcome: Outcome

    @property
    def local_value(self) -> Quantity:
        """The law's values at the nodes, or of the patch, in the unit of the outcome."""
        return from_si(self.rate, self.outcome.unit)

    @property
    def value(self) -> Quantity:
        """The outcome, a mean over the patch or the value of the patch, in its unit."""
        of_patch = self.outcome.of == "patch"
        return from_si(self.rate if of_patch else self.contact.mean(self.rate), self.outcome.unit)

    def __repr__(self) -> str:
        return f"{type(self).__name__} with {self.outcome.name} {self.value!r}"


class Law(Model):
    """A law of any outcome: from a solved contact to a value at each of its nodes, or of the whole patch.

    A law of wear derives from `WearLaw`.
    """

    kind: ClassVar[str] = "law"
    conditions: ClassVar[type[Any] | None]

    outcome: ClassVar[Outcome]
    """What the law predicts."""

    zero_in_stick: ClassVar[bool] = False
    """Whether the value is zero at nodes that stick."""

    follows_pressure_times_slip: ClassVar[bool] = False
    """Whether the value at a node goes with pressure times slip, p·s, as in Archard's law. wearlaw then warns if a
    contact model bounds its traction otherwise than by μp, so that ∫p·s dA is not the dissipated energy over μ."""

    fitted_for: Calibration | None = None
    """Record of the tests that the numbers are from, with their range; `wl.fit` fills it in."""
    body: str | None = None
    """The body that the law is for, by its name in the rig, such as "rail"; None for every body."""
    label: str | None = None
    """The name of the law beside others, in tables, figures and what is printed, such as "our tests of 2026"; None for
    the name of the model, with the options that tell it from others."""

    published: ClassVar = cast(Any, None)  # Any: as for `scale`
    """Record of the tests behind the published numbers of the law, or None. A law with other numbers than the published
    ones has none, so make it a property."""

    scale: ClassVar = cast(Any, "any")  # Any: for type checkers, a subclass may make it a property
    """"patch" if the law is stated only for the means of the whole patch, otherwise "any". A law that contains another
    can make it a property."""

    example_material: ClassVar = cast(Any, None)  # Any: as for `scale`
    """A material to try the law with, if it reads fields of a class of materials; None for steel. A law can make it a
    property, so that the material is not made when the law is loaded."""

    monotone_in: ClassVar[tuple[LawVariable, ...]] = ()
    """Variables of a `Contact` with which the rate never falls while the others stay the same."""

    if not TYPE_CHECKING:  # type checkers already compare the methods with this class

        @classmethod
        def __pydantic_init_subclass__(cls, **options: Any) -> None:
            """Raise an error for a law without an outcome."""
            super().__pydantic_init_subclass__(**options)
            if not isinstance(getattr(cls, "outcome", None), Outcome):
                raise TypeError(
                    f"{cls.__name__} has no outcome; add what it predicts, as in"
                    ' outcome = wl.Outcome("rcf_damage", unit="", of="patch"), or derive it from wl.WearLaw'
                )
            if "outcome" in vars(cls):
                declare(cls, cls.outcome)
            check_scale(cls, SCALES)
            fields = cls.__pydantic_fields__
            for name in Law.model_fields:
                if fields[name].default is None:
                    fields[name] = fields.pop(name)  # last where fields are shown

    def check_variables(self) -> None:
        """Raise a `ModelError` if `breakpoints`, `jumps`, `monotone_in` or `valid_range` names no variable."""
        with Blame(self):
            points = {"breakpoints": self.breakpoints(self.numbers) or {}, "jumps": self.jumps(self.numbers)}
            names = (*LAW_VARIABLES, *self.variables)
            declared = {
                **{name: (variables, names) for name, variables in points.items()},
                "monotone_in": (self.monotone_in, LAW_VARIABLES),
                "valid_range": (self.valid_range, PATCH_VARIABLES),
            }
            for name, by_variable in points.items():
                if not all(isinstance(values, tuple | list | np.ndarray) for values in by_variable.values()):
                    raise fault(
                        self, f'gives {shown(by_variable)} as `{name}`; it must be like {{"pressure": (2.1e9,)}}'
                    )
            for name, (variables, allowed) in declared.items():
                for variable in variables:
                    if variable not in allowed:
                        raise fault(
                            self,
                            f"names the variable {shown(variable)} in `{name}`, which is unknown"
                            f"{did_you_mean(variable, allowed)} There are: {', '.join(allowed)}",
                        )

    def __repr_args__(self) -> Any:
        inherited = Law.model_fields
        return ((name, value) for name, value in super().__repr_args__() if name not in inherited or value is not None)

    @abstractmethod
    def rate(self, contact: Contact, p: Numbers) -> Array:
        """Return the value of the outcome in SI, of the shape of the nodes; for an outcome of the patch, of the batch.

        Parameters
        ----------
        contact : Contact
            The solved contact.
        p : mapping of str to float or ndarray
            The law's numbers in SI; read them here and not from `self`. Fits and uncertainties pass arrays with one
            value for each operating point, so write the rate with NumPy functions that broadcast: ``np.where`` instead
            of ``if``, ``np.exp`` instead of ``math.exp``.
        """

    @cached_property
    def numbers(self) -> Mapping[str, float]:
        """The law's own numbers in SI, as floats; a name such as "mid" is replaced by its numbers."""
        with Blame(self):
            return numbers_in_si(self.explicit())

    @np.errstate(all="ignore")  # what overflows is not finite, which the check at the end finds
    def checked_rate(self, contact: Contact, p: Numbers | None = None) -> Array:
        """Return `rate` with the given numbers, by default the law's own.

        Raises
        ------
        ModelError
            If `rate` fails, or returns wrong values.
        """
        p = self.numbers if p is None else p
        with Blame(self, p):
            rate = self.rate(contact, p)
        if type(rate) not in (np.ndarray, np.float64) or rate.dtype != np.float64:
            raise fault(self, f"returned values of type {type_name(rate)}; it must return a float64 array")
        of_patch = self.outcome.of == "patch"
        shape = contact.rolling_speed.shape if of_patch else contact.pressure.shape
        if rate.shape != shape:
            each = "patch" if of_patch else "node"
            raise fault(self, f"returned values of shape {rate.shape}; it must return one a {each}, of shape {shape}")
        low, high = extremes(rate) if rate.size else (0.0, 0.0)
        if not (math.isfinite(low) and math.isfinite(high)):
            raise fault(
                self, "returned a value that is not finite; are its numbers, the loads and the materials right?"
            )
        if self.zero_in_stick and not of_patch and rate[contact.slip == 0.0].any():
            raise fault(self, "gives values where the bodies stick; they must be zero where the slip is zero")
        return rate

    def __ror__(self, contact: Contact) -> LocalOutcome:
        """Return the outcome in a contact solved elsewhere, as in ``Contact.from_arrays(...) | law``.

        Raises
        ------
        CompositionError
            If the law is stated for the whole patch, and the contact has more than one node.
        InputError
            If the contact lacks a condition of the law.
        """
        if not isinstance(contact, Contact):
            raise CompositionError(f"a {self.kind} takes a contact, not {shown(contact)}; a pipeline begins with a rig")
        scale: Scale = "patch" if contact.pressure.size == contact.rolling_speed.size else "cells"
        if self.scale == "patch" and scale != "patch":
            raise CompositionError(
                f"{self.kind} '{self.name}' is stated for the means of the whole patch; use contact.patch_mean() | law"
            )
        self._warn_of_calibration(contact, scale)
        contact = self.under_conditions(contact)
        rate = self.checked_rate(contact)
        self.check_not_negative(rate)
        return LocalOutcome(contact, rate, self.outcome)

    def under_conditions(self, contact: Contact) -> Contact:
        """Return a contact solved elsewhere with the conditions of this law in SI.

        Raises
        ------
        InputError
            If one is missing.
        UnitError
            If one has the wrong unit, or is out of bounds.
        """
        conditions = dict(contact.conditions)
        for name, condition in self.own_conditions().items():
            value = conditions.get(name)
            if isinstance(value, pint.Quantity):
                conditions[name] = condition.in_si(value)
            elif value is None and condition.required:
                raise InputError(
                    f"{name}: is missing; {condition.of} needs it. Give it with the contact, as in"
                    f" contact.at({name}={condition.example!r})"
                )
        if not self.own_conditions():
            return contact
        in_si = {name: value for name, value in conditions.items() if not isinstance(value, pint.Quantity)}
        problem = contact.problem and contact.problem.replaced(conditions=in_si)
        return contact.replaced(conditions=conditions, problem=problem)

    def check_not_negative(self, value: Array, error: Callable[[], Array] = lambda: np.zeros(())) -> None:
        """Raise a `ModelError` if an outcome without sign is negative by more than its numerical error, in SI.

        This is a check of results for users. On its way to the best fit, a law may pass through negative values.
        """
        if self.outcome.sign == "any":
            return
        low, _ = extremes(value)
        if low < 0.0 and (value < -error()).any():
            shown = from_si(low, self.outcome.unit)
            raise fault(
                self, f"gives a negative {self.outcome.long_name}, {shown!r}; see its parameters and the wear index"
            )

    def _warn_of_calibration(self, contact: Contact, scale: Scale) -> None:
        """Warn if the parameters were fitted for another kind of contact, as far as the contact shows its kind."""
        fitted_for = self.calibration
        if fitted_for is None:
            return
        held = "the means of the patch" if scale == "patch" else "its cells"
        if contact.on_strips and fitted_for.geometry == "line":
            held += ", of an ellipse"
        elif fitted_for.scale in ("any", scale):
            return
        warn(
            f"the parameters of {self.kind} '{self.name}' were fitted for {fitted_for}, but the contact holds {held};"
            " check them against data",
            CalibrationWarning,
        )

    def breakpoints(self, p: Numbers) -> BreakpointMap | None:  # noqa: ARG002
        """Return the variables in which the law branches, with the SI values of the branch points.

        {} declares a law that is smooth everywhere. None, the default, declares nothing.
        """
        return None

    def ramps(self, p: Numbers) -> tuple[tuple[Any, Any], ...] | None:  # noqa: ARG002
        """Return the law as pairs of threshold [N/m²] and slope [kg/m/N], if it is a sum of ramps in q·s.

        The rate is Σ slope · max(q·s - threshold, 0). Contact models with a closed form of the energy above a threshold
        then give the mean over the patch without nodes.
        """
        return None

    @property
    def own_variables(self) -> Mapping[Variable, Callable[[Contact], Array]]:
        """Variables of the law's own in which it branches, each a function from a contact to one value for a node."""
        return {}

    @cached_property
    def variables(self) -> Mapping[str, Variable]:
        """The variables of the law's own by name."""
        with Blame(self):
            variables = self.own_variables
        if not all(isinstance(variable, Variable) for variable in variables):
            raise fault(self, f"gives {shown([*variables])} as `own_variables`; they must be of type wl.Variable")
        return {variable.name: variable for variable in variables}

    def value_at(self, contact: Contact, name: str) -> Array:
        """Return a variable of the law's own or of the contact at the nodes, in SI."""
        if name not in self.variables:
            return variable_at_nodes(contact, name)
        with Blame(self):
            return self.own_variables[self.variables[name]](contact)

    def jumps(self, p: Numbers) -> BreakpointMap:  # noqa: ARG002
        """Return the breakpoints at which the rate jumps."""
        return {}

    @property
    def valid_range(self) -> Mapping[str, tuple[float, float]]:
        """The stated range of the law: patch means of `Contact` variables with their SI bounds.

        By default it is that of the `calibration`.
        """
        calibration = self.calibration
        return {} if calibration is None else calibration.range_in_si

    @property
    def calibration(self) -> Calibration | None:
        """Record of the tests that the numbers are from: `fitted_for`, or else `published`; None if there is none."""
        record: Calibration | None = self.fitted_for if isinstance(self.fitted_for, Calibration) else self.published
        return record

    def explicit(self) -> "Law":
        """Return the same law with numbers instead of names of published values."""
        return self

    def band(self) -> "tuple[Law, Law, Law] | None":
        """Return the laws at the low end, middle and high end of published parameter ranges, or None without ranges."""
        return None


class WearLaw(Law):
    """A law of wear: from a solved contact to the wear rate at each of its nodes.

    Its `rate` is the mass lost per metre rolled and contact area [kg/m/m²]. It is not negative, and it is zero where
    nothing slips.
    """

    kind: ClassVar[str] = "wear law"
    outcome: ClassVar[Outcome] = Outcome(WEAR, WEAR_RATE, of="area mean", wear=True)
    zero_in_stick: ClassVar[bool] = True

    if TYPE_CHECKING:  # for checkers, these methods of `Law` return wear laws

        def explicit(self) -> "WearLaw": ...  # noqa: D102

        def band(self) -> "tuple[WearLaw, WearLaw, WearLaw] | None": ...  # noqa: D102


def variable_at_nodes(contact: Contact, name: str) -> Array:
    """Return a variable of a contact by its name, of the shape of the nodes; a total is the same at all nodes."""
    value: Array = getattr(contact, name)
    return np.broadcast_to(contact.per_node(value), contact.pressure.shape)


def named_outcomes(laws: Sequence[Law]) -> dict[str, int]:
    """Return the index of each law by the name of its outcome in results, such as "wear_rate".

    If several laws have one outcome, each for a body, the name of the body follows, as in "wear_rate_rail".
    """
    names = [law.outcome.name for law in laws]
    return {
        name if names.count(name) == 1 else f"{name}_{law.body}": index
        for index, (name, law) in enumerate(zip(names, laws, strict=True))
    }
