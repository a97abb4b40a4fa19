"""Writes the tables of the page "How far from CONTACT": strips and ellipses with each contact model beside CONTACT.

`python -m docs.how_far_from_contact` does so. Where CONTACT has no result, the reference is wearlaw's `half_space`.
Signs are CONTACT's.
"""

from __future__ import annotations

import csv
import io
import itertools
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

import wearlaw as wl
from docs.wheelset_benchmark import DATA, Patch, in_track, reference, wheelset
from wearlaw import Array, Q

FOLDER = Path(__file__).parent / "how-far-from-contact"
CELLS = 60
CHOICES: tuple[tuple[Patch, str], ...] = (
    ("ellipse", "fastsim"), ("ellipse", "half_space"),
    ("strips", "fastsim"), ("strips", "strip_theory"), ("strips", "half_space"),
)  # fmt: skip
"""What contact models get of a patch, and the models."""
EXACT = CHOICES[-1]
FRICTION, RIGHT, SPEED, RADIUS = 0.3, 1, 2.0, 0.46
CONTACT, HALF_SPACE = "CONTACT", "`half_space`"
BEYOND = 1e3
"""A distance from a patch at which there is none [mm]."""


class Case(NamedTuple):
    """A position of a wheelset: where the right wheel touches, its load [kN], displacement [mm] and yaw [mrad]."""

    place: str
    load: float
    displacement: float
    yaw: float
    reference: str = CONTACT


SERVICE = tuple(
    Case(place, 80.0, displacement, 12.0)
    for place, displacement in (
        ("tread", -7.0), ("tread", -5.0), ("tread", -3.0), ("tread", -1.0), ("humps", 1.0), ("tread", 3.0),
        ("humps", 5.0), ("flange", 7.0),
    )
)  # fmt: skip
MANCHESTER = tuple(
    Case(place, 10.0, displacement, 2.4 * displacement)
    for place, displacement in (("humps", 0.0), ("humps", 0.5), ("tread", 3.0), ("root", 6.0), ("flange", 6.5))
)
OTHERS = (
    Case("tread", 80.0, -3.0, 0.5, HALF_SPACE),
    Case("humps", 80.0, 1.0, 0.5, HALF_SPACE),
    Case("root", 80.0, 5.6, 0.0, HALF_SPACE),
    Case("yaw", 80.0, 3.0, 36.0, HALF_SPACE),
    Case("yaw", 20.0, 7.0, 24.0, HALF_SPACE),
    Case("yaw", 20.0, 6.8, 36.0, HALF_SPACE),
)
GROUPS = (SERVICE, MANCHESTER, OTHERS)
PLACES = ("tread", "humps", "root", "flange", "yaw")
CASES = tuple(sorted(sum(GROUPS, ()), key=lambda case: PLACES.index(case.place)))
"""All cases, by place."""


class Rows(NamedTuple):
    """Rows of a patch: places across in the track [mm], their widths [mm], and force and energy over width [N/mm]."""

    y: Array
    width: Array
    force: Array
    energy: Array


class Result(NamedTuple):
    """What a program says of a right wheel, its patches together.

    Forces are in N, `power` is Tγ from the forces and creepages [N], `pressure` the greatest one [MPa], `area` in mm²,
    `angle` and `roll` in mrad.
    """

    patches: int
    force: float
    angle: float
    pressure: float
    area: float
    along: float
    across: float
    power: float
    roll: float
    rows: tuple[Rows, ...]


def conditions(group: tuple[Case, ...]) -> dict[str, Any]:
    """Return the conditions of a group of cases; those of CONTACT have its speed of rotation, and service its roll."""
    given: dict[str, Any] = {
        "lateral_displacement": Q([case.displacement for case in group], "mm"),
        "yaw": Q([case.yaw for case in group], "mrad"),
        "vertical_load": Q([case.load for case in group], "kN"),
        "friction_coefficient": FRICTION,
    }
    if group is SERVICE:
        roll = Q(service().roll.to_numpy(), "rad")
        given |= {"angular_speed": Q(SPEED / RADIUS, "rad/s"), "roll": roll}
    elif group is MANCHESTER:
        given["angular_speed"] = Q(reference()["rotation"][manchester_rows(), RIGHT], "rad/s")
    return given


