"""The uncertainty of the predictions of a case: every contact model with every wear law."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from wearlaw.errors import InputError
from wearlaw.models.law import WEAR
from wearlaw.units.quantities import WEAR_RATE
from wearlaw.units.variables import name_of
from wearlaw_apps.fits.uncertainty import CONFIDENCE, Uncertainty, uncertainty
from wearlaw_apps.output.curves import FigureData
from wearlaw_apps.output.labels import readable
from wearlaw_apps.output.notes import Notes
from wearlaw_apps.studies.case import Case
from wearlaw_apps.studies.results import pairs_of


@dataclass(frozen=True, eq=False)
class CaseUncertainty:
    """The uncertainty of the predictions of a case.

    Attributes
    ----------
    figures : list of FigureData
        The samples of each operating point and pair; their names are such as "scatter_usfd_on_exact".
    wear_rates : pandas.DataFrame
        Median and interval for each operating point and pair. If there are other outcomes than wear, they have rows
        here too, and columns say which outcome and unit each row has.
    indices : pandas.DataFrame
        Sobol indices, with a row for each input.
    samples : int
        Samples for each pair and operating point.
    notes : tuple of str
        Remarks for the reader.
    """

    figures: list[FigureData]
    wear_rates: pd.DataFrame
    indices: pd.DataFrame
    samples: int
    notes: tuple[str, ...]


def uncertainty_of(
    case: Case, samples: int, seed: int, on_pair: Callable[[int], None] = lambda _: None
) -> CaseUncertainty:
    """Return the uncertainty of the predictions of a case; `on_pair` is called with 1 after each pair.

    Raises
    ------
    InputError
        If nothing in the case is uncertain.
    """
    notes = Notes()
    pairs = pairs_of(case, notes)
    if not any(point.varies(pair.law) for point in case.uncertainty.values() for pair in pairs):
        raise InputError(
            "nothing in the case is uncertain; add a table such as [uncertainty.scatter] in which some conditions are"
            ' distributions, as in creepage = {uniform = ["0.5 %", "1.5 %"]}'
        )
    figures, rates, indices, used = [], [], [], samples
    for name, point, pair in ((name, point, pair) for name, point in case.uncertainty.items() for pair in pairs):
        subject = f"{name}, {pair.label}"
        if not point.varies(pair.law):
            notes.add(f"{subject} is left out, since none of its inputs is uncertain")
            on_pair(1)
            continue
        with notes.of(subject):
            law = point.parameters(pair.law)
            result = uncertainty(pair.pipeline, law=law, samples=samples, seed=seed, **point.conditions())
            each, used = [result.of(outcome) for outcome in result.outcomes], result.samples
            rates += [{"point": name, "pair": pair.label, **_interval(single)} for single in each]
        for single in each:
            (outcome,) = single.outcomes
            if np.ptp(single[outcome].magnitude) == 0.0:
                notes.add(f"{subject}: the {name_of(outcome)} is the same in all samples")
            else:
                where = {"point": name, "pair": pair.label, "outcome": outcome}
                indices.append(single.sobol().reset_index().assign(**where))
            words = name_of(outcome)
            title = f"{words[:1].upper()}{words[1:]} by {pair.label}: {name}"
            file = re.sub(r"\W+", "_", f"{name} {pair.label} {outcome if len(each) > 1 else ''}").strip("_")
            figures.append(replace(single.figure_data(), name=file, title=title))
        on_pair(1)
    only_wear = all(row["outcome"] == WEAR for row in rates)
    front = ["point", "pair"] if only_wear else ["point", "pair", "outcome"]
    table = pd.concat(indices, ignore_index=True) if indices else pd.DataFrame(columns=front)
    shares = table[[*front, *table.columns.drop(["point", "pair", "outcome"], errors="ignore")]]
    medians = pd.DataFrame(rates)
    if only_wear:
        ends = {name: f"{name} [{readable(WEAR_RATE)}]" for name in medians.columns.drop(["point", "pair"])}
        medians = medians.drop(columns=["outcome", "unit"]).rename(columns=ends)
    return CaseUncertainty(figures, medians, shares, used, tuple(notes.texts))


def _interval(result: Uncertainty) -> dict[str, str | float]:
    low, high = result.interval(CONFIDENCE)
    ends = {"median": result.median, f"{50 - 50 * CONFIDENCE:g} %": low, f"{50 + 50 * CONFIDENCE:g} %": high}
    values = {name: float(value.to(result.unit or "dimensionless").magnitude) for name, value in ends.items()}
    return {"outcome": result.outcomes[0], "unit": result.unit or "-", **values}
