"""The creepage at which a contact transmits a given tangential force."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import elementwise

from wearlaw.arrays import Array, steady
from wearlaw.contact.conditions import is_friction_law
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, ConditionsError
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.pipeline.pipeline import Rig
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, coefficient, from_si
from wearlaw_sweeps.evaluation import expect_pipeline

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from wearlaw.pipeline.pipeline import Pipeline

SMALLEST = 1e-30
"""Smallest creepage of the search; a smaller one counts as zero."""

TRIED = np.geomspace(1e-5, 1.0, 40, endpoint=False)
"""Creepages at which the search checks whether the traction of an elliptic contact keeps rising."""

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
    """Return the longitudinal creepage at which a contact transmits a traction [-], with the sign of the traction.

    The result is the longitudinal creepage of the problem and has the broadcast shape. `Rig.creepage` names the
    condition that sets it. The rest of the problem stays as the rig makes it with that condition at zero.

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
        If no creepage, or more than one, transmits the traction. None does at full slip and above or, with lateral
        creepage, above the share of friction left for the longitudinal direction. Several can if friction falls with
        the creep speed.
    CompositionError
        If the rig has no condition for the creepage.
    """
    expect_pipeline(predict)
    if (tangential_force is None) == (traction_coefficient is None):
        raise ConditionsError("give either tangential_force or traction_coefficient")
    if is_friction_law(conditions.get("friction_coefficient")):
        raise ConditionsError(
            "friction_coefficient: must be a number here; with friction that falls with the creep speed, two creepages"
            " can transmit the same force"
        )
    problem = _at_rest(predict, conditions)
    if tangential_force is None:
        assert traction_coefficient is not None
        target = coefficient(traction_coefficient, "traction_coefficient", positive=False)
    else:
        target = Unit("N", positive=False).si(tangential_force, "tangential_force") / problem.normal_force
    try:
        shape = np.broadcast_shapes(target.shape, problem.batch_shape)
    except ValueError:
        raise ConditionsError(
            f"the shapes of the traction {target.shape} and of the conditions {problem.batch_shape} do not broadcast"
        ) from None
    flat = problem.broadcast_to(shape).flatten()
    wanted = np.broadcast_to(target, shape).reshape(-1)
    size, sign = np.abs(wanted), np.copysign(1.0, wanted)

    def shortfall(log_creepage: Array, point: Array) -> Array:
        """Return by how much T/N falls short; `find_root` passes the indices of the points as floats."""
        index = point.astype(np.intp)
        at = flat[index].replaced(longitudinal_creepage=sign[index] * np.exp(log_creepage))
        return size[index] - sign[index] * integrate_forces(predict.staged_model, at).longitudinal / at.normal_force

    points = np.arange(size.size, dtype=np.float64)
    start = np.full(size.size, np.log(SMALLEST))
    at_start, short = shortfall(start, points), shortfall(np.zeros(size.size), points)
    tried = np.stack([at_start, short])
    if flat.geometry != "line":
        between = [shortfall(np.full(size.size, np.log(one)), points) for one in TRIED]
        tried = np.stack([at_start, *between, short])
        short = tried.min(axis=0) + ROUNDED * flat.friction_coefficient
    if (short >= 0.0).any():
        first = np.flatnonzero(short >= 0.0)[0]
        reached = size[first] - short[first]
        raise ConditionsError(
            f"no creepage transmits a traction coefficient of {_where(size, first, shape)}: with contact model"
            f" '{predict.contact_model.name}' it stays below {reached:.6g} (full slip); give a smaller one"
        )
    _refuse_several(tried, flat.friction_coefficient, wanted, shape)
    creepage = np.zeros(size.size)
    # With a wanted force of zero, the sum over the nodes may be off by rounding.
    rounded = np.where(size == 0.0, ROUNDED * flat.friction_coefficient, 0.0)
    search = np.flatnonzero(at_start > rounded)
    if search.size:
        root = elementwise.find_root(shortfall, (start[search], np.zeros(search.size)), args=(points[search],))
        creepage[search] = np.exp(root.x)
    return from_si(np.copysign(creepage.reshape(shape), target), "%")


def _at_rest(predict: Pipeline[...], conditions: Mapping[str, Any]) -> Problem:
    """Return the problem at zero longitudinal creepage."""
    rig = predict.rig
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
    return predict.posed({**conditions, rig.creepage: from_si(0.0, "")}, of_one_patch="creepage_for")


def _refuse_several(tried: Array, friction: Array, wanted: Array, shape: tuple[int, ...]) -> None:
    """Raise an error if a contact transmits a traction [-] at several creepages, or exceeds it without creepage.

    Parameters
    ----------
    tried : ndarray, (creepages, points)
        By how much T/N falls short at creepages in ascending order; the first creepage is practically zero.
    friction, wanted : ndarray, (points,)
        μ and the wanted tractions with their signs.
    shape : tuple of int
        The shape of the result.
    """
    exceeded = tried[0] < -ROUNDED * friction
    crossed = np.abs(np.diff((tried > 0.0).astype(int), axis=0)).sum(axis=0) > 1
    for wrong, why in (
        (exceeded, "without longitudinal creepage the contact transmits more already"),
        (crossed, "several creepages do, because the traction falls again as the creepage grows"),
    ):
        if wrong.any():
            first = np.flatnonzero(wrong)[0]
            raise ConditionsError(
                f"no single creepage transmits a traction coefficient of {_where(wanted, first, shape)}: {why}"
            )


def _where(values: Array, first: int, shape: tuple[int, ...]) -> str:
    """Return a value and, if it is one of several, its index."""
    where = f" at index {[int(i) for i in np.unravel_index(first, shape)]}" if shape else ""
    return f"{values[first]:.6g}{where}"
