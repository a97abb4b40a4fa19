"""Contact models that several test files share, and where the kit's strategies crowd for them."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw_kit.examples import EPS
from wearlaw_kit.reduced import saturation, with_creepage
from wearlaw_kit.strategies import line_problems, log_uniform

__all__ = [
    "EPS",
    "FULL_SLIP",
    "LINE_MODELS",
    "MODELS",
    "line_problems",
    "log_uniform",
    "saturation_creepage",
    "with_creepage",
]

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

FULL_SLIP = {
    "exact": 1.0,
    "exact-as_printed": 1.0,
    "fastsim-parabolic-line": 1.5,
    "fastsim-parabolic-kalker": 1.5 * 8.0 / (3.0 * np.pi),
    "global": 1.0,
}
"""Creepage of full slip over μa/R, for the models that saturate.

FASTSIM: 3μPL/(2a²) with L = 4a/(πE*) or 32a/(3π²E*), and P/E* = πa²/(4R).
"""


def saturation_creepage(problem: wl.Problem) -> float:
    """Return μa/R."""
    return float(saturation(problem))
