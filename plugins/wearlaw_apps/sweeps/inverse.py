"""The creepage at which a contact transmits a given tangential force."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import elementwise

from wearlaw.arrays import Array, steady
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, ConditionsError
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.pipeline.pipeline import Rig
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, coefficient, from_si
from wearlaw.units.registry import unit_in_si
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.sweeps.evaluation import expect_pipeline

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from wearlaw.pipeline.pipeline import Pipeline

SMALLEST = 1e-30
"""Smallest creepage of the search; a smaller one counts as zero."""

TRIED = np.array([SMALLEST, *np.geomspace(1e-5, 1.0, 41)])
"""Creepages at which the search computes the traction first, as shares of the largest one."""

ROUNDED = 1e-12
"""Rounding error of a sum over some thousand nodes, as a share of the friction force."""


@steady
def creepage_for(
    predict: Pipeline[...],
    /,
    *,
    tangential_force: QuantityLike | None = None,
    traction_coefficient: ArrayLike | None = None,
    **conditions: Any,
) -> Quantity:
    """Return the smallest creepage at which a contact transmits a traction [-], with the sign of the traction.

    The result has the broadcast shape. It is a value of the rig's longitudinal creepage, the condition that
    `Rig.creepage` names. If friction falls with the creep speed or as the contact heats up, two creepages can transmit
    the same traction; the result is then on the rising branch.

    Parameters
    ----------
    predict : Pipeline
        A rig and a contact model.
    tangential_force : Quantity or str, optional
        The longitudinal force, T [N].
    traction_coefficient : array_like of float, Quantity or str, optional
        T/N [-], in place of `tangential_force`.
    **conditions
        All conditions of the rig except the longitudinal creepage: for discs the load and the friction coefficient, for
        a wheel on a rail also any lateral creepage and spin.

    Raises
    ------
    ConditionsError
        If no creepage transmits the traction, with the greatest traction that there is. At full slip and above none
        does or, with lateral creepage, above the share of friction left for the longitudinal direction. Also if the
        contact transmits more already without longitudinal creepage.
    CompositionError
        If the rig has no condition for the creepage.
    """
    expect_pipeline(predict)
    if (tangential_force is None) == (traction_coefficient is None):
        raise ConditionsError("give either tangential_force or traction_coefficient")
    with caught_warnings():  # the search visits contacts that nobody asked for
        search = _Search(predict, conditions, tangential_force, traction_coefficient)
        creepage = search.creepage()
    search.traction(creepage, np.arange(creepage.size))  # raises the warnings about the result
    return from_si(creepage.reshape(search.shape), "%")


class _Search:
    """The search for the creepage at all operating points at once.

    Attributes
    ----------
    shape : tuple of int
        The shape of the result; all other arrays have one axis for the operating points.
    size, sign : ndarray
        Magnitude and sign of the wanted T/N [-].
    rounded : ndarray
        Rounding error of T/N [-].
    """

    def __init__(
        self,
        predict: Pipeline[...],
        conditions: Mapping[str, Any],
        tangential_force: QuantityLike | None,
        traction_coefficient: ArrayLike | None,
    ) -> None:
        self.predict, self.conditions = predict, conditions
        self.name, self.largest = _condition(predict.rig, conditions)
        problem = self._posed(np.zeros(()))
        if tangential_force is None:
            assert traction_coefficient is not None
            wanted = coefficient(traction_coefficient, "traction_coefficient", positive=False)
        else:
            wanted = Unit("N", positive=False).si(tangential_force, "tangential_force") / problem.normal_force
        try:
            self.shape = np.broadcast_shapes(wanted.shape, problem.batch_shape)
        except ValueError:
            raise ConditionsError(
                f"the shapes of the traction {wanted.shape} and of the conditions {problem.batch_shape} do not"
                " broadcast"
            ) from None
        wanted = np.broadcast_to(wanted, self.shape).reshape(-1)
        self.size, self.sign = np.abs(wanted), np.copysign(1.0, wanted)
        self.rounded = ROUNDED * np.broadcast_to(problem.friction_coefficient, self.shape).reshape(-1)

    def creepage(self) -> Array:
        """Return the smallest creepage [-] that transmits the traction, with its sign, (points,)."""
        points = np.arange(self.size.size, dtype=np.float64)
        tried = np.repeat(np.log(TRIED * self.largest)[:, None], points.size, axis=1)
        short = self._sampled(tried)
        self._move_to_peaks(tried, short)
        reached = short < -self.rounded
        for first in np.flatnonzero(reached[0])[:1]:
            raise ConditionsError(
                f"no creepage transmits a traction coefficient of {self._where(first, self.sign * self.size)}: without"
                " longitudinal creepage the contact transmits more already"
            )
        for first in np.flatnonzero(~reached.any(axis=0))[:1]:
            raise ConditionsError(self._out_of_reach(first, tried[:, first], short[:, first]))
        creepage = np.zeros(points.size)
        # With a wanted force of zero, the sum over the nodes may be off by rounding.
        point = np.flatnonzero(short[0] > np.where(self.size == 0.0, self.rounded, 0.0))
        if point.size:
            after = reached.argmax(axis=0)[point]
            bracket = tried[after - 1, point], tried[after, point]
            creepage[point] = np.exp(elementwise.find_root(self._shortfall, bracket, args=(points[point],)).x)
        return np.copysign(creepage, self.sign)

    def traction(self, creepage: Array, index: NDArray[np.intp]) -> Array:
        """Return T/N [-] of operating points at their creepages [-]."""
        everywhere = np.zeros(self.size.size)
        everywhere[index] = creepage
        at = self._posed(everywhere.reshape(self.shape)).flatten()[index]
        traction: Array = integrate_forces(self.predict.staged_model, at).longitudinal / at.normal_force
        return traction

    def _shortfall(self, log_creepage: Array, point: Array) -> Array:
        """Return by how much T/N falls short; `elementwise` passes the indices of the points as floats."""
        index = point.astype(np.intp)
        creepage = np.minimum(np.exp(log_creepage), self.largest)  # rounding may exceed what the rig allows
        sign = self.sign[index]
        return self.size[index] - sign * self.traction(sign * creepage, index)

    def _sampled(self, tried: Array) -> Array:
        """Return the shortfall at samples (samples, points), or NaN after the first that reaches the traction."""
        short = np.full(tried.shape, np.nan)
        point = np.arange(self.size.size)
        for row, log_creepage in zip(short, tried, strict=True):
            if point.size:
                row[point] = self._shortfall(log_creepage[point], point.astype(np.float64))
                point = point[row[point] >= -self.rounded[point]]
        return short

    def _move_to_peaks(self, tried: Array, short: Array) -> None:
        """Move samples to the peak of the traction beside them where no sample before has the wanted one."""
        for step in range(1, len(TRIED) - 1):
            left, middle, right = short[step - 1 : step + 2]
            before = (short[: step + 1] >= -self.rounded).all(axis=0)
            point = np.flatnonzero(before & (middle < left - self.rounded) & (middle <= right))
            if point.size:
                bracket = tuple(tried[step + k, point] for k in (-1, 0, 1))
                peak = elementwise.find_minimum(self._shortfall, bracket, args=(point.astype(np.float64),))
                tried[step, point], short[step, point] = peak.x, peak.f_x

    def _out_of_reach(self, point: int, tried: Array, short: Array) -> str:
        """Return the message for the traction of a point that no sample reaches (samples,), with the greatest."""
        best = short.argmin()
        greatest = f"{self.size[point] - short[best]:.6g}"
        if short[-1] <= short[best] + self.rounded[point]:
            reached = f"it stays below {greatest} (full slip)"
        else:
            reached = f"the greatest is {greatest}, at a creepage of {100.0 * np.exp(tried[best]):.4g} %"
        return (
            f"no creepage transmits a traction coefficient of {self._where(point, self.size)}: with contact model"
            f" '{self.predict.contact_model.name}' {reached}; give a smaller one"
        )

    def _posed(self, creepage: Array) -> Problem:
        return self.predict.posed({**self.conditions, self.name: from_si(creepage, "")}, of_one_patch="creepage_for")

    def _where(self, point: int, values: Array) -> str:
        """Return the value of a point and, if there are several, its index."""
        where = f" at index {[int(i) for i in np.unravel_index(point, self.shape)]}" if self.shape else ""
        return f"{values[point]:.6g}{where}"


def _condition(rig: Rig, conditions: Mapping[str, Any]) -> tuple[str, float]:
    """Return the name of the condition that sets the creepage, and its largest value [-]."""
    if rig.creepage is None:
        raise CompositionError(
            f"creepage_for: no single condition of rig '{rig.name}' sets the creepage; sweep its conditions instead"
        )
    if rig.creepage in conditions:
        raise ConditionsError(f"{rig.creepage}: creepage_for returns it; leave it out")
    if type(rig).balanced is not Rig.balanced:
        raise CompositionError(
            f"creepage_for: rig '{rig.name}' balances its loads, which depend on the unknown creepage; sweep the"
            " creepage instead"
        )
    condition = rig.conditions().get(rig.creepage)
    unit = None if condition is None else condition.unit
    return rig.creepage, 1.0 if unit is None else min(1.0, unit.limit * unit_in_si(unit.unit))
