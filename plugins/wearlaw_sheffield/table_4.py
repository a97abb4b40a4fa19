"""Table 4 of Tassini et al. (2010) as a fit: parameters of USFD on cells that make its mean follow the global law."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd

import wearlaw as wl
from wearlaw import Array, Q
from wearlaw_sheffield.bench import TESTED, WEAR_RATE, Bench
from wearlaw_sheffield.claims import SIMILAR, percent, verdict
from wearlaw_sheffield.tables import USFD_UNITS, number, shown_unit, usfd_parameters

FREE = ("q_s", "m_c", "tr_sc")
"""The parameters that the paper changed; it kept m_m."""

HIGHEST = (18.0, 20.5, 22.0, 25.0)
"""Creepages up to which parameters are fitted [%]; `SHOWN` is the one of the first table and the figures."""

SHOWN = 20.5

POINTS = 200
"""Number of creepages in a fit, evenly spaced."""

STARTS = 0
"""Number of starting points of a fit besides the published set, which is near enough."""

Norm = Literal["absolute", "relative"]

NORMS: tuple[Norm, ...] = ("absolute", "relative")
"""Measures of the difference from the global law."""

THEORY = {"exact": "exact theory", "fastsim": "simplified theory"}

TEXT = """\
The paper chose the corrected parameters of Table 4 so that USFD on cells gives the same results as on the patch \
means. It states neither the range of creepage nor the measure of the difference. Here q_s, m_c and tr_sc are fitted \
by least squares of absolute differences to the rates of the global law, at {points} evenly spaced creepages up to \
{shown:g} %; m_m keeps its value. Each fit starts from the paper's set. There is no noise, so the residual shows the \
limits of three parameters: near the onset of catastrophic wear, where the middle of the patch is past it and the mean \
is not, no set for cells reproduces the kink of the global law.

{residuals}

The other tables repeat the fit for other ranges and with relative differences. {spread} Such a set belongs to its \
contact model, traction bound, geometry, load, friction and range of creepage; it is not a property of the steels."""


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

    @property
    def law(self) -> wl.WearLaw:
        """The law with the fitted parameters."""
        return _law(self.model, self.parameters)


def section(study: wl.Study) -> wl.Section:
    """Return the section; see `Bench.of` for what it needs."""
    bench = Bench.of(study)
    fits = [fitted(bench, model, highest, norm) for model in THEORY for highest in HIGHEST for norm in NORMS]
    shown = {one.model: one for one in fits if one.highest == SHOWN and one.norm == "absolute"}
    residuals = " ".join(_in_words(bench, model, one.law) for model, one in shown.items())
    spread = " ".join(_spread(fits, model) for model in THEORY)
    return wl.Section(
        title="Table 4 of the paper as a fit",
        text=TEXT.format(points=POINTS, shown=SHOWN, residuals=residuals, spread=spread),
        claims=(follows_from_a_fit(fits),),
        tables={
            "table_4_fit": side_by_side(shown),
            **{f"table_4_sensitivity_{norm}": sensitivity(fits, norm) for norm in NORMS},
        },
        figures=(residual_figure(bench, shown, "relative"), residual_figure(bench, shown, "absolute")),
    )


def fitted(bench: Bench, model: str, highest: float, norm: Norm) -> Fitted:
    """Return the fit for a contact model up to a creepage [%]."""
    creepage = np.linspace(highest / POINTS, highest, POINTS)
    target = bench.rate("global", wl.wear_law("usfd"), creepage)
    published = wl.wear_law("usfd", fitted_for=model)
    tests = wl.WearTests.from_arrays(
        creepage=Q(creepage, "%"),
        normal_force_per_width=bench.normal_force_per_width,
        friction_coefficient=bench.friction_coefficient,
        wear_rate=Q(target, WEAR_RATE),
        source="USFD on the patch means",
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)  # the study itself has already warned
        predict = bench.rig | wl.contact_model(model) | published
        found = wl.fit(predict, tests, free=FREE, scatter=norm, bootstrap=0, starts=STARTS)
    values = {name: number(found.parameters[name], USFD_UNITS[name]) for name in FREE}
    rms, of_published = (
        float(np.sqrt(np.mean(_residuals(bench.rate(model, law, creepage), target, norm) ** 2)))
        for law in (_law(model, values), published)
    )
    return Fitted(model, highest, norm, values, rms, of_published)


def _law(model: str, parameters: dict[str, float]) -> wl.WearLaw:
    values = {name: Q(value, USFD_UNITS[name]) for name, value in parameters.items()}
    return wl.wear_law("usfd", fitted_for=model, **values)


def _residuals(local: Array, target: Array, norm: Norm) -> Array:
    return local - target if norm == "absolute" else np.log(local / target)


def _in_words(bench: Bench, model: str, law: wl.WearLaw) -> str:
    """Return, in words, how far a fitted law and the paper's set are from the global law."""
    tested = bench.creepage >= TESTED[0]
    target = bench.rate("global", wl.wear_law("usfd"))
    said = []
    for name, one in (("the fit", law), ("the paper's set", wl.wear_law("usfd", fitted_for=model))):
        share = (bench.rate(model, one) / target - 1.0)[tested]
        said.append(f"{name} differs by {percent(float(share.min()))} to {percent(float(share.max()))}")
    return f"With the {THEORY[model]}, from {TESTED[0]:g} to {bench.creepage[-1]:g} % creepage, {' and '.join(said)}."


