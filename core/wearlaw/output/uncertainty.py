"""Writing how uncertain the predictions of a case are."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from wearlaw.errors import OutputError
from wearlaw.figures.curves import FigureFormat
from wearlaw.output.results import save_figure, save_table
from wearlaw.study.case import Case, written
from wearlaw.study.study import provenance
from wearlaw.study.uncertainty import CaseUncertainty

UNCERTAINTY = "uncertainty.json"


def write_uncertainty(
    case: Case,
    found: CaseUncertainty,
    seed: int,
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    latex: bool = False,
) -> list[str]:
    """Write tables, figures and a record of it all into an empty folder, and return the names of the files.

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
    try:
        names = save_table(found.wear_rates, folder, "wear_rates", latex)
        if len(found.indices):
            names += save_table(found.indices, folder, "sobol_indices", latex)
        for number, one in enumerate(found.pairs, 1):
            figure = one.uncertainty.figure_data()
            titled = replace(figure, title=f"{one.pair.label}, {one.point}")
            names += save_figure(titled, folder, f"{one.point}_{number}", figure_formats)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        text = json.dumps(record, indent=2, ensure_ascii=False)
        (folder / UNCERTAINTY).write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise OutputError(f"output: cannot write the results: {error.strerror or error}") from None
    return [*names, *files, UNCERTAINTY]
