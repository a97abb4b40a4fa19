"""Writing the uncertainty of a case."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from wearlaw.units.variables import name_of
from wearlaw_output.curves import FigureFormat
from wearlaw_output.files import write_files
from wearlaw_studies.case import Case, written
from wearlaw_studies.study import provenance
from wearlaw_studies.uncertainty import CaseUncertainty, UncertainPair

UNCERTAINTY = "uncertainty.json"


def write_uncertainty(
    case: Case,
    found: CaseUncertainty,
    seed: int,
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write the uncertainty of a case, and the case itself, into an empty folder, and return the names of the files."""
    record = {
        "samples": found.samples,
        "seed": seed,
        "provenance": provenance(case),
        "notes": list(found.notes),
    }
    tables = {"wear_rates": found.wear_rates, **({"sobol_indices": found.indices} if len(found.indices) else {})}
    figures = {}
    for file, one in zip(figure_files(found.pairs), found.pairs, strict=True):
        name = name_of(one.uncertainty.outcomes[0])
        title = f"{name[:1].upper()}{name[1:]} by {one.pair.label}: {one.point}"
        figures[file] = replace(one.uncertainty.figure_data(), title=title)
    return write_files(folder, UNCERTAINTY, record, tables, figures, figure_formats, latex, written(case))


def figure_files(pairs: Sequence[UncertainPair]) -> list[str]:
    """Return a file name for each figure, such as "scatter_usfd_on_exact" for an operating point called "scatter".

    Pairs with several outcomes add the outcome.
    """
    labels = [f"{one.point} {one.pair.label}" for one in pairs]
    names = [
        label if labels.count(label) == 1 else f"{label} {one.uncertainty.outcomes[0]}"
        for label, one in zip(labels, pairs, strict=True)
    ]
    return [re.sub(r"\W+", "_", name).strip("_") for name in names]
