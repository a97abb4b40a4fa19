"""The base class of wear laws, `WearLaw`, and the record of the fit of their parameters, `Calibration`."""

import inspect
import math
import warnings
from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias, cast

import numpy as np
from pydantic import model_validator

from wearlaw.arrays.array import Array, extremes, type_name
from wearlaw.contact.contact import LAW_VARIABLES, PATCH_VARIABLES, Contact, LawVariable, check_variables
from wearlaw.contact.material import Material
from wearlaw.contact.problem import Geometry
from wearlaw.errors import CalibrationWarning, CompositionError, InputError, ModelError, did_you_mean
from wearlaw.models.contact_model import Blame, ContactModel, Model, Scale, check_scale
from wearlaw.settings.configuration import Configuration
from wearlaw.settings.parameters import numbers_in_si
from wearlaw.units.quantities import WEAR_RATE, Quantity, Unit, from_si
from wearlaw.units.variables import UNITS

Numbers: TypeAlias = Mapping[str, float | Array]
"""A law's numbers in SI, by the names of its fields; a number of a record within a law as "coefficient.low_speed".

Each number is a float. If it differs between operating points, it is an array of shape (points, 1), on an ellipse
(points, 1, 1), which broadcasts over the nodes.
"""

BreakpointMap: TypeAlias = Mapping[str, tuple[Any, ...]]
"""Variables of a `Contact` with the SI values at which a law branches, each a float or an array as in `Numbers`."""

SCALES = ("patch", "any")
"""What a law can declare as its `scale`."""

TAKE_NUMBERS = {"rate": ("self", "contact", "p"), **dict.fromkeys(("breakpoints", "ramps", "jumps"), ("self", "p"))}
"""The methods of a law that take its numbers, with their arguments."""


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
    source: str
    """Literature on the parameters and on their range."""

    @model_validator(mode="after")
    def _range_has_units(self) -> "Calibration":
        self.range_in_si  # noqa: B018  raises if it is wrong
        return self

    @cached_property
    def range_in_si(self) -> dict[str, tuple[float, float]]:
        """The stated range in SI."""
        found = {}
        for variable, low, high in self.stated_range:
            if variable not in LAW_VARIABLES:
                raise InputError(f"stated_range: unknown variable '{variable}'{did_you_mean(variable, LAW_VARIABLES)}")
            unit = Unit(UNITS[variable], positive=False)
            found[variable] = float(unit.si(low, variable)), float(unit.si(high, variable))
        return found

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


@dataclass(frozen=True, slots=True, eq=False)
class LocalWear:
    """The wear in a contact solved elsewhere.

    Attributes
    ----------
    contact : Contact
        The contact.
    rate : ndarray, (batch, nodes)
        The law's rate at the nodes [kg/m/m²].
    """

    contact: Contact
    rate: Array

    @property
    def local_wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area at the nodes [kg/m/m²]."""
        return from_si(self.rate, WEAR_RATE)

    @property
    def wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area, mean over the patch [kg/m/m²]."""
        return from_si(self.contact.mean(self.rate), WEAR_RATE)

    @property
    def wear_index(self) -> Quantity:
        """Wear index, Tγ [N], the energy dissipated per metre rolled."""
        return from_si(self.contact.wear_index, "N")

    @property
    def tangential_force(self) -> Quantity:
        """Tangential force, T [N], the sum of the tractions."""
        return from_si(self.contact.tangential_force, "N")

    @property
    def mass_per_distance(self) -> Quantity:
        """Mass lost per metre rolled [kg/m]."""
        return from_si(self.contact.sum_over_nodes(self.rate * self.contact.area), "ug/m")

    def __repr__(self) -> str:
        return f"LocalWear with wear_rate {self.wear_rate!r}"


