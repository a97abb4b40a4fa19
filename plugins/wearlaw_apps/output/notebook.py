"""HTML for notebooks: models with their fields, and predictions."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from wearlaw.models.model import Model
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.solution import Solution
from wearlaw_apps.output.conditions import Conditions
from wearlaw_apps.output.labels import long_name


def html(model: Model) -> str:
    """Return a model for a notebook."""
    fields = {name: getattr(model, name) for name in type(model).model_fields}
    rows = "".join(
        f"<tr><td><code>{escape(name)}</code></td><td>{escape(str(value))}</td></tr>"
        for name, value in fields.items()
        if value is not None
    )
    return f"<div><b>{escape(model.name)}</b><table>{rows}</table></div>"


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
