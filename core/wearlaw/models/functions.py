"""A wear law from one function, for a notebook or a first try."""

from __future__ import annotations

import functools
import importlib
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, create_model

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import PATCH_VARIABLES, Contact, variable_at_nodes
from wearlaw.errors import ConfigurationError, Fault, UnitError, did_you_mean
from wearlaw.models.law import BreakpointMap, Numbers, WearLaw
from wearlaw.units.quantities import WEAR_RATE, Q, Quantity, Unit, in_unit, text_of
from wearlaw.units.registry import unit_in_si
from wearlaw.units.variables import UNITS, readable

Function = Callable[..., Any]


class FunctionLaw(WearLaw):
    """Base class of the laws made by `as_wear_law`; their fields are the parameters of the function."""

    function: ClassVar[Function]
    inputs: ClassVar[Mapping[str, str]]
    returns: ClassVar[str]
    units: ClassVar[Mapping[str, str]]
    declared: ClassVar[tuple[BreakpointMap | None, BreakpointMap]]

    def breakpoints(self, p: Numbers) -> BreakpointMap | None:  # noqa: ARG002
        """Return the declared breakpoints in SI."""
        return self.declared[0]

    def jumps(self, p: Numbers) -> BreakpointMap:  # noqa: ARG002
        """Return the declared jumps in SI."""
        return self.declared[1]

    def rate(self, contact: Contact, p: Numbers) -> Array:
        """Return the function's value at the nodes [kg/m/m²]."""
        arguments = [in_unit(variable_at_nodes(contact, name), unit) for name, unit in self.inputs.items()]
        parameters = {name: p[name] / unit_in_si(unit) for name, unit in self.units.items()}
        value = np.asarray(type(self).function(*arguments, **parameters), dtype=np.float64)
        return np.broadcast_to(value * unit_in_si(self.returns), contact.pressure.shape)

    def __reduce__(self) -> tuple[Any, ...]:
        own = {name: text_of(getattr(self, name)) for name in self.units}
        fields = own | {name: getattr(self, name) for name in WearLaw.model_fields}
        return _restore, (type(self).__module__, type(self).__qualname__, fields)


def _restore(module: str, name: str, fields: dict[str, Any]) -> FunctionLaw:
    """Make a law again from the decorated function, which is an attribute of its module."""
    law: Any = importlib.import_module(module)
    for part in name.split("."):
        law = getattr(law, part)
    restored: FunctionLaw = type(law)(**fields)
    return restored


def as_wear_law(
    *,
    inputs: Mapping[str, str],
    returns: str,
    breakpoints: Mapping[str, Sequence[float]] | None = None,
    jumps: Sequence[float] | Mapping[str, Sequence[float]] = (),
    parameters: Mapping[str, str] | None = None,
    monotone_in: Sequence[str] = (),
    source: str,
) -> Callable[[Function], FunctionLaw]:
    """Return a decorator that makes a wear law of a function of plain numbers.

    Parameters
    ----------
    inputs : mapping of str to str
        The positional arguments of the function, each a variable of a `Contact`, with their units: "pressure",
        "traction", "slip", "slip_speed", "wear_index_density" at the nodes, or "wear_index".
    returns : str
        The unit of the return value, such as "ug/m/mm^2".
    breakpoints : mapping of str to sequence of float, optional
        The points where the function branches, in the units of `inputs`; {} for a smooth function. By default, nothing
        is known about its branches.
    jumps : sequence of float, or mapping of str to sequence of float
        The breakpoints at which the value of the function jumps.
    parameters : mapping of str to str, optional
        The keyword arguments of the function with their units; their defaults are the defaults of the law's fields.
        Fits and uncertainties pass arrays of shape (points, 1) for them, so write the function with NumPy functions
        that broadcast, such as ``np.where`` instead of ``if``.
    monotone_in : sequence of str
        The inputs with which the value never falls.
    source : str
        The literature source of the function.

    Returns
    -------
    callable
        A decorator. The decorated function becomes a `WearLaw` with the name of the function.

    Raises
    ------
    ConfigurationError
        If the declaration does not fit the function, or a unit is wrong.
    """
    units = dict(parameters or {})

    def decorate(function: Function) -> FunctionLaw:
        subject = f"as_wear_law on {function.__name__}"
        _check(subject, function, inputs, units, returns)
        _check_names(subject, units, inputs, monotone_in)
        splits = None if breakpoints is None else _in_si(subject, "breakpoints", breakpoints, inputs)
        named = _jumps(subject, jumps, breakpoints or {})
        declared = (splits, _in_si(subject, "jumps", named, inputs))
        fields = _fields(function, units)
        law: Any = create_model(function.__name__, __base__=FunctionLaw, __module__=function.__module__, **fields)
        law.__qualname__ = function.__qualname__
        law.__doc__ = inspect.getdoc(function) or f"The function {function.__name__} as a wear law."
        law.name, law.source, law.monotone_in = function.__name__, source, tuple(monotone_in)
        law.function, law.inputs, law.returns = staticmethod(function), dict(inputs), returns
        law.units, law.declared = units, declared
        made: FunctionLaw = law()
        return made

    return decorate


