"""Draws the pictures of the README and the documentation: the shipped study, and the results of the benchmarks."""

import csv
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from wearlaw.case import load_case
from wearlaw.figures import LINES, PALETTE, STYLE, figures
from wearlaw.study import run

FOLDER = Path(__file__).parent / "pictures"
BENCHMARKS = Path(__file__).parent / "accuracy.csv"


def draw() -> None:
    FOLDER.mkdir(exist_ok=True)
    for name, picture in figures(run(load_case("tassini2010"))).items():
        _save(picture(), name)
    _save(cost_against_error(), "accuracy_cost_against_error")


def cost_against_error() -> Figure:
    """Return the time of a point against the error there, a line for each method of the benchmarks."""
    with BENCHMARKS.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.4, 4.8), layout="constrained")
        axes = figure.subplots()
        for number, method in enumerate(dict.fromkeys(row["method"] for row in rows)):
            points = [row for row in rows if row["method"] == method]
            errors = [float(row["rms relative error"]) for row in points]
            times = [float(row["µs a point"]) for row in points]
            style: Any = {"color": PALETTE[number % len(PALETTE)], "linestyle": LINES[number % len(LINES)]}
            axes.plot(errors, times, label=method, marker="*" if method.startswith("wearlaw") else "o", **style)
            for row, error, time in zip(points, errors, times, strict=True) if len(points) > 1 else ():
                axes.annotate(row["cells"], (error, time), (0, 6), textcoords="offset points", ha="center", fontsize=7)
        axes.set(xlabel="rms relative error of the wear rate", ylabel="time of an operating point [µs]")
        axes.set(xscale="log", yscale="log")
        axes.legend(title="with the number of cells")
    return figure


def _save(figure: Figure, name: str) -> None:
    figure.savefig(FOLDER / f"{name}.png", dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    draw()
