"""Writes the tables of how far the models of elliptic contact are from the half-space theory.

`python -m docs.half_spaces` does so. The reference is tests/data/half_spaces.csv. Errors are rounded up.
"""

import csv
import io
import math
from pathlib import Path
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
    "`shen_hedrick_elkins`": wl.contact_model("shen_hedrick_elkins"),
    "`polach`": wl.contact_model("polach"),
}
SIZE, MODULUS, LIMIT = 6e-3, 82e9, 3e4
"""√(ab) [m], G [Pa] and μN [N]; what is reduced does not depend on them."""
UNIT = LIMIT / (MODULUS * SIZE**2)
"""Creepage of one when reduced, μN/(G ab)."""
SPINS = {"none": "none", "small": "up to half the creepage", "any": "any"}
RATIOS = {2.0: "1/2 to 2", 10.0: "1/10 to 10"}
Rows = list[tuple[str, ...]]
SLOPES = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


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
    """Return how far a model is from the reference, point by point."""
    contact = model.solve(ellipses(*(found[name] for name in ("ratio", "xi", "eta", "phi"))))
    moment = contact.moment_z / (LIMIT * SIZE) - found["mz"]
    force = np.hypot(contact.force_x / LIMIT - found["fx"], contact.force_y / LIMIT - found["fy"])
    energies = [energy / (LIMIT * UNIT) for energy in (contact.wear_index, contact.cell_wear_index)]
    return Errors(force, np.abs(moment), *(energy / found["power"] - 1.0 for energy in energies))


def classes(found: dict[str, Array]) -> dict[tuple[str, float], NDArray[np.bool_]]:
    """Return which points have which spin, and an axis ratio up to which."""
    slender, spin = np.maximum(found["ratio"], 1.0 / found["ratio"]), np.abs(found["phi"])
    small = spin <= 0.5 * np.hypot(found["xi"], found["eta"])
    spins = {"none": spin == 0.0, "small": (spin > 0.0) & small, "any": spin > 0.0}
    return {(name, most): spins[name] & (slender <= most) for name in SPINS for most in RATIOS}


def rms(error: Array) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(error**2)))


def percent(value: float, digits: int) -> float:
    """Return a share in percent, rounded away from zero; what is an integer but for rounding stays."""
    return math.copysign(math.ceil(abs(value) * 100.0 * 10**digits - 1e-9) / 10**digits, value)


def size(error: Array, random: NDArray[np.bool_]) -> str:
    """Return the root mean square at random points and the largest of all errors."""
    return f"{percent(rms(error[random]), 1):.1f} / {percent(error.max(), 1):.1f}"


def span(error: Array, random: NDArray[np.bool_]) -> str:
    """Return the root mean square at random points, and the lowest and the highest of all errors."""
    low, high = percent(error.min(), 0), percent(error.max(), 0)
    return f"{percent(rms(error[random]), 0):.0f} / {low:+.0f} to {high:+.0f}"


def slopes() -> Rows:
    """Return by how much FASTSIM's moment misses the linear theory where everything sticks."""
    ratio, little = np.array(SLOPES), np.full(len(SLOPES), 1e-7)
    rows = []
    for eta, phi in ((little, 0.0 * little), (0.0 * little, little)):
        problem = ellipses(ratio, 0.0 * little, eta, phi)
        fastsim, linear = (wl.contact_model(name).creep_forces(problem).spin_moment for name in ("fastsim", "linear"))
        rows.append([f"{100.0 * miss:+.0f}" for miss in fastsim / linear - 1.0])
    return [("a/b", "from lateral creepage", "from spin"), *zip([f"{one:g}" for one in SLOPES], *rows, strict=True)]


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
        for name, rows in {"forces": force, "energies": energy, "moments": moment, "slopes": slopes()}.items()
    }


def points_in_words() -> str:
    """Return the sentence about the number of points."""
    drawn = sum(DRAWS)
    return (
        f"Root mean squares are those of {drawn} points drawn at random; the largest, lowest and highest errors are"
        f" those of these and of {table()['ratio'].size - drawn} points that a search for large errors found."
    )


def range_in_words() -> str:
    """Return the sentence about the greatest creepage and spin."""
    return f"In the cases above that is {100.0 * UNIT:.1f} % and {UNIT / SIZE:.1f} /m."


def grids_in_words() -> str:
    """Return the sentence about what a coarser grid changes."""
    fine, coarse = table(), table(CELLS[-2])
    step = np.hypot(fine["fx"] - coarse["fx"], fine["fy"] - coarse["fy"])
    return (
        f"Extrapolated from {CELLS[0]} and {CELLS[1]} elements, its forces differ by at most"
        f" {percent(step.max(), 1):.1f} % of μN, root mean square {percent(rms(step), 1):.1f} %."
    )


def energies_in_words() -> str:
    """Return the sentence about which energy of FASTSIM is nearer, over all points with spin."""
    found = table()
    spin = (found["phi"] != 0.0) & (np.arange(found["phi"].size) < sum(DRAWS))
    parts = []
    for name, bound in zip(list(MODELS)[:2], ("parabolic", "elliptic"), strict=True):
        missed = errors(found, MODELS[name])
        cells, total = (100.0 * rms(error[spin]) for error in (missed.cells, missed.wear_index))
        parts.append(f"{cells:.0f} % in the cells and {total:.0f} % in Tγ with the {bound} bound")
    return f"At random points with spin the root mean square error is {parts[0]}, {parts[1]}"


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
