"""Wearing profiles over a distance, step by step."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Mapping
from contextlib import ExitStack, closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw.pipeline.pipeline import expect_pipeline
from wearlaw_life._life import SIDES, UNITS, Life, unit_of
from wearlaw_life._line import Line, Wear
from wearlaw_life._measures import NAMES, flange, hollow
from wearlaw_life._removal import conserving, even, normal_depth, positions, smoothed, swept
from wearlaw_life._state import Plan, State
from wearlaw_sweeps.progress import Bar
from wearlaw_sweeps.tables import from_table
from wearlaw_sweeps.wear_profile import SHARE

if TYPE_CHECKING:
    from wearlaw_life._store import Store
    from wearlaw_wheelset import Profile

DEEPEST = 1e-4
"""Largest depth of a step [m]: contacts move with the wear."""

START = 0.25
"""Share of `depth_step` of the first step, which has none before it to extrapolate from."""

GROWTH = 2.0
"""Largest ratio of the distances of two steps: the extrapolation then weighs the latest wear at most twice."""

CORRECTION = 2e3
"""Largest depth by which extrapolation may change the wear of a step anywhere, over the square of `depth_step` [1/m]:
all steps halve with it. Where contact leaves a place and comes back, longer steps would wear one place too deep,
and then the other."""

SHORTEST = 1.0 / 64.0
"""Smallest share of `depth_step` that a jump of the conicity makes a step; a jump stays one however short the step."""

AIM = 0.95
"""Share of `conicity_step` at which a step aims."""

TRIES = 8
"""Most distances that a step tries to hold the conicity."""

NEAR = 1e-9
"""Share of the way to a limit at which it counts as reached."""

EDGE = 1e-3
"""Share of the deepest wear at an end of a profile that says that the profile is too short."""

Limits = list[tuple[str, float]]
"""Limits of measures in SI, by column."""


def wear_out(
    predict: wl.Pipeline[...],
    line: Any,
    /,
    *,
    over: wl.QuantityLike | float,
    share: str = "share",
    columns: Mapping[str, str] | None = None,
    depth_step: wl.QuantityLike = "0.05 mm",
    smoothing: wl.QuantityLike = "3 mm",
    spacing: wl.QuantityLike = "0.1 mm",
    until: Mapping[str, wl.QuantityLike | float] | None = None,
    body: str = "wheel",
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
    lengths. The wear of a step is that of its middle, extrapolated from its beginning and from the step before
    (Adams and Bashforth's method of second order), so that a step needs one prediction of the line.

    Parameters
    ----------
    predict : Pipeline
        A rig whose field of the body's name is its profile, such as a `wearlaw_wheelset.Wheelset`, a contact model that
        resolves the patch, and a wear law.
    line : pandas.DataFrame, xarray.Dataset or path
        Operating states in rows, conditions in columns with units, and a column with the share of the distance. A file
        is read in pieces, as in `wearlaw.sweep`; one of any length needs no more memory than a short one.
    over : Quantity, str or float
        The distance [m], or the number of passages for a rail.
    share : str
        The column with the shares, which add up to one.
    columns : mapping of str to str, optional
        The column of each condition, as in `wearlaw.sweep`.
    depth_step : Quantity or str
        Largest depth of a step, at most 0.1 mm [m].
    smoothing : Quantity or str
        Standard deviation of the Gaussian kernel that smooths the summed wear [m]. It stands for what lies between the
        states; zero does not smooth.
    spacing : Quantity or str
        Distance between the positions of the wear along the profile [m].
    until : mapping, optional
        Limits of measures in `Life.table` that end the life, such as {"flange_thickness": "25 mm"}.
    body : str
        "wheel" or "rail".
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
        A folder that keeps the finished steps.
    resume : bool
        Whether to go on with the life in `store`, if there is one.
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
        climbs; the message names the row. If steps were finished before, the error's attribute `life` holds them.
    InputError
        If an argument is wrong, or the profile is too short for the wear.
    OutputError
        If `store` holds anything but the same life.
    """
    expect_pipeline(predict)
    first = tuple(even(one) for one in _given(predict.rig, body, sides))
    length = wl.Unit("mm")
    plan = Plan(
        body=body,
        over=_distance(body, over),
        depth_step=float(length.si(depth_step, "depth_step")),
        smoothing=float(wl.Unit("mm", positive=False).si(smoothing, "smoothing")),
        spacing=float(length.si(spacing, "spacing")),
        conicity_step=float(conicity_step),
        each=sides == "each",
        until=_in_si(until or {}),
    )
    if plan.depth_step > DEEPEST:
        raise wl.InputError(
            f"depth_step: must be at most {1e3 * DEEPEST:g} mm, since contacts move as a profile wears; got"
            f" {1e3 * plan.depth_step:.4g} mm"
        )
    if not (plan.conicity_step > 0.0 and plan.smoothing >= 0.0):
        raise wl.InputError("conicity_step and smoothing: must be positive; only smoothing may be zero")
    count = math.ceil(max(np.ptp(one.curve.s) for one in first) / plan.spacing) + 1
    at = positions(first, count)
    beside = Path(tempfile.gettempdir(), "line") if store is None else Path(store)
    check = predict.rig.check_names
    read = from_table(line, conditions, columns=columns, keep={SHARE: share}, check=check, on_disk=beside)
    with ExitStack() as stack:
        states = Line.of(predict, stack.enter_context(read), share, body, at, workers, client)
        kept = None
        if store is not None:
            from wearlaw_life._store import Store  # zarr takes half a second

            kept = stack.enter_context(closing(Store(store, resume, predict, states, plan)))
        unit = 1.0 if body == "rail" else 1e-3
        bar = stack.enter_context(Bar(round(unit * plan.over), progress))
        bar.stage("passages" if body == "rail" else "km")
        return _run(predict, states, plan, first, kept, bar, unit)


