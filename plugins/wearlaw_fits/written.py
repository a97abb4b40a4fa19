"""Writing the results of a fit or of a comparison."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from wearlaw.units.quantities import text_of
from wearlaw.version import __version__
from wearlaw_fits.comparison import Comparison
from wearlaw_fits.result import Fit
from wearlaw_output.curves import FigureFormat
from wearlaw_output.files import named, write_files

FIT = "fit.json"
COMPARISON = "comparison.json"
LAW = "law.toml"


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
    return [*names, *write_files(folder, FIT, record, tables, named(fit.figure_data()), figure_formats, latex)]


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
    return write_files(folder, COMPARISON, record, tables, named(comparison.figure_data()), figure_formats, latex)
