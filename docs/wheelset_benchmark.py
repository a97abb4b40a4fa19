"""Writes the table of wheelsets beside CONTACT, in the Manchester benchmark A-2.2.

`python -m docs.wheelset_benchmark` does so. Differences are those of wearlaw less CONTACT, in CONTACT's signs.
"""

import csv
import io
import warnings
from pathlib import Path
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import wearlaw as wl
from wearlaw import Array, Q
from wearlaw_apps.output.style import PAGE, PALETTE, STYLE

FOLDER = Path(__file__).parent / "wheelset-benchmark"
DATA = Path(__file__).parents[1] / "tests" / "data"
SIDES = ("left", "right")
Patch = Literal["strips", "ellipse"]
PATCHES: tuple[Patch, ...] = ("strips", "ellipse")

STEPS = 0.5 * np.arange(21)
"""Lateral displacements of the benchmark [mm]."""

JUMPS = {("left", 0.0), ("right", 0.0), ("right", 0.5), ("right", 5.0)}
"""Wheels and displacements [mm] at which the point of contact jumps, or is about to."""

FLANGE = 0.2
"""Contact angle beyond which the tables speak of the flange [rad]."""

Rows = list[tuple[str, ...]]


def wheelset(patch: Patch = "strips", speed: float = 2.0) -> wl.Wheelset:
    """Return the wheelset of the benchmark at a speed [m/s]."""
    steel = wl.Material(youngs_modulus="209.92 GPa", poisson_ratio=0.28, density="7850 kg/m^3")  # G is 82 GPa
    return wl.Wheelset(
        wheel=wl.Profile.s1002(),
        rail=wl.Profile.uic60(),
        nominal_radius="460 mm",
        flange_back_distance="1360 mm",
        gauge="1435 mm",
        rail_cant="1:40",
        material=steel,
        rolling_speed=Q(speed, "m/s"),
        patch=patch,
    )


def benchmark(patch: Patch) -> dict[str, Array]:
    """Return the results of wearlaw in CONTACT's signs and units, of shape (cases, sides, patches)."""
    return solved(
        wheelset(patch),
        lateral_displacement=Q(STEPS, "mm"),
        yaw=Q(2.4 * STEPS, "mrad"),
        angular_speed=Q(reference()["rotation"][:, 0], "rad/s"),
    )


def two_patches(patch: Patch) -> dict[str, Array]:
    """Return the results of the cases with two patches, of shape (cases, sides, patches)."""
    return solved(
        wheelset(patch, 30.0),
        lateral_displacement=Q([5.1, 6.4], "mm"),
        yaw=Q([0.0, 24.0], "mrad"),
        roll="0 mrad",
        angular_speed=Q(30.0 / 0.46, "rad/s"),
    )


def solved(rig: wl.Wheelset, **conditions: Any) -> dict[str, Array]:
    """Return results under 10 kN at a friction coefficient of 0.3, in CONTACT's signs and units."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)  # from 6.5 mm on the wheel climbs
        r = (rig | wl.contact_model("fastsim"))(vertical_load="10 kN", friction_coefficient=0.3, **conditions)
    radius = np.asarray(r.problem.bodies["wheel"].rolling_radius)
    speed = rig.rolling_speed.m_as("m/s")
    rotation = np.broadcast_to(conditions["angular_speed"].m_as("rad/s"), radius.shape[:1])[:, None, None]
    # CONTACT's creepages are those of the rail less the wheel, over the mean of the speeds of rail and wheel
    share = -speed / (0.5 * (speed + rotation * radius))
    return {
        "y": 1e3 * in_track(rig, np.asarray(r.problem.bodies["rail"].profile_position)),
        "delta": r.contact_angle.m_as("rad"),
        "xi": share * r.creepage.m_as(""),
        "eta": share * r.lateral_creepage.m_as(""),
        "phi": share * r.spin.m_as("1/mm"),
        "fn": r.normal_force.m_as("N"),
        "fx": r.longitudinal_force.m_as("N"),
        "fs": r.lateral_force.m_as("N"),
        "mn": r.spin_moment.m_as("N*mm"),
        "pmax": r.max_pressure.m_as("MPa"),
        "power": -speed * r.wear_index.m_as("N"),
    }


def in_track(rig: wl.Wheelset, arc: Array) -> Array:
    """Return y in the track of places on the rails, by their arc lengths [m]; the arrays end in side and patch."""
    cant, rail = rig.rail_cant.m_as("rad"), rig.rail.curve
    across = rail.y * np.cos(cant) + rail.z * np.sin(cant)
    touched = rig.geometry(lateral_displacement="0 mm").dataset.sel(side="right", patch=1)
    middle = 1e-3 * float(touched.y) - float(np.interp(1e-3 * float(touched.rail_position), rail.s, across))
    place: Array = (middle + np.interp(arc, rail.s, across)) * np.array([-1.0, 1.0])[:, None]
    return place


def blended(found: dict[str, Array]) -> dict[str, Array]:
    """Return one patch for each wheel: sums of forces and powers, the largest pressure, and means weighted with N."""
    force = found["fn"]
    share = force / np.nansum(force, axis=-1, keepdims=True)
    whole = {name: np.nansum(share * array, axis=-1) for name, array in found.items()}
    whole |= {name: np.nansum(found[name], axis=-1) for name in ("fn", "fx", "fs", "mn", "power")}
    return whole | {"pmax": np.nanmax(found["pmax"], axis=-1), "patches": np.isfinite(force).sum(axis=-1)}


def reference() -> dict[str, Array]:
    """Return CONTACT's results of the benchmark, of shape (cases, sides)."""
    table = pd.read_csv(DATA / "manchester_a22.csv", comment="#")
    return {name: np.stack([table[name][table.side == side] for side in SIDES], axis=-1) for name in map(str, table)}


