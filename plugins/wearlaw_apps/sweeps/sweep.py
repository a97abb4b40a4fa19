"""Sweeps: predictions at very many operating points, block by block."""

from __future__ import annotations

import dataclasses
import math
import os
import pickle
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray

from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, ConditionsError, InputError, ResumeWarning, shown, warn
from wearlaw.models.law import named_outcomes
from wearlaw.pipeline.composition import check_traction, warn_of_unlike_materials
from wearlaw.pipeline.pipeline import TOUCH_NOWHERE, Pipeline
from wearlaw.pipeline.variables import default_variables
from wearlaw_apps.output.datasets import names_in
from wearlaw_apps.output.labels import unit_of
from wearlaw_apps.output.notes import caught_warnings, warn_by_kind
from wearlaw_apps.sweeps.evaluation import Job, expect_pipeline, range_warnings, unsolved
from wearlaw_apps.sweeps.located import posed
from wearlaw_apps.sweeps.plan import planned
from wearlaw_apps.sweeps.points import BLOCK, Points
from wearlaw_apps.sweeps.progress import Bar
from wearlaw_apps.sweeps.provenance import parts
from wearlaw_apps.sweeps.results import Memory, Target
from wearlaw_apps.sweeps.room import writing_to
from wearlaw_apps.sweeps.tables import operating_points
from wearlaw_apps.sweeps.wear_profile import WEAR_PROFILE, Sum
from wearlaw_apps.sweeps.workers import here, in_processes, on_cluster

if TYPE_CHECKING:
    import pandas

MOST = 2**24
"""Most numbers of a sweep whose outputs are not named; a larger sweep keeps the outcomes of laws alone."""

SAMPLE = 250
"""A rig that makes several patches is checked at this many values along a dimension, or up to twice as many."""


