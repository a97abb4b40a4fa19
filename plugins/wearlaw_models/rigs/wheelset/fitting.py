"""Whether the profiles of wheels and rails fit each other in a rig."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

import wearlaw as wl
from wearlaw_models.rigs.wheelset import doubts
from wearlaw_models.rigs.wheelset.geometry import patches
from wearlaw_models.rigs.wheelset.profile import Profile
from wearlaw_models.rigs.wheelset.search import Section, both_sides, searched

FLANGE_DEPTH = 10e-3
"""Depth below the taping line at which the thickness of a flange is measured (EN 15313) [m]."""

FLANGE_SLOPE = np.radians(50.0)
"""A wheel has a flange if its profile is steeper than this; those in use have 60 to 75 degrees [rad]."""

MOST_PLAY = 40e-3
"""Greatest distance between flange and rail in the middle of the track [m]: a worn flange in a widened curve has 30."""


def check_fit(
    profiles: Mapping[str, Profile], section: Section, *, cant: float, radius: float,
    back: tuple[wl.Quantity, wl.Quantity], gauge: wl.Quantity, flange_angle: float,
) -> None:  # fmt: skip
    """Raise an error if wheels do not fit the rails, and warn of profiles that hardly do.

    Parameters
    ----------
    profiles : dict of str to Profile
        Profiles by the fields of the rig.
    section : Section
    cant, radius : float
        Cant of the rails [rad] and nominal radius of the wheels [m].
    back : tuple of Quantity
        Place of the inner face in the wheel's profile, and distance between the inner faces.
    gauge : Quantity
    flange_angle : float
        Contact angle of a flange [rad].

    Raises
    ------
    ValueError
        By the faults of profiles if there are any.
    """
    for name, profile in profiles.items():
        if profile.kind != (kind := name.removeprefix("left_")):
            raise ValueError(f"{name} is the profile of a {profile.kind}; give that of a {kind}")
        for text in _unlikely(profile, cant, radius, wl.scalar_si(back[0], "m")):
            wl.errors.warn(f"{name}: {text}", wl.UnusualWarning)
    play = _play(profiles["wheel"], section, radius, wl.scalar_si(gauge, "m"))
    straight = np.zeros(1)
    if play is not None and not 0.0 < play < MOST_PLAY:
        misfit = (
            f"gauge: rails {gauge!r} apart leave the flanges {1e3 * play:.4g} mm on either side, of wheels {back[1]!r}"
            f" apart between their inner faces; they must leave 0 to {1e3 * MOST_PLAY:g} mm"
        )
    else:
        roll, touching = searched(section, straight, straight)
        angle = patches(section, both_sides(straight, roll, straight), touching)["contact_angle"][0, :, 0]
        if np.abs(angle).max() <= flange_angle:  # NaN without contact
            return
        misfit = (
            "gauge: in the middle of the track the wheels stand on their flanges or beside the rails; wheels"
            f" {back[1]!r} apart between their inner faces do not fit rails {gauge!r} apart"
        )
    faults = [f"{name}: {fault}" for name, profile in profiles.items() for fault in _faults(profile, cant)]
    raise ValueError("; ".join(faults) or misfit)


def _play(wheel: Profile, section: Section, radius: float, gauge: float) -> float | None:
    """Return the distance from the right flange to the rail in the middle of the track [m]; None without a flange."""
    deep = np.flatnonzero(section.wheel_radius.value > radius + FLANGE_DEPTH)
    if not deep.size or wheel.curve.angle.min() > -FLANGE_SLOPE:
        return None
    return 0.5 * gauge - float(section.wheel_y.value[deep[-1]])


def _unlikely(profile: Profile, cant: float, radius: float, back: float) -> Iterator[str]:
    """Yield what is unlikely about a profile with a cant [rad], a radius and a place of the back [m]."""
    yield from _of_ends(profile, cant)
    if profile.kind == "rail" and not profile._worn:
        yield from doubts.of_lean(wl.scalar_si(profile.apparent_cant, "rad"), cant)
    if profile.kind == "wheel":
        yield from doubts.of_back(profile.curve, back)
        if profile.diameter is not None:
            yield from doubts.of_radius(radius, profile.curve, wl.scalar_si(profile.diameter, "m"))


def _faults(profile: Profile, cant: float) -> Iterator[str]:
    """Yield why a profile may not fit others, beside their distances; the cant is that of a rail [rad]."""
    yield from _of_ends(profile, cant)
    if profile.kind == "wheel":
        yield from doubts.of_height(profile.curve)


def _of_ends(profile: Profile, cant: float) -> Iterator[str]:
    yield from doubts.of_ends(profile.curve, cant if profile.kind == "rail" else 0.0, profile._near)
