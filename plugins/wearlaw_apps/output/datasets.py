"""Labelled datasets and tables of a prediction, and the fields along the patch of a line."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import Nodes
from wearlaw.errors import InputError, shown
from wearlaw.late import needed_for
from wearlaw.models.contact_model import LineContactModel
from wearlaw.models.law import Law, named_outcomes
from wearlaw.numerics.solving import Solver
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.selection import axis_names
from wearlaw.pipeline.solution import Solution
from wearlaw.pipeline.variables import default_variables
from wearlaw.units.quantities import in_unit
from wearlaw.units.registry import magnitude
from wearlaw.units.variables import UNITS, name_of
from wearlaw_apps.output.conditions import Conditions, Known
from wearlaw_apps.output.labels import long_name, unit_of

if TYPE_CHECKING:
    import pandas
    import xarray

POINT = "point"
"""Name of the rows of a table."""

PROFILE_CELLS = 200
"""Points of a profile along the patch, in the middles of equal cells."""

Columns: TypeAlias = Mapping[str, tuple[Array, str]]
"""Arrays in SI and the units to show them in, by name."""


def names_in(names: Iterable[str], argument: str) -> list[str]:
    """Return an argument that is a list of names, each once, or raise an `InputError` for a single name."""
    if isinstance(names, str):
        raise InputError(f"{argument}: must be a list of names, such as [{shown(names)}], got {shown(names)}")
    return list(dict.fromkeys(names))


def to_dataset(prediction: Prediction, solution: Solution, names: Sequence[str] | None) -> xarray.Dataset:
    """Return a prediction as a dataset; see `Prediction.to_dataset`."""
    return dataset(prediction, Conditions.of(solution), names)


def dataset(prediction: Prediction, conditions: Conditions, names: Sequence[str] | None) -> xarray.Dataset:
    """Return a prediction as a dataset with its conditions as coordinates."""
    problem = prediction.problem
    every = axis_names(problem)
    count = len(every) - len(problem.dims)
    chosen = default_variables(prediction, conditions.numbers) if names is None else names_in(names, "names")
    dims = [*conditions.axes(every[:count], {*problem.dims, *chosen}), *every[count:]]
    coordinates = {
        name: _coordinate(name, condition, dims[:count])
        for name, condition in conditions.numbers.items()
        if name not in problem.dims and name not in chosen
    }
    variables = {}
    for name in chosen:
        value = prediction[name]
        unit = unit_of(name, value, prediction.laws)
        attributes = {"units": unit, "long_name": long_name(name, prediction.laws)}
        variables[name] = (dims, np.asarray(magnitude(value, unit)), attributes)
    return labelled(problem, coordinates, variables).assign_attrs(conditions.others)


def _coordinate(name: str, condition: Known, dims: Sequence[str]) -> tuple[list[str], Array, dict[str, str]]:
    kept = [axis for axis, size in enumerate(condition.values.shape) if size > 1]
    values = condition.values.reshape([condition.values.shape[axis] for axis in kept])
    return [dims[axis] for axis in kept], values, {"units": condition.unit or "", "long_name": name_of(name)}


def table(prediction: Prediction, solution: Solution, names: Sequence[str] | None) -> pandas.DataFrame:
    """Return a prediction as a table; see `Prediction.to_dataframe`."""
    conditions = Conditions.of(solution)
    data = dataset(prediction, conditions, names)
    problem = prediction.problem
    rows = _rows(data, [*conditions.numbers, *problem.dims, *data.data_vars])
    return rows if problem.resolved is None else rows[problem.resolved.reshape(-1)].reset_index(drop=True)


def to_dataframe(data: xarray.Dataset, /) -> pandas.DataFrame:
    """Return a dataset of wearlaw, such as the results of a sweep, as a table with units in its heads.

    Parameters
    ----------
    data : xarray.Dataset
        The units are in `attrs["units"]` of its variables.

    Returns
    -------
    pandas.DataFrame
        A row for each combination of the dimensions, and a column for each coordinate and variable. The heads are such
        as "wear_rate [ug/m/mm^2]"; `wearlaw.sweep` and `wearlaw.read_tests` read them.
    """
    return _rows(data, [*data.coords, *data.data_vars])


def _rows(data: xarray.Dataset, order: Iterable[Hashable]) -> pandas.DataFrame:
    """Return a row for each combination of the dimensions of a dataset, with columns in an order."""
    dims = max((variable.dims for variable in data.data_vars.values()), key=len, default=())
    rows = (
        data.to_dataframe(dim_order=dims if set(dims) == set(data.sizes) else None)
        if data.sizes
        else data.expand_dims(POINT).to_dataframe()
    )
    names = [str(name) for name in dict.fromkeys(order) if name in data.variables]
    units = {name: data[name].attrs.get("units") for name in names}
    heads = {name: f"{name} [{unit}]" for name, unit in units.items() if unit}
    return rows.reset_index()[names].rename(columns=heads)


def profile(solution: Solution) -> xarray.Dataset:
    """Return the fields and the outcomes of laws along the patches of lines; see `Prediction.profile`."""
    problem = solution.problem
    columns = fields(_cells(solution), solution.laws, ("x", "pressure", "traction", "traction_bound", "slip"))
    if problem.exists is not None:
        columns = {name: (problem.unflatten(values), unit) for name, (values, unit) in columns.items()}
    batch = axis_names(problem)
    data = data_of([*batch, "cell"] if batch else ["x"], columns)
    return labelled(problem, {"x": data.pop("x")}, data)


def fields(contact: Contact, laws: Sequence[Law], names: Iterable[str]) -> dict[str, tuple[Array, str]]:
    """Return fields of a contact, and the outcomes that laws have at each of its cells, with their units."""
    local = {name: laws[index] for name, index in named_outcomes(laws).items() if laws[index].outcome.of == "area mean"}
    rates = {name: (law.checked_rate(contact), law.outcome.unit) for name, law in local.items()}
    return {name: (getattr(contact, name), UNITS[name]) for name in names} | rates


def _cells(solution: Solution) -> Contact:
    """Return the contact of the existing patches, at equal distances if the model can give them."""
    model, problem = solution.model, solution.problem
    problem.needs("line", "profile")
    if problem.size == 0:
        raise InputError("profile: none of these patches exists; select others")
    if model.scale == "cells" and isinstance(model, LineContactModel):
        there = problem.existing()
        share = (2.0 * np.arange(PROFILE_CELLS) + 1.0) / PROFILE_CELLS - 1.0
        nodes = Nodes.at(share * there.half_width[..., None], there.half_width)
        return Solver(model).at(there, nodes, totals=False)
    return solution.contact if problem.exists is None else solution.contact[problem.exists]


def data_of(dims: Sequence[str], columns: Columns, per: str = "") -> dict[str, Any]:
    """Return the variables of a dataset; `per` is what their values are per, such as "metre rolled"."""
    return {
        name: (
            dims,
            in_unit(values, unit),
            {"units": unit, "long_name": f"{name.replace('_', ' ')} per {per}" if per else name_of(name)},
        )
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
