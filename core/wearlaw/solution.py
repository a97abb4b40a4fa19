"""What every solved contact has, on a line or an ellipse: quantities with units, and itself as text."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import numpy as np

from wearlaw.arrays import Array
from wearlaw.ellipse import EllipticProblem
from wearlaw.integrate import SlipTotals
from wearlaw.line import LineProblem
from wearlaw.units import Quantity, from_si

if TYPE_CHECKING:
    from wearlaw.pipeline import Pipeline

P = TypeVar("P", LineProblem, EllipticProblem)
W = TypeVar("W")


class Solution(ABC, Generic[P, W]):
    """The contact at one or many operating points, which shows itself by some of its properties."""

    _summary: ClassVar[tuple[str, ...]]
    pipeline: Pipeline[..., Any]
    problem: P
    _given_wear: W | None

    @cached_property
    def _wear(self) -> W:
        """The outcome of the wear law, or a `CompositionError` where there is none."""
        self.pipeline.wear_law  # noqa: B018  raises where there is none
        assert self._given_wear is not None
        return self._given_wear

    @cached_property
    @abstractmethod
    def _force(self) -> Array:
        """Return the tangential force [N], on an ellipse its magnitude."""

    @cached_property
    @abstractmethod
    def _wear_index(self) -> Array:
        """Return Tγ [N]."""

    @cached_property
    @abstractmethod
    def _slip(self) -> SlipTotals:
        """Return how the patch slips."""

    @cached_property
    def _patch_area(self) -> Array:
        """Return the area of the patch, the sum of its nodes' areas [m²]."""
        return self._slip.patch_area

    @property
    def traction_coefficient(self) -> Quantity:
        """Tangential over normal force, T/N [-]."""
        return from_si(self._force / self.problem.normal_force, "")

    @property
    def wear_index_density(self) -> Quantity:
        """Wear index over the area of the patch, Tγ/A [N/m²]."""
        return from_si(self._wear_index / self._patch_area, "N/mm^2")

    @property
    def friction_coefficient(self) -> Quantity:
        """Friction coefficient, μ [-]."""
        return from_si(self.problem.friction_coefficient, "")

    @property
    def max_pressure(self) -> Quantity:
        """Hertz's maximum pressure, p0 [Pa]."""
        return from_si(self.problem.max_pressure, "MPa")

    @property
    def patch_area(self) -> Quantity:
        """Area of the patch, A [m²], the sum of its nodes' areas: of Hertz's patches 2a × track width, or πab."""
        return from_si(self._patch_area, "mm^2")

    @property
    def stick_ratio(self) -> Quantity:
        """Share of the patch that sticks [-]."""
        return from_si(1.0 - self._slip.slip_area / self._slip.patch_area, "")

    @property
    def mean_slip(self) -> Quantity:
        """Mean magnitude of the relative slip over the whole patch [-]."""
        return from_si(self._slip.mean_slip, "%")

    def __repr__(self) -> str:
        names = ("wear_rate", *self._summary) if self.pipeline.laws else self._summary
        rows = "".join(f"\n  {name:<20} {_brief(getattr(self, name))}" for name in names)
        points = "1 operating point" if self.problem.size == 1 else f"{self.problem.size} operating points"
        return f"{type(self).__name__} of {points}{rows}"


def _brief(quantity: Quantity) -> str:
    """Return a scalar as it is, an array as its range."""
    if np.ndim(quantity.magnitude) == 0:
        return repr(quantity)
    return f"{quantity.min()!r} to {quantity.max()!r}"
