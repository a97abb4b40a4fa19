"""Draws the picture of the README: three wear laws on one contact, the regimes of wear, and where tests were run."""

import warnings
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

import wearlaw as wl
from wearlaw import Q
from wearlaw_apps.output.style import LINES, PAGE, PALETTE, STYLE

DENSITY, RATE = "N/mm^2", "ug/m/mm^2"
ENDS = (0.15, 140.0)
"""Ends of the axis of Tγ/A [N/mm²]."""
LAWS = {
    "usfd": "USFD law (University of Sheffield)",
    "kth": "KTH law (Stockholm), middle of its range",
    "brr": "BRR law (British Rail Research)",
}
CONTACT = wl.TwinDisc.suros() | wl.contact_model("global")
PRESSURE = Q(1500, "MPa")


def predicted(law: wl.WearLaw) -> wl.Prediction:
    """Return the wear of the discs of the tests at up to 20 % creepage, under the pressure of the tests."""
    creepage = Q(np.geomspace(0.1, 20.0, 2000), "%")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", (wl.CalibrationWarning, wl.RangeWarning, wl.PlasticityWarning))
        return (CONTACT | law)(max_pressure=PRESSURE, creepage=creepage, friction_coefficient=0.46)


def borders() -> tuple[float, float]:
    """Return Tγ/A [N/mm²] where USFD passes from mild to severe and from severe to catastrophic wear."""
    usfd: Any = wl.wear_law("usfd", fitted_for="global")
    return (usfd.q_s / usfd.m_m).m_as(DENSITY), usfd.tr_sc.m_as(DENSITY)


def tested() -> wl.Array:
    """Return the measured Tγ/A [N/mm²] of the tests."""
    tests = wl.read_tests("lewis2004")
    conditions = tests.conditions(CONTACT.contact_model, friction_coefficient=0.46, rig=CONTACT.rig)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.PlasticityWarning)
        density: wl.Array = CONTACT(**conditions).wear_index_density.m_as(DENSITY)
    return density


def picture() -> Figure:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE, 4.2), layout="constrained")
        axes = figure.subplots()
        low, high = borders()
        names = {"mild": (ENDS[0], low), "severe": (low, high), "catastrophic": (high, ENDS[1])}
        for (name, (start, end)), shade in zip(names.items(), ("1.0", "0.95", "0.88"), strict=True):
            axes.axvspan(start, end, color=shade, lw=0.0, zorder=0)
            size = 8 if name == "catastrophic" else 10
            axes.text(np.sqrt(start * end), 14000.0, f"{name}\nwear", ha="center", va="top", fontsize=size)
        for number, (name, label) in enumerate(LAWS.items()):
            found = predicted(wl.wear_law(name))
            x = found.wear_index_density.m_as(DENSITY)
            axes.plot(x, found.wear_rate.m_as(RATE), color=PALETTE[number], ls=LINES[number], lw=2.0, label=label)
            if name == "kth":
                ends = [predicted(wl.wear_law(name, coefficient=one)).wear_rate.m_as(RATE) for one in ("low", "high")]
                axes.fill_between(x, *ends, color=PALETTE[number], alpha=0.12, lw=0.0, label="KTH law, published range")
        points = tested()
        label = "twin-disc tests: energy measured"
        axes.plot(points, np.full_like(points, 0.35), "k|", ms=12, mew=1.5, label=label)
        axes.set(xscale="log", yscale="log", xlim=ENDS, ylim=(0.25, 20000.0))
        axes.set(xlabel="friction energy per metre rolled and contact area, Tγ/A [N/mm²]")
        axes.set(ylabel="wear rate [µg of steel per m rolled and mm²]")
        axes.set_title("How fast does steel wear in rolling contact? Three laws, one contact")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_major_formatter("{x:g}")
        figure.legend(loc="outside lower center", ncols=2)
    return figure
