"""Wear rates where the parameters of a law differ from operating point to operating point, as in fits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.blocks import blocks
from wearlaw.integrate import BLOCK, NODE_BLOCK, closed_form, integrate_wear, over_slip_zone, seen_by_law
from wearlaw.line import LineProblem
from wearlaw.line_model import LineContactModel
from wearlaw.models import WearLaw
from wearlaw.parameters import changed, number_like, numbers, per_point
from wearlaw.solving import Solver, check_columns
from wearlaw.tangential import Blame, ContactModel, Scale


def integrate_varying(
    model: ContactModel, law: WearLaw, values: Mapping[str, Array], problem: LineProblem, scale: Scale
) -> Array:
    """Return the wear rates [kg/m/m²] of a law whose parameters differ from operating point to operating point.

    Parameters
    ----------
    model, law, scale
        As for `integrate_wear`.
    values : mapping of str to ndarray, (points,)
        The parameters that differ, by the names of `parameters.numbers`, in SI; positive.
    problem : LineProblem
        With a batch of one axis, (points,).

    Raises
    ------
    ModelError
        If the model or the law breaks its contract.
    """
    if not values:
        return integrate_wear(model, law, problem, scale).wear_rate
    if not law.varies:
        return _one_law_at_a_time(model, law, values, problem, scale)
    rate, solver = np.empty(problem.creepage.shape), Solver(model)
    for part in blocks(rate.size, NODE_BLOCK if law.ramps is None else BLOCK):
        within = problem[part]
        with Blame(model):
            found = _block(solver, law, {name: value[part] for name, value in values.items()}, within, scale)
        check_columns(model, {"wear_rate": found}, within)
        rate[part] = found
    return rate


def _one_law_at_a_time(
    model: ContactModel, law: WearLaw, values: Mapping[str, Array], problem: LineProblem, scale: Scale
) -> Array:
    rate = np.empty(problem.creepage.shape)
    rows, which = np.unique(np.stack(list(values.values()), axis=-1), axis=0, return_inverse=True)
    units = numbers(law)
    for number, row in enumerate(rows):
        points = np.flatnonzero(which.ravel() == number)
        one = changed(law, {name: number_like(units[name], float(si)) for name, si in zip(values, row, strict=True)})
        rate[points] = integrate_wear(model, one, problem[points], scale).wear_rate
    return rate


def _block(solver: Solver, law: WearLaw, values: Mapping[str, Array], problem: LineProblem, scale: Scale) -> Array:
    varied, model = per_point(law, values), solver.model
    if scale == "patch" or not isinstance(model, LineContactModel):
        contact = seen_by_law(model, solver.solve(problem), scale)
        return contact.mean(solver.rate(varied, contact, problem))
    found = None if varied.ramps is None else closed_form(model, varied.ramps, problem)
    if found is None:

        def law_at(points: NDArray[np.intp]) -> WearLaw:
            return per_point(law, {name: value[points] for name, value in values.items()})

        found = over_slip_zone(solver, model, varied, problem, law_at)
    return found["wear_rate"]