DIFFERENCES = {
    "y [mm]": ("y", 1.0, 2),
    "δ [mrad]": ("delta", 1e3, 1),
    "ξ [10⁻⁵]": ("xi", 1e5, 1),
    "η [%]": ("eta", None, 1),
    "φ [%]": ("phi", None, 1),
    "N [%]": ("fn", None, 1),
    "p_max [%]": ("pmax", None, 1),
    "power [%]": ("power", None, 1),
}
"""Heads of the columns of differences: the result, the factor of its unit, or None for percent, and the digits."""


def differences(patch: Patch) -> dict[str, Array]:
    """Return the differences by their heads, of shape (cases, sides)."""
    ours, contact = blended(benchmark(patch)), reference()
    return {head: difference(ours[name], contact[name], factor) for head, (name, factor, _) in DIFFERENCES.items()}


def difference(ours: Array, contact: Array, factor: float | None) -> Array:
    """Return the difference, in percent of CONTACT's value without a factor; NaN where that value is zero."""
    if factor is not None:
        return (ours - contact) * factor
    return 100.0 * (ours - contact) / np.where(contact == 0.0, np.nan, contact)


def summary() -> Rows:
    """Return the largest differences away from jumps, on the tread and on the flange."""
    at_jump = np.array([[(side, displacement) in JUMPS for side in SIDES] for displacement in STEPS])
    flange = np.abs(reference()["delta"]) > FLANGE
    rows: Rows = [("contact on", "`patch`", "wheels", *DIFFERENCES)]
    for place, there in (("tread", ~flange & ~at_jump), ("flange", flange & ~at_jump)):
        for patch in PATCHES:
            found = differences(patch)
            most = (
                f"{np.nanmax(np.abs(found[head][there])):.{digits}f}" for head, (_, _, digits) in DIFFERENCES.items()
            )
            rows.append((place, f"`{patch}`", f"{np.count_nonzero(there)}", *most))
    return rows


def predicted(displacement: Array) -> wl.Prediction:
    """Return the contact at displacements [mm] of the benchmark, at the speed of the mean rolling radius."""
    predict = wheelset() | wl.contact_model("fastsim")
    given: dict[str, Any] = {"lateral_displacement": Q(displacement, "mm"), "yaw": Q(2.4 * displacement, "mrad")}
    given |= {"vertical_load": "10 kN", "friction_coefficient": 0.3}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)
        radius = np.asarray(predict(**given).problem.bodies["wheel"].rolling_radius)
        return predict(**given, angular_speed=Q(2.0 / radius[..., 0].mean(axis=-1), "rad/s"))


def picture() -> Figure:
    """Return place and power over the displacement, and the pressure of two humps, beside CONTACT's."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE, 6.6), layout="constrained")
        axes = figure.subplot_mosaic([["where", "power"], ["humps", "humps"]], height_ratios=(1.5, 1.0))
        _over_displacement(axes["where"], axes["power"])
        _two_humps(axes["humps"])
        handles, labels = axes["where"].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2, markerscale=1.5)
    return figure


def _over_displacement(where: Axes, power: Axes) -> None:
    displacement = np.linspace(0.0, 10.0, 401)
    r, contact, rig = predicted(displacement), reference(), wheelset()
    place = np.abs(1e3 * in_track(rig, np.asarray(r.problem.bodies["rail"].profile_position)))
    for side, name in enumerate(SIDES):
        colour: Any = {"color": PALETTE[side]}
        for patch in range(place.shape[-1]):
            label = f"wearlaw, {name} wheel" if patch == 0 else None
            where.plot(displacement, place[:, side, patch], ".", ms=2.5, label=label, **colour)
        power.plot(displacement, np.nansum(2.0 * r.wear_index.m_as("N")[:, side], axis=-1), ".", ms=2.5, **colour)
        points: Any = {"marker": "o", "ls": "", "ms": 5, "mfc": "none", **colour}
        where.plot(STEPS, np.abs(contact["y"][:, side]), label=f"CONTACT, {name} wheel", **points)
        power.plot(STEPS, -contact["power"][:, side], **points)
    where.set(xlabel="lateral displacement [mm]", ylabel="y of contact, outwards [mm]")
    power.set(xlabel="lateral displacement [mm]", ylabel="frictional power of a wheel [W]", yscale="log")


def _two_humps(axes: Axes) -> None:
    r, table = predicted(np.zeros(1)), pd.read_csv(DATA / "contact_two_humps.csv", comment="#")
    strips, rig = r.problem.strips, wheelset()
    assert strips is not None
    middle = 1e3 * in_track(rig, np.asarray(r.problem.bodies["rail"].profile_position))
    axes.plot(table.y, table.pmax, "o", ms=4, mfc="none", color=PALETTE[1])
    right = 0, 1, 0
    axes.plot(middle[right] + 1e3 * strips.y[right], 1e-6 * strips.max_pressure[right], ".-", ms=3.0, lw=1.0,
              color=PALETTE[1])  # fmt: skip
    axes.set(xlabel="y in the track [mm]", ylabel="maximum pressure [MPa]", title="right wheel, lateral displacement 0")


def tables() -> dict[str, str]:
    """Return the tables by the names of their files."""
    return {"summary": as_csv(summary())}


def as_csv(rows: Rows) -> str:
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(rows)
    return file.getvalue()


def write() -> None:
    """Write the tables into the folder beside the page that shows them."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in tables().items():
        (FOLDER / f"{name}.csv").write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    write()
