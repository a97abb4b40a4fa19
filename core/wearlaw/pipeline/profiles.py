"""Datasets of profiles: along a patch, across it, and over given positions of a body's profile."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import Body, Problem
from wearlaw.errors import InputError, shown
from wearlaw.extras import needed_for
from wearlaw.numerics.blocks import blocks
from wearlaw.numerics.profiles import onto_positions
from wearlaw.pipeline.selection import axis_names
from wearlaw.units.quantities import QuantityLike, in_unit
from wearlaw.units.variables import VARIABLES, name_of

if TYPE_CHECKING:
    import xarray

Columns: TypeAlias = Mapping[str, tuple[Array, str]]
"""Arrays in SI and the units to show them in, by name."""

PATCH = "patch"
"""Name of the axis of patches that lie on one profile."""

POSITION = "profile_position"
"""Name of the position along a profile."""

BLOCK = 2**18
"""Positions in a block of patches."""


def along_patch(problem: Problem, columns: Columns) -> xarray.Dataset:
    """Return columns over x along the patches of lines; the existing patches come first to last, (patches, nodes)."""
    batch = axis_names(problem)
    dims = [*batch, "cell"] if batch else ["x"]
    data = {
        name: (dims, in_unit(values if problem.exists is None else problem.unflatten(values), unit), {"units": unit})
        for name, (values, unit) in columns.items()
    }
    return labelled(problem, {"x": data.pop("x")}, data)


def across_patch(problem: Problem, body: Body, y: Array, columns: Columns, per: str) -> xarray.Dataset:
    """Return columns over the strips of patches, (batch, strips), with their places on the body's profile if known."""
    batch = axis_names(problem)
    dims = [*batch, "strip"] if batch else ["y"]
    places = {"y": y}
    if body.profile_position is not None:
        places[POSITION] = _arc(body, y)
    coordinates = {name: (dims, *_shown(name, values)) for name, values in places.items()}
    return labelled(problem, coordinates, _data(dims, columns, per))


def on_profile(
    problem: Problem, body: Body, y: Array, width: Array, columns: Columns, per: str, at: QuantityLike
) -> xarray.Dataset:
    """Return columns over positions of the body's profile, summed over the axis of patches if there is one.

    Raises
    ------
    InputError
        If the positions do not increase, or the rig does not know where its patches lie on the profile.
    """
    positions = VARIABLES[POSITION].expected.si(at, "at")
    if positions.ndim != 1 or positions.size < 2 or not (np.diff(positions) > 0.0).all():
        raise InputError(
            f"at: must be two or more increasing positions, such as Q(np.linspace(-40, 30, 141), 'mm'); got {shown(at)}"
        )
    if body.profile_position is None:
        raise InputError(
            "at: the rig does not say where its patches lie on the profile; leave it out, or give the bodies of the"
            " problem a `profile_position`"
        )
    names = axis_names(problem)
    rest = {name: size for name, size in zip(names, problem.batch_shape, strict=True) if name != PATCH}
    sums = {name: np.zeros((*rest.values(), positions.size)) for name in columns}
    rows = np.arange(math.prod(rest.values())).reshape(tuple(rest.values()))
    if PATCH in names:
        rows = np.expand_dims(rows, names.index(PATCH))
    there = np.broadcast_to(rows, problem.batch_shape).reshape(-1)
    arc, of_strip = _arc(body, y), [values for values, _ in columns.values()]
    if problem.exists is not None:
        exists = problem.exists
        there, arc, width, *of_strip = there[exists.reshape(-1)], *(one[exists] for one in (arc, width, *of_strip))
    arc, width, *of_strip = (one.reshape(-1, one.shape[-1]) for one in (arc, width, *of_strip))
    for some in blocks(there.size, max(BLOCK // positions.size, 1)):
        index, found = onto_positions(arc[some], width[some], [one[some] for one in of_strip], positions)
        flat = index + positions.size * there[some, None]
        for total, values in zip(sums.values(), found, strict=True):
            np.add.at(total.reshape(-1), flat, values)
    dims = [*rest, POSITION]
    data = _data(dims, {name: (total, columns[name][1]) for name, total in sums.items()}, per)
    return labelled(problem, {POSITION: (POSITION, *_shown(POSITION, positions))}, data, without=PATCH)


def _arc(body: Body, y: Array) -> Array:
    """Return the positions of strips along the profile of the body [m]."""
    arc: Array = np.asarray(body.profile_position)[..., None] + np.asarray(body.profile_direction)[..., None] * y
    return arc


def _shown(name: str, values: Array) -> tuple[Array, dict[str, str]]:
    return in_unit(values, "mm"), {"units": "mm", "long_name": name_of(name)}


def _data(dims: list[str], columns: Columns, per: str) -> dict[str, Any]:
    return {
        name: (dims, in_unit(values, unit), {"units": unit, "long_name": f"{name.replace('_', ' ')} per {per}"})
        for name, (values, unit) in columns.items()
    }


def labelled(
    problem: Problem, coordinates: Mapping[str, Any], variables: Mapping[str, Any], without: str = ""
) -> xarray.Dataset:
    """Return a dataset with the labels of the rig's own axes as coordinates, but for one axis."""
    with needed_for("a dataset", "sweeps"):
        import xarray

    labels = {name: list(labels) for name, labels in problem.dims.items() if name != without}
    return xarray.Dataset(variables, {**labels, **coordinates})
