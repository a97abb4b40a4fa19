"""Sweeps: a prediction at very many operating points, block by block."""

from __future__ import annotations

import os
import pickle
import warnings
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wearlaw.errors import InputError, ResumeWarning, WorkerWarning
from wearlaw.pipeline.composition import warn_of_geometry
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.settings.configuration import parts
from wearlaw.sweeping.cluster import on_cluster
from wearlaw.sweeping.evaluation import Job, output_units, range_warnings
from wearlaw.sweeping.points import Block, Points, outer_product
from wearlaw.sweeping.processes import Done, in_processes
from wearlaw.sweeping.progress import Bar
from wearlaw.sweeping.store import Store, finished
from wearlaw.sweeping.tables import from_table
from wearlaw.sweeping.targets import Memory, Target, damage
from wearlaw.sweeping.worker import evaluated
from wearlaw.units.quantities import shortened

if TYPE_CHECKING:
    import pandas
    import xarray


def sweep(
    predict: Pipeline[...],
    /,
    table: pandas.DataFrame | xarray.Dataset | None = None,
    *,
    outputs: Sequence[str] = ("wear_rate",),
    workers: int = 1,
    client: Any = None,
    store: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: bool = False,
    **conditions: Any,
) -> xarray.Dataset:
    """Return predictions at all combinations of the conditions that are arrays, or at the rows of a table.

    Parameters
    ----------
    predict : Pipeline
        A rig, a contact model and a wear law; without a law, other `outputs` than the wear are possible.
    table : pandas.DataFrame or xarray.Dataset, optional
        Operating points row by row, a condition a column, with units by type (pint), `attrs["units"]` or heads such as
        "creepage [%]"; the conditions that are given besides are the same in all rows.
    outputs : sequence of str
        What is kept: names of properties of a prediction, such as "wear_rate" or "tangential_force".
    workers : int
        How many processes of this machine take part; they are kept for later sweeps.
    client : distributed.Client, optional
        A cluster of dask.distributed, in place of `workers`.
    store : path, optional
        A folder for the results, in zarr format, where they are written block by block. An interrupted sweep leaves
        there what is done. Without it the results are in memory.
    resume : bool
        Whether to go on with the sweep that `store` holds a part of, if it does. Blocks that are damaged there are
        computed again, with a `ResumeWarning`.
    progress : bool
        Whether to show a progress bar with rate and time left.
    **conditions
        Those of a prediction; each array is an axis, with one value for each of its coordinates.

    Returns
    -------
    xarray.Dataset
        The outputs along the conditions, which are its coordinates; units are in `attrs["units"]`. With `store`
        values are read from there when they are used.

    Raises
    ------
    InputError
        If conditions or outputs are not possible, or the results would not fit into memory or on the disk.
    OutputError
        If `store` holds anything else than an unfinished part of the same sweep.
    SweepError
        If workers die again and again.
    """
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise InputError(f"workers: must be the number of processes, at least 1; got {workers!r}")
    if not isinstance(store, str | os.PathLike | None):
        raise InputError(f'store: must be the path of a folder, such as "map.zarr"; got {shortened(store)}')
    points = outer_product(conditions) if table is None else from_table(table, conditions)
    _check_conditions(predict, points, {name: None for name, value in conditions.items() if value is None})
    job = _checked_job(predict, points, outputs, workers > 1 or client is not None)
    if store is None:
        if resume:
            raise InputError("resume: needs the store that an interrupted sweep has left; give store=...")
        target: Memory | Store = Memory(job, points)
    else:
        path = Path(store)
        there = finished(job, points, path, resume)
        if there is not None:
            return there
        target = Store(job, points, path, resume)
        if target.damaged:
            warnings.warn(damage(target.damaged, target.listed, path), ResumeWarning, stacklevel=2)
    with closing(target), Bar(points.size, progress) as bar:
        found = run(target, bar, workers, client)
        for warning in found:
            warnings.warn(warning, stacklevel=2)
        return target.finish([str(warning) for warning in found])


def _checked_job(pipeline: Pipeline[...], points: Points, outputs: Sequence[str], elsewhere: bool) -> Job:
    """Return what is done at every point, once the outputs are found to be possible.

    Raises
    ------
    InputError
        If they are not, or if other processes could not find a model.
    """
    names = list(outputs) if isinstance(outputs, Iterable) and not isinstance(outputs, str) else []
    if not names or not all(isinstance(name, str) for name in names):
        raise InputError(f'outputs: must be a list of names, such as ["wear_rate"], got {outputs!r}')
    if elsewhere:
        check_importable(pipeline)
    return Job(pipeline, output_units(pipeline, points, list(dict.fromkeys(names))))


def check_importable(pipeline: Pipeline[...]) -> None:
    """Refuse models that other processes could not find.

    Raises
    ------
    InputError
        If a model is defined in the script that runs.
    """
    for part in parts(pipeline):
        if type(part).__module__ == "__main__":
            raise InputError(
                f"{part.subject()}: is defined in the script or notebook that runs, where other processes do not find"
                " it; define it in a module and import it from there, or use one process"
            )


def _check_conditions(pipeline: Pipeline[...], points: Points, not_given: Mapping[str, None]) -> None:
    """Find invalid conditions before anything is evaluated: along each dimension, at the first values of the others."""
    for dim in points.dims:
        line = points.part(slice(None) if other == dim else slice(0, 1) for other in points.dims)
        problem = pipeline.rig.checked_problem({**not_given, **line.conditions()})
        for law in pipeline.laws if dim == points.dims[0] else ():
            warn_of_geometry(pipeline.rig, pipeline.contact_model, pipeline.scale, law, problem, stacklevel=4)


def run(target: Target, on_block: Callable[[int], None], workers: int = 1, client: Any = None) -> list[Warning]:
    """Evaluate the remaining blocks, and return the warnings that belong to the results.

    Parameters
    ----------
    target : Target
        Where the results go. An interrupt leaves there what is done.
    on_block : callable
        Called with the number of points done, for each block; first of all for those that were done before.
    workers, client
        As in `sweep`.
    """
    left = [block for block in target.points.blocks() if block.number not in target.done]
    on_block(sum(seen.points for seen in target.done.values()))
    several = client is not None or workers > 1
    with closing(_elsewhere(target, left, workers, client) if several else _here(target, left, on_block)) as every:
        for block, seen, deaths in every:
            target.add(block.number, seen)
            for death in deaths:
                warnings.warn(death, WorkerWarning, stacklevel=3)
            if several:
                on_block(seen.points)
    return range_warnings(target.job.pipeline, target.done.values())


def _elsewhere(target: Target, blocks: list[Block], workers: int, client: Any) -> Generator[Done, None, None]:
    """Evaluate blocks in other processes."""
    job = pickle.dumps(target.job)
    if client is None:
        return in_processes(workers, job, target.store, target.points, blocks, target.places)
    return on_cluster(client, job, target.store, target.points, blocks, target.places)


def _here(target: Target, blocks: list[Block], on_block: Callable[[int], None]) -> Generator[Done, None, None]:
    """Evaluate blocks in this process, with progress also within a block."""
    for block in blocks:
        part = target.points.part(block.slices)
        outputs, seen = evaluated(target.job, block, part, target.store, on_block)
        for place, values in zip(target.places(block), outputs.values(), strict=True):
            place[:] = values
        yield block, seen, []