def _run(
    predict: wl.Pipeline[...], line: Line, plan: Plan, first: tuple[Profile, ...], store: Store | None, bar: Bar,
    unit: float,
) -> Life:  # fmt: skip
    states, ended, quiet = [] if store is None else list(store.states), "", False
    rig = with_profiles(predict, plan, first).rig
    row = {plan.along: 0.0, **_measured(rig, plan, first, first, {}, np.zeros(line.sides))}
    limits = _limits(plan, row)

    def life() -> Life:
        profiles, rows = tuple(one.profiles for one in states), tuple(one.row for one in states)
        return Life(with_profiles(predict, plan, profiles[-1]), plan.body, ended, profiles, rows)

    def add(state: State) -> None:
        states.append(state)
        if store is not None:
            store.add(len(states) - 1, state)

    if not states:
        add(State(first, row))
    done = 0
    try:
        while not (ended := _reached(plan, limits, row, states[-1].row)):
            state = _step(predict, line, plan, limits, first, states[-1], quiet)
            states[-1] = states[-1]._replace(wear=None)  # only the last one goes on
            quiet = True
            add(state)
            bar(round(unit * state.row[plan.along]) - done)
            done = round(unit * state.row[plan.along])
    except (wl.WearlawError, KeyboardInterrupt) as error:
        if len(states) > 1:
            error.life = life()  # type: ignore[union-attr]
            reached = f"{unit * states[-1].row[plan.along]:.6g} {'passages' if plan.body == 'rail' else 'km'}"
            error.add_note(
                f"{len(states) - 1} steps, to {reached}, are finished: the error's attribute `life` has them"
            )
        raise
    return life()


