"""Draws the pictures of the README and the documentation: the shipped study, conventions, results of the benchmarks.

The picture of the report in a browser stays as it is where there is no chromium with its chromedriver.
"""

import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import wearlaw as wl
from docs.choosing import picture as models_to_choose_from
from docs.conventions import conventions
from docs.laws_compared import DPI
from docs.laws_compared import picture as laws_compared
from docs.regimes import picture as regimes
from docs.wheelset_benchmark import picture as wheelsets_beside_contact
from docs.wheelset_benchmark import wheelset
from wearlaw import Q
from wearlaw_apps.output.curves import BLACK
from wearlaw_apps.output.drawing import draw as drawing_of
from wearlaw_apps.output.style import COLUMN, LINES, PALETTE, STYLE
from wearlaw_apps.studies.written import write

FOLDER = Path(__file__).parent / "pictures"
GALLERY = Path(__file__).parent / "gallery"
BENCHMARKS = Path(__file__).parent / "accuracy.csv"
REFERENCE = Path(__file__).parents[1] / "tests" / "data" / "hertz3d_reference.csv"
OF_STUDY = ("figure_03", "figure_04", "figure_05", "figure_08", "figure_10", "wear_over_load")
"""The figures of the shipped study that pages show."""
BOUNDS = ("elliptic", "parabolic")


def draw() -> None:
    FOLDER.mkdir(exist_ok=True)
    study = wl.run(wl.load_case("tassini2010"))
    for figure in study.figures:
        if figure.name in OF_STUDY:
            save(drawing_of(figure), FOLDER / f"{figure.name}.png")
    save(cost_against_error(), FOLDER / "accuracy_cost_against_error.png")
    save(regimes(), FOLDER / "regimes.png")
    save(models_to_choose_from(), FOLDER / "choosing.png")
    save(conventions(), FOLDER / "conventions.png")
    save(laws_compared(), FOLDER / "laws_compared.png")
    save(wheelsets_beside_contact(), FOLDER / "wheelset_benchmark.png")
    geometry = wheelset().geometry(lateral_displacement=Q(np.linspace(-8.0, 8.0, 161), "mm"))
    save(geometry.plot(), FOLDER / "wheelset_geometry.png")
    save(worn_wheel(), FOLDER / "wheel_life.png")
    for figure in (creep_forces(), falling_friction()):
        save(drawing_of(figure), FOLDER / f"{figure.name}.png")
    for script in sorted(GALLERY.glob("*.py")):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, script], cwd=folder, env={**os.environ, "MPLBACKEND": "agg"}, check=True)
            shutil.copy(Path(folder) / f"{script.stem}.png", FOLDER / f"gallery_{script.stem}.png")
    if shutil.which("chromium") is None or shutil.which("chromedriver") is None:
        return
    with tempfile.TemporaryDirectory() as folder:
        photograph(Path(folder) / write(study, Path(folder), figure_formats=())[0])


def save(figure: Figure, path: Path) -> None:
    """Write a picture with matplotlib's version in it, because pixels compare only within one version."""
    figure.savefig(path, dpi=DPI)


def photograph(page: Path) -> None:
    """Take a screenshot of the first screen of a report in a browser, with the mouse over a curve."""
    from selenium import webdriver
    from selenium.webdriver import ActionChains
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.support.ui import WebDriverWait

    options = webdriver.ChromeOptions()
    for flag in ("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1200,1180"):
        options.add_argument(flag)
    browser = webdriver.Chrome(options, Service(shutil.which("chromedriver")))
    try:
        browser.get(page.resolve().as_uri())
        drag = "css selector", ".main .draglayer .xy .nsewdrag"
        plot = WebDriverWait(browser, 60.0).until(lambda _: browser.find_element(*drag))
        ActionChains(browser).move_to_element_with_offset(plot, -150, -20).pause(1).perform()
        browser.save_screenshot(str(FOLDER / "report.png"))
    finally:
        browser.quit()


def worn_wheel() -> Figure:
    """Draw the life on the page about wheels, from the script of that page."""
    page = (Path(__file__).parent / "wheel-life.md").read_text(encoding="utf-8")
    names: dict[str, Any] = {}
    exec(re.findall(r"```python\n(.*?)```", page, re.DOTALL)[0], names)
    figure: Figure = names["life"].plot()
    return figure


