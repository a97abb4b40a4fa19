"""Wearing a profile over a distance, step by step."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw.pipeline.pipeline import expect_pipeline
from wearlaw_life._life import UNITS, Life
from wearlaw_life._line import Line, Wear, first_state, flank_of, read_line, wear_of, weighted
from wearlaw_life._measures import NAMES, flange, hollow
from wearlaw_life._removal import Profile, conserving, even, normal_depth, positions, smoothed, swept
from wearlaw_life._state import Plan, Side, State
from wearlaw_sweeps.progress import Bar

if TYPE_CHECKING:
    from wearlaw_life._store import Store

DEEPEST = 1e-4
"""Largest depth of a step [m]: contacts move with the wear."""

START = 0.25
"""Share of `depth_step` of the first step, which has none before it to extrapolate from."""

GROWTH = 2.0
"""Largest ratio of the distances of two steps: the extrapolation then weighs the latest wear at most twice."""

CORRECTION = 0.1
"""Largest share of `depth_step` by which extrapolation may change the wear of a step anywhere. Where contact leaves a
place and comes back, longer steps would wear one place too deep, and then the other."""

SHORTEST = 1.0 / 64.0
"""Smallest share of `depth_step` that a jump of the conicity makes a step; a jump stays one however short the step."""

AIM = 0.95
"""Share of `conicity_step` at which a step aims."""

TRIES = 8
"""Most distances that a step tries to hold the conicity."""

EDGE = 1e-3
"""Share of the deepest wear at an end of a profile that says that the profile is too short."""


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
    side: Side = "mean",
    conicity_step: float = 0.005,
    amplitude: wl.QuantityLike = "3 mm",
    store: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: bool = False,
    **conditions: Any,
) -> Life:
    """Return how a profile wears over a distance on a line.

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
        is read in pieces, as in `wearlaw.sweep`.
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
    side : "mean", "left" or "right"
        Whose wear is removed. The rig has one profile for both sides: "mean" suits a vehicle that turns, the others
        give both wheels the wear of one.
    conicity_step : float
        Largest change of the equivalent conicity in a step, if the rig has one; math.inf for any.
    amplitude : Quantity or str
        Amplitude of the lateral displacement at which the conicity is taken [m].
    store : path, optional
        A folder that keeps the finished steps. A line from a file of any length then needs 8 bytes of memory a state.
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
    ConditionsError
        If a state is impossible, its wheel climbs or it has no result; the message names the row. If steps were
        finished before, the error's attribute `life` holds them.
    DataError
        If the line is wrong, or its shares do not add up to one.
    InputError
        If an argument is wrong, or the profile is too short for the wear.
    OutputError
        If `store` holds anything but the same life.
    """
    expect_pipeline(predict)
    plan = _plan(predict, body, over, depth_step, smoothing, spacing, conicity_step, amplitude, side, until)
    with ExitStack() as stack:
        on_disk = None if store is None else Path(store)
        read = stack.enter_context(read_line(predict, line, share, columns, conditions, on_disk, progress))
        problem = first_state(predict, read)
        read, plan = weighted(read, problem), replace(plan, sides=len(problem.dims.get("side", "-")))
        kept = None
        if store is not None:
            from wearlaw_life._store import Store  # zarr takes half a second

            kept = stack.enter_context(Store(store, resume, predict, read, plan))
        bar = stack.enter_context(Bar(round(plan.over if body == "rail" else 1e-3 * plan.over), progress))
        bar.stage("passages" if body == "rail" else "km")
        return _run(predict, read, plan, kept, bar)


def _run(predict: wl.Pipeline[...], line: Line, plan: Plan, store: Store | None, bar: Bar) -> Life:
    along = "passages" if plan.body == "rail" else "distance"
    states = [] if store is None else store.states()
    ended = ""
    unit = 1.0 if plan.body == "rail" else 1e-3
    shown = round(unit * states[-1].row[along]) if states else 0
    bar(shown)

    def life() -> Life:
        last = states[-1].pipeline or with_profile(predict, plan.body, states[-1].profile)
        return Life(last, plan.body, ended, tuple(one.profile for one in states), tuple(one.row for one in states))

    try:
        for state, why in _steps(predict, line, plan, along, states):
            ended = why
            if states and state is states[-1]:
                break
            states[-1:] = [one._replace(pipeline=None, wear=None) for one in states[-1:]]  # only the last one goes on
            states.append(state)
            if store is not None:
                store.add(state)
            done = round(unit * state.row[along])
            bar(done - shown)
            shown = done
    except (wl.WearlawError, KeyboardInterrupt) as error:
        if len(states) > 1:
            error.life = life()  # type: ignore[union-attr]
            reached = f"{unit * states[-1].row[along]:.6g} {'passages' if plan.body == 'rail' else 'km'}"
            error.add_note(
                f"{len(states) - 1} steps, to {reached}, are finished: the error's attribute `life` has them"
            )
        raise
    return life()


def _steps(
    predict: wl.Pipeline[...], line: Line, plan: Plan, along: str, states: list[State]
) -> Iterator[tuple[State, str]]:
    """Yield the state at the start and after each step, and why the life ends if it does."""
    original = getattr(predict.rig, plan.body)
    if states:
        first, now = states[0].profile, states[-1]
        _, ended = _share_to_limit(plan, states[0].row, now.row, "")
        if ended:  # the life is complete
            yield now, ended
            return
    else:
        first = even(original)
        pipeline = with_profile(predict, plan.body, first)
        now = State(first, {along: 0.0, **_measured(pipeline, plan, first, first, {})}, pipeline=pipeline)
        _check_limits(plan, now.row)
        yield now, ""
    count = math.ceil(np.ptp(first.curve.s) / plan.spacing) + 1
    while now.row[along] < plan.over * (1.0 - 1e-12):
        now, ended = _step(predict, line, plan, along, first, now, count, quiet=bool(now.step))
        yield now, ended
        if ended != "":
            return


def _step(
    predict: wl.Pipeline[...], line: Line, plan: Plan, along: str, first: Profile, now: State, count: int, quiet: bool
) -> tuple[State, str]:
    """Return the state after one more step, and why the life ends if it does."""
    profile = now.profile
    pipeline = now.pipeline or with_profile(predict, plan.body, profile)
    at = positions(profile, count)
    wear = wear_of(pipeline, line, plan.body, at, quiet, flank_of(profile))
    wear = Wear(smoothed(wear.depth, at, plan.smoothing), wear.mass)
    chosen = slice(None) if plan.side == "mean" or plan.sides == 1 else slice(*_index(plan.side))
    deepest = float(wear.depth[chosen].mean(axis=0).max())
    if not deepest > 0.0:
        raise wl.ConditionsError("line: no state wears the profile; the distance that wears a depth is infinite")
    left = plan.over - now.row[along]
    step = min((1.0 if now.step else START) * plan.depth_step / deepest, left)
    if now.step:
        step = min(step, GROWTH * now.step)
        if now.wear is not None:
            rise = float(np.abs((wear.depth - now.wear.depth)[chosen].mean(axis=0)).max())
            step = min(step, math.sqrt(2.0 * CORRECTION * plan.depth_step * now.step / rise)) if rise else step
        if now.change > 0.0:
            step = min(step, AIM * plan.conicity_step / now.change * now.step)
    density = _density(pipeline, plan.body)
    radius = _radius(pipeline, plan.body)
    for _ in range(TRIES):
        middle = _of_middle(wear, now.wear, step, now.step)
        depth, mass = middle.depth[chosen].mean(axis=0) * step, middle.mass * step
        _check_ends(depth, plan.body)
        removal = conserving(profile, at, depth, float(mass[chosen].mean()) / density, radius)
        after = with_profile(predict, plan.body, removal.profile)
        row = {along: now.row[along] + step, **_measured(after, plan, first, removal.profile, now.row, mass)}
        row["factor"] = removal.factor
        ended = "over" if step >= left * (1.0 - 1e-12) else ""
        share, ended = _share_to_limit(plan, now.row, row, ended)
        change = abs(row["equivalent_conicity"] - now.row["equivalent_conicity"])
        if change > plan.conicity_step and step * deepest > SHORTEST * plan.depth_step:
            step *= max(AIM * plan.conicity_step / change, 0.25)
        elif share < 1.0 - 1e-6:
            step *= share
        else:
            break
    return State(removal.profile, row, wear, step, change, after), ended


def _of_middle(wear: Wear, before: Wear | None, step: float, step_before: float) -> Wear:
    """Return the wear in the middle of a step, extrapolated from its beginning and the step before."""
    if before is None:
        return wear
    share = 0.5 * step / step_before
    middle = Wear(*(one + share * (one - other) for one, other in zip(wear, before, strict=True)))
    if (middle.mass < 0.5 * wear.mass).any():  # the wear has jumped
        return wear
    return Wear(np.maximum(middle.depth, 0.0), middle.mass)


def _share_to_limit(plan: Plan, before: Mapping[str, float], now: dict[str, float], ended: str) -> tuple[float, str]:
    """Return the share of a step at which the first measure reaches its limit, and why the life ends."""
    found = 1.0
    for name, limit in plan.until.items():
        start, end = before[name], now[name]
        if start != limit and (start - limit) * (end - limit) <= 1e-9 * (start - limit) ** 2:
            share = (limit - start) / (end - start)
            if share <= found:
                found, ended = share, name
    return found, ended


def with_profile(predict: wl.Pipeline[...], body: str, profile: Profile) -> wl.Pipeline[...]:
    """Return the pipeline with another profile of a body."""
    rig = predict.rig
    fields = {name: getattr(rig, name) for name in type(rig).model_fields} | {body: profile}
    new = type(rig)(**fields)
    return wl.Pipeline(rig=new, contact_model=predict.contact_model, stages=predict.stages, laws=predict.laws)


def _measured(
    pipeline: wl.Pipeline[...],
    plan: Plan,
    first: Profile,
    profile: Profile,
    before: Mapping[str, float],
    mass: Array | None = None,
) -> dict[str, float]:
    """Return the measures of a profile in SI."""
    rig = pipeline.rig
    lost = np.zeros(plan.sides) if mass is None else mass
    chosen = float(lost.mean()) if plan.side == "mean" or plan.sides == 1 else float(lost[_index(plan.side)[0]])
    row = {"mass": before.get("mass", 0.0) + chosen}
    if lost.size == 2:
        pair = zip(("mass_left", "mass_right"), lost, strict=True)
        row |= {name: before.get(name, 0.0) + float(one) for name, one in pair}
    s = first.curve.s
    row["depth"] = 0.0 if profile is first else float(normal_depth(first, profile, s).max())
    row["worn_area"] = 0.0 if profile is first else swept(first, profile, None)
    if plan.body == "wheel":
        y, z = (1e-3 * one.magnitude for one in profile.points)
        back = wl.scalar_si(getattr(rig, "flange_back_position", wl.Q(-70.0, "mm")), "m")
        row |= dict(zip(NAMES, (*flange(y, z, back), hollow(z)), strict=True))
    row["equivalent_conicity"] = _conicity(rig, plan.amplitude)
    row["factor"] = 1.0
    return row


def _conicity(rig: Any, amplitude: float) -> float:
    """Return the equivalent conicity, NaN where the rig or the profile has none."""
    try:
        return float(rig.equivalent_conicity(amplitude=wl.Q(1e3 * amplitude, "mm")).m_as(""))
    except (AttributeError, wl.InputError):
        return math.nan


def _check_ends(depth: Array, body: str) -> None:
    ends = {"first": depth[0], "last": depth[-1]}
    for name, value in ends.items():
        if value > EDGE * depth.max():
            raise wl.InputError(
                f"{body}: the profile is too short for the wear, which reaches {value / depth.max():.2g} of its deepest"
                f" place at the {name} point; give a wider profile, or less smoothing"
            )


def _check_limits(plan: Plan, row: Mapping[str, float]) -> None:
    for name, limit in plan.until.items():
        if name not in row or math.isnan(row[name]):
            known = ", ".join(key for key, value in row.items() if math.isfinite(value) and key != "factor")
            raise wl.InputError(f"until: this profile has no {wl.shown(name)}; it has {known}")
        if row[name] == limit:
            raise wl.InputError(f"until: {name} has its limit already; give another one")


def _index(side: str) -> tuple[int, int]:
    first = ("left", "right").index(side)
    return first, first + 1


def _density(pipeline: wl.Pipeline[...], body: str) -> float:
    return wl.scalar_si(pipeline.rig.bodies[body].material.density, "kg/m^3")


def _radius(pipeline: wl.Pipeline[...], body: str) -> float | None:
    """Return the radius at z = 0 of a body that turns, None for one that does not [m]."""
    radius = float(np.asarray(pipeline.rig.bodies[body].rolling_radius))
    return radius if math.isfinite(radius) else None


def _plan(
    predict: wl.Pipeline[...],
    body: str,
    over: Any,
    depth_step: wl.QuantityLike,
    smoothing: wl.QuantityLike,
    spacing: wl.QuantityLike,
    conicity_step: float,
    amplitude: wl.QuantityLike,
    side: Side,
    until: Mapping[str, Any] | None,
) -> Plan:
    """Return the settings in SI, checked."""
    if body not in predict.rig.bodies or not hasattr(getattr(predict.rig, body, None), "worn"):
        raise wl.InputError(
            f"body: the rig {predict.rig.name!r} has no profile of {wl.shown(body)} that can wear; take a rig with"
            " profiles, such as wearlaw_wheelset.Wheelset, and its 'wheel' or 'rail'"
        )
    if side not in ("mean", "left", "right"):
        raise wl.InputError(f"side: must be 'mean', 'left' or 'right', got {wl.shown(side)}")
    if body == "rail" and (isinstance(over, str | wl.Quantity) or not over > 0.0):
        raise wl.InputError(f"over: a rail wears by passages; give their number, such as 1e6, got {wl.shown(over)}")
    if not conicity_step > 0.0:
        raise wl.InputError(f"conicity_step: must be positive, got {wl.shown(conicity_step)}")
    length = wl.Unit("mm")
    plan = Plan(
        body,
        float(over) if body == "rail" else float(wl.Unit("km").si(over, "over")),
        float(length.si(depth_step, "depth_step")),
        float(wl.Unit("mm", positive=False).si(smoothing, "smoothing")),
        float(length.si(spacing, "spacing")),
        float(conicity_step),
        float(length.si(amplitude, "amplitude")),
        side,
        {},
    )
    if plan.depth_step > DEEPEST:
        raise wl.InputError(
            f"depth_step: must be at most {1e3 * DEEPEST:g} mm, since contacts move as a profile wears; got"
            f" {1e3 * plan.depth_step:.4g} mm"
        )
    if plan.smoothing < 0.0:
        raise wl.InputError(f"smoothing: must not be negative, got {1e3 * plan.smoothing:.4g} mm")
    limits = {}
    for name, value in (until or {}).items():
        if name not in UNITS or name == "factor":
            raise wl.InputError(f"until: there is no measure {wl.shown(name)}; there are {', '.join(UNITS)}")
        unit = wl.Unit(UNITS[name])
        limits[name] = float(unit.si(value, f"until: {name}")) if UNITS[name] else float(value)
    return replace(plan, until=limits)