def _step(
    predict: wl.Pipeline[...], line: Line, plan: Plan, limits: Limits, first: tuple[Profile, ...], now: State,
    quiet: bool,
) -> State:  # fmt: skip
    """Return the state after one more step."""
    pipeline = with_profiles(predict, plan, now.profiles)
    at = positions(now.profiles, line.job.at.size)
    wear = line.wear(pipeline, at, quiet)
    wear = wear._replace(depth=smoothed(plan.of_profiles(wear.depth), at, plan.smoothing))
    deepest = float(wear.depth.max())
    if not deepest > 0.0:
        raise wl.ConditionsError("line: no state wears the profile; the distance that wears a depth is infinite")
    left = plan.over - now.row[plan.along]
    step = min((START if now.wear is None else 1.0) * plan.depth_step / deepest, left)
    if now.wear is not None:
        step = min(step, GROWTH * now.step)
        rise = float(np.abs(wear.depth - now.wear.depth).max())
        step = min(step, plan.depth_step * math.sqrt(2.0 * CORRECTION * now.step / rise)) if rise else step
        if now.change > 0.0:
            step = min(step, AIM * plan.conicity_step / now.change * now.step)
    body = pipeline.rig.bodies[plan.body]
    density, radius = wl.scalar_si(body.material.density, "kg/m^3"), float(np.asarray(body.rolling_radius))
    tries = 0
    while True:
        tries += 1
        middle = _of_middle(wear, now.wear, step, now.step)
        removals = []
        for profile, depth, mass in zip(now.profiles, middle.depth, plan.of_profiles(middle.mass), strict=True):
            _check_ends(profile, at, depth, plan.body)
            volume = step * float(mass) / density
            removals.append(conserving(profile, at, step * depth, volume, radius if math.isfinite(radius) else None))
        after = tuple(one.profile for one in removals)
        row = {plan.along: now.row[plan.along] + step}
        row |= _measured(with_profiles(predict, plan, after).rig, plan, first, after, now.row, step * middle.mass)
        row |= {f"factor{side}": one.factor for side, one in zip(SIDES[len(after)], removals, strict=True)}
        share = _share_to_limit(limits, now.row, row)
        change = abs(row["equivalent_conicity"] - now.row["equivalent_conicity"])
        if tries == TRIES:
            return State(after, row, wear, step, change)
        if change > plan.conicity_step and step * deepest > SHORTEST * plan.depth_step:
            step *= max(AIM * plan.conicity_step / change, 0.25)
        elif share < 1.0 - 1e-6:
            step *= share
        else:
            return State(after, row, wear, step, change)


def _of_middle(wear: Wear, before: Wear | None, step: float, step_before: float) -> Wear:
    """Return the wear in the middle of a step, extrapolated from its beginning and the step before."""
    if before is None:
        return wear
    share = 0.5 * step / step_before
    middle = Wear(*(one + share * (one - other) for one, other in zip(wear, before, strict=True)))
    if (middle.mass < 0.5 * wear.mass).any():  # the wear has jumped
        return wear
    return Wear(np.maximum(middle.depth, 0.0), middle.mass)


def _limits(plan: Plan, row: Mapping[str, float]) -> Limits:
    """Return the limits by the columns of their measures: a column of its own, or those of both sides.

    Raises
    ------
    InputError
        If these profiles lack a measure.
    """
    found: list[tuple[str, float]] = []
    there = {name: value for name, value in row.items() if math.isfinite(value)}
    for name, limit in plan.until.items():
        columns = [one for one in ([name] if name in row else [f"{name}{side}" for side in SIDES[2]]) if one in there]
        if not columns:
            raise wl.InputError(f"until: this profile has no {wl.shown(name)}; it has {', '.join(there)}")
        found += [(column, limit) for column in columns]
    return found


def _share_to_limit(limits: Limits, before: Mapping[str, float], after: Mapping[str, float]) -> float:
    """Return the share of a step at which the first measure reaches its limit, one if none does."""
    passed = (
        (limit - before[column]) / (after[column] - before[column])
        for column, limit in limits
        if (before[column] - limit) * (after[column] - limit) < 0.0
    )
    return min(passed, default=1.0)


def _reached(plan: Plan, limits: Limits, first: Mapping[str, float], now: Mapping[str, float]) -> str:
    """Return why a life ends, "" if it goes on."""
    for column, limit in limits:
        if (first[column] - limit) * (now[column] - limit) <= NEAR * (first[column] - limit) ** 2:
            return column
    return "over" if now[plan.along] >= plan.over * (1.0 - 1e-12) else ""


