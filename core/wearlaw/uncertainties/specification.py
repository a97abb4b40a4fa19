"""What is not known exactly, as a case file describes it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from wearlaw.conditions import TWIN_DISC
from wearlaw.configuration import Configuration
from wearlaw.errors import InputError, did_you_mean
from wearlaw.grid import Value
from wearlaw.models import WearLaw
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.uncertainties.distributions import (
    Distribution,
    PublishedRange,
    lognormal,
    normal,
    published_range,
    uniform,
)
from wearlaw.uncertainties.inputs import parameter, split


class Spread(Configuration):
    """A distribution; exactly one of its fields is given."""

    uniform: tuple[Value, Value] | None = None
    """Two ends, between which all values are equally likely."""
    normal: tuple[Value, Value] | None = None
    """Mean and standard deviation."""
    lognormal: tuple[Value, float] | None = None
    """Median, and the factor to which two thirds of the values stay close to it."""

    @model_validator(mode="after")
    def _one(self) -> Spread:
        given = [name for name, value in self if value is not None]
        if len(given) != 1:
            raise ValueError(f"give one of uniform, normal and lognormal; got {' and '.join(given) or 'none of them'}")
        return self

    def distribution(self) -> Distribution:
        """Return the distribution."""
        if self.uniform is not None:
            return uniform(*self.uniform)
        if self.normal is not None:
            return normal(*self.normal)
        assert self.lognormal is not None
        return lognormal(*self.lognormal)


def _uncertain(value: Any) -> Any:
    if isinstance(value, dict):
        return Spread(**value)
    if isinstance(value, Spread | str | float | int) and not isinstance(value, bool):
        return value
    raise InputError(f"must be a value, or a table such as {{uniform = [0.3, 0.5]}}; got {value!r}")


Condition = Annotated[float | str | Spread, BeforeValidator(_uncertain)]
"""A value, or its distribution."""

Parameter = Annotated[Literal["published_range"] | Spread, BeforeValidator(_uncertain)]
"""The distribution of a parameter of a law."""


class UncertainPoint(Configuration):
    """An operating point at which some conditions, or parameters of the laws, are distributed.

    Exactly one of `normal_force`, `normal_force_per_width` and `max_pressure` gives the load.
    """

    normal_force: Condition | None = None
    """N, with its unit."""
    normal_force_per_width: Condition | None = None
    """P, with its unit."""
    max_pressure: Condition | None = None
    """p0, with its unit."""
    creepage: Condition
    """ξ, in percent or as a ratio."""
    friction_coefficient: Condition
    """μ, a plain number."""
    traction_coefficient: Condition | None = None
    """Measured T/N, a plain number; for contact models that can use it."""
    laws: dict[str, dict[str, Parameter]] = Field(default_factory=dict)
    """For each wear law, by its name in the results, its parameters that are distributed."""

    @model_validator(mode="after")
    def _possible(self) -> UncertainPoint:
        """Find what is wrong with the conditions when they are read, not when they are used."""
        known, uncertain = split(self.conditions())
        middle: dict[str, Any] = {one.name: one.distribution.first for one in uncertain}
        TwinDisc.suros().problem(**known, **middle)
        return self

    def conditions(self) -> dict[str, Any]:
        """Return the conditions as `uncertainty` takes them."""
        given = {name: getattr(self, name) for name in TWIN_DISC.names}
        return {name: _distribution(value) for name, value in given.items() if value is not None}

    def varies(self, law: str) -> bool:
        """Return whether anything is distributed that a prediction with this law depends on."""
        return bool(split(self.conditions())[1] or self.laws.get(law))

    def parameters(self, law: str) -> dict[str, Distribution | PublishedRange]:
        """Return the parameters of a law that are distributed."""
        return {name: _parameter(value) for name, value in self.laws.get(law, {}).items()}

    def check_laws(self, known: Mapping[str, WearLaw]) -> None:
        """Refuse laws that the case does not have, and parameters that they do not have.

        Raises
        ------
        InputError
            If there are any.
        """
        for law in self.laws:
            if law not in known:
                hint = did_you_mean(law, known)
                raise InputError(f"laws.{law}: the case has no such law{hint} There are: {', '.join(known)}")
            for name, given in self.parameters(law).items():
                try:
                    parameter(name, given, known[law])
                except InputError as error:
                    raise InputError(f"laws.{law}.{error}") from None


def _distribution(value: Any) -> Any:
    return value.distribution() if isinstance(value, Spread) else value


def _parameter(value: Spread | Literal["published_range"]) -> Distribution | PublishedRange:
    return value.distribution() if isinstance(value, Spread) else published_range()