def _fields(function: Function, units: Mapping[str, str]) -> dict[str, Any]:
    """Return the function's keyword arguments as fields with units."""
    signature = inspect.signature(function).parameters
    return {
        name: (
            Annotated[Quantity, Unit(unit, positive=False)],
            Field(
                default_factory=functools.partial(Q, signature[name].default, unit),
                description=f"Parameter {name} of {function.__name__} [{readable(unit) or '-'}].",
            ),
        )
        for name, unit in units.items()
    }


def _jumps(
    subject: str, jumps: Sequence[float] | Mapping[str, Sequence[float]], breakpoints: Mapping[str, Sequence[float]]
) -> Mapping[str, Sequence[float]]:
    """Return the jumps by variable; their variable can be left out if only one has breakpoints."""
    if not isinstance(jumps, Mapping):
        if len(jumps) and len(breakpoints) != 1:
            raise _error(subject, "jumps", "name their variable, as in {'pressure': [2.1]}, unless there is only one")
        jumps = dict.fromkeys(breakpoints, jumps) if len(jumps) else {}
    for name, values in jumps.items():
        known = breakpoints.get(name, ())
        for value in values:
            if value not in known:
                raise _error(subject, f"jumps.{name}", f"{value} is not one of the breakpoints: {_listed(known)}")
    return jumps


def _check(subject: str, function: Function, inputs: Mapping[str, str], units: Mapping[str, str], returns: str) -> None:
    """Raise an error for a declaration that does not fit the function."""
    for name, unit in inputs.items():
        if name not in PATCH_VARIABLES:
            hint = did_you_mean(name, PATCH_VARIABLES)
            raise _error(subject, f"inputs.{name}", f"unknown variable{hint} There are: {', '.join(PATCH_VARIABLES)}")
        _check_unit(subject, f"inputs.{name}", unit, UNITS[name])
    _check_unit(subject, "returns", returns, WEAR_RATE)
    signature = inspect.signature(function).parameters
    keywords = [name for name, parameter in signature.items() if parameter.kind is parameter.KEYWORD_ONLY]
    if len(signature) - len(keywords) != len(inputs):
        raise _error(
            subject, "inputs", f"{len(inputs)} are declared; the function takes {len(signature) - len(keywords)}"
        )
    if sorted(keywords) != sorted(units):
        raise _error(subject, "parameters", f"declare a unit for each of {', '.join(keywords) or 'none'}")
    for name in keywords:
        if signature[name].default is inspect.Parameter.empty:
            raise _error(subject, f"parameters.{name}", "needs a default value in the function")
        try:
            Q(signature[name].default, units[name])
        except UnitError as error:
            raise _error(subject, f"parameters.{name}", str(error)) from None


def _check_names(subject: str, units: Mapping[str, str], inputs: Mapping[str, str], monotone_in: Sequence[str]) -> None:
    """Raise an error for a parameter that cannot be a field of a law, or a variable that is not among the inputs."""
    for name in units:
        if name.startswith("_") or name in FunctionLaw.__class_vars__ or hasattr(FunctionLaw, name):
            raise _error(subject, f"parameters.{name}", "is a name that wear laws use themselves; choose another")
    for name in monotone_in:
        if name not in inputs:
            raise _error(subject, f"monotone_in.{name}", f"is not one of the inputs: {_listed(inputs)}")


def _check_unit(subject: str, path: str, unit: str, expected: str) -> None:
    try:
        Unit(expected).si(Q(1.0, unit), path)
    except UnitError as error:
        raise _error(subject, path, str(error)) from None


def _in_si(
    subject: str, path: str, values: Mapping[str, Sequence[float]], inputs: Mapping[str, str]
) -> dict[str, tuple[float, ...]]:
    """Return breakpoints in SI, given in the units of the inputs."""
    for name in values:
        if name not in inputs:
            raise _error(subject, f"{path}.{name}", f"is not one of the inputs: {_listed(inputs)}")
    return {name: tuple(float(v) * unit_in_si(inputs[name]) for v in given) for name, given in values.items()}


def _listed(known: Iterable[object]) -> str:
    return ", ".join(map(str, known)) or "none"


def _error(subject: str, path: str, message: str) -> ConfigurationError:
    return ConfigurationError(subject, [Fault((path,), message)])
