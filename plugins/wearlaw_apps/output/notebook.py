"""HTML for notebooks: the fields of models, with a drawing of a rig and the curve of a law, and predictions.

Drawings are SVG in the colour of the text, written by hand, so that nothing else is loaded.
"""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

import numpy as np

from wearlaw import loader
from wearlaw.errors import WearlawError
from wearlaw.models.law import Law
from wearlaw.models.model import Model
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.solution import Solution
from wearlaw.units.quantities import Q
from wearlaw.units.variables import name_of
from wearlaw_apps.output.conditions import Conditions
from wearlaw_apps.output.labels import long_name, readable
from wearlaw_apps.output.notes import caught_warnings

WIDTH, HEIGHT = 280, 160
"""Of a drawing, in pixels."""

CREEPAGE = np.geomspace(0.05, 20.0, 60)
"""Creepages of the curve of a law [%]: SUROS at 1500 MPa with a friction coefficient of 0.45, and patch means."""


def html(model: Model) -> str:
    """Return a model for a notebook."""
    drawing = rig_drawing(model) if isinstance(model, Rig) else law_curve(model) if isinstance(model, Law) else ""
    fields = {name: getattr(model, name) for name in type(model).model_fields}
    rows = "".join(
        f"<tr><td><code>{escape(name)}</code></td><td>{escape(str(value))}</td></tr>"
        for name, value in fields.items()
        if value is not None
    )
    return f"<div><b>{escape(model.name)}</b><br>{drawing}<table>{rows}</table></div>"


def of_prediction(prediction: Prediction, solution: Solution, head: str, summary: Mapping[str, str]) -> str:
    """Return a prediction for a notebook: its models, its conditions and a table of its variables."""
    models = ", ".join(model.name for model in (prediction.contact_model, *prediction.laws))
    lines = [f"<b>{escape(head)}</b>", *map(escape, (models, Conditions.of(solution).text()))]
    rows = "".join(
        f"<tr><td>{escape(long_name(name, prediction.laws))}</td><td><code>{escape(name)}</code></td>"
        f"<td>{escape(text)}</td></tr>"
        for name, text in summary.items()
    )
    return f"<div>{'<br>'.join(filter(None, lines))}<table>{rows}</table></div>"


def _svg(inside: str) -> str:
    look = 'fill="none" stroke="currentColor" font-size="10"'
    return f'<svg width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" {look}>{inside}</svg>'


def _text(x: float, y: float, text: str) -> str:
    return f'<text x="{x:g}" y="{y:g}" fill="currentColor" stroke="none">{escape(text)}</text>'


def rig_drawing(rig: Rig) -> str:
    """Return the two bodies of a rig from the side, to scale: a circle each, or a line for a straight one."""
    sizes = {name: float(np.ravel(body.rolling_radius)[0]) for name, body in rig.bodies.items()}
    finite = [radius for radius in sizes.values() if np.isfinite(radius)]
    if len(sizes) != 2 or not finite:
        return ""
    scale = 0.45 * HEIGHT / sum(finite) if len(finite) == 2 else 0.4 * HEIGHT / finite[0]
    touching = 2.0 * finite[0] * scale + 5.0 if np.isfinite(next(iter(sizes.values()))) else 0.2 * HEIGHT
    drawn = []
    for (name, radius), side in zip(sizes.items(), (-1.0, 1.0), strict=True):
        if np.isfinite(radius):
            middle = touching + side * radius * scale
            drawn.append(f'<circle cx="{0.65 * WIDTH:g}" cy="{middle:.4g}" r="{radius * scale:.4g}"/>')
        else:
            drawn.append(f'<line x1="0" x2="{WIDTH}" y1="{touching:.4g}" y2="{touching:.4g}"/>')
        beside = touching + (14.0 if side > 0.0 else -20.0)
        size = f"radius {1e3 * radius:.4g} mm" if np.isfinite(radius) else "straight"
        drawn.append(_text(4.0, beside, name) + _text(4.0, beside + 11.0, size))
    return _svg("".join(drawn))


def law_curve(law: Law) -> str:
    """Return the outcome of a law over the wear index on logarithmic axes, or "" if it cannot be had on two discs."""
    rig, model = loader.rig("twin_disc", **DISCS), loader.contact_model("global")
    try:
        with caught_warnings():
            of_any = law.model_copy(update={"body": None})
            prediction = Pipeline(rig=rig, contact_model=model, laws=(of_any,)).predict(rig.checked_problem(CONDITIONS))
        x, y = prediction.wear_index.m_as("N"), prediction[law.outcome.name].m_as(law.outcome.unit or "")
    except WearlawError:
        return ""
    there = (x > 0.0) & (y > 0.0) & np.isfinite(y)
    if there.sum() < 2:
        return ""
    across, up = (np.log10(values[there]) for values in (x, y))
    at_x = 10.0 + (WIDTH - 20.0) * (across - across.min()) / (np.ptp(across) or 1.0)
    at_y = HEIGHT - 22.0 - (HEIGHT - 44.0) * (up - up.min()) / (np.ptp(up) or 1.0)
    points = " ".join(f"{px:.1f},{py:.1f}" for px, py in zip(at_x, at_y, strict=True))
    unit = readable(law.outcome.unit) or "-"
    head = f"{name_of(law.outcome.name)} {10 ** up.min():.3g} to {10 ** up.max():.3g} {unit}"
    foot = f"wear index Tγ {10 ** across.min():.3g} to {10 ** across.max():.3g} N, two discs"
    return _svg(f'<polyline points="{points}"/>{_text(4.0, 12.0, head)}{_text(4.0, HEIGHT - 4.0, foot)}')


DISCS = {
    **{f"disc_{number}": {"diameter": "47 mm", "material": "steel"} for number in (1, 2)},
    "track_width": "10 mm",
    "rolling_speed": "1 m/s",
}
CONDITIONS = {"max_pressure": "1500 MPa", "creepage": Q(CREEPAGE, "%"), "friction_coefficient": 0.45}
