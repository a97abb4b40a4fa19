"""Draws the picture of the page about choosing: the questions that lead to a contact model and to a wear law."""

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wearlaw_apps.output.style import PALETTE, STYLE

MODELS = (
    ("Discs, or a wheel on a rail?", ""),
    ("discs, with one mean for the patch", "global"),
    ("discs, with stick and slip resolved", "exact"),
    ("a wheel: wear, also across the tread", "strip_theory"),
    ("a wheel: a reference, a patch at a time", "half_space"),
    ("a wheel: as other programs have it", "fastsim"),
    ("a wheel: forces, no slip to speak of", "linear"),
    ("a wheel: forces in vehicle dynamics", "shen_hedrick_elkins"),
    ("a wheel: forces near the limit of adhesion", "polach"),
)
LAWS = (
    ("Which numbers do you have?", ""),
    ("none; R8T wheel steel, dry", "usfd"),
    ("none; wear set by pressure and slip speed", "kth"),
    ("none; Tγ of the whole patch is all you know", "brr"),
    ("one wear coefficient and a hardness", "archard"),
    ("mass per energy, with or without a limit", "energy"),
    ("points of fatigue damage against Tγ", "wlrm"),
)
"""The question first, then each answer with the name of its model."""


def column(axes: Axes, title: str, rows: tuple[tuple[str, str], ...], colour: str) -> None:
    """Draw a question with its answers below it, each with an arrow to a model."""
    (question, _), *answers = rows
    axes.set(xlim=(0.0, 1.0), ylim=(len(answers) + 0.2, -1.6))
    axes.axis("off")
    axes.text(0.0, -1.3, title, fontsize=12, fontweight="bold", va="center")
    axes.text(0.0, -0.6, question, fontsize=11, color=colour, va="center")
    for row, (answer, name) in enumerate(answers):
        axes.text(0.0, row + 0.2, answer, fontsize=9, va="center")
        box = {"boxstyle": "round,pad=0.35", "facecolor": "white", "edgecolor": colour}
        axes.text(1.0, row + 0.2, name, fontsize=9, va="center", ha="right", family="monospace", bbox=box)
        axes.axhline(row + 0.7, color="0.9", lw=0.8)


def picture() -> Figure:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10.4, 3.8), layout="constrained")
        left, right = figure.subplots(1, 2, gridspec_kw={"wspace": 0.08})
        column(left, "Contact model", MODELS, PALETTE[0])
        column(right, "Law", LAWS, PALETTE[1])
    return figure
