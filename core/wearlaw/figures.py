"""The pictures of a study, drawn with matplotlib in one style.

Colour tells the wear law and line style the contact model, in a palette that colour-blind people can tell
apart (Okabe and Ito, 2008). Bands show the published range of a law's parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from wearlaw.study import Study, along_main_axis, axes_of, main_axis
from wearlaw.variables import NAMES, UNITS, label

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

    from wearlaw.arrays import Array

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
LINES = ("-", "--", ":", "-.")
STYLE: Any = {
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "legend.fontsize": "small",
    "font.size": 10,
    "lines.linewidth": 1.6,
}


def figures(study: Study) -> dict[str, Callable[[], Figure]]:
    """Return what draws each figure of a study, by the name that its file gets."""
    drawn: dict[str, Callable[[], Figure]] = {}
    for name, sweep in study.sweeps.items():
        for x in ("wear_index", main_axis(sweep)):
            drawn[f"{name}_wear_rate_against_{x}"] = lambda sweep=sweep, x=x: wear_rate(study, sweep, x)  # type: ignore[misc]
        if main_axis(sweep) == "creepage":
            drawn[f"{name}_traction_against_creepage"] = lambda sweep=sweep: traction(study, sweep)  # type: ignore[misc]
    for name, profile in study.profiles.items():
        if profile:
            drawn[f"{name}_along_the_patch"] = lambda name=name: along_the_patch(study, name)  # type: ignore[misc]
    return drawn


def wear_rate(study: Study, sweep: xarray.Dataset, x: str) -> Figure:
    """Return wear rate against wear index or against a condition, for every pair."""
    line = along_main_axis(sweep)
    with mpl.rc_context(STYLE):
        figure, axes = _figure(study, sweep)
        colours = dict(zip(dict.fromkeys(line.pair_wear_law.values), PALETTE * 9, strict=False))
        styles = dict(zip(line.contact_model.values, LINES * 9, strict=False))
        for pair in line.pair.values:
            one = line.sel(pair=pair)
            model, law = one.pair_contact_model.item(), one.pair_wear_law.item()
            along = _along(one.sel(contact_model=model), x)
            style: Any = {"color": colours[law], "linestyle": styles[model], "marker": _marker(along)}
            axes.plot(along, one.wear_rate, label=pair, **style)
            if (one.wear_rate_high > one.wear_rate_low).any():
                axes.fill_between(along, one.wear_rate_low, one.wear_rate_high, color=colours[law], alpha=0.08, lw=0)
        axes.set(xlabel=label(x), ylabel=label("wear_rate"))
        _log_x(axes)
        _log_y(axes)
        axes.legend(title="bands: published range of parameters" if _has_band(line) else None)
    return figure


def traction(study: Study, sweep: xarray.Dataset) -> Figure:
    """Return traction against creepage for every contact model, with the measured points."""
    line = along_main_axis(sweep)
    with mpl.rc_context(STYLE):
        figure, axes = _figure(study, sweep)
        for number, model in enumerate(line.contact_model.values):
            one = line.sel(contact_model=model)
            along = _along(one, "creepage")
            axes.plot(
                along,
                abs(one.tangential_force) / one.normal_force,
                label=model,
                color=PALETTE[number % len(PALETTE)],
                linestyle=LINES[number % len(LINES)],
                marker=_marker(along),
            )
        if study.case.measured is not None:
            creepage, measured = study.case.measured.points(study.case.rig)
            label_text = _literal(study.case.measured.label)
            axes.plot(100.0 * abs(creepage), measured, "o", color="black", ms=4, label=label_text)
        axes.set(xlabel=label("creepage"), ylabel=label("traction_coefficient"), ylim=(0.0, None))
        _log_x(axes)
        axes.legend()
    return figure


def along_the_patch(study: Study, name: str) -> Figure:
    """Return pressure, traction and slip along the patch for every contact model that resolves it."""
    profile = study.profiles[name]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.4, 6.4), layout="constrained")
        stresses, slip = figure.subplots(2, sharex=True)
        stresses.set_title(_literal(study.case.title))
        for number, model in enumerate(profile.contact_model.values):
            one = profile[["pressure", "traction", "traction_bound", "slip"]].sel(contact_model=model).dropna("x")
            if number == 0:
                stresses.plot(one.x, one.pressure, color="0.6", label=NAMES["pressure"])
            colour, style = PALETTE[number % len(PALETTE)], LINES[number % len(LINES)]
            stresses.plot(one.x, one.traction, label=f"q, {model}", color=colour, linestyle=style)
            stresses.plot(one.x, one.traction_bound, color=colour, linestyle=style, lw=0.6)
            slip.plot(one.x, one.slip, label=model, color=colour, linestyle=style)
        stresses.set(ylabel="stress [MPa] (thin: bound)")
        slip.set(xlabel=label("x"), ylabel=label("slip"))
        stresses.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        slip.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def _figure(study: Study, sweep: xarray.Dataset) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(6.4, 4.8), layout="constrained")
    axes = figure.subplots()
    fixed = [axis for axis in axes_of(sweep) if axis != main_axis(sweep)]
    at = ", ".join(f"{NAMES[axis]} {along_main_axis(sweep)[axis].item():.4g} {UNITS[axis]}".rstrip() for axis in fixed)
    title = _literal(study.case.title)
    axes.set_title(f"{title}\n{at}" if at else title)
    return figure, axes


def _literal(text: str) -> str:
    """Return a text that matplotlib shows as it is: no formula between dollar signs, no hidden legend entry."""
    shown = text.replace("$", r"\$")
    return f" {shown}" if shown.startswith("_") else shown


def _marker(along: Array) -> str:
    """Return the marker of a line; a line of one point would not be seen without."""
    return "o" if along.size == 1 else ""


def _along(line: xarray.Dataset, x: str) -> Array:
    values: Array = abs(line[x]).values
    return values


def _has_band(line: xarray.Dataset) -> bool:
    return bool((line.wear_rate_high > line.wear_rate_low).any())


def _log_x(axes: Axes) -> None:
    """Use a logarithmic axis unless that would hide everything, as at zero creepage."""
    if any((np.asarray(line.get_xdata()) > 0).any() for line in axes.get_lines()):
        axes.set_xscale("log")


def _log_y(axes: Axes) -> None:
    """Use a logarithmic axis unless that would hide everything, as where there is no wear."""
    if any((np.asarray(line.get_ydata()) > 0).any() for line in axes.get_lines()):
        axes.set_yscale("log")