def sweep(
    predict: Pipeline[...],
    /,
    table: pandas.DataFrame | xarray.Dataset | str | os.PathLike[str] | None = None,
    *,
    columns: Mapping[str, str] | None = None,
    keep: Mapping[str, str] | None = None,
    sep: str | None = None,
    decimal: str = ".",
    sheet: str | None = None,
    outputs: Sequence[str] | None = None,
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
        A rig, a contact model, and stages and laws if given.
    table : pandas.DataFrame, xarray.Dataset or path, optional
        Operating points in rows, conditions in columns, with units as in `read_table`. Further conditions are the same
        in all rows. A file is read in pieces. With `store`, one of any length needs no more memory than a short one.
    columns : mapping of str to str, optional
        The column of each condition, as in {"normal_force": "Fz [N]", "longitudinal_creepage": "-creep_x [-]"}. A minus
        changes the sign. The unit in brackets may be left out if the table has it, and the table may lack it if it is
        given. Other columns are not used. Default: columns have the names of conditions. A name in braces, as in
        "W{wheel} N [N]", stands for all wheels (contacts, ...) of a row, which become a dimension of the results.
    keep : mapping of str to str, optional
        Further columns of numbers to keep as coordinates of the results, such as {"time": "Time [s]"}.
    sep, decimal : str, optional
        Of a CSV file: what separates its cells, and its decimal mark, as in `read_table`.
    sheet : str, optional
        The sheet of a spreadsheet by its name. Default: the only one that has cells.
    outputs : sequence of str, optional
        Names of outcomes and properties of a prediction to keep, such as "wear_rate", "rcf_damage" or
        "tangential_force". If laws of one outcome differ by body, the name of the body follows, as in "wear_rate_rail".
        Default: the variables of `Prediction.to_dataset`, as long as they are no more than 2²⁴ numbers (128 MiB), and
        in a larger sweep the outcomes of all laws alone; `attrs["notes"]` then says so.
    workers : int
        Number of processes on this machine; they are kept for later sweeps. A sweep that takes no longer than they need
        to start is evaluated here.
    client : distributed.Client, optional
        A cluster of dask.distributed, instead of `workers`.
    store : path, optional
        A folder for the results in zarr format, written block by block. An interrupted sweep keeps its finished blocks
        there. Default: results in memory.
    resume : bool
        Whether to go on with the sweep in `store`, if there is one. Blocks that are missing or damaged are computed,
        and a `ResumeWarning` says how many were kept.
    progress : bool
        Whether to show a progress bar with rate and time left.
    **conditions
        The conditions of a prediction; each array is an axis.

    Returns
    -------
    xarray.Dataset
        The outputs, with the conditions as coordinates, and with units in `attrs["units"]` and readable names in
        `attrs["long_name"]`. With `store`, values are read from there when used.

    Raises
    ------
    CompositionError
        If a large sweep has no law and no outputs are named.
    DataError
        If the table is wrong; for a file, the message names line and column.
    InputError
        If conditions or outputs are invalid, or the results would not fit into memory or on the disk.
    OutputError
        If `store` holds anything but the same sweep, cannot be written, or another process is writing it.
    SweepError
        If workers die again and again.
    """
    if outputs is not None and WEAR_PROFILE in outputs:
        raise InputError("outputs: wear across a profile is wl.wear_profiles(predict, table, at=..., outputs=[...])")
    return computed(
        lambda first, points: checked_job(predict, first, points, outputs),
        *(predict, table, conditions),
        reading=Reading(columns, keep, sep, decimal, sheet=sheet),
        running=Running(workers, client, store, resume, progress),
    )


class Reading(NamedTuple):
    """How a table is read: the arguments of `sweep` of these names, and whether all its rows are summed."""

    columns: Mapping[str, str] | None
    keep: Mapping[str, str] | None
    sep: str | None
    decimal: str
    summed: bool = False
    sheet: str | None = None


class Running(NamedTuple):
    """Where and how a sweep runs: the arguments of `sweep` of these names."""

    workers: int
    client: Any
    store: str | os.PathLike[str] | None
    resume: bool
    progress: bool


def computed(
    job_of: Callable[[Problem, Points], tuple[Job, list[str]]],
    predict: Pipeline[...],
    table: pandas.DataFrame | xarray.Dataset | str | os.PathLike[str] | None,
    conditions: Mapping[str, Any],
    reading: Reading,
    running: Running,
) -> xarray.Dataset:
    """Return the results of a job at all operating points.

    `job_of` returns the job and remarks on it, after checks with the problem of the first points.
    """
    workers, client, store, resume, progress = running
    expect_pipeline(predict)
    if isinstance(workers, bool) or not isinstance(workers, int) or workers < 1:
        raise InputError(f"workers: must be the number of processes, at least 1; got {shown(workers)}")
    as_csv = {"sep": reading.sep, "decimal": reading.decimal, "sheet": reading.sheet}
    with (
        writing_to(store),
        operating_points(
            predict, table, conditions, reading.columns, reading.keep, as_csv, store, reading.summed
        ) as points,
    ):
        not_given = {name: None for name, value in conditions.items() if value is None}
        first = _checked_conditions(predict, points, not_given)
        check_importable(predict, workers, client)
        job, notes = job_of(first, points)
        if store is None and resume:
            raise InputError("resume: needs the store that an interrupted sweep has left; give store=...")
        folder = None if store is None else Path(store)
        points = dataclasses.replace(points, weight=job.weight(first))
        processes = workers if client is None else max(2, sum(client.nthreads().values()))
        points, several = planned(job, points, processes, store is not None)
        if not several:
            workers, client = 1, None
        target = target_of(job, points, folder, resume)
        blocks = len(target.points.blocks())
        if folder is not None and target.resumed and len(target.done) < blocks:
            warn(kept(len(target.done), blocks, folder), ResumeWarning)
        with closing(target), Bar(points.size, progress) as bar:
            of_results = run(target, bar, workers, client)
            warn_by_kind(of_results)
            return target.finish([*notes, *map(str, of_results)])


def target_of(job: Job, points: Points, store: Path | None, resume: bool) -> Target:
    """Return where the results of a sweep go: to a sum, to memory, or to a store."""
    if job.summed:
        return Sum(job, points, store, resume)
    if store is None:
        return Memory(job, points)
    from wearlaw_apps.sweeps.store import Store  # zarr takes half a second

    return Store(job, points, store, resume)


def kept(count: int, of: int, where: Path) -> str:
    """Return the remark of a sweep that is resumed, with numbers of blocks."""
    return f"{count} of {of} blocks are kept in {shown(where)}; the others are missing or damaged, and are computed"


def checked_job(
    pipeline: Pipeline[...], first: Problem, points: Points, outputs: Sequence[str] | None
) -> tuple[Job, list[str]]:
    """Return the job of a sweep, after checks of its outputs, and remarks on them.

    Raises
    ------
    CompositionError
        If no outputs are given and there is no law.
    InputError
        If there is no such output, or it is a condition.
    """
    point, laws, conditions = first.flatten()[:1], pipeline.laws, {*points.coordinates(), *points.fixed}
    if point.geometry == "line":
        check_traction(pipeline.contact_model, point)
    prediction = unsolved(point, pipeline.staged_model, laws)
    names, notes = [] if outputs is None else names_in(outputs, "outputs"), []
    if outputs is None:
        names = default_variables(prediction, conditions, bool(first.dims))
        size = len(names) * points.size * math.prod(map(len, first.dims.values()))
        if size > MOST:
            names = []
            notes = [f"the sweep is large and keeps only the outcomes of laws: all outputs are {size:.2g} numbers"]
    names = names or list(named_outcomes(laws))
    if not names:
        raise CompositionError(
            f"the pipeline has no wear law; give one, as in rig | {pipeline.contact_model!r} | wl.wear_law('usfd'), or"
            ' name what to keep, as in outputs=["tangential_force"]'
        )
    units = {}
    for name in names:
        if name in conditions:
            raise InputError(f"outputs: {shown(name)} is among the coordinates of the results already")
        try:
            units[name] = unit_of(name, prediction[name], laws)
        except CompositionError as error:
            raise InputError(f"outputs: {error}") from None
    return Job(pipeline, units, first.dims), notes


def check_importable(pipeline: Pipeline[...], workers: int, client: Any = None) -> None:
    """Raise an error if a sweep needs other processes, which could not import a model.

    Raises
    ------
    InputError
        If a model is defined in the running script.
    """
    for part in parts(pipeline) if workers > 1 or client is not None else ():
        if type(part).__module__ == "__main__":
            raise InputError(
                f"{part.subject()}: is defined in the running script or notebook, from which other processes cannot"
                " import it; define it in a module and import it from there, or use one process"
            )


def _checked_conditions(pipeline: Pipeline[...], points: Points, not_given: Mapping[str, None]) -> Problem:
    """Return the problem of some of the first operating points, after checks of the conditions.

    They are checked along each dimension, at the first values of the others. A rig that makes several patches may take
    long, so that it is asked for a sample of the values.
    """

    def along(dim: str, values: slice) -> Problem:
        line = points.part(values if other == dim else slice(0, 1) for other in points.dims)
        with caught_warnings():  # the blocks record them
            return posed(line, lambda arrays: pipeline.rig.checked_problem({**not_given, **arrays}, pipeline.models))

    first = along(points.dims[0], slice(0, SAMPLE))
    slipperiest, there = first, first if first.size or first.unloaded is not None else None
    whole = points.sizes[points.dims[0]] <= SAMPLE
    for dim in points.dims[1 if whole else 0 :]:
        size = points.sizes[dim]
        every = max(size // SAMPLE, 1) if first.dims else 1
        step = size if points.file is None else every * BLOCK  # a table of any length must not need more memory
        for start in range(0, size, step):
            sample = along(dim, slice(start, start + step, every))
            slipperiest = min(slipperiest, sample, key=lambda p: np.nanmin(p.friction_coefficient, initial=np.inf))
            if there is None and sample.size:
                there = sample
    pipeline.warn_of_problem(first)
    warn_of_unlike_materials(pipeline.contact_model, slipperiest)
    if there is None:
        raise ConditionsError(TOUCH_NOWHERE.format(pipeline.rig.name))
    return there


def run(target: Target, on_block: Callable[[int], None], workers: int = 1, client: Any = None) -> list[Warning]:
    """Evaluate the remaining blocks and return the warnings that belong to the results.

    Parameters
    ----------
    target : Target
        Where the results go. It keeps the finished blocks after an interrupt.
    on_block : callable
        Called with the number of points in each finished block, and first with those finished earlier.
    workers, client
        As in `sweep`.
    """
    points = target.points
    left = [block for block in points.blocks() if block.number not in target.done]
    on_block(points.size - sum(block.size for block in left))
    several = client is not None or (workers > 1 and len(left) > 1)
    job = pickle.dumps(target.job) if several else b""
    if client is not None:
        evaluated = on_cluster(client, job, target.store, points, left)
    elif several:
        evaluated = in_processes(workers, job, target.store, points, left)
    else:
        evaluated = here(target.job, target.store, points, left, on_block)
    with closing(evaluated):
        for block, outputs, record in evaluated:
            target.add(block, outputs, record)
            if several:
                on_block(block.size)
    return range_warnings(target.job, (target.done[number] for number in sorted(target.done)))
