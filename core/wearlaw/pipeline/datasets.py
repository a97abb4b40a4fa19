"""The conditions of a prediction, and labelled datasets and tables of its values."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.conditions import Known
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError, shown
from wearlaw.extras import needed_for
from wearlaw.pipeline.selection import Selection, axis_names
from wearlaw.pipeline.variables import Predicted, default_variables, long_name, unit_of
from wearlaw.units.quantities import in_unit
from wearlaw.units.variables import name_of

if TYPE_CHECKING:
    import pandas
    import xarray

POINT = "point"
"""Name of the rows of a table."""


Columns: TypeAlias = Mapping[str, tuple[Array, str]]
"""Arrays in SI and the units to show them in, by name."""


class Conditions:
    """The conditions of a prediction as its user gave them, laid along the axes of its operating points.

    Parameters
    ----------
    given : mapping of str to object
        The conditions.
    shape : tuple of int
        The shape of the operating points.

    Attributes
    ----------
    numbers : dict of str to Known
        The numbers, with an axis for each axis of the operating points, of its full length or 1.
    others : dict of str to str
        Text of the others, such as a law of friction.
    """

    def __init__(self, given: Mapping[str, Any], shape: tuple[int, ...]) -> None:
        self.numbers: dict[str, Known] = {}
        self.others: dict[str, str] = {}
        for name, value in given.items():
            known = None if value is None else Known.of(value)
            if known is not None and _fits(np.shape(known.values), shape):
                values = np.asarray(known.values)
                self.numbers[name] = Known(values.reshape((1,) * (len(shape) - values.ndim) + values.shape), known.unit)
            elif value is not None:
                self.others[name] = str(value)

    def chosen(self, selection: Selection) -> Conditions:
        """Return the conditions of some of the operating points."""
        found = Conditions({}, ())
        found.others = self.others
        found.numbers = {
            name: Known(selection.of_conditions(one.values), one.unit) for name, one in self.numbers.items()
        }
        return found

    def text(self, without: Collection[str] = ()) -> str:
        """Return the conditions in words, those with several values as their range."""
        found = []
        for name, one in self.numbers.items():
            if name not in without and one.values.size:
                ends = dict.fromkeys(f"{end:.4g}" for end in (one.values.min(), one.values.max()))
                found.append(f"{name_of(name)} {' to '.join(ends)} {one.unit or ''}".rstrip())
        found += [f"{name_of(name)} {text}" for name, text in self.others.items() if name not in without]
        return ", ".join(found)

    def varying(self, axis: int) -> list[str]:
        """Return the names of the conditions that vary along an axis."""
        return [name for name, one in self.numbers.items() if one.values.shape[axis] > 1]

    def axes(self, names: Sequence[str], taken: Collection[str]) -> list[str]:
        """Return names for the axes of the operating points.

        An axis along which a single condition varies, and along no other, has its name; the others keep theirs.
        """
        found = list(names)
        for axis in range(len(names)):
            alone = self.varying(axis)
            if len(alone) == 1 and alone[0] not in taken:
                (name,) = alone
                if self.numbers[name].values.size == self.numbers[name].values.shape[axis]:
                    found[axis] = name
        return found


def names_in(names: Iterable[str], argument: str) -> list[str]:
    """Return an argument that is a list of names, each once, or raise an `InputError` for a single name."""
    if isinstance(names, str):
        raise InputError(f"{argument}: must be a list of names, such as [{shown(names)}], got {shown(names)}")
    return list(dict.fromkeys(names))


def _fits(shape: tuple[int, ...], whole: tuple[int, ...]) -> bool:
    """Return whether an array broadcasts to a shape without changing it."""
    try:
        return np.broadcast_shapes(shape, whole) == whole
    except ValueError:
        return False


def dataset(prediction: Predicted, conditions: Conditions, names: Sequence[str] | None) -> xarray.Dataset:
    """Return a prediction as a dataset with its conditions as coordinates; see `Prediction.to_dataset`."""
    problem = prediction.problem
    every = axis_names(problem)
    count = len(every) - len(problem.dims)
    chosen = default_variables(prediction, conditions.numbers) if names is None else names_in(names, "names")
    dims = [*conditions.axes(every[:count], {*problem.dims, *chosen}), *every[count:]]
    coordinates = {
        name: _coordinate(name, one, dims[:count])
        for name, one in conditions.numbers.items()
        if name not in problem.dims and name not in chosen
    }
    variables = {}
    for name in chosen:
        value = prediction[name]
        unit = unit_of(name, value, prediction.laws)
        attributes = {"units": unit, "long_name": long_name(name, prediction.laws)}
        variables[name] = (dims, np.asarray(value.to(unit).magnitude), attributes)
    return labelled(problem, coordinates, variables).assign_attrs(conditions.others)


def _coordinate(name: str, one: Known, dims: Sequence[str]) -> tuple[list[str], Array, dict[str, str]]:
    kept = [axis for axis, size in enumerate(one.values.shape) if size > 1]
    values = one.values.reshape([one.values.shape[axis] for axis in kept])
    return [dims[axis] for axis in kept], values, {"units": one.unit or "", "long_name": name_of(name)}


def frame(prediction: Predicted, conditions: Conditions, names: Sequence[str] | None) -> pandas.DataFrame:
    """Return a prediction as a table; see `Prediction.to_dataframe`."""
    found = dataset(prediction, conditions, names)
    units = {str(name): one.attrs.get("units", "") for name, one in found.variables.items()}
    problem = prediction.problem
    (dims, *_) = (list(one.dims) for one in found.data_vars.values())
    rows = found.to_dataframe(dim_order=dims) if dims else found.expand_dims(POINT).to_dataframe()
    if problem.exists is not None:
        rows = rows[problem.exists.reshape(-1)]
    order = [*conditions.numbers, *problem.dims, *found.data_vars]
    columns = [name for name in dict.fromkeys(order) if name in found.variables]
    table = rows.reset_index()[columns]
    return table.rename(columns={name: f"{name} [{unit}]" for name, unit in units.items() if unit})


def along_patch(problem: Problem, columns: Columns) -> xarray.Dataset:
    """Return columns over x along the patches of lines; the existing patches come first to last, (patches, nodes)."""
    batch = axis_names(problem)
    shaped = {
        name: (values if problem.exists is None else problem.unflatten(values), unit)
        for name, (values, unit) in columns.items()
    }
    data = data_of([*batch, "cell"] if batch else ["x"], shaped)
    return labelled(problem, {"x": data.pop("x")}, data)


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