def service() -> pd.DataFrame:
    """Return CONTACT's results under service load, a row for each case."""
    return pd.read_csv(DATA / "contact_service.csv", comment="#")


def manchester_rows() -> list[int]:
    """Return the rows of the benchmark's table that the cases are."""
    return [round(2.0 * case.displacement) for case in MANCHESTER]


def computed(group: tuple[Case, ...], patch: Patch, model: str) -> tuple[list[Result], float]:
    """Return wearlaw's results of a group of cases, and the processor time that they took [s]."""
    rig = wheelset(patch)
    predict: Any = rig | wl.contact_model(model, **{"cells": CELLS} if model == "half_space" else {})
    frictionless: Any = rig | wl.contact_model("fastsim")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)  # wheels climb
        start = time.process_time()
        r = predict(**conditions(group))
        taken = time.process_time() - start
        roll = np.asarray(r.problem.roll)[:, RIGHT, 0]
        if group is SERVICE:  # CONTACT's roll has no friction
            free = {name: value for name, value in conditions(group).items() if name != "roll"}
            free["friction_coefficient"] = 1e-9
            roll = np.asarray(frictionless(**free).problem.roll)[:, RIGHT, 0]
    totals = {
        "along": r.longitudinal_force.m_as("N"),
        "across": r.lateral_force.m_as("N"),
        "power": r.wear_index.m_as("N"),
        "area": 1e6 * np.asarray(r.contact.patch_area),
    }
    whole = {name: np.nansum(value[:, RIGHT], axis=-1) for name, value in totals.items()}
    force, angle = r.normal_force.m_as("N")[:, RIGHT], r.contact_angle.m_as("mrad")[:, RIGHT]
    most = np.nanmax(r.max_pressure.m_as("MPa")[:, RIGHT], axis=-1)
    results = [
        Result(
            patches=int(np.isfinite(force[case]).sum()),
            force=float(np.nansum(force[case])),
            angle=float(np.nansum(force[case] * angle[case]) / np.nansum(force[case])),
            pressure=float(most[case]),
            roll=1e3 * float(roll[case]),
            rows=tuple(rows_of(rig, r, case)),
            **{name: float(value[case]) for name, value in whole.items()},
        )
        for case in range(len(group))
    ]
    return results, taken


def rows_of(rig: Any, r: Any, case: int) -> Iterator[Rows]:
    """Yield the rows of each patch of the right wheel, by their places in the track."""
    contact, problem = r.contact, r.problem
    middle = 1e3 * in_track(rig, np.asarray(problem.bodies["rail"].profile_position))[case, RIGHT]
    force, energy = contact.over_strip(contact.pressure), contact.over_strip(contact.wear_index_density)
    for patch in np.flatnonzero(np.isfinite(middle)):
        at = case, RIGHT, patch
        y, width = 1e3 * contact.y[at][0], 1e3 * contact.strip_width[at]
        order, cosine = np.argsort(y), np.cos(problem.contact_angle[at])
        order = order[width[order] > 0.0]  # patches with fewer rows than others are filled up
        yield Rows(
            (middle[patch] + cosine * y)[order],
            (cosine * width)[order],
            (1e-3 / cosine * force[at])[order],
            (1e-3 / cosine * energy[at])[order],
        )


