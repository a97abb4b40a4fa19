"""A line contact by positions x, as the literature writes it."""

from __future__ import annotations

from typing import Literal

import numpy as np

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Array


def slip_zone(model: wl.ContactModel, problem: wl.Problem) -> tuple[Array, Array]:
    """Return where the slip zone begins and ends."""
    assert isinstance(model, wl.LineContactModel)
    return problem.half_width - model.slip_length(problem), problem.half_width


def fields_at(model: wl.ContactModel, problem: wl.Problem, x: Array) -> wl.LineFields:
    """Return the fields at positions x of shape (batch, points)."""
    assert isinstance(model, wl.LineContactModel)
    return model.fields(problem[..., None], wl.Nodes.at(np.asarray(x), np.asarray(problem.half_width)))


def crossings_meet(model: wl.LineContactModel, problem: wl.Problem) -> None:
    """Hold that slip and pressure cross the values that they have in the slip zone where they have them."""
    problem = problem.broadcast_to((12,))
    a, start = problem.half_width, slip_zone(model, problem)[0]
    x = start + (a - start) * np.linspace(0.05, 0.9, 12)
    known = fields_at(model, problem, x[:, None])
    names: list[Literal["slip", "pressure"]] = ["slip", "pressure"]
    for name in names:
        found = model.crossings(problem, name, getattr(known, name)[:, 0])
        assert found is not None
        # Some eight roundings of the value are as much of a over how fast it changes: at the least the creepage is
        # 14 times the slope of the bound or μa/R, and the pressure changes by 1/25 next to the middle.
        off = np.abs(a[:, None] - found - x[:, None]).min(axis=-1)
        assert (off <= 8 * 25 * EPS * a).all(), name
    assert model.crossings(problem, "traction", known.traction[:, 0]) is None


def uniform_cells(half_width: Array, cells: int) -> wl.Nodes:
    """Return the centres and lengths of equal cells over the whole patch."""
    width = half_width[..., None]
    centres = (2.0 * np.arange(cells) + 1.0) / cells
    length = np.broadcast_to(2.0 * width / cells, (*half_width.shape, cells))
    return wl.Nodes(width * centres, width * centres[::-1], length)
