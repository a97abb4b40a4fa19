"""Table 4 of Tassini et al. (2010) as a fit: parameters of USFD on cells that make its mean follow the global law."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd

import wearlaw as wl
from wearlaw import Q
from wearlaw_apps.fits import WearTests
from wearlaw_apps.papers.tassini2010.bench import WEAR_RATE, Bench
from wearlaw_apps.papers.tassini2010.claims import SIMILAR, verdict
from wearlaw_apps.papers.tassini2010.tables import USFD_UNITS, number, shown_unit, usfd_parameters

FREE = ("q_s", "m_c", "tr_sc")
"""The parameters that the paper changed; it kept m_m."""

HIGHEST = (18.0, 20.5, 22.0, 25.0)
"""Creepages up to which parameters are fitted [%]."""

POINTS = 200
"""Number of creepages in a fit, evenly spaced."""

Norm = Literal["absolute", "relative"]

NORMS: tuple[Norm, ...] = ("absolute", "relative")
"""Measures of the difference from the global law."""

THEORY = {"exact": "exact theory", "fastsim": "simplified theory"}

TEXT = """\
The paper chose the corrected parameters of Table 4 so that USFD on cells gives the same results as on the patch \
means. It states neither the range of creepage nor the measure of the difference. Here q_s, m_c and tr_sc are fitted \
by least squares to the rates of the global law, at {points} evenly spaced creepages, by absolute and by relative \
differences and up to several creepages; m_m keeps its value. Each fit starts from the paper's set. There is no noise, \
so the residual shows the limits of three parameters: near the onset of catastrophic wear, where the middle of the \
patch is past it and the mean is not, no set for cells reproduces the kink of the global law. Such a set belongs to \
its contact model, traction bound, geometry, load, friction and range of creepage; it is no property of the steels."""


@dataclass(frozen=True)
class Fitted:
    """A fit, with the root mean square of its residuals and of the paper's set's residuals at the same creepages.

    Residuals are in µg/m/mm², or ln(local/global), which is close to the relative difference.
    """

    model: str
    highest: float
    norm: Norm
    parameters: dict[str, float]
    rms: float
    rms_published: float


def section(study: wl.Study) -> wl.Section:
    """Return the section; see `Bench.of` for what it needs."""
    bench = Bench.of(study)
    fits = [fitted(bench, model, highest, norm) for model in THEORY for norm in NORMS for highest in HIGHEST]
    return wl.Section(
        title="Table 4 of the paper as a fit",
        text=TEXT.format(points=POINTS),
        claims=(follows_from_a_fit(fits),),
        tables={"table_4_fit": table(fits)},
    )


def fitted(bench: Bench, model: str, highest: float, norm: Norm) -> Fitted:
    """Return the fit for a contact model up to a creepage [%]."""
    creepage = np.linspace(highest / POINTS, highest, POINTS)
    target = bench.rate("global", wl.wear_law("usfd"), creepage)
    published = wl.wear_law("usfd", fitted_for=model)
    tests = WearTests.from_arrays(
        creepage=Q(creepage, "%"),
        normal_force_per_width=bench.normal_force_per_width,
        friction_coefficient=bench.friction_coefficient,
        wear_rate=Q(target, WEAR_RATE),
        source="USFD on the patch means",
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)  # the study itself has already warned
        predict = bench.rig | wl.contact_model(model) | published
        fit = wl.fit(predict, tests, free=FREE, scatter=norm, bootstrap=0, starts=0)
    values = {name: number(fit.parameters[name], USFD_UNITS[name]) for name in FREE}
    local = bench.rate(model, published, creepage)
    apart = local - target if norm == "absolute" else np.log(local / target)
    return Fitted(model, highest, norm, values, float(fit.rms.magnitude), float(np.sqrt(np.mean(apart**2))))


def follows_from_a_fit(fits: list[Fitted]) -> wl.CheckedClaim:
    """Compare the paper's sets with the fits for other ranges and measures of the difference."""
    parts, ours = [], []
    for model, words in THEORY.items():
        published, of_model = usfd_parameters(model), [fit for fit in fits if fit.model == model]
        apart = [max(abs(fit.parameters[name] / published[name] - 1.0) for name in FREE) for fit in of_model]
        near = sum(share < SIMILAR for share in apart)
        parts += [near > 0, near == len(of_model)]
        ours.append(f"{near} of {len(of_model)} fits similar, the closest to {100 * min(apart):.1f} % ({words})")
    return wl.CheckedClaim(
        theirs="The corrected parameters are those that make the local USFD reproduce the global one.",
        where="Section 5.2, Table 4",
        ours="; ".join(ours),
        verdict=verdict(parts),
        why="The paper states neither range nor measure of its fit, on which the parameters depend.",
    )


def table(fits: list[Fitted]) -> pd.DataFrame:
    """Return the fits, a row each, with the paper's set of their model before them."""
    heads = {name: f"{name} [{shown_unit(name)}]" for name in FREE}
    rows: list[dict[str, object]] = []
    for model, words in THEORY.items():
        published = usfd_parameters(model)
        rows.append({"contact model": words, "differences": "paper", **{heads[name]: published[name] for name in FREE}})
        rows += [
            {
                "contact model": words,
                "differences": "absolute [µg/m/mm²]" if fit.norm == "absolute" else "ln(local/global) [-]",
                "up to creepage [%]": fit.highest,
                **{heads[name]: round(fit.parameters[name], 2) for name in FREE},
                "rms of the fit": round(fit.rms, 4),
                "rms of the paper's set": round(fit.rms_published, 4),
            }
            for fit in fits
            if fit.model == model
        ]
    order = ["contact model", "differences", "up to creepage [%]", *heads.values()]
    return pd.DataFrame(rows, columns=[*order, "rms of the fit", "rms of the paper's set"])
