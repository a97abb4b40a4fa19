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
    return [*names, *_write(folder, FIT, record, tables, fit.figure_data(), figure_formats, latex)]


def write_comparison(
    comparison: Comparison,
    notes: Sequence[str],
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write a comparison into an empty folder and return the names of the files, the ranking first.

    Parameters, errors: as for `write_fit`.
    """
    record = {
        "wearlaw": __version__,
        "tests": comparison.tests.source,
        "cross_validated": comparison.cross_validated,
        "predictors": {one.names.label: one.pipeline.model_dump(mode="json") for one in comparison.compared},
        "notes": list(notes),
    }
    tables = {"ranking": comparison.table(), "predictions": comparison.predictions()}
    return _write(folder, COMPARISON, record, tables, comparison.figure_data(), figure_formats, latex)


def write_wear(
    tables: Mapping[str, pd.DataFrame],
    figure: FigureData | None,
    laws: Sequence[Law],
    notes: Sequence[str],
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write the wear in contacts of other programs into an empty folder and return the names of the files.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        The tables by the names of their files.
    figure : FigureData or None
        The figure, if there is one.
    laws : sequence of Law
        The laws.
    notes, folder, figure_formats, latex
        As for `write_fit`.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    record = {"wearlaw": __version__, "laws": [specification(law) for law in laws], "notes": list(notes)}
    return _write(folder, WEAR, record, tables, figure, figure_formats, latex)


def _write(
    folder: Path,
    marker: str,
    record: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    figure: FigureData | None,
    figure_formats: Sequence[FigureFormat],
    latex: bool,
) -> list[str]:
    """Write tables, a figure if there is one, and a JSON record."""
    with writing():
        names = [file for name, frame in tables.items() for file in save_table(frame, folder, name, latex)]
        if figure is not None:
            names += save_figure(figure, folder, figure.name, figure_formats)
        text = json.dumps(record, indent=2, ensure_ascii=False)
        (folder / marker).write_text(text + "\n", encoding="utf-8")
    return [*names, marker]


def write_uncertainty(
    case: Case,
    found: CaseUncertainty,
    seed: int,
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write tables, figures and a JSON record into an empty folder, and return the names of the files.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    files = written(case)
    record = {
        "samples": found.samples,
        "seed": seed,
        "provenance": provenance(case),
        "notes": list(found.notes),
    }
    with writing():
        names = save_table(found.wear_rates, folder, "wear_rates", latex)
        if len(found.indices):
            names += save_table(found.indices, folder, "sobol_indices", latex)
        figures = []
        for one in found.pairs:
            figure = one.uncertainty.figure_data()
            name = name_of(one.uncertainty.outcomes[0])
            figures.append(replace(figure, title=f"{name[:1].upper()}{name[1:]} by {one.pair.label}: {one.point}"))
        for file, figure in zip(figure_files(found.pairs), figures, strict=True):
            names += save_figure(figure, folder, file, figure_formats)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        text = json.dumps(record, indent=2, ensure_ascii=False)
        (folder / UNCERTAINTY).write_text(text + "\n", encoding="utf-8")
    return [*names, *files, UNCERTAINTY]


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
