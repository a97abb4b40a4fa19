"""The creepage at which a contact transmits a given tangential force."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import is_friction_law
from wearlaw.errors import CompositionError, ConditionsError, UnitError
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, from_si, real_array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from wearlaw.pipeline.pipeline import Pipeline

SMALLEST = 1e-30
"""The least creepage that is searched; what is below counts as none."""


def creepage_for(
    predict: Pipeline[...],
    /,
    *,
    tangential_force: QuantityLike | None = None,
    traction_coefficient: ArrayLike | None = None,
    **conditions: Any,
) -> Quantity:
    """Return the creepage at which a contact transmits a traction [-], of its sign and of the broadcast shape.

    Parameters
    ----------
    predict : Pipeline
        A rig and a contact model.
    tangential_force : Quantity or str, optional
        T [N].
    traction_coefficient : array_like of float, optional
        T/N [-], in place of `tangential_force`.
    **conditions
        All conditions of the rig but the creepage: for discs the load and the friction coefficient.

    Raises
    ------
    ConditionsError
        If no creepage, or more than one, transmits so much: at μN and above; or if friction falls with the creep
        speed.
    """
    if (tangential_force is None) == (traction_coefficient is None):
        raise ConditionsError("give either tangential_force or traction_coefficient")
    if is_friction_law(conditions.get("friction_coefficient")):
        raise ConditionsError(
            "friction_coefficient: must be a number here; where friction falls with the creep speed, two creepages can"
            " transmit one force"
        )
    rig = predict.rig
    problem = rig.checked_problem({**conditions, rig.creepage: from_si(0.0, "")})
    if problem.geometry != "line":
        raise CompositionError(f"creepage_for: is for line contacts, which rig '{rig.name}' does not make")
    if tangential_force is None:
        target = _finite(traction_coefficient)
    else:
        target = Unit("N", positive=False).si(tangential_force, "tangential_force") / problem.normal_force
    shape = _broadcast(target.shape, problem.batch_shape)
    flat = problem.broadcast_to(shape).flatten()
    due = np.abs(np.broadcast_to(target, shape).reshape(-1))

    def lacking(log_creepage: Array, point: Array) -> Array:
        """Return by how much T/N falls short, for points as floats, as `find_root` hands them on."""
        index = point.astype(np.intp)
        at = flat[index].replaced(longitudinal_creepage=np.exp(log_creepage))
        return due[index] - integrate_forces(predict.contact_model, at).longitudinal / at.normal_force

    points = np.arange(due.size, dtype=np.float64)
    short = lacking(np.zeros(due.size), points)
    if (short >= 0.0).any():
        raise _beyond_reach(predict, due, due - short, np.flatnonzero(short >= 0.0)[0], shape)
    creepage = np.zeros(due.size)
    start = np.full(due.size, np.log(SMALLEST))
    search = np.flatnonzero(lacking(start, points) > 0.0)
    if search.size:
        from scipy.optimize import elementwise  # half of the time of `import wearlaw`, so only where it is used

        root = elementwise.find_root(lacking, (start[search], np.zeros(search.size)), args=(points[search],))
        creepage[search] = np.exp(root.x)
    return from_si(np.copysign(creepage.reshape(shape), target), "%")


def _broadcast(traction: tuple[int, ...], conditions: tuple[int, ...]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(traction, conditions)
    except ValueError:
        raise ConditionsError(
            f"the shapes of the traction {traction} and of the conditions {conditions} do not broadcast"
        ) from None


def _finite(traction_coefficient: object) -> Array:
    try:
        target = real_array(traction_coefficient)
        if not np.isfinite(target).all():
            raise UnitError("must be finite")
    except UnitError as error:
        raise UnitError(f"traction_coefficient: {error}; give T/N as plain numbers, such as 0.3") from None
    return target


def _beyond_reach(
    predict: Pipeline[...], due: Array, reached: Array, first: int, shape: tuple[int, ...]
) -> ConditionsError:
    where = f" at index {[int(i) for i in np.unravel_index(first, shape)]}" if shape else ""
    return ConditionsError(
        f"a traction coefficient of {due[first]:.6g}{where} belongs to no creepage: with contact model"
        f" '{predict.contact_model.name}' it stays below {reached[first]:.6g}, at full slip; ask for less"
    )
