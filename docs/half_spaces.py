"""Writes the tables of how far the models of elliptic contact are from the half-space theory, and FASTSIM from its own.

`python -m docs.half_spaces` does so. The reference is tests/data/half_spaces.csv, and for the strips of FASTSIM many of
them. Errors are rounded up.
"""

import csv
import functools
import io
import math
import warnings
from pathlib import Path
from random import Random
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from tests.half_spaces import CELLS, DRAWS, POISSON_RATIO, table
from wearlaw import Array, Q

FOLDER = Path(__file__).parent / "half-spaces"
MODELS = {
    "`fastsim`": wl.contact_model("fastsim"),
    '`fastsim`, `bound="elliptic"`': wl.contact_model("fastsim", bound="elliptic"),
    "`strip_theory`": wl.contact_model("strip_theory"),
    "`shen_hedrick_elkins`": wl.contact_model("shen_hedrick_elkins"),
    "`polach`": wl.contact_model("polach"),
}
SIZE, MODULUS, LIMIT = 6e-3, 82e9, 3e4
"""√(ab) [m], G [Pa] and μN [N]; reduced quantities do not depend on them."""
UNIT = LIMIT / (MODULUS * SIZE**2)
"""The creepage whose reduced value is one, μN/(G ab)."""
SPINS = {"none": "none", "small": "up to half the creepage", "any": "any"}
RATIOS = {2.0: "1/2 to 2", 10.0: "1/10 to 10"}
Rows = list[tuple[str, ...]]
SLOPES = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
SEARCHED = {
    "parabolic": (0.1, 0.3897, -0.0895, 1.0),
    "elliptic": (0.1, 0.4327, -0.1078, 1.0),
}
"""a/b and reduced ξ, η and φ at which a search found the largest errors of forces on 10 strips."""
STRIPS, MANY_STRIPS, POINTS_OF_STRIPS = (10, 20, 40), 80, 500
"""Numbers of strips that are compared with many strips, and the number of points."""


class Errors(NamedTuple):
    """Errors of a model: of forces and moments over μN and μN √(ab), of energies relative."""

    force: Array
    moment: Array
    wear_index: Array
    cells: Array


def ellipses(ratio: Array, xi: Array, eta: Array, phi: Array) -> wl.Problem:
    """Return contacts with reduced creepages and spins."""
    root = np.sqrt(ratio)
    return wl.Problem.ellipse(
        a=Q(SIZE * root, "m"),
        b=Q(SIZE / root, "m"),
        normal_force=Q(LIMIT / 0.3, "N"),
        shear_modulus=Q(MODULUS, "Pa"),
        poisson_ratio=POISSON_RATIO,
        friction_coefficient=0.3,
        longitudinal_creepage=Q(UNIT * xi, ""),
        lateral_creepage=Q(UNIT * eta, ""),
        spin=Q(UNIT / SIZE * phi, "1/m"),
    )


def errors(found: dict[str, Array], model: wl.ContactModel) -> Errors:
    """Return the errors of a model at each point."""
    contact = model.solve(ellipses(*(found[name] for name in ("ratio", "xi", "eta", "phi"))))
    moment = contact.moment_z / (LIMIT * SIZE) - found["mz"]
    force = np.hypot(contact.force_x / LIMIT - found["fx"], contact.force_y / LIMIT - found["fy"])
    energies = [energy / (LIMIT * UNIT) for energy in (contact.wear_index, contact.cell_wear_index)]
    return Errors(force, np.abs(moment), *(energy / found["power"] - 1.0 for energy in energies))


def classes(found: dict[str, Array]) -> dict[tuple[str, float], NDArray[np.bool_]]:
    """Return masks of the points by spin and by the largest axis ratio."""
    slender, spin = np.maximum(found["ratio"], 1.0 / found["ratio"]), np.abs(found["phi"])
    small = spin <= 0.5 * np.hypot(found["xi"], found["eta"])
    spins = {"none": spin == 0.0, "small": (spin > 0.0) & small, "any": spin > 0.0}
    return {(name, most): spins[name] & (slender <= most) for name in SPINS for most in RATIOS}


def rms(error: Array) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(error**2)))


def percent(value: float, digits: int) -> float:
    """Return a share in percent, rounded away from zero, except for integers with a rounding error."""
    return math.copysign(math.ceil(abs(value) * 100.0 * 10**digits - 1e-9) / 10**digits, value)


def size(error: Array, random: NDArray[np.bool_]) -> str:
    """Return the root mean square at random points and the largest of all errors."""
    return f"{percent(rms(error[random]), 1):.1f} / {percent(error.max(), 1):.1f}"


