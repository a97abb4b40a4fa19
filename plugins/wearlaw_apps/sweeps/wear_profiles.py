"""Wear across the profile of a body at many operating points, or its sum over service."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import xarray

from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw_apps.sweeps.evaluation import Job
from wearlaw_apps.sweeps.points import Points
from wearlaw_apps.sweeps.sweep import Reading, Running, checked_job, computed
from wearlaw_apps.sweeps.wear_profile import SHARE, ProfileJob

if TYPE_CHECKING:
    import pandas

    from wearlaw.units.quantities import QuantityLike


def wear_profiles(
    predict: Pipeline[...],
    table: pandas.DataFrame | xarray.Dataset | str | os.PathLike[str] | None = None,
    /,
    *,
    at: QuantityLike,
    body: str = "wheel",
    share: str | None = None,
    outputs: Sequence[str] = (),
    columns: Mapping[str, str] | None = None,
    keep: Mapping[str, str] | None = None,
    sep: str | None = None,
    decimal: str = ".",
    workers: int = 1,
    client: Any = None,
    store: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: bool = False,
    **conditions: Any,
) -> xarray.Dataset:
    """Return the wear across the profile of a body at all operating points of a sweep, or its sum over service.

    Parameters
    ----------
    predict : Pipeline
        A rig whose body has a profile, such as a `Wheelset`, a contact model that resolves the patch, and a wear law.
    table, columns, keep, sep, decimal, workers, client, store, resume, progress, **conditions
        As in `sweep`.
    at : Quantity or str
        Positions along the profile of the body [mm], shape (positions,).
    body : str
        The body that wears.
    share : str, optional
        The column of the table with the share of each row, as in `wear_out`. The results are then the weighted sums
        over all rows, with the mass, at constant memory for a file of any length. A store keeps the sum of each block.
    outputs : sequence of str
        Further outputs, as in `sweep`; none beside `share`.

    Returns
    -------
    xarray.Dataset
        `depth` and `sliding_distance` with the axis `profile_position`, and `mass` of a sum: per distance rolled for a
        body that turns, per passage of a wheel for a rail.

    Raises
    ------
    DataError
        If the table is wrong, or a row of a sum has no balance of loads.
    InputError
        If the body, the positions or the shares are wrong; else as `sweep`.
    """
    summed = share is not None
    if share is not None:
        if table is None or outputs:
            raise InputError("share: needs a table and no further outputs; the sum has the mass")
        keep = {**(keep or {}), SHARE: share}

    def job_of(first: Problem, points: Points) -> tuple[Job, list[str]]:
        beside = checked_job(predict, first, points, outputs)[0].units if outputs else {}
        return ProfileJob.of(predict, first, body, at, summed, beside), []

    return computed(
        job_of,
        *(predict, table, conditions),
        reading=Reading(columns, keep, sep, decimal, summed),
        running=Running(workers, client, store, resume, progress),
    )
