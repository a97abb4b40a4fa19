"""The base class of all models, `Model`, and the errors that name a model.

A model is its configuration: a frozen pydantic record. Its fields carry units, and its methods compute.
"""

import inspect
from abc import ABC
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias, cast, is_typeddict

import numpy as np

from wearlaw.configuration import Configuration
from wearlaw.contact.conditions import Condition, of_table
from wearlaw.errors import CompositionError, InputError, ModelError, WearlawError, described, did_you_mean
from wearlaw.late import method

Claim: TypeAlias = str
"""Name of an invariant that a model keeps unless it declares itself exempt; see `Model.exemptions`.

It is the name of a check of the conformance kit, such as "each_node_wears_by_itself". For contact models, some claims
have several checks, such as "energy_balance" or "spin".
"""

ORDER = 'the order is rig | wl.contact_model("exact") | stages such as wl.patch_mean() | wl.wear_law("usfd")'
"""Hint for models that do not make a pipeline."""

CONDITIONS: set[str] = set()
"""Names of the conditions that classes of contact models, stages and laws declare."""

OF_ARRAYS = (
    "\nIn a fit or an uncertainty, its numbers are arrays of shape (points, 1), one value for each operating point."
    " Write its formulas with NumPy functions that broadcast: np.where instead of if, np.exp instead of math.exp"
)
"""Hint for a law that fails with arrays instead of numbers."""

OF_READ_ONLY = (
    "\nThe arrays that a model is given are read-only, because other models read them too. Make a new array, as in"
    " mpa = pressure / 1e6 instead of mpa = pressure; mpa /= 1e6, or begin with pressure.copy()"
)
"""Hint for a model that fails because it writes into an array that it was given."""


@dataclass(frozen=True)
class Exempt:
    """An exemption from a part of a claim, or from a claim up to a bound; see `Model.exemptions`.

    Attributes
    ----------
    reason : str
        Why the model does not keep it.
    only : str or tuple of str
        The parts that it does not keep, such as "spin"; the check of the others stays. () for all of them.
    upto : float or None
        The largest relative deviation there, such as 0.1, which the check then allows. None for any.
    """

    reason: str
    only: str | tuple[str, ...] = ()
    upto: float | None = None

    @property
    def parts(self) -> tuple[str, ...]:
        """The parts as a tuple."""
        return (self.only,) if isinstance(self.only, str) else self.only

    @property
    def whole(self) -> bool:
        """Whether the check of the claim is left out altogether."""
        return not self.parts and self.upto is None

    def __str__(self) -> str:
        bound = "" if self.upto is None else f"up to {self.upto:.2g}"
        scope = ", ".join(filter(None, (" and ".join(self.parts), bound)))
        return f"{self.reason} ({scope})" if scope else self.reason


