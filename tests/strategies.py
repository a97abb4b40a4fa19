"""Hypothesis strategies and contact models that several test files share."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
from hypothesis import strategies as st

import wearlaw as wl

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

CROWDED = sorted(set(FULL_SLIP.values()))

EPS = float(np.finfo(np.float64).eps)


def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """Return floats that are uniform in their logarithm."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda exponent: float(10.0**exponent))


@st.composite
def line_problems(draw: st.DrawFn, crowded: Sequence[float] = CROWDED) -> wl.LineProblem:
    """Draw one operating point of two discs of unlike sizes and materials; one may be flat.

    The load is drawn as p0/E* = a/(2R) from 1e-5 to 0.03, the range from a light touch to where the patch is no
    longer small against the discs. Half the creepages lie anywhere in 1e-7 to 1, half crowd at full slip.

    Parameters
    ----------
    crowded : sequence of float
        Creepages over μa/R to crowd at.
    """
    radius = wl.hertz.relative_radius(draw(log_uniform(1e-3, 10.0)), draw(st.just(np.inf) | log_uniform(1e-3, 10.0)))
    modulus = wl.hertz.effective_modulus(
        draw(log_uniform(1e9, 1e12)), draw(st.floats(0.0, 0.5)), draw(log_uniform(1e9, 1e12)), draw(st.floats(0.0, 0.5))
    )
    ratio, friction = draw(log_uniform(1e-5, 3e-2)), draw(log_uniform(1e-2, 1.5))
    load = wl.hertz.force_from_max_pressure(np.asarray(ratio * modulus), radius, modulus)
    half_width = wl.hertz.half_width(load, radius, modulus)
    at_full_slip = st.builds(
        lambda centre, side, gap: centre * friction * float(half_width) / radius * (1.0 + side * gap),
        st.sampled_from(crowded),
        st.sampled_from([-1.0, 0.0, 1.0]),
        log_uniform(1e-12, 1e-1),
    )
    values = {
        "normal_force_per_width": load,
        "half_width": half_width,
        "max_pressure": wl.hertz.max_pressure(load, half_width),
        "relative_radius": radius,
        "effective_modulus": modulus,
        "friction_coefficient": friction,
        "creepage": min(draw(st.one_of(log_uniform(1e-7, 1.0), at_full_slip)), 1.0),
        "rolling_speed": draw(log_uniform(1e-2, 100.0)),
        "track_width": draw(log_uniform(1e-4, 1.0)),
        "density": draw(st.floats(1e3, 2e4)),
    }
    return wl.LineProblem(**{name: np.asarray(value, dtype=np.float64) for name, value in values.items()})


def with_creepage(problem: wl.LineProblem, creepage: float) -> wl.LineProblem:
    """Return the problem at another creepage."""
    return dataclasses.replace(problem, creepage=np.asarray(creepage, dtype=np.float64))


def saturation_creepage(problem: wl.LineProblem) -> float:
    """Return μa/R."""
    return float(problem.friction_coefficient * problem.half_width / problem.relative_radius)


def of_size(problem: wl.LineProblem, points: int) -> wl.LineProblem:
    """Return the one operating point of a problem `points` times."""
    fields = {f.name: getattr(problem, f.name) for f in dataclasses.fields(problem)}
    return wl.LineProblem(**{name: value.repeat(points) for name, value in fields.items() if value is not None})