def of_contact(group: tuple[Case, ...]) -> list[Result]:
    """Return CONTACT's results of a group of cases."""
    if group is MANCHESTER:
        table, humps = reference(), pd.read_csv(DATA / "contact_two_humps.csv", comment="#")
        found = {name: column[manchester_rows(), RIGHT] for name, column in table.items() if name != "side"}
        names = ("xi", "fx"), ("eta", "fs"), ("phi", "mn")
        power = -np.sum([found[creepage] * found[force] for creepage, force in names], axis=0)
        width = np.full(humps.y.size, 0.2)
        first = Rows(humps.y.to_numpy(), width, humps.fn.to_numpy() / width, -humps.power.to_numpy() / SPEED / width)
        rows: list[tuple[Rows, ...]] = [(first,), *[() for _ in group[1:]]]
    else:
        found = {str(name): column.to_numpy() for name, column in service().items()}
        table_of_rows = pd.read_csv(DATA / "contact_service_rows.csv", comment="#")
        power, rows = -found["tgamma"], []
        for case, y, delta in zip(group, found["y"], found["delta"], strict=True):
            part, cosine = table_of_rows[table_of_rows.displacement == case.displacement], np.cos(delta)
            fields = (part.force.to_numpy() / cosine, part.energy.to_numpy() / cosine)
            rows.append((Rows(y + cosine * part.s.to_numpy(), np.full(len(part), 0.4 * cosine), *fields),))
    return [
        Result(
            patches=1,
            force=found["fn"][case],
            angle=1e3 * found["delta"][case],
            pressure=found["pmax"][case],
            area=found["area"][case],
            along=found["fx"][case],
            across=found["fs"][case],
            power=float(power[case]),
            roll=1e3 * found["roll"][case],
            rows=rows[case],
        )
        for case in range(len(group))
    ]


def spread(rows: Rows, edges: Array, name: Literal["force", "energy"] = "energy") -> Array:
    """Return the force or energy [N] between edges, of the sum up to the borders of rows by monotone cubics."""
    borders = rows.y[0] - 0.5 * rows.width[0] + np.concatenate([[0.0], np.cumsum(rows.width)])
    total = np.concatenate([[0.0], np.cumsum(rows.width * getattr(rows, name))])
    share: Array = np.diff(PchipInterpolator(borders, total)(np.clip(edges, borders[0], borders[-1])))
    return share


class Placed(NamedTuple):
    """Share of the energy in other rows than those of the reference, and the peak row over the reference's, less 1."""

    misplaced: float
    peak: float


def placed(ours: Result, due: Result, name: Literal["force", "energy"] = "energy") -> Placed:
    """Return how a result lies across the rows of the reference, each over its total."""
    if not due.rows:
        return Placed(np.nan, np.nan)
    (rows,) = due.rows
    edges = np.concatenate([rows.y - 0.5 * rows.width, [rows.y[-1] + 0.5 * rows.width[-1]]])
    edges = np.concatenate([[edges[0] - BEYOND], edges, [edges[-1] + BEYOND]])
    found = np.sum([spread(one, edges, name) for one in ours.rows], axis=0)
    expected = np.concatenate([[0.0], rows.width * getattr(rows, name), [0.0]])
    found, expected = found / found.sum(), expected / expected.sum()
    return Placed(float(0.5 * np.abs(found - expected).sum()), float(found.max() / expected.max() - 1.0))


DIFFERENCES = {
    "N [%]": 1, "δ [mrad]": 1, "p_max [%]": 1, "area [%]": 1, "Fx [% of μN]": 1, "Fy [% of μN]": 1, "Tγ [%]": 1,
    "misplaced [%]": 1, "peak [%]": 1, "roll [mrad]": 3,
}  # fmt: skip
"""Heads of the columns of differences, and their digits."""


def differences(ours: Result, due: Result) -> tuple[float, ...]:
    """Return the differences of a result from the reference, in the order of the heads."""
    grip, rows = 0.01 * FRICTION * due.force, placed(ours, due)
    return (
        100.0 * (ours.force / due.force - 1.0), ours.angle - due.angle, 100.0 * (ours.pressure / due.pressure - 1.0),
        100.0 * (ours.area / due.area - 1.0), (ours.along - due.along) / grip, (ours.across - due.across) / grip,
        100.0 * (ours.power / due.power - 1.0), 100.0 * rows.misplaced, 100.0 * rows.peak, ours.roll - due.roll,
    )  # fmt: skip


class Computed(NamedTuple):
    """The references of the cases, wearlaw's results by patch and model, and the time of a wheel [s]."""

    due: dict[Case, Result]
    ours: dict[tuple[Patch, str], dict[Case, Result]]
    taken: dict[tuple[Patch, str], float]


