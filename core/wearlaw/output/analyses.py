"""Writing the results of a fit, a comparison, an uncertainty analysis, or of contacts that were read."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pandas as pd

from wearlaw.figures.curves import FigureData, FigureFormat
from wearlaw.fitting.comparison import Comparison
from wearlaw.fitting.result import Fit
from wearlaw.models.law import Law
from wearlaw.output.results import save_figure, save_table, writing
from wearlaw.plugins.fields import specification
from wearlaw.study.case import Case, written
from wearlaw.study.study import provenance
from wearlaw.study.uncertainty import CaseUncertainty, UncertainPair
from wearlaw.units.quantities import text_of
from wearlaw.units.variables import name_of
from wearlaw.version import __version__

FIT = "fit.json"
COMPARISON = "comparison.json"
UNCERTAINTY = "uncertainty.json"
WEAR = "wear.json"
LAW = "law.toml"

LONGEST_NAME = 100
"""Most bytes of a figure's name; file systems allow 255 for a name with its ending."""


def write_fit(
    fit: Fit,
    notes: Sequence[str],
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write a fit into an empty folder and return the names of the files, the fitted law first.

    Parameters
    ----------
    fit : Fit
        What to write.
    notes : sequence of str
        Remarks for the reader.
    folder : Path
        Where to.
    figure_formats : sequence of str
        The formats in which the figure is written.
    latex : bool
        Whether the tables are also written for LaTeX.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    record = {
        "parameters": {name: text_of(value) for name, value in fit.parameters.items()},
        "intervals": {name: [text_of(end) for end in ends] for name, ends in fit.intervals.items()},
        "interval_method": fit.interval_method,
        "aic": fit.aic,
        "lack_of_fit": [asdict(one) for one in fit.lack_of_fit],
        "provenance": fit.provenance,
        "predict": fit.predict.model_dump(mode="json"),
        "notes": list(notes),
    }
    names = []
    if fit.law is not None:
        fit.to_toml(folder / LAW)
        names.append(LAW)
    tables = {"parameters": fit.table(), "residuals": fit.residuals}
    return [*names, *_write(folder, FIT, record, tables, _named(fit.figure_data()), figure_formats, latex)]


def write_comparison(
    comparison: Comparison,
    notes: Sequence[str],
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write a comparison as `write_fit` writes a fit, the ranking first."""
    record = {
        "wearlaw": __version__,
        "tests": comparison.tests.source,
        "cross_validated": comparison.cross_validated,
        "predictors": {one.names.label: one.pipeline.model_dump(mode="json") for one in comparison.compared},
        "notes": list(notes),
    }
    tables = {"ranking": comparison.table(), "predictions": comparison.predictions()}
    return _write(folder, COMPARISON, record, tables, _named(comparison.figure_data()), figure_formats, latex)


def write_wear(
    tables: Mapping[str, pd.DataFrame],
    figure: FigureData | None,
    laws: Sequence[Law],
    notes: Sequence[str],
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write the wear in contacts of other programs as `write_fit` writes a fit; tables by the names of their files."""
    record = {"wearlaw": __version__, "laws": [specification(law) for law in laws], "notes": list(notes)}
    return _write(folder, WEAR, record, tables, _named(figure), figure_formats, latex)


def write_uncertainty(
    case: Case,
    found: CaseUncertainty,
    seed: int,
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write the uncertainty of a case, and the case itself, as `write_fit` writes a fit."""
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
    return _write(folder, UNCERTAINTY, record, tables, figures, figure_formats, latex, written(case))


def _named(figure: FigureData | None) -> dict[str, FigureData]:
    return {} if figure is None else {figure.name: figure}


def _write(
    folder: Path,
    marker: str,
    record: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    figures: Mapping[str, FigureData],
    figure_formats: Sequence[FigureFormat],
    latex: bool,
    texts: Mapping[str, str] | None = None,
) -> list[str]:
    """Write tables, figures and texts by the names of their files, and a JSON record."""
    with writing():
        names = [file for name, frame in tables.items() for file in save_table(frame, folder, name, latex)]
        for name, figure in figures.items():
            names += save_figure(figure, folder, name, figure_formats)
        record_text = json.dumps(record, indent=2, ensure_ascii=False) + "\n"
        for name, text in {**(texts or {}), marker: record_text}.items():
            (folder / name).write_text(text, encoding="utf-8")
            names.append(name)
    return names


def figure_files(pairs: Sequence[UncertainPair]) -> list[str]:
    """Return a file name for each figure, such as "scatter_usfd_on_exact" for an operating point called "scatter".

    Pairs with several outcomes add the outcome; names that would be equal add a number.
    """
    labels = [f"{one.point} {one.pair.label}" for one in pairs]
    names: list[str] = []
    for label, one in zip(labels, pairs, strict=True):
        text = label if labels.count(label) == 1 else f"{label} {one.uncertainty.outcomes[0]}"
        name = re.sub(r"\W+", "_", text).strip("_").encode()[:LONGEST_NAME].decode(errors="ignore")
        numbered = (f"{name}_{number}" for number in itertools.count(2))
        names.append(name if name not in names else next(other for other in numbered if other not in names))
    return names
