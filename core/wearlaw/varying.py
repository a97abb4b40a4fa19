"""Wear rates where the parameters of a law differ from operating point to operating point, as in fits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from wearlaw.arrays import Array
from wearlaw.blocks import blocks
from wearlaw.integrate import (
    BLOCK,
    NODE_BLOCK,
    check_finite,
    closed_form,
    integrate_wear,
    over_panels,
    solve,
    splits_of,
)
from wearlaw.line import LineProblem
from wearlaw.line_model import LineContactModel
from wearlaw.models import ContactModel, Scale, WearLaw
from wearlaw.parameters import changed, number_like, numbers, per_point


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
    if not law.varies:
        return _one_law_at_a_time(model, law, values, problem, scale)
    rate = np.empty(problem.creepage.shape)
    for part in blocks(rate.size, NODE_BLOCK if law.ramps is None else BLOCK):
        varied = per_point(law, {name: value[part] for name, value in values.items()})
        rate[part] = _varying_block(model, varied, problem[part], scale)
    check_finite(model, {"wear_rate": rate}, problem)
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


def _varying_block(model: ContactModel, law: WearLaw, problem: LineProblem, scale: Scale) -> Array:
    if scale == "patch" or not isinstance(model, LineContactModel):
        contact = solve(model, problem, scale)
        return contact.mean(law.checked_rate(contact))
    found = None if law.ramps is None else closed_form(model, law.ramps, problem)
    if found is not None:
        return found["wear_rate"]
    rate, _ = over_panels(model, law, problem, splits_of(model, law, problem))
    return rate
