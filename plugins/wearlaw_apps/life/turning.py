"""Turning worn wheels on a lathe: the cut that restores their profile, and the diameter that is left."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

import wearlaw as wl
from wearlaw_apps.life.life import SIDES
from wearlaw_apps.life.steps import DIAMETER, State, Steps

if TYPE_CHECKING:
    from wearlaw_models.rigs.wheelset import Profile


def least_cut(new: Profile, worn: Profile) -> float:
    """Return the least radial shift of a new profile at which it lies nowhere outside the worn one [m].

    It is taken from the top of the flange outwards: lathes do not cut the back of a flange. Wear along the normal of a
    flank at an angle δ takes 1/cos δ times its depth, so that a thin flange costs diameter.
    """
    outer = slice(int(np.argmax(new.curve.z)), None)
    y, z = new.curve.y[outer], new.curve.z[outer]
    there = (y >= worn.curve.y[0]) & (y <= worn.curve.y[-1])
    return float((z - np.interp(y, worn.curve.y, worn.curve.z))[there].max())


def turned(steps: Steps, now: State) -> State:
    """Return the state after a cut that restores the first profiles, on both wheels at one diameter."""
    rig: Any = now.predict.rig
    cut = max(least_cut(new, worn) for new, worn in zip(steps.new, now.profiles, strict=True))
    radius = wl.Q(1e3 * (wl.scalar_si(rig.nominal_radius, "m") - cut), "mm")
    predict = now.predict.model_copy(update={"rig": rig.model_copy(update={"nominal_radius": radius})})
    return steps.begin(predict, now)


def turns(rig: Any, body: str, until: Mapping[str, Any], turn: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the limits at which a body is turned, if it can be.

    Raises
    ------
    InputError
        If it is no wheel with a nominal radius, or a measure also ends the life.
    """
    if turn and (body != "wheel" or not hasattr(rig, "nominal_radius")):
        raise wl.InputError(f"turn: the {body} of rig {rig.name!r} has no nominal radius to turn to; leave it out")
    if twice := sorted(turn.keys() & until):
        raise wl.InputError(f"turn: {twice[0]} is also in `until`, which ends the life there; keep one")
    return turn


def cut_of(
    limit: str, last: Mapping[str, float], before: Mapping[str, float], after: Mapping[str, float]
) -> dict[str, Any]:
    """Return the row of a cut in `Life.cuts`, from the measures after the last cut, and before and after this one."""
    along, *_ = before
    row: dict[str, Any] = {along: before[along], "since_last [km]": before[along] - last[along], "limit": limit}
    for end in SIDES[1 if DIAMETER in before else 2]:
        column = DIAMETER.replace(" ", f"{end} ")
        row[f"depth_of_cut{end} [mm]"] = 0.5 * (before[column] - after[column])
        row[f"diameter_lost{end} [mm]"] = last[column] - after[column]
        row[column] = after[column]
    return row
