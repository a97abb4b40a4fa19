"""A rig's problem in the shape of its batch, with the conditions of models."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import ConditionsError


def with_conditions(problem: Problem, arrays: Mapping[str, Array]) -> Problem:
    """Return a rig's problem with conditions of models in the shape of its batch; the rig's own values stay."""
    batch, within = problem.batch_shape, (..., *[None] * len(problem.dims))
    wide = {
        name: array if array.shape == batch else np.broadcast_to(array[within], batch) for name, array in arrays.items()
    }
    return problem.replaced(conditions={**wide, **problem.conditions})


def with_same(part: Problem, problem: Problem, names: Iterable[str]) -> Problem:
    """Return a problem that a rig makes to balance its loads, with conditions that all operating points share.

    Raises
    ------
    ConditionsError
        If a condition differs between the points, and the rig does not give it to the problem.
    """
    lacking = {name: problem.conditions[name] for name in names if name not in part.conditions}
    for name, array in lacking.items():
        if np.ptp(array) > 0.0:
            raise ConditionsError(f"{name}: must be one value, since the rig balances its loads without it")
        lacking[name] = np.full(part.batch_shape, array.flat[0] if array.ndim else array)
    return part.replaced(conditions={**part.conditions, **lacking}) if lacking else part


def in_batch(problem: Problem) -> Problem:
    """Return a rig's problem with places on profiles in the shape of its batch, and NaN for patches that do not exist.

    Raises
    ------
    ValueError
        If they do not fit the batch.
    """
    batch, dims = problem.batch_shape, problem.dims
    if dims and batch[len(batch) - len(dims) :] != tuple(map(len, dims.values())):
        raise ValueError(f"`dims` must label the last axes of the batch, of shape {batch}; got {problem.dims!r}")
    placed = {}
    for name, body in problem.bodies.items():
        if body.profile_position is not None:
            try:
                position, direction = (
                    np.broadcast_to(np.asarray(value, dtype=np.float64), batch)
                    for value in (body.profile_position, body.profile_direction)
                )
            except ValueError:
                raise ValueError(f"`profile_position` and `profile_direction` of {name} must fit {batch}") from None
            if not (np.abs(direction) == 1.0).all():
                raise ValueError(f"`profile_direction` of {name} must be 1 or -1")
            placed[name] = dataclasses.replace(body, profile_position=position, profile_direction=direction)
    if placed:
        problem = problem.replaced(bodies={**problem.bodies, **placed})
    return problem if problem.exists is None else masked(problem)


def axes(problem: Problem) -> tuple[object, ...]:
    """Return what loads that balance leave as it is: the shape of the patches, the batch and the rig's own axes."""
    return problem.geometry, problem.batch_shape, problem.dims


def masked(problem: Problem) -> Problem:
    """Return the problem with NaN for patches that do not exist."""
    exists = np.asarray(problem.exists)
    if exists.dtype != np.bool_ or exists.shape != problem.batch_shape:
        raise ValueError(f"`exists` must be an array of bool of the shape of the batch, {problem.batch_shape}")
    of_strips = exists[..., None]
    masked = problem.mapped(  # texts of a rig, such as why there is no patch, stay
        lambda array: np.where(exists, array, np.nan) if array.dtype.kind == "f" else array,
        lambda array: np.where(of_strips, array, np.nan),
    )
    return masked.replaced(exists=exists, unloaded=problem.unloaded)