def _spread(fits: list[Fitted], model: str) -> str:
    """Return, in words, the range of each parameter over all fits."""
    said = []
    for name in FREE:
        values = [one.parameters[name] for one in fits if one.model == model]
        said.append(f"{name} from {min(values):.1f} to {max(values):.1f} {shown_unit(name)}")
    return f"With the {THEORY[model]} they give {', '.join(said)}."


def follows_from_a_fit(fits: list[Fitted]) -> wl.CheckedClaim:
    """Compare the paper's sets with the fits for other ranges and measures of the difference."""
    parts, ours = [], []
    for model, words in THEORY.items():
        published, of_model = usfd_parameters(model), [one for one in fits if one.model == model]
        apart = [max(abs(one.parameters[name] / published[name] - 1.0) for name in FREE) for one in of_model]
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


def side_by_side(shown: dict[str, Fitted]) -> pd.DataFrame:
    """Return the paper's sets beside the fits."""
    columns: dict[str, list[float]] = {}
    for model, one in shown.items():
        published = usfd_parameters(model)
        columns[f"{THEORY[model]}, paper"] = list(published.values())
        columns[f"{THEORY[model]}, fit"] = [round(one.parameters.get(name, published[name]), 2) for name in USFD_UNITS]
    return pd.DataFrame({"parameter": [f"{name} [{shown_unit(name)}]" for name in USFD_UNITS], **columns})


def sensitivity(fits: list[Fitted], norm: Norm) -> pd.DataFrame:
    """Return all fits by one measure of the difference, a row each."""
    unit = "[µg/m/mm²]" if norm == "absolute" else "of ln(local/global) [-]"
    rows = [
        {
            "contact model": one.model,
            "up to creepage [%]": one.highest,
            **{f"{name} [{shown_unit(name)}]": round(value, 2) for name, value in one.parameters.items()},
            f"rms of the fit {unit}": round(one.rms, 4),
            f"rms of the paper's set {unit}": round(one.rms_published, 4),
        }
        for one in fits
        if one.norm == norm
    ]
    return pd.DataFrame(rows)


def residual_figure(bench: Bench, shown: dict[str, Fitted], norm: Norm) -> wl.FigureData:
    """Return the differences from the global law over creepage, for the fit and for the paper's set."""
    inside = bench.creepage >= TESTED[0]
    x, target = bench.creepage[inside], bench.rate("global", wl.wear_law("usfd"))[inside]

    def curve(model: str, label: str, law: wl.WearLaw, style: int) -> wl.Curve:
        local = bench.rate(model, law)[inside]
        y = local - target if norm == "absolute" else 100.0 * (local / target - 1.0)
        return wl.Curve(label=label, x=x, y=y, colour=style, dash=style)

    unit = "[µg/m/mm²]" if norm == "absolute" else "[%]"
    panels = tuple(
        wl.Panel(
            x=wl.PlotAxis("creepage [%]"),
            y=wl.PlotAxis(f"local minus global wear rate {unit}"),
            curves=(
                curve(model, "parameters of the paper", wl.wear_law("usfd", fitted_for=model), 0),
                curve(model, f"fit up to {SHOWN:g} %", one.law, 1),
            ),
            title=THEORY[model].capitalize(),
        )
        for model, one in shown.items()
    )
    return wl.FigureData(
        name=f"table_4_residuals_{norm}",
        title=f"{'Difference' if norm == 'absolute' else 'Relative difference'} of the local USFD from the global one",
        panels=panels,
        caption="USFD on cells minus USFD on the patch means, with the corrected parameters of Table 4 and with"
        f" parameters fitted up to {SHOWN:g} % creepage by absolute differences, at"
        f" {bench.normal_force_per_width:.5g~P}.",
    )