def span(error: Array, random: NDArray[np.bool_]) -> str:
    """Return the root mean square at random points, and the lowest and the highest of all errors."""
    low, high = percent(error.min(), 0), percent(error.max(), 0)
    return f"{percent(rms(error[random]), 0):.0f} / {low:+.0f} to {high:+.0f}"


def slopes() -> Rows:
    """Return the error of FASTSIM's moment beside the linear theory if the whole patch sticks."""
    ratio, little = np.array(SLOPES), np.full(len(SLOPES), 1e-7)
    rows = []
    for eta, phi in ((little, 0.0 * little), (0.0 * little, little)):
        problem = ellipses(ratio, 0.0 * little, eta, phi)
        fastsim, linear = (wl.contact_model(name).creep_forces(problem).spin_moment for name in ("fastsim", "linear"))
        rows.append([f"{100.0 * miss:+.0f}" for miss in fastsim / linear - 1.0])
    return [("a/b", "from lateral creepage", "from spin"), *zip([f"{one:g}" for one in SLOPES], *rows, strict=True)]


def wheels(count: int) -> wl.Problem:
    """Draw contacts of wheels on rails over the range that the page states, at 20 m/s."""
    draw = Random(1982).random  # the same numbers with any version of Python

    def drawn(low: float, high: float) -> Array:
        return np.array([low * (high / low) ** draw() for _ in range(count)])

    def signed() -> Array:
        return np.array([math.copysign(0.01 * 100.0 ** draw(), draw() - 0.5) for _ in range(count)])

    root, pressure, friction = np.sqrt(drawn(0.1, 10.0)), drawn(0.6e9, 2.4e9), drawn(0.1, 0.6)
    load = 2.0 / 3.0 * np.pi * SIZE**2 * pressure
    unit = friction * load / (MODULUS * SIZE**2)
    xi, eta, phi = signed(), signed(), signed()
    return wl.Problem.ellipse(
        a=Q(SIZE * root, "m"),
        b=Q(SIZE / root, "m"),
        normal_force=Q(load, "N"),
        shear_modulus=Q(MODULUS, "Pa"),
        poisson_ratio=POISSON_RATIO,
        friction_coefficient=friction,
        longitudinal_creepage=Q(unit * xi, ""),
        lateral_creepage=Q(unit * eta, ""),
        spin=Q(unit / SIZE * phi, "1/m"),
        rolling_speed=Q(20, "m/s"),
    )


def on_strips(problem: wl.Problem, bound: str, strips: int) -> dict[str, Array]:
    """Return FASTSIM's results with a number of strips: forces over μN, Mz over μN√(ab), energy [N] and wear rates."""
    rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="20 m/s")
    model = wl.contact_model("fastsim", bound=bound, strips=strips)
    forces = model.creep_forces(problem)
    limit = problem.friction_coefficient * problem.normal_force
    found = {"x": forces.longitudinal / limit, "y": forces.lateral / limit, "Mz": forces.spin_moment / (limit * SIZE)}
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", wl.WearlawWarning
        )  # the sets were fitted on a line, and some pressures are high
        for law in ("usfd", "kth"):
            prediction = (rig | model | wl.wear_law(law)).predict(problem)
            found[law] = np.asarray(prediction.wear_rate.magnitude)
            if strips == STRIPS[0]:
                found[f"{law} error"] = np.asarray(prediction.wear_rate_error.to(prediction.wear_rate.units).magnitude)
    found["energy"] = np.asarray(prediction.cell_wear_index.to("N").magnitude)
    return found


@functools.cache
def of_strips(bound: str) -> dict[int, dict[str, Array]]:
    """Return FASTSIM's results with each number of strips in `STRIPS`, and with many."""
    problem = wheels(POINTS_OF_STRIPS)
    return {strips: on_strips(problem, bound, strips) for strips in (*STRIPS, MANY_STRIPS)}


def strips() -> Rows:
    """Return the difference between FASTSIM on few strips and on many."""
    rows: Rows = [("bound", "strips", "forces", "Mz", "energy of the cells", "USFD", "KTH")]
    for bound in ("parabolic", "elliptic"):
        fine = of_strips(bound)[MANY_STRIPS]
        for count in STRIPS:
            found = of_strips(bound)[count]
            missed = [
                np.hypot(found["x"] - fine["x"], found["y"] - fine["y"]),
                np.abs(found["Mz"] - fine["Mz"]),
                *(np.abs(found[name] / fine[name] - 1.0) for name in ("energy", "usfd", "kth")),
            ]
            sizes = (f"{percent(rms(one), 2):.2f} / {percent(one.max(), 1):.1f}" for one in missed)
            rows.append((bound, str(count), *sizes))
    return rows


