"""Uncertain operating points and parameters, as a case file describes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from wearlaw.configuration import Configuration
from wearlaw.errors import Fault, InputError, did_you_mean, shown
from wearlaw.models.law import Law
from wearlaw.models.model import Model
from wearlaw.pipeline.composition import several_patches
from wearlaw.pipeline.pipeline import Rig
from wearlaw_apps.fits.distributions import Distribution, PublishedRange, lognormal, normal, published_range, uniform
from wearlaw_apps.fits.uncertain_inputs import parameter
from wearlaw_apps.studies.grid import Conditions, Value, wrong_conditions

MAKERS: dict[str, Callable[..., Distribution]] = {"uniform": uniform, "normal": normal, "lognormal": lognormal}
"""What makes each distribution."""


class Spread(Configuration):
    """A distribution, given by exactly one of these fields."""

    uniform: tuple[Value, Value] | None = None
    """Lower and upper end; all values between them are equally likely."""
    normal: tuple[Value, Value] | None = None
    """Mean and standard deviation."""
    lognormal: tuple[Value, float] | None = None
    """Median, and geometric standard deviation: two thirds of the values lie within this factor of the median."""

    @model_validator(mode="after")
    def _one(self) -> Spread:
        names = [name for name, value in self if value is not None]
        if len(names) != 1:
            raise ValueError(f"give one of uniform, normal and lognormal; got {' and '.join(names) or 'none of them'}")
        self.distribution()  # raises if it is impossible
        return self

    def distribution(self) -> Distribution:
        """Return the distribution."""
        ((make, values),) = ((MAKERS[name], values) for name, values in self if values is not None)
        return make(*values)


def _uncertain(value: Any) -> Any:
    if isinstance(value, dict):
        return Spread(**value)
    if isinstance(value, Spread | str | float | int) and not isinstance(value, bool):
        return value
    raise InputError(f"must be a value, or a table such as {{uniform = [0.3, 0.5]}}; got {shown(value)}")


Condition = Annotated[float | str | Spread, BeforeValidator(_uncertain)]
"""A value, or its distribution."""

Parameter = Annotated[Literal["published_range"] | Spread, BeforeValidator(_uncertain)]
"""The distribution of a parameter of a law."""


class UncertainPoint(Conditions):
    """Conditions of an operating point, and parameters of the laws.

    Each may be a distribution.
    """

    __pydantic_extra__: dict[str, Condition]  # pyright: ignore[reportIncompatibleVariableOverride]

    laws: dict[str, dict[str, Parameter]] = Field(default_factory=dict)
    """The distributed parameters of each wear law, by its name in the results."""

    def faults(self, rig: Rig, models: Iterable[Model] = ()) -> list[Fault]:
        """Return what is wrong with the conditions, tried at the first number of each distribution."""
        conditions = self.conditions()
        middle = {name: value.first for name, value in conditions.items() if isinstance(value, Distribution)}
        faults = list(wrong_conditions(rig, {**conditions, **middle}, models))
        if not faults and (several := several_patches(rig.checked_problem({**conditions, **middle}, models), rig)):
            faults = [Fault((), f"{several}; leave it out")]
        return faults

    def conditions(self) -> dict[str, Any]:
        """Return the conditions as arguments of `uncertainty`."""
        return {
            name: value.distribution() if isinstance(value, Spread) else value for name, value in self.written.items()
        }

    def varies(self, law: str) -> bool:
        """Return whether a condition, or a parameter of this law, is distributed."""
        return bool(any(isinstance(value, Spread) for value in self.written.values()) or self.laws.get(law))

    def parameters(self, law: str) -> dict[str, Distribution | PublishedRange]:
        """Return the distributed parameters of a law."""
        parameters = self.laws.get(law, {}).items()
        return {
            name: value.distribution() if isinstance(value, Spread) else published_range() for name, value in parameters
        }

    def wrong_laws(self, laws: Mapping[str, Law]) -> Iterator[Fault]:
        """Yield the unknown laws, and the unknown or impossible parameters of the others."""
        for law in self.laws:
            if law not in laws:
                hint = did_you_mean(law, laws)
                yield Fault(("laws", law), f"the case has no such law{hint} There are: {', '.join(laws)}")
                continue
            for name, distribution in self.parameters(law).items():
                try:
                    parameter(name, distribution, laws[law])
                except InputError as error:
                    yield Fault(("laws", law, name), str(error).removeprefix(f"{name}: "))
