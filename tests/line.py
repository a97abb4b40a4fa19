"""A line contact by positions x, as the literature writes it."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array


def slip_zone(model: wl.ContactModel, problem: wl.LineProblem) -> tuple[Array, Array]:
    """Return where the slip zone begins and ends."""
    assert isinstance(model, wl.LineContactModel)
    return problem.half_width - model.slip_length(problem), problem.half_width


def fields_at(model: wl.ContactModel, problem: wl.LineProblem, x: Array) -> wl.LineFields:
    """Return the fields at positions x of shape (batch, points)."""
    assert isinstance(model, wl.LineContactModel)
    return model.fields(problem[..., None], wl.Nodes.at(np.asarray(x), np.asarray(problem.half_width)))