def compute() -> Computed:
    """Return all results: some minutes' work."""
    due = {case: one for group in (SERVICE, MANCHESTER) for case, one in zip(group, of_contact(group), strict=True)}
    ours: dict[tuple[Patch, str], dict[Case, Result]] = {}
    taken: dict[tuple[Patch, str], float] = {}
    for choice in CHOICES:
        found, spent = zip(*(computed(group, *choice) for group in GROUPS), strict=True)
        ours[choice] = dict(zip(itertools.chain(*GROUPS), itertools.chain(*found), strict=True))
        taken[choice] = sum(spent) / (2 * len(CASES))
    return Computed(due | {case: ours[EXACT][case] for case in OTHERS}, ours, taken)


Table = list[tuple[str, ...]]


def tables(found: Computed) -> dict[str, str]:
    """Return the tables by the names of their files."""
    lines: Table = [(
        "place", "load [kN]", "displacement [mm]", "yaw [mrad]", "from", "N [N]", "δ [mrad]", "p_max [MPa]",
        "area [mm²]", "Fx [N]", "Fy [N]", "Tγ [N]", "rows", "roll [mrad]",
    )]  # fmt: skip
    for case in CASES:
        one = found.due[case]
        count = f"{one.rows[0].y.size}" if one.rows else ""
        lines.append((
            case.place, *named(case), case.reference, f"{one.force:.0f}", f"{one.angle:.1f}", f"{one.pressure:.0f}",
            f"{one.area:.1f}", f"{one.along:.0f}", f"{one.across:.0f}", f"{one.power:.4g}", count, f"{one.roll:.3f}",
        ))  # fmt: skip
    by_place = {"cases": lines, "summary": summary(found)}
    for place in PLACES:
        lines = [("load [kN]", "displacement [mm]", "yaw [mrad]", "`patch`", "model", *DIFFERENCES)]
        for case in CASES:
            if case.place != place:
                continue
            for choice, results in found.ours.items():
                if case.reference == HALF_SPACE and choice == EXACT:
                    continue
                values = zip(differences(results[case], found.due[case]), DIFFERENCES.values(), strict=True)
                cells = ("" if np.isnan(value) else f"{round(value, n) + 0.0:+.{n}f}" for value, n in values)
                lines.append((*named(case), *(f"`{name}`" for name in choice), *cells))
        by_place[place] = lines
    by_place["times"] = [("`patch`", "model", "time [ms]")]
    by_place["times"] += [(*(f"`{name}`" for name in choice), f"{1e3 * t:.2g}") for choice, t in found.taken.items()]
    return {name: as_csv(rows) for name, rows in by_place.items()}


def summary(found: Computed) -> Table:
    """Return the largest differences at each place from the cases that CONTACT solved, or else `half_space`."""
    lines: Table = [("place", "`patch`", "model", "cases", *DIFFERENCES)]
    for place, chosen in itertools.product(PLACES, CHOICES):
        cases = [case for case in CASES if case.place == place and (case.reference == CONTACT or place == "yaw")]
        if place == "yaw" and chosen == EXACT:
            continue
        each = [np.abs(differences(found.ours[chosen][case], found.due[case])) for case in cases]
        most = zip(np.fmax.reduce(each), DIFFERENCES.values(), strict=True)  # NaN where CONTACT's rows are not known
        cells = ("" if np.isnan(value) else f"{value:.{n}f}" for value, n in most)
        lines.append((place, f"`{chosen[0]}`", f"`{chosen[1]}`", f"{len(cases)}", *cells))
    return lines


def named(case: Case) -> tuple[str, str, str]:
    """Return load, displacement and yaw of a case as shown."""
    return f"{case.load:g}", f"{case.displacement:g}", f"{case.yaw:g}"


def as_csv(rows: Table) -> str:
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(rows)
    return file.getvalue()


def write() -> None:
    """Write the tables into the folder beside the page that shows them."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in tables(compute()).items():
        (FOLDER / f"{name}.csv").write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    write()
