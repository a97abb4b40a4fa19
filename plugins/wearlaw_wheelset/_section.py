"""The section of a report about a wheelset: contact points, forces, and wear across both profiles."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import numpy as np
import pandas as pd

import wearlaw as wl
from wearlaw import Array
from wearlaw_wheelset._pictures import APART
from wearlaw_wheelset._rig import Wheelset

STEP = 0.25
"""Distance between positions of wear along a profile [mm]."""

SHOWN = (-20.0, 16.0)
"""Heights that pictures of contact points show [mm]."""

COLUMNS = {
    "contact_angle": "deg",
    "normal_force": "kN",
    "max_pressure": "MPa",
    "longitudinal_force": "kN",
    "lateral_force": "kN",
    "spin": "1/m",
    "wear_index": "N",
}
"""Variables of the table of patches, with their units."""

DISPLACEMENTS = np.linspace(-8.0, 8.0, 321)
"""Lateral displacements of the figure of geometry [mm]."""


def section(study: wl.Study) -> wl.Section:
    """Return the section about the wheelset of a study, with the operating points of its profiles.

    Raises
    ------
    InputError
        If the rig of the case is not a wheelset.
    """
    rig = study.case.rig
    if not isinstance(rig, Wheelset):
        raise wl.InputError(f"the section 'wheelset' is about wheelsets; the rig of the case is '{rig.name}'")
    figures, tables = [_geometry(rig)], {}
    for name in study.case.profiles:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wl.WearlawWarning)  # the profiles of the study have said them
            found = {
                pair.label: pair.pipeline(**study.conditions(profile=name))
                for pair in study.pairs
                if pair.pipeline.scale == "cells"
            }
        if not found:
            continue
        first = next(iter(found.values()))
        tables[f"patches_{name}"] = _table(first)
        figures += profile_figures(rig, found, name)
    return wl.Section(
        title="The wheelset on its rails",
        text="Patch 1 of a wheel is the one that touches first. y runs to the right and z down. Forces act from the"
        " wheel on the rail. The loads of the patches balance the creep forces, and the wheelset turns at the speed at"
        " which they balance the torque on the axle.\n\n"
        "Depths are normal to the surface, summed over the patches of a wheel: per distance rolled for the wheel, and"
        " per passage of the wheel for the rail.",
        tables=tables,
        figures=tuple(figures),
    )


def _geometry(rig: Wheelset) -> wl.FigureData:
    """Return rolling radius difference and contact angle of rigid wheels."""
    there = DISPLACEMENTS[rig.on_rails(1e-3 * DISPLACEMENTS)]
    found = rig.geometry(lateral_displacement=wl.Q(there, "mm")).dataset
    across = found["lateral_displacement"].values
    x = wl.PlotAxis("lateral displacement [mm]")
    radius = wl.Curve("right minus left", across, found["rolling_radius_difference"].values, points=True, hollow=True)
    angles = [
        wl.Curve(f"right wheel, patch {patch}", across, found["contact_angle"].sel(side="right", patch=patch).values,
                 colour=number, points=True, hollow=True)
        for number, patch in enumerate(found["patch"].values)
        if found["contact_angle"].sel(side="right", patch=patch).notnull().any()
    ]  # fmt: skip
    conicity = rig.equivalent_conicity(amplitude=wl.Q(3.0, "mm"))
    return wl.FigureData(
        name="rolling_radius_difference",
        title="Geometry of contact, without load",
        panels=(
            wl.Panel(x, wl.PlotAxis("rolling radius difference [mm]"), (radius,)),
            wl.Panel(x, wl.PlotAxis("contact angle [deg]"), tuple(angles)),
        ),
        caption="Rigid wheels and rails, no yaw. The equivalent conicity at 3 mm is"
        f" {conicity.magnitude:.3f}, after Klingel's equation.",
    )


def profile_figures(rig: Wheelset, found: Mapping[str, wl.Prediction], name: str) -> tuple[wl.FigureData, ...]:
    """Return the figures of the contacts on the profiles and of the wear along them; see `Wheelset.profile_figures`."""
    return _contact(rig, name, next(iter(found.values()))), _wear(rig, name, found)


def _contact(rig: Wheelset, name: str, found: wl.Prediction) -> wl.FigureData:
    """Return both wheels above their rails, with lines between places that touch."""
    profiles = rig.profiles_in_track()
    panels = []
    for index, side in enumerate(("left", "right")):
        sign = (-1.0, 1.0)[index]
        here = found.sel(side=side)
        wheel, rail = (np.asarray(here.problem.body(body).profile_position) for body in ("wheel", "rail"))
        ends = []
        for one, other in zip(np.ravel(wheel), np.ravel(rail), strict=True):
            if np.isfinite(one):
                ends.append((*profiles.at("wheel", one), *profiles.at("rail", other)))
        lines = (
            np.array([[a, c, np.nan] for a, _, c, _ in ends]).ravel(),
            np.array([[b - 1e-3 * APART, d, np.nan] for _, b, _, d in ends]).ravel(),
        )
        panels.append(
            wl.Panel(
                wl.PlotAxis("y, to the right [mm]"),
                wl.PlotAxis("z, down [mm]", ends=SHOWN, inverted=True),
                (
                    wl.Curve("wheel", sign * 1e3 * profiles.wheel_y, 1e3 * profiles.wheel_z - APART, colour=6),
                    wl.Curve("rail", sign * 1e3 * profiles.rail_y, 1e3 * profiles.rail_z, colour=6, dash=1),
                    wl.Curve("lines between places that touch", sign * 1e3 * lines[0], 1e3 * lines[1], dash=2),
                ),
                f"{side} wheel",
                equal=True,
            )
        )
    return wl.FigureData(
        name=f"contact_{name}",
        title=f"Contact points: {name}",
        panels=tuple(panels),
        caption=f"Wheel and rail are drawn {APART:g} mm apart in the middle of the track; lines join the middles of the"
        " patches.",
    )


def _wear(rig: Wheelset, name: str, found: Mapping[str, wl.Prediction]) -> wl.FigureData:
    """Return the depth that both wheels and rails lose along their profiles."""
    panels = []
    for body in ("wheel", "rail"):
        for side in ("left", "right"):
            curves, unit = [], ""
            for number, (label, prediction) in enumerate(found.items()):
                at = _positions(rig, body)
                worn = prediction.sel(side=side).wear_profile(body, at=wl.Q(at, "mm"))["depth"]
                unit = worn.attrs["units"]
                curves.append(wl.Curve(label, at, np.ravel(worn.values), colour=number, dash=number))
            per = "" if body == "wheel" else " per passage"
            panels.append(
                wl.Panel(
                    wl.PlotAxis(f"position along the profile of the {body} [mm]"),
                    wl.PlotAxis(f"depth{per} [{unit}]".replace("um", "µm")),
                    tuple(curves),
                    f"{side} {body}",
                )
            )
    return wl.FigureData(
        name=f"wear_{name}", title=f"Wear along the profiles: {name}", panels=tuple(panels),
        caption="The flange of a wheel and the gauge side of a rail are at negative positions.",
    )  # fmt: skip


def _positions(rig: Wheelset, body: str) -> Array:
    """Return positions along the part of a profile on which contact is looked for [mm]."""
    profiles = rig.profiles_in_track()
    arc = profiles.wheel_arc if body == "wheel" else profiles.rail_arc
    return np.arange(1e3 * arc[0], 1e3 * arc[-1], STEP)


def _table(found: wl.Prediction) -> pd.DataFrame:
    """Return the existing patches in rows."""
    exists = found.problem.exists
    assert exists is not None
    place = np.nonzero(exists)
    sides, patches = (found.problem.dims[name] for name in ("side", "patch"))
    rows: dict[str, object] = {
        "side": [sides[index] for index in place[-2]],
        "patch": [patches[index] for index in place[-1]],
    }
    radius = np.asarray(found.problem.body("wheel").rolling_radius)
    rows["rolling radius [mm]"] = 1e3 * radius[place]
    for name, unit in COLUMNS.items():
        rows[f"{name.replace('_', ' ')} [{unit}]"] = found[name].to(unit).magnitude[place]
    return pd.DataFrame(rows)