def cost_against_error() -> Figure:
    """Return the time per point against the error, a line for each method of the benchmarks."""
    with BENCHMARKS.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(COLUMN, 3.2), layout="constrained")
        axes = figure.subplots()
        for number, method in enumerate(dict.fromkeys(row["method"] for row in rows)):
            points = [row for row in rows if row["method"] == method]
            errors = [float(row["rms relative error"]) for row in points]
            times = [float(row["µs a point"]) for row in points]
            style: Any = {"color": PALETTE[number % len(PALETTE)], "linestyle": LINES[number % len(LINES)]}
            axes.plot(errors, times, label=method, marker="*" if method.startswith("wearlaw") else "o", **style)
            for row, error, time in zip(points, errors, times, strict=True) if len(points) > 1 else ():
                axes.annotate(row["cells"], (error, time), (0, 6), textcoords="offset points", ha="center", fontsize=7)
        axes.set(xlabel="rms relative error of the wear rate [-]", ylabel="time of an operating point [µs]")
        axes.set(xscale="log", yscale="log")
        axes.legend(title="with the number of cells")
    return figure


def reference_problem(xi: Any, eta: Any, phi: Any) -> wl.Problem:
    """Return the contact of the reference cases under other creepages [-] and spin [1/mm]."""
    return wl.Problem.ellipse(
        a=Q(6, "mm"),
        b=Q(6, "mm"),
        normal_force=Q(100, "kN"),
        shear_modulus=Q(82, "GPa"),
        poisson_ratio=0.28,
        friction_coefficient=0.3,
        longitudinal_creepage=Q(xi, ""),
        lateral_creepage=Q(eta, ""),
        spin=Q(phi, "1/mm"),
    )


def force_errors_in_words() -> str:
    """Return the sentence of the theory about FASTSIM's forces less those of the half-space theory, in % of μN."""
    table = pd.read_csv(REFERENCE, comment="#")
    problem = reference_problem(table.xi.to_numpy(), table.eta.to_numpy(), table.phi.to_numpy())
    sizes = []
    for bound in BOUNDS:
        contact = wl.contact_model("fastsim", bound=bound).solve_ellipse(problem)
        pairs = (contact.force_x, -table.fullX_fx.to_numpy()), (contact.force_y, -table.fullX_fy.to_numpy())
        # without the forces that are zero by symmetry
        found = 100.0 * np.concatenate([(ours / 30e3 - full)[full != 0.0] for ours, full in pairs])
        sizes.append(f"{np.abs(found).max():.1f} % with an rms of {np.sqrt(np.mean(found**2)):.1f} %")
    return "The largest error is {} with the elliptic bound, and {} with the parabolic one.".format(*sizes)


def creep_forces() -> wl.FigureData:
    """Return the forces of the models under longitudinal creepage alone and spin alone, with the half-space theory."""
    table = pd.read_csv(REFERENCE, comment="#")
    panels = []
    parts = ("x", "xi", "longitudinal creepage ξ [%]", 100.0, 6e-3), ("y", "phi", "spin φ [1/m]", 1000.0, 2e-3)
    for part, creepage, label, unit, last in parts:
        given = np.linspace(0.0, last, 121)
        problem = reference_problem(**{"xi": 0.0, "eta": 0.0, "phi": 0.0, creepage: given})
        curves = []
        for number, name in enumerate(("fastsim", "linear", "shen_hedrick_elkins", "polach")):
            force = getattr(wl.contact_model(name).solve(problem), f"force_{part}")
            curves.append(wl.Curve(name, unit * given, force / 30e3, number, number))
        alone = table[(table[creepage] != 0.0) & ((table[["xi", "eta", "phi"]] != 0.0).sum(axis=1) == 1)]
        x, y = unit * alone[creepage].to_numpy(), -alone[f"fullX_f{part}"].to_numpy()
        curves.append(wl.Curve("half-space theory", x, y, BLACK, points=True))
        y_axis = wl.PlotAxis(f"F{part}/(μN) [-]", ends=(0.0, 1.1))
        panels.append(wl.Panel(wl.PlotAxis(label), y_axis, tuple(curves)))
    return wl.FigureData("creep_forces", "Forces of the models of elliptic contact", tuple(panels))


def falling_friction() -> wl.FigureData:
    """Return the traction coefficient of two models under friction that falls with the creep speed."""
    friction = wl.FallingFriction(static_coefficient=0.55, limit_ratio=0.4, decay="0.6 s/m")
    rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    given = np.geomspace(0.01, 10.0, 121)
    curves = []
    for number, model in ((0, wl.contact_model("fastsim")), (3, wl.contact_model("polach", slip_reduction=0.4))):
        c = (rig | model)(normal_force="80 kN", longitudinal_creepage=Q(given, "%"), friction_coefficient=friction)
        curves.append(wl.Curve(model.name, given, c.traction_coefficient.m, number, number))
    curves.append(wl.Curve("friction coefficient", given, c.friction_coefficient.m, BLACK, 1))
    axes = wl.PlotAxis("longitudinal creepage ξ [%]", "log"), wl.PlotAxis("traction coefficient T/N [-]")
    return wl.FigureData("falling_friction", "Friction that falls", (wl.Panel(*axes, tuple(curves)),))


if __name__ == "__main__":
    draw()
