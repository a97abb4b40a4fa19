"""Draws the pictures of the README and the documentation: the shipped study, and the results of the benchmarks.

The picture of the report in a browser stays as it is where there is no chromium with its chromedriver.
"""

import csv
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from wearlaw.case import load_case
from wearlaw.figures.drawing import LINES, PALETTE, STYLE
from wearlaw.figures.drawing import draw as drawing_of
from wearlaw.output import write
from wearlaw.study import run

FOLDER = Path(__file__).parent / "pictures"
GALLERY = Path(__file__).parent / "gallery"
BENCHMARKS = Path(__file__).parent / "accuracy.csv"


def draw() -> None:
    FOLDER.mkdir(exist_ok=True)
    study = run(load_case("tassini2010"))
    for figure in study.figures:
        _save(drawing_of(figure), figure.name)
    _save(cost_against_error(), "accuracy_cost_against_error")
    for script in sorted(GALLERY.glob("*.py")):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, script], cwd=folder, env={**os.environ, "MPLBACKEND": "agg"}, check=True)
            shutil.copy(Path(folder) / f"{script.stem}.png", FOLDER / f"gallery_{script.stem}.png")
    if shutil.which("chromium") is None or shutil.which("chromedriver") is None:
        return
    with tempfile.TemporaryDirectory() as folder:
        photograph(Path(folder) / write(study, Path(folder), figure_formats=())[0])


def photograph(page: Path) -> None:
    """Draw how a report looks in a browser, with the mouse over a curve."""
    from selenium import webdriver
    from selenium.webdriver import ActionChains
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    for flag in ("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1200,860"):
        options.add_argument(flag)
    browser = webdriver.Chrome(options, Service(shutil.which("chromedriver")))
    try:
        browser.get(page.resolve().as_uri())
        figure = browser.find_element("css selector", "#figure-figure_08")
        browser.execute_script("arguments[0].scrollIntoView()", figure)
        plot = figure.find_element("css selector", ".draglayer .xy .nsewdrag")
        ActionChains(browser).move_to_element_with_offset(plot, -100, -100).pause(1).perform()
        browser.save_screenshot(str(FOLDER / "report.png"))
    finally:
        browser.quit()


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