class WearLaw(Model):
    """A law of wear: from a solved contact to the wear rate at each of its nodes."""

    kind: ClassVar[str] = "wear law"

    scale: ClassVar = cast(Any, "any")  # Any: for type checkers, a subclass may make it a property
    """"patch" if the law is stated only for the means of the whole patch, otherwise "any". A law that contains another
    can make it a property."""

    monotone_in: ClassVar[tuple[LawVariable, ...]] = ()
    """Variables of a `Contact` with which the rate never falls while the others stay the same."""

    if not TYPE_CHECKING:  # type checkers already compare the methods with this class

        @classmethod
        def __pydantic_init_subclass__(cls, **options: Any) -> None:
            """Raise an error for methods that do not take the law's numbers, and for an unknown scale."""
            super().__pydantic_init_subclass__(**options)
            check_scale(cls, inspect.getattr_static(cls, "scale"), SCALES)
            for name, arguments in TAKE_NUMBERS.items():
                _check_arguments(cls, name, arguments)

    @model_validator(mode="after")
    def _has_a_scale(self) -> Self:
        check_scale(self, self.scale, SCALES)
        return self

    def check_variables(self) -> None:
        """Raise a `ModelError` if `breakpoints`, `jumps`, `monotone_in` or `valid_range` name an unknown variable."""
        with Blame(self):
            declared = {
                "breakpoints": (self.breakpoints(self.numbers) or {}, LAW_VARIABLES),
                "jumps": (self.jumps(self.numbers), LAW_VARIABLES),
                "monotone_in": (self.monotone_in, LAW_VARIABLES),
                "valid_range": (self.valid_range, PATCH_VARIABLES),
            }
        for name, (variables, known) in declared.items():
            check_variables(f"wear law '{self.name}': `{name}`", variables, known)

    @abstractmethod
    def rate(self, contact: Contact, p: Numbers) -> Array:
        """Return the mass lost per metre rolled and contact area [kg/m/m²], of the shape of the nodes.

        The rate is not negative, and it is zero where nothing slips.

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
        if type(rate) is not np.ndarray or rate.dtype != np.float64:
            raise ModelError(
                f"wear law '{self.name}' returned rates of type {type_name(rate)}; it must return a float64 array"
            )
        if rate.shape != contact.pressure.shape:
            raise ModelError(
                f"wear law '{self.name}' returned rates of shape {rate.shape} for nodes of shape"
                f" {contact.pressure.shape}; it must return one rate a node"
            )
        low, high = extremes(rate) if rate.size else (0.0, 0.0)
        if not (math.isfinite(low) and math.isfinite(high)):
            raise ModelError(f"wear law '{self.name}' returned a rate that is not finite")
        if rate[contact.slip == 0.0].any():
            raise ModelError(
                f"wear law '{self.name}' gives wear where the bodies stick; the rate must be zero if the slip is zero"
            )
        return rate

    def __ror__(self, contact: Contact) -> LocalWear:
        """Return the wear in a contact solved elsewhere, as in ``Contact.from_arrays(...) | law``.

        Raises
        ------
        CompositionError
            If the law is stated for the whole patch, and the contact has more than one node.
        """
        if not isinstance(contact, Contact):
            raise CompositionError(f"a wear law takes a contact, not {contact!r}; a pipeline begins with a rig")
        scale: Scale = "patch" if contact.pressure.size == contact.rolling_speed.size else "cells"
        if self.scale == "patch" and scale != "patch":
            raise CompositionError(
                f"wear law '{self.name}' is stated for the means of the whole patch; use contact.patch_mean() | law"
            )
        self._warn_of_calibration(contact, scale)
        rate = self.checked_rate(contact)
        self.check_not_negative(rate)
        return LocalWear(contact, rate)

    def check_not_negative(self, rate: Array, error: Callable[[], Array] = lambda: np.zeros(())) -> None:
        """Raise a `ModelError` if wear is negative by more than its numerical error [kg/m/m²].

        This is a check of results for users. On its way to the best fit, a law may pass through negative wear.
        """
        low, _ = extremes(rate)
        if low < 0.0 and (rate < -error()).any():
            raise ModelError(f"wear law '{self.name}' gives a negative wear rate, {low:g} kg/m/m²; see its parameters")

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
        warnings.warn(
            f"the parameters of wear law '{self.name}' were fitted for {fitted_for}, but the contact holds {held};"
            " check them against data",
            CalibrationWarning,
            stacklevel=3,
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
        """Record of the fit of the parameters, or None."""
        return None

    def explicit(self) -> "WearLaw":
        """Return the same law with numbers instead of names of published values."""
        return self

    def fitted(self, calibration: Calibration) -> "WearLaw":  # noqa: ARG002
        """Return this law with a record of the fit of its parameters; by default the law keeps no record."""
        return self

    def band(self) -> "tuple[WearLaw, WearLaw, WearLaw] | None":
        """Return the laws at the low end, middle and high end of published parameter ranges, or None without ranges."""
        return None


def _check_arguments(law: type[WearLaw], name: str, arguments: tuple[str, ...]) -> None:
    """Raise a `TypeError` if a method of a law does not take these arguments."""
    method = inspect.getattr_static(law, name)
    rule = f"{law.__name__}.{name} must take ({', '.join(arguments)}): p holds the law's numbers in SI"
    if isinstance(method, property | cached_property):
        raise TypeError(f"{rule}; it is a property, make it a method")
    if inspect.isfunction(method):
        try:
            inspect.signature(method).bind(*arguments)
        except TypeError:
            raise TypeError(f"{rule}; it takes {inspect.signature(method)}") from None
