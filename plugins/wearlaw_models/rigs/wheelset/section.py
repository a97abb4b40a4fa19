"""The section of a report about a wheelset: contact points, forces, and wear across both profiles."""

from __future__ import annotations

import warnings

import numpy as np
import pandas as pd

import wearlaw as wl
from wearlaw_models.rigs.wheelset.rig import Wheelset

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
            predictions = {
                pair.label: pair.pipeline(**study.conditions(profile=name))
                for pair in study.pairs
                if pair.pipeline.scale == "cells"
            }
        if not predictions:
            continue
        first = next(iter(predictions.values()))
        tables[f"patches_of_{name}"] = _table(first)
        figures += rig.profile_figures(predictions, name)
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
    dataset = rig.geometry(lateral_displacement=wl.Q(there, "mm")).dataset
    across = dataset["lateral_displacement"].values
    x = wl.PlotAxis("lateral displacement [mm]")
    radius = wl.Curve("right minus left", across, dataset["rolling_radius_difference"].values, points=True, hollow=True)
    angles = [
        wl.Curve(f"right wheel, patch {patch}", across, dataset["contact_angle"].sel(side="right", patch=patch).values,
                 colour=number, points=True, hollow=True)
        for number, patch in enumerate(dataset["patch"].values)
        if dataset["contact_angle"].sel(side="right", patch=patch).notnull().any()
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


def _table(prediction: wl.Prediction) -> pd.DataFrame:
    """Return the existing patches in rows."""
    exists = prediction.problem.exists
    assert exists is not None
    place = np.nonzero(exists)
    sides, patches = (prediction.problem.dims[name] for name in ("side", "patch"))
    rows: dict[str, object] = {
        "side": [sides[index] for index in place[-2]],
        "patch": [patches[index] for index in place[-1]],
    }
    radius = np.asarray(prediction.problem.body("wheel").rolling_radius)
    rows["rolling radius [mm]"] = 1e3 * radius[place]
    for name, unit in COLUMNS.items():
        rows[f"{name.replace('_', ' ')} [{unit}]"] = prediction[name].to(unit).magnitude[place]
    return pd.DataFrame(rows)
