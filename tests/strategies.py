"""Contact models and strategies that several test files share."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

import wearlaw as wl

EPS = float(np.finfo(np.float64).eps)

MODELS: dict[str, wl.ContactModel] = {
    "exact": wl.contact_model("exact"),
    "exact-as_printed": wl.contact_model("exact", slip="as_printed"),
    "fastsim-parabolic-line": wl.contact_model("fastsim"),
    "fastsim-parabolic-kalker": wl.contact_model("fastsim", flexibility="kalker"),
    "fastsim-elliptic-line": wl.contact_model("fastsim", bound="elliptic"),
    "fastsim-elliptic-kalker": wl.contact_model("fastsim", bound="elliptic", flexibility="kalker"),
    "global": wl.contact_model("global"),
    "global-of-elliptic": wl.contact_model("global", total_from=wl.contact_model("fastsim", bound="elliptic")),
}
"""Every configuration of the contact models that has a theory of its own."""

LINE_MODELS = {name: model for name, model in MODELS.items() if isinstance(model, wl.LineContactModel)}


def saturation_creepage(problem: wl.Problem) -> float:
    """Return μa/R."""
    return float(problem.friction_coefficient * problem.half_width / problem.relative_radius)


def with_creepage(problem: wl.Problem, creepage: wl.Array | float) -> wl.Problem:
    """Return the problem at another longitudinal creepage."""
    return problem.replaced(longitudinal_creepage=np.asarray(creepage, dtype=np.float64))


def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """Return floats that are uniform in their logarithm."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda exponent: float(10.0**exponent))