def worst_in_words() -> str:
    """Return the sentence about the largest error of a force on 10 strips that a search found."""
    worst = {}
    for bound, at in SEARCHED.items():
        problem = ellipses(*np.array(at)[:, None])
        few, fine = (
            wl.contact_model("fastsim", bound=bound, strips=count).creep_forces(problem)
            for count in (STRIPS[0], MANY_STRIPS)
        )
        worst[bound] = float(np.hypot(few.longitudinal - fine.longitudinal, few.lateral - fine.lateral)[0]) / LIMIT
    parabolic, elliptic = (percent(worst[bound], 0) for bound in ("parabolic", "elliptic"))
    return (
        f"A search for large errors found {parabolic:.0f} % of μN with the parabolic bound and {elliptic:.0f} % with"
        f" the elliptic one, on {STRIPS[0]} strips at a/b = 1/10."
    )


def estimates_in_words() -> str:
    """Return the sentence about how often the estimated error of a wear rate is as large as the true one."""
    covered = {}
    for law in ("usfd", "kth"):
        hits = []
        for bound in ("parabolic", "elliptic"):
            few, fine = of_strips(bound)[STRIPS[0]], of_strips(bound)[MANY_STRIPS]
            hits.append(np.abs(few[law] - fine[law]) <= few[f"{law} error"])
        covered[law] = math.floor(100.0 * float(np.mean(hits)))
    return (
        f"On {STRIPS[0]} strips, `wear_rate_error` is at least as large as the error at {covered['usfd']} % of the"
        f" points for USFD, and at {covered['kth']} % for KTH."
    )


def tables() -> dict[str, str]:
    """Return the tables as CSV, by the names of their files."""
    found = table()
    random = np.arange(found["ratio"].size) < sum(DRAWS)
    missed = {name: errors(found, model) for name, model in MODELS.items()}
    head = "spin", "a/b"
    energies = {name: ("Tγ", "cells") if "fastsim" in name else ("Tγ",) for name in MODELS}
    force: Rows = [(*head, *MODELS)]
    moment: Rows = [(*head, *MODELS)]
    energy: Rows = [(*head, *(f"{name}: {kind}" for name, kinds in energies.items() for kind in kinds))]
    for (spin, most), chosen in classes(found).items():
        which, there = (SPINS[spin], RATIOS[most]), random[chosen]
        force.append((*which, *(size(one.force[chosen], there) for one in missed.values())))
        moment.append((*which, *(size(one.moment[chosen], there) for one in missed.values())))
        spans = []
        for name, kinds in energies.items():
            of = {"Tγ": missed[name].wear_index, "cells": missed[name].cells}
            spans += [span(of[kind][chosen], there) for kind in kinds]
        energy.append((*which, *spans))
    return {
        name: as_csv(rows)
        for name, rows in {
            "forces": force,
            "energies": energy,
            "moments": moment,
            "slopes": slopes(),
            "strips": strips(),
        }.items()
    }


def points_in_words() -> str:
    """Return the sentence about the number of points."""
    drawn = sum(DRAWS)
    return (
        f"Root mean squares are over {drawn} points drawn at random. The largest, lowest and highest errors are over"
        f" these and {table()['ratio'].size - drawn} points that a search for large errors found."
    )


def range_in_words() -> str:
    """Return the sentence about the greatest creepage and spin."""
    return f"which is {100.0 * UNIT:.1f} % and {UNIT / SIZE:.1f} /m in the cases above."


def grids_in_words() -> str:
    """Return the sentence about what a coarser grid changes."""
    fine, coarse = table(), table(CELLS[-2])
    step = np.hypot(fine["fx"] - coarse["fx"], fine["fy"] - coarse["fy"])
    return (
        f"Extrapolated from {CELLS[0]} and {CELLS[1]} elements instead, its forces differ by at most"
        f" {percent(step.max(), 1):.1f} % of μN, root mean square {percent(rms(step), 1):.1f} %"
    )


def energies_in_words() -> str:
    """Return the rows that show which energy of FASTSIM is nearer, over all points with spin."""
    found = table()
    spin = (found["phi"] != 0.0) & (np.arange(found["phi"].size) < sum(DRAWS))
    parts = []
    for name, bound in zip(list(MODELS)[:2], ("parabolic", "elliptic"), strict=True):
        missed = errors(found, MODELS[name])
        cells, total = (100.0 * rms(error[spin]) for error in (missed.cells, missed.wear_index))
        parts.append(f"| {bound} | {cells:.0f} % | {total:.0f} % |")
    return " ".join(parts)


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
