"""Wearing profiles over a distance, step by step."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from contextlib import ExitStack, closing
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pandas as pd
import xarray

import wearlaw as wl
from wearlaw.errors import DataError
from wearlaw_apps.life.life import Life, measure_of
from wearlaw_apps.life.line import Line
from wearlaw_apps.life.removal import even, positions
from wearlaw_apps.life.steps import Limits, Steps, with_profiles
from wearlaw_apps.life.turning import cut_of, turned, turns
from wearlaw_apps.sweeps.evaluation import expect_pipeline
from wearlaw_apps.sweeps.points import Points
from wearlaw_apps.sweeps.progress import Bar
from wearlaw_apps.sweeps.tables import operating_points
from wearlaw_apps.sweeps.wear_profile import SHARE

if TYPE_CHECKING:
    from wearlaw_models.rigs.wheelset import Profile

DEEPEST = 1e-4
"""Largest depth of a step [m]: contacts move with the wear."""


def wear_out(
    predict: wl.Pipeline[...],
    line: Any,
    /,
    *,
    over: wl.QuantityLike | float,
    share: str = "share",
    columns: Mapping[str, str] | None = None,
    sep: str | None = None,
    decimal: str = ".",
    depth_step: wl.QuantityLike = "0.05 mm",
    smoothing: wl.QuantityLike = "3 mm",
    resolution: wl.QuantityLike = "0.4 mm",
    spacing: wl.QuantityLike = "0.1 mm",
    until: Mapping[str, wl.QuantityLike | float] | None = None,
    until_all: bool = False,
    turn: Mapping[str, wl.QuantityLike | float] | None = None,
    least_diameter: wl.QuantityLike | None = None,
    body: str = "wheel",
    passages_per_km: float | None = None,
    sides: Literal["mean", "each"] = "mean",
    conicity_step: float = 0.005,
    workers: int = 1,
    client: Any = None,
    store: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: bool = False,
    **conditions: Any,
) -> Life:
    """Return how profiles wear over a distance on a line.

    A step predicts the wear of all states across the profile and sums it with their shares. It smooths the sum,
    removes it along the normal over a distance that wears at most `depth_step`, and takes new points at even arc
    lengths. The wear of a step is that of its middle, extrapolated from its beginning and from the step before. At
    each place it changes as an exponential with its relative rate of change, a method of second order like that of
    Adams and Bashforth. A step needs one prediction of the line. Flanks get hardly steeper than 80°: where a rail would
    cut further in, the edge below wears too.

    Parameters
    ----------
    predict : Pipeline
        A rig whose field of the body's name is its profile, such as a `wearlaw.Wheelset`, a contact model that resolves
        the patch, and a wear law.
    line : pandas.DataFrame, xarray.Dataset, path or callable
        Operating states in rows, conditions in columns with units, and a column with the share of the distance. A file
        is read in pieces, as in `wearlaw.sweep`; one of any length needs no more memory than a short one. States that
        follow from the profiles come from a function, which takes the rig at each step and returns such a DataFrame or
        Dataset.
    over : Quantity, str or float
        The distance [m], or the number of passages for a rail. A roller in place of the rail wears over a distance.
    share : str
        The column with the shares of the distance, which add up to one; "equal" for rows of equal shares. Of a run, it
        is the column of times or of distances, which grow: a row then stands for what lies half-way to its neighbours,
        and a column `rolling_speed` makes distances of times.
    columns : mapping of str to str, optional
        The column of each condition, as in `wearlaw.sweep`. Default: columns have the names of conditions, and a
        warning names the others, which are ignored.
    sep, decimal : str, optional
        Of a CSV file: what separates its cells, and its decimal mark, as in `wearlaw.read_table`.
    depth_step : Quantity or str
        Largest depth of a step, at most 0.1 mm [m].
    smoothing : Quantity or str
        Largest standard deviation of the Gaussian kernel that smooths the wear of a tread [m]. It stands for further
        states between those of the line: the kernel is as wide as the mean distance of their patches, so that it
        vanishes with dense states. On flanges, steeper than 30°, there is none. Zero does not smooth.
    resolution : Quantity or str
        Standard deviation of the Gaussian kernel that smooths all wear [m], as instruments that measure profiles do.
        For lines with curves take 0.8 mm, so that no ripples grow on flanges.
    spacing : Quantity or str
        Distance between the positions of the wear along the profile [m].
    until : mapping, optional
        Limits of measures in `Life.table` that end the life, such as {"flange_thickness": "25 mm"}. Limits of the
        flange's thickness and gradient lie below the measure of the new profile, those of the conicity on either side,
        and all others above.
    until_all : bool
        Whether the last of these limits ends the life, instead of the first; `Life.reached` has the distance to each.
    turn : mapping, optional
        Limits of measures, as in `until`, at which wheels are turned: they get their first profile again, at the
        greatest diameter that worn wheels leave, the same on both sides. `Life.cuts` has the cuts.
    least_diameter : Quantity or str, optional
        Least diameter of a wheel at the taping line [m]. It ends the life, as does a cut that would go below it.
    body : str
        "wheel", "rail", or "both" for a wheel and a rail in one life. The life is then that of the wheel, and the
        measures of the rail begin with `rail_`.
    passages_per_km : float, optional
        With "both": wheels that pass over the rail while this wheel runs 1 km; all of them have its profile.
    sides : "mean" or "each"
        With "mean" both sides have one profile, which wears by the mean of both, as on a vehicle that turns. With
        "each" they wear for themselves.
    conicity_step : float
        Largest change of the equivalent conicity in a step, if the rig has one; math.inf for any.
    workers : int
        Number of processes on this machine.
    client : distributed.Client, optional
        A cluster of dask.distributed, instead of `workers`.
    store : path, optional
        A folder that keeps the finished steps, with the states that a function returned.
    resume : bool
        Whether to go on with the life in `store`, if there is one. A function must return the same states again.
    progress : bool
        Whether to show the distance and the time left.
    **conditions
        Conditions that are the same in all states.

    Returns
    -------
    Life

    Raises
    ------
    DataError
        If the line is wrong, its shares do not add up to one, or a state is impossible, has no result or its wheel
        climbs; the message names the step and the row. If steps were finished before, the error's attribute `life`
        holds them.
    InputError
        If an argument is wrong, the new profile is beyond a limit, or it is too short for the wear.
    OutputError
        If `store` holds anything but the same life, or a function returns other states for a finished step.
    """
    expect_pipeline(predict)
    length, width = wl.Unit("mm"), wl.Unit("mm", positive=False, negative=False)
    settings: dict[str, Any] = {
        "depth_step": float(length.si(depth_step, "depth_step")),
        "smoothing": float(width.si(smoothing, "smoothing")),
        "resolution": float(width.si(resolution, "resolution")),
        "conicity_step": float(conicity_step),
    }
    if settings["depth_step"] > DEEPEST:
        raise wl.InputError(f"depth_step: must be at most {1e3 * DEEPEST:g} mm, since contacts move as a profile wears")
    if not conicity_step > 0.0:
        raise wl.InputError(f"conicity_step: must be positive, or math.inf for no limit; got {conicity_step:g}")
    body, *beside = bodies = ["wheel", "rail"] if body == "both" else [body]
    news = {name: tuple(even(profile) for profile in _profiles(predict.rig, name, sides)) for name in bodies}
    rolls = bool(np.isfinite(predict.rig.bodies[body].rolling_radius))
    distance, passages = _distance(over, rolls), _passages(passages_per_km, predict.rig, bool(beside))
    at = {}
    for name, new in news.items():
        predict = with_profiles(predict, name, new)
        longest = max(np.ptp(profile.curve.s) for profile in new)
        at[name] = positions(new, math.ceil(longest / length.si(spacing, "spacing")) + 1)
    reading = (conditions, columns, {SHARE: share}, {"sep": sep, "decimal": decimal})

    def of_rig(rig: wl.Rig) -> Points:
        """Return the states that a function gives."""
        table = line(rig)
        if not isinstance(table, pd.DataFrame | xarray.Dataset):
            raise DataError(f"line: must return a pandas.DataFrame or an xarray.Dataset, got {wl.shown(table)}")
        with operating_points(predict, table, *reading, None, True, True) as points:
            return points

    renewed: Callable[[wl.Rig], Points] | None = of_rig if callable(line) else None
    with ExitStack() as stack:
        try:
            points = (
                stack.enter_context(operating_points(predict, line, *reading, store, True, True))
                if renewed is None
                else renewed(predict.rig)
            )
            of_line = Line(predict, points, at, workers, client, renewed)
        except wl.InputError as error:
            if renewed is None:
                raise
            raise type(error)(f"step 1: {error}") from None
        rail = Steps(of_line, "rail", False, news["rail"], **settings) if beside else None
        steps = Steps(of_line, body, rolls, news[body], **settings, rail=rail, passages=1e-3 * passages)
        now = steps.begin(predict)
        rows, worn = [now.row], [now.of_bodies]
        notes: list[tuple[str, ...]] = []
        cutting = turns(predict.rig, body, until or {}, turn or {})
        least = {} if least_diameter is None else {"diameter": least_diameter}
        waiting = until or {} if until_all else {}
        limits = Limits({**(until or {}), **cutting, **least}, distance, now.row, waiting)
        cuts: list[dict[str, Any]] = []
        last = now.row
        if store is not None:
            settings |= {"sides": sides, "limits": limits.ends, "turn": sorted(cutting), "until_all": until_all}
            settings |= {"passages_per_km": passages} if beside else {}
            stack.enter_context(closing(steps.line.keep(store, settings, resume)))
        along, _ = limits.ends["over"]
        bar = stack.enter_context(Bar(round(distance), progress))
        bar.stage(along)

        def life(ended: str = "") -> Life:
            ends = dict(end for name, end in limits.ends.items() if name != "over")
            table, every, (profiles, *rails) = pd.DataFrame(rows), pd.DataFrame(cuts), zip(*worn, strict=True)
            of_rail = rails[0] if rails else ()
            return Life(now.predict, body, ended, profiles, table, tuple(notes), ends, every, of_rail)

        try:
            while True:
                ended = limits.reached(now.row)
                if measure_of(ended) in cutting:
                    cut = turned(steps, now)
                    if ended_by := limits.reached(cut.row):  # the cut would take too much
                        ended = ended_by
                        break
                    cuts.append(cut_of(ended, last, now.row, cut.row))
                    now, last = cut, cut.row
                elif ended:
                    break
                else:
                    begin, now = steps.step(now, limits)
                    rows[-1], worn[-1] = begin.row, begin.of_bodies
                    notes.append(now.notes)
                bar(round(now.row[along]) - round(rows[-1][along]))
                rows.append(now.row)
                worn.append(now.of_bodies)
        except (wl.WearlawError, KeyboardInterrupt) as error:
            if now.number:
                error.life = life()  # type: ignore[union-attr]
                error.add_note(f"{now.number} steps are finished: the error's attribute `life` has them")
            raise
        return life(ended)


def _distance(over: Any, rolls: bool) -> float:
    """Return the distance [km], or the number of passages of a rail."""
    if rolls:
        return 1e-3 * float(wl.Unit("km").si(over, "over"))
    if isinstance(over, str | wl.Quantity) or not over > 0.0:
        raise wl.InputError(f"over: a rail wears by passages; give their number, such as 1e6; got {wl.shown(over)}")
    return float(over)


def _passages(per_km: float | None, rig: wl.Rig, both: bool) -> float:
    """Return the passages over a rail in a kilometre of a wheel."""
    if both and np.isfinite(rig.bodies["rail"].rolling_radius):
        raise wl.InputError(f"body: 'both' takes a rail, and rig {rig.name!r} has a roller; wear its 'wheel' or 'rail'")
    passages = 0.0 if per_km is None else float(wl.coefficient(per_km, "passages_per_km", positive=False))
    if (per_km is not None) != both or passages < 0.0:
        raise wl.InputError(
            f'passages_per_km: with body="both" alone, give how many wheels pass over the rail while this wheel runs'
            f" 1 km, such as 20; got {wl.shown(per_km)}"
        )
    return passages


def _profiles(rig: Any, body: str, sides: str) -> tuple[Profile, ...]:
    """Return the profiles of a rig that wear: one, or those of the left and the right side."""
    right: Any = getattr(rig, body, None)
    left = f"left_{body}"
    if body not in rig.bodies or not hasattr(right, "worn"):
        raise wl.InputError(
            f"body: the rig {rig.name!r} has no profile of {wl.shown(body)} that can wear; take a rig with profiles,"
            " such as wearlaw.Wheelset, and its 'wheel', 'rail' or 'both'"
        )
    if sides == "each" and hasattr(rig, left):
        return getattr(rig, left) or right, right
    if sides != "mean" or getattr(rig, left, None) is not None:
        raise wl.InputError(
            f"sides: {wl.shown(sides)} does not suit the rig {rig.name!r}; give 'mean' if it has one profile of its"
            f" {body} for both sides, or 'each' if it has {left} too"
        )
    return (right,)