def _given(rig: Any, body: str, sides: str) -> tuple[Profile, ...]:
    """Return the profiles of a rig, one or those of the left and the right side."""
    right: Any = getattr(rig, body, None)
    left, fields = f"left_{body}", type(rig).model_fields
    if body not in rig.bodies or not hasattr(right, "worn"):
        raise wl.InputError(
            f"body: the rig {rig.name!r} has no profile of {wl.shown(body)} that can wear; take a rig with profiles,"
            " such as wearlaw_wheelset.Wheelset, and its 'wheel' or 'rail'"
        )
    if sides not in ("mean", "each"):
        raise wl.InputError(f"sides: must be 'mean' or 'each', got {wl.shown(sides)}")
    if sides == "each" and left not in fields:
        raise wl.InputError(f"sides: the rig {rig.name!r} has one profile for both sides; give 'mean'")
    if sides == "mean" and getattr(rig, left, None) is not None:
        raise wl.InputError(
            f"sides: the rig has a {left} of its own, which has no mean with the right one; give 'each'"
        )
    return (getattr(rig, left) or right, right) if sides == "each" else (right,)


def _distance(body: str, over: Any) -> float:
    """Return the distance [m], or the number of passages of a rail."""
    if body != "rail":
        return float(wl.Unit("km").si(over, "over"))
    if isinstance(over, str | wl.Quantity) or not over > 0.0:
        raise wl.InputError(f"over: a rail wears by passages; give their number, such as 1e6, got {wl.shown(over)}")
    return float(over)


def _in_si(until: Mapping[str, wl.QuantityLike | float]) -> dict[str, float]:
    """Return the limits of measures in SI."""
    limits = {}
    for name, value in until.items():
        unit = unit_of(name)
        if unit is None:
            raise wl.InputError(f"until: there is no measure {wl.shown(name)}; there are {', '.join(UNITS)}")
        limits[name] = float(wl.Unit(unit).si(value, f"until: {name}") if unit else value)  # type: ignore[arg-type]
    return limits


def with_profiles(predict: wl.Pipeline[...], plan: Plan, profiles: tuple[Profile, ...]) -> wl.Pipeline[...]:
    """Return the pipeline with other profiles of a body."""
    rig = predict.rig
    worn = {plan.body: profiles[-1]} | ({f"left_{plan.body}": profiles[0]} if plan.each else {})
    fields = {name: getattr(rig, name) for name in type(rig).model_fields} | worn
    return wl.Pipeline(
        rig=type(rig)(**fields), contact_model=predict.contact_model, stages=predict.stages, laws=predict.laws
    )


def _measured(
    rig: Any, plan: Plan, first: tuple[Profile, ...], profiles: tuple[Profile, ...], before: Mapping[str, float],
    lost: Array,
) -> dict[str, float]:  # fmt: skip
    """Return the measures of profiles in SI, after a loss of mass of each side [kg]."""
    row = {} if plan.each else {"mass": before.get("mass", 0.0) + float(lost.mean())}
    if lost.size == 2:
        pairs = zip((f"mass{side}" for side in SIDES[2]), lost, strict=True)
        row |= {name: before.get(name, 0.0) + float(one) for name, one in pairs}
    for side, start, profile in zip(SIDES[len(profiles)], first, profiles, strict=True):
        new = profile is start
        row[f"depth{side}"] = 0.0 if new else float(normal_depth(start, profile, start.curve.s).max())
        row[f"worn_area{side}"] = 0.0 if new else swept(start, profile, None)
        if plan.body == "wheel":
            y, z = (1e-3 * one.magnitude for one in profile.points)
            back = wl.scalar_si(getattr(rig, "flange_back_position", wl.Q(-70.0, "mm")), "m")
            values = (*flange(y, z, back), hollow(z))
            row |= {f"{name}{side}": value for name, value in zip(NAMES, values, strict=True)}
    row["equivalent_conicity"] = _conicity(rig)
    return row | {f"factor{side}": 1.0 for side in SIDES[len(profiles)]}


def _conicity(rig: Any) -> float:
    """Return the equivalent conicity at 3 mm, NaN where the rig or the profile has none."""
    try:
        return float(rig.equivalent_conicity(amplitude="3 mm").m_as(""))
    except (AttributeError, wl.InputError):
        return math.nan


def _check_ends(profile: Profile, at: Array, depth: Array, body: str) -> None:
    for name, value in zip(("first", "last"), np.interp(profile.curve.s[[0, -1]], at, depth), strict=True):
        if value > EDGE * depth.max():
            raise wl.InputError(
                f"{body}: the profile is too short for the wear, which reaches {value / depth.max():.2g} of its deepest"
                f" place at the {name} point; give a wider profile, or less smoothing"
            )
