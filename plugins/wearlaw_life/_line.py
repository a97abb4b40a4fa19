"""The operating states of a line, and the wear that they cause across a profile."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, nullcontext
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw.settings.caught_warnings import caught_warnings
from wearlaw_life._removal import Profile
from wearlaw_sweeps.points import Points
from wearlaw_sweeps.sweep import weight
from wearlaw_sweeps.tables import from_table

SUM = 1e-6
"""Deviation of the sum of the shares from one that is rounding of the numbers in a table."""

STEEPEST = 1e-6
"""Difference in the angle of a flank that is straight but for rounding [rad]."""


class Wear(NamedTuple):
    """Wear of the two sides of a body per metre rolled, or per passage of a rail, weighted by share.

    Attributes
    ----------
    depth : ndarray, (sides, positions)
        Depth normal to the profile [m per metre or passage].
    mass : ndarray, (sides,)
        Mass of a wheel [kg/m], or of a metre of rail [kg/m per passage].
    """

    depth: Array
    mass: Array


class Line(NamedTuple):
    """Operating states with their shares of the distance.

    Attributes
    ----------
    points : Points
        The conditions, a row for each state.
    share : ndarray, (states,)
        Shares, which sum to one.
    """

    points: Points
    share: Array


@contextmanager
def read_line(
    predict: wl.Pipeline[...],
    table: Any,
    share: str,
    columns: Mapping[str, str] | None,
    conditions: Mapping[str, Any],
    on_disk: Path | None,
    progress: bool,
) -> Iterator[Line]:
    """Give the states of a table or file; with a path `on_disk`, the numbers of a file are kept beside it.

    Raises
    ------
    DataError
        If the table is wrong, has no column with the shares, or they do not sum to one.
    """
    if not isinstance(share, str):
        raise wl.InputError(f"share: must be the name of the column with the shares, got {wl.shown(share)}")
    with ExitStack() as stack:
        keep, check = {"share": share}, predict.rig.check_names
        try:
            points = stack.enter_context(
                from_table(
                    table, conditions, columns=columns, keep=keep, check=check, on_disk=on_disk, progress=progress
                )
            )
        except wl.DataError as error:
            if "there is no column" in str(error):
                error.add_note('The line needs a column with the share of each state; name it, as in share="share"')
            raise
        kept = points.kept["share"]
        shares = np.asarray(kept.values[0 : kept.values.size])
        if kept.unit is not None:
            shares = wl.coefficient(wl.Q(shares, kept.unit), share)
        _check_shares(shares, share)
        yield Line(points, shares)


def _check_shares(shares: Array, name: str) -> None:
    """Raise an error unless shares are of one whole."""
    wrong = np.flatnonzero(~(shares >= 0.0))
    if wrong.size:
        row = int(wrong[0])
        raise wl.DataError(
            f"line, row {row}: {name} must be a share of the distance, zero or more, got {shares[row]:g}"
        )
    total = float(shares.sum())
    if abs(total - 1.0) > SUM:
        percent = "; are they in percent? Name the column with its unit, as in 'share [%]'"
        advice = percent if abs(total - 100.0) < 100.0 * SUM else f"; divide the column by {total:.6g}"
        raise wl.DataError(f"line: the shares in {wl.shown(name)} must add up to 1, but add up to {total:.6g}{advice}")


def wear_of(
    predict: wl.Pipeline[...], line: Line, body: str, at: Array, quiet: bool, flank: float | None = None
) -> Wear:
    """Return the wear of a body at positions of its profile, over all states of a line, block by block.

    Parameters
    ----------
    predict : Pipeline
    line : Line
    body : str
    at : ndarray, (positions,)
        Arc lengths of the body's profile [m].
    quiet : bool
        Whether the warnings of predictions were given before.
    flank : float, optional
        Arc length of the steepest place of a wheel's flange [m]; a state whose first patch lies beyond it climbs.

    Raises
    ------
    ConditionsError
        If a state has no result, or its wheel climbs; the message names the row.
    """
    points = line.points
    total: Wear | None = None
    for block in points.blocks():
        part, share = points.part(block.slices), line.share[block.slices[0]]
        first = block.flat.start
        problem = _posed(part, predict.posed, first)
        _check(problem, part, body, flank, first)
        with caught_warnings() if quiet else nullcontext():
            found = predict.predict(problem, stacklevel=5)
            across = found.wear_profile(body, at=wl.Q(1e3 * at, "mm"))["depth"]
        depth = wl.Q(across.values, across.attrs["units"]).m_as("m/m" if "/" in across.attrs["units"] else "m")
        mass = np.asarray(found.mass_lost("1 m", body).m_as("kg"))
        if "patch" in problem.dims:
            mass = np.nansum(mass, axis=-1)
        wear = Wear(*(np.tensordot(share, one, axes=1) for one in (depth, mass)))
        total = wear if total is None else Wear(*(one + other for one, other in zip(total, wear, strict=True)))
    assert total is not None
    depth, mass = total
    sides = depth.ndim == 2
    return Wear(depth if sides else depth[None], np.atleast_1d(mass))


def weighted(line: Line, problem: wl.Problem) -> Line:
    """Return the line with blocks in proportion to the patches and strips of a state."""
    return Line(dataclasses.replace(line.points, weight=weight(problem)), line.share)


def first_state(predict: wl.Pipeline[...], line: Line) -> wl.Problem:
    """Return the problem of the first state."""
    return _posed(line.points.part([slice(0, 1)]), predict.rig.checked_problem, 0)


def _posed(part: Points, pose: Callable[[Mapping[str, Any]], wl.Problem], first: int) -> wl.Problem:
    """Return the problem of states; an error names the first row that is wrong by itself, found by halving."""
    with caught_warnings():  # a state that climbs or jams is an error here
        try:
            return pose(part.conditions())
        except wl.ConditionsError as error:
            low, high = 0, part.size
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (low, middle) if _fails(part, pose, low, middle) else (middle, high)
            if not _fails(part, pose, low, high):  # wrong for every row, such as a condition that is missing
                raise
            raise type(error)(f"{_row(part, low, first)}: {error}") from None


def _fails(part: Points, pose: Callable[[Mapping[str, Any]], wl.Problem], start: int, stop: int) -> bool:
    try:
        pose(part.part([slice(start, stop)]).conditions())
    except wl.ConditionsError:
        return True
    return False


def _row(part: Points, row: int, first: int) -> str:
    """Return a state in a message: its row, counted from zero, and its conditions."""
    values = ", ".join(
        f"{name} = {one.values[row]:.4g} {one.unit or ''}".rstrip() for name, one in part.varying.items()
    )
    return f"line, row {first + row} ({values})"


def _check(problem: wl.Problem, part: Points, body: str, flank: float | None, first: int) -> None:
    """Raise an error for a state without a result, or whose wheel climbs."""
    if problem.exists is None or "patch" not in problem.dims:
        return
    lost = _rows(~problem.exists.any(axis=-1))
    if lost.size:
        raise wl.ConditionsError(
            f"{_row(part, int(lost[0]), first)}: no normal forces balance this state, as where friction holds a flange"
            f" ({lost.size} of {part.size} states); leave it out, and divide the shares by the sum of those that stay"
        )
    place = problem.body(body).profile_position
    if flank is None or place is None:
        return
    with np.errstate(invalid="ignore"):
        over = _rows(np.asarray(place)[..., 0] < flank)
    if over.size:
        raise wl.ConditionsError(
            f"{_row(part, int(over[0]), first)}: the wheel climbs its rail, beyond the steepest place of its flange"
            f" ({over.size} of {part.size} states); its wear there is none of service. Correct the state or leave it"
            " out, and divide the shares by the sum of those that stay"
        )


def _rows(wrong: Any) -> NDArray[np.intp]:
    """Return the rows in which any side is wrong."""
    wrong = np.asarray(wrong)
    return np.flatnonzero(wrong.reshape(wrong.shape[0], -1).any(axis=-1))


def flank_of(profile: Profile) -> float | None:
    """Return the arc length of the steepest place of a wheel's flange, or of its end towards the top [m]."""
    curve = profile.curve
    if profile.kind != "wheel":
        return None
    tip = int(np.argmax(curve.z))
    angle = curve.angle[tip:]
    steep = int(np.argmax(angle <= angle.min() + STEEPEST))
    return float(curve.s[tip + steep])