class Model(Configuration, ABC):
    """Base class of rigs, contact models and wear laws."""

    kind: ClassVar[str]
    """Word for a model of this kind in messages."""

    name: ClassVar[str]
    """Name of the model in the look-up."""

    source: ClassVar[str]
    """Literature source of the model."""

    conditions: ClassVar = cast(Any, None)  # Any: a rig has a method of this name
    """A `TypedDict` of conditions that a contact model, a stage or a law needs beside those of rigs, each with its unit
    and a docstring. They are conditions of every pipeline with the model, which reads them from `conditions` of the
    problem or the contact. A rig with a condition of this name provides it."""

    example_fields: ClassVar[Mapping[str, Any]] = {}
    """Values of fields to try the model with: of those without a default, or of one that makes it fast."""

    _provided_by: ClassVar[Callable[..., str]]
    """Where a class of models comes from, in words; set by the look-up of plugins."""

    def _origin(self) -> str:
        """Return the class of this model in words, with the distribution or the module that it comes from."""
        cls = type(self)
        return f"class {cls.__name__}{cls._provided_by(cls)}"

    if not TYPE_CHECKING:  # checkers keep the signature that pydantic derives from the fields

        def __init__(self, /, **fields: object) -> None:
            if not hasattr(type(self), "name"):
                cls = type(self).__name__
                raise ModelError(f'{cls}: has no name; write name: ClassVar[str] = "{cls.lower()}" in the class')
            super().__init__(**fields)

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        """Raise an error for conditions without units, and list the others."""
        super().__pydantic_init_subclass__(**options)
        table = vars(cls).get("conditions")
        if is_typeddict(table):
            CONDITIONS.update(of_table(table))
            if bare := [name for name, condition in of_table(table).items() if condition.check is None]:
                raise ModelError(
                    f"{cls.__name__}.conditions: {bare[0]} has no unit; write {bare[0]}: Annotated[wl.QuantityLike,"
                    ' wl.Unit("%")], or wl.Coefficient for a plain number'
                )
        elif isinstance(table, type):
            raise ModelError(f"{cls.__name__}.conditions: must be a TypedDict, got {table.__name__}")

    @classmethod
    def subject(cls) -> str:
        """Return the name of this model in messages."""
        return cls.name

    def own_conditions(self) -> Mapping[str, Condition]:
        """Return the conditions that a contact model, a stage or a law declares, by name."""
        return {} if self.conditions is None else of_table(self.conditions, f"{self.kind} '{self.name}'")

    def _repr_html_(self) -> str:
        """Return the model for a notebook: its name and fields."""
        shown: str = method("html", "a notebook")(self)
        return shown

    @property
    def exemptions(self) -> Mapping[Claim, str | Exempt]:
        """The invariants that this model does not keep, each with the reason, or with an `Exempt` for a part of it."""
        return {}

    if not TYPE_CHECKING:  # checkers reject both by themselves

        def __or__(self, other: object) -> object:
            raise CompositionError(f"{self.kind} '{self.name}' cannot start a pipeline; {ORDER}")

        def __call__(self, *_: object, **_conditions: object) -> object:
            """Raise an error, because only a pipeline predicts."""
            raise CompositionError(f"{self.kind} '{self.name}' predicts nothing by itself; {ORDER}")


def fault(model: Model, what: str) -> ModelError:
    """Return the error for a model that is at fault; it names the model, its class and its distribution.

    `what` is what the model did, such as "returned values of shape (3,)".
    """
    return ModelError(with_origin(model, f"{model.kind} '{model.name}' {what}"))


def with_origin(model: Model, message: str) -> str:
    """Return a message about a model with the class of the model and the distribution or module that it comes from."""
    return f"{message}\nThe {model.kind} is {model._origin()}"


class Blame:
    """A context that turns an exception in a model's code into a `ModelError` that names the model.

    Errors of wearlaw pass, because their messages are complete. An `InputError` gets a note that names the model, but
    not one of a rig or a reader, which is about the conditions or a file. Ctrl-C and a lack of memory pass as well. If
    there are arrays among the numbers `p` given to a law, the message says how to compute with arrays.
    """

    __slots__ = ("_model", "_p")

    def __init__(self, model: Model, p: Mapping[str, object] | None = None) -> None:
        self._model, self._p = model, p

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        if error is None:
            return
        model = self._model
        if isinstance(error, InputError) and model.kind not in ("rig", "reader") and not hasattr(error, "__notes__"):
            error.add_note(f"raised in {model.kind} '{model.name}', {model._origin()}")
        if isinstance(error, WearlawError | KeyboardInterrupt | MemoryError):
            return
        said = described(error)
        hint = ""
        if "read-only" in said or "readonly" in said:  # as NumPy and numba say it
            hint = OF_READ_ONLY
        elif any(isinstance(number, np.ndarray) for number in (self._p or {}).values()):
            hint = OF_ARRAYS
        raise fault(model, f"failed: {said}{hint}") from error


def check_scale(model: type[Model], scales: tuple[str, ...]) -> None:
    """Raise a `ModelError` if a class of models declares an unknown scale; it can also be a property."""
    scale = inspect.getattr_static(model, "scale")
    if isinstance(scale, str) and scale not in scales:
        words = " or ".join(repr(word) for word in scales)
        raise ModelError(f"{model.__name__}.scale: is {scale!r}{did_you_mean(scale, scales)} It must be {words}")
