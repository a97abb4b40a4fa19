"""The free motion of a wheelset after Klingel, as a table of states."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import scipy
from numpy.typing import ArrayLike, NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.conicity import wave
from wearlaw_models.rigs.wheelset.geometry import patches
from wearlaw_models.rigs.wheelset.guidance import FARTHEST
from wearlaw_models.rigs.wheelset.rig import Wheelset
from wearlaw_models.rigs.wheelset.search import both_sides, searched

POSITIONS = 801
"""Displacements at which rigid wheels have their radii, within the clearance."""

LOADED = 41
"""Displacements at which wheels have their radii under load."""

COARSE = 0.25e-3
"""Distance of the displacements between which the clearance is looked for [m]."""


def free_motion(
    rig: Any,
    *,
    amplitudes: wl.QuantityLike,
    shares: ArrayLike,
    phases: int = 8,
    vertical_load: wl.QuantityLike | None = None,
) -> pd.DataFrame:
    """Return the states of a free wheelset that follows Klingel's waves, as a table for `wearlaw.wear_out`.

    The wheelset moves as y'' = ψ', with ψ = y', so that it rolls without creeping at the rigid points of contact:
    ψ' = -Δr/(2 e r0), with the rolling radius difference Δr and half the distance e of the contact points at y. Spin,
    and the differences of the radius within a patch, remain. The wheels have no mass, and no suspension holds them.

    Parameters
    ----------
    rig : Wheelset
        It gives the profiles and the speed.
    amplitudes : Quantity or str
        Amplitudes of the lateral displacement, (waves,) [m].
    shares : array_like of float, (waves,)
        Share of the distance with each amplitude [-].
    phases : int
        States of each wave, spread evenly over the phase θ of y = y_m + ŷ sin θ. Each has the share of the distance in
        which the phase is near it.
    vertical_load : Quantity or str, optional
        Load of each wheel with which Δr is that of the loaded patches, each row with its radius weighted by its force
        [N]. By default Δr is that of rigid wheels, which jumps where contact does, so that loaded wheels creep in waves
        that are small beside the jump.

    Returns
    -------
    pandas.DataFrame
        Lateral displacement [mm], yaw [mrad], their velocities [m/s] and [rad/s], and the share of the distance.

    Raises
    ------
    InputError
        If an amplitude is beyond the clearance, within which neither wheel touches with its flange, or the rolling
        radii do not steer the wheelset back.

    Notes
    -----
    Source: J. Klingel, Organ für die Fortschritte des Eisenbahnwesens 20 (1883) 113-123.
    """
    if not isinstance(rig, Wheelset):
        raise wl.InputError(f"rig: free motion is that of a wheelset, got {wl.shown(rig)}")
    if phases < 2:
        raise wl.InputError(f"phases: must be at least 2, got {phases}")
    waves = np.atleast_1d(wl.Unit("mm").si(amplitudes, "amplitudes"))
    share = np.atleast_1d(np.asarray(shares, np.float64))
    if waves.ndim > 1 or share.shape != waves.shape:
        raise wl.InputError(f"shares: give one for each amplitude, got {share.shape} for {waves.shape}")
    y, turning = _turning(rig, vertical_load)
    theta = 2.0 * np.pi * (np.arange(phases) + 0.5) / phases
    speed, rows = wl.scalar_si(rig.rolling_speed, "m/s"), []
    for amplitude, part in zip(waves, share, strict=True):
        reach = 0.5 * (y[-1] - y[0])
        if amplitude > reach:
            raise wl.InputError(
                f"amplitudes: {1e3 * amplitude:.4g} mm is beyond the clearance of {1e3 * reach:.4g} mm: flanges touch"
                f" at lateral displacements of {1e3 * y[0]:.4g} and {1e3 * y[-1]:.4g} mm"
            )
        place, stiffness = wave(y, turning, amplitude, theta)
        yaw = amplitude * np.cos(theta) * np.sqrt(stiffness)
        rate = -speed * np.interp(place, y, turning)
        distance = 1.0 / np.sqrt(stiffness)  # ds = dy/y'
        rows.append([1e3 * place, 1e3 * yaw, speed * yaw, rate, part * distance / distance.sum()])
    heads = ("lateral_displacement [mm]", "yaw [mrad]", "lateral_velocity [m/s]", "yaw_velocity [rad/s]", "share")
    return pd.DataFrame(dict(zip(heads, np.concatenate(rows, axis=1), strict=True)))


def _turning(rig: Wheelset, vertical_load: wl.QuantityLike | None) -> tuple[Array, Array]:
    """Return displacements within the clearance [m], and the yaw -ψ' at which both wheels roll without creeping [1/m].

    Without creepage Ω r/V = 1 ∓ ψ' b, with the distance b of the contact point from the middle of the axle.
    """
    every = np.arange(-FARTHEST, FARTHEST, COARSE)
    low, high = every[_clear(rig, every)][[0, -1]]
    y = np.linspace(low - COARSE, high + COARSE, POSITIONS)
    y = y[_clear(rig, y)]
    first = {name: values[..., 0] for name, values in _rigid(rig, y).items()}
    radius, lever = first["rolling_radius"], np.abs(first["y"] - y[:, None])
    if vertical_load is not None:
        few = np.linspace(y[0], y[-1], LOADED)
        # Without creep forces, for which the friction would count.
        loaded = rig.problem(lateral_displacement=wl.Q(few, "m"), vertical_load=vertical_load, friction_coefficient=0.3)
        force = np.nan_to_num(loaded.normal_force)
        of_wheels = (force * np.nan_to_num(loaded.bodies["wheel"].rolling_radius)).sum(axis=-1) / force.sum(axis=-1)
        radius = scipy.interpolate.PchipInterpolator(few, of_wheels)(y)
    return y, (radius[:, 1] - radius[:, 0]) / (radius * lever[:, ::-1]).sum(axis=-1)


def _clear(rig: Wheelset, y: Array) -> NDArray[np.bool_]:
    """Return whether displacements are those around the middle of the track where no flange touches."""
    steep = ~(np.abs(_rigid(rig, y)["contact_angle"][..., 0]).max(axis=-1) <= wl.scalar_si(rig.flange_angle, "rad"))
    bounds = np.flatnonzero(steep)  # NaN without contact is one, too
    middle = int(np.searchsorted(y, 0.0))
    inside = np.arange(y.size)
    low, high = bounds[bounds < middle].max(initial=-1), bounds[bounds >= middle].min(initial=y.size)
    return np.asarray((inside > low) & (inside < high))


def _rigid(rig: Wheelset, y: Array) -> dict[str, Array]:
    """Return where rigid wheels touch without yaw, as in `patches`."""
    straight = np.zeros_like(y)
    roll, touching = searched(rig._section, y, straight)
    return patches(rig._section, both_sides(y, roll, straight), touching)
