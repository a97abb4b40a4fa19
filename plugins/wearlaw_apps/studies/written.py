"""Writing the results of a study."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TypeVar

import pandas as pd
import xarray

from wearlaw.errors import OutputError, shown
from wearlaw.pipeline.variables import OF_CONTACT, OF_PATCH, OF_POINT
from wearlaw_apps.output.curves import FigureFormat
from wearlaw_apps.output.files import save_figure
from wearlaw_apps.output.spreadsheets import write_csv
from wearlaw_apps.studies.case import CASE_FILE, Case, written
from wearlaw_apps.studies.report.page import report
from wearlaw_apps.studies.report.tables import tables
from wearlaw_apps.studies.results import patch_axes
from wearlaw_apps.studies.study import Study
from wearlaw_apps.sweeps.points import ITEM
from wearlaw_apps.sweeps.results import CONVENTIONS
from wearlaw_apps.sweeps.room import check_disk, check_memory

RESULTS = "results.nc"
CSV = "results.csv"
FIGURES = "figures"
REPORT = "report.html"
TABLES = "tables"
VARIABLES = 20
"""Most numbers that a row of results takes; pairs share those of their contact model."""
COPIES = 2
"""Number of copies of a result in memory: the computed one, and one in the stack of all pairs."""
ROW_IN_MEMORY, ROW_ON_DISK = 800, 400
"""Bytes of a row of the table of results in memory (measured) and as CSV."""
MOST_ROWS = 2**20 - 1
"""Most rows of a table of results that is written unasked: those that a sheet of Excel holds below the head."""
T = TypeVar("T")


def rows_of(case: Case) -> int:
    """Return the most rows that the table of results of a case can have."""
    patches = math.prod(map(len, next(iter(case.sweeps.values())).problem(case.rig, case.models).dims.values()))
    points = sum(grid.size for grid in case.sweeps.values())
    return points * patches * len(case.contact_models) * len(case.laws_by_label)


def without_csv(case: Case, asked: bool | None) -> str | None:
    """Return a note on why results.csv is left out, or None if it is written: if asked for, or up to `MOST_ROWS`."""
    if asked is False:
        return f"{CSV} is left out, as --no-csv asks; {RESULTS} holds all numbers"
    rows = rows_of(case)
    if asked or rows <= MOST_ROWS:
        return None
    return (
        f"{CSV} is left out, since it would have up to {rows} rows, and Excel reads {MOST_ROWS}; {RESULTS} holds all"
        " numbers, and --csv writes the table too"
    )


def check_room(case: Case, folder: Path, csv: bool = True) -> None:
    """Raise an error if the results of a case would not fit into memory or on the disk of a folder."""
    count, rows = VARIABLES * rows_of(case), rows_of(case) if csv else 0
    check_memory(COPIES * ITEM * count + ROW_IN_MEMORY * rows, "give the sweeps fewer points")
    check_disk(2 * ITEM * count + ROW_ON_DISK * rows, folder)


def write(
    study: Study,
    folder: Path,
    figure_formats: Sequence[FigureFormat] = ("png",),
    on_stage: Callable[[str], None] = lambda _: None,
    csv: bool = True,
) -> list[str]:
    """Write a study's results into an empty folder and return the names of the files, the report first.

    `on_stage` is called with a text for each stage, to show progress.
    """
    case_files = written(study.case)
    on_stage("writing results")
    groups = {"/": xarray.Dataset(attrs={**CONVENTIONS, "title": study.case.title})}
    groups |= {f"sweeps/{name}": dataset for name, dataset in study.sweeps.items()}
    groups |= {f"profiles/{name}": dataset for name, dataset in study.profiles.items() if dataset}
    xarray.DataTree.from_dict(groups).to_netcdf(folder / RESULTS, engine="h5netcdf")
    if csv:
        write_csv(table(study), folder / CSV)
    for name, text in case_files.items():
        (folder / name).write_text(text, encoding="utf-8")
    names = [REPORT, RESULTS, *([CSV] if csv else []), *case_files]
    (folder / TABLES).mkdir()
    named_tables = ((named.name, named) for named in tables(study))
    for name, named in _by_name("table", named_tables).items():
        write_csv(named.frame, folder / TABLES / f"{name}.csv")
        names.append(f"{TABLES}/{name}.csv")
    (folder / FIGURES).mkdir()
    every = (*study.figures, *(figure for section in study.sections for figure in section.figures))
    for name, figure in _by_name("figure", ((figure.name, figure) for figure in every)).items():
        on_stage(f"drawing {name}")
        names += save_figure(figure, folder, f"{FIGURES}/{name}", figure_formats)
    on_stage("writing the report")
    (folder / REPORT).write_text(report(study, case_files[CASE_FILE]), encoding="utf-8")
    return names


def _by_name(kind: str, named: Iterable[tuple[str, T]]) -> dict[str, T]:
    """Return things by the names of their files, which must differ and be identifiers."""
    things: dict[str, T] = {}
    for name, thing in named:
        if name in things or not name.isidentifier():
            fault = "another has its name" if name in things else "letters, digits and underscores make a name"
            raise OutputError(f"output: the {kind} {shown(name)} cannot be written: {fault}")
        things[name] = thing
    return things


def table(study: Study) -> pd.DataFrame:
    """Return the results of all sweeps as one tidy table, a row for each pair at each operating point.

    If the rig makes several patches, there is a row for each existing patch. Columns that a sweep lacks stay empty, and
    so do outcomes that the law of a pair does not predict.
    """
    rows = pd.concat([_rows(name, sweep) for name, sweep in study.sweeps.items()], ignore_index=True)
    units = study.case.result_units
    variables = (*OF_POINT, *study.case.units, *OF_PATCH)
    of_point = [name for name in variables if name in rows and name not in OF_CONTACT]
    of_pairs = [str(v) for sweep in study.sweeps.values() for v in sweep.data_vars if "pair" in sweep[v].dims]
    of_rig = (str(v) for sweep in study.sweeps.values() for v in sweep.data_vars if "contact_model" in sweep[v].dims)
    of_contact = [name for name in (*OF_CONTACT, *of_rig) if name in rows]
    laws = ("wear_law", "law") if study.case.laws else ("wear_law",)
    patches = [axis for sweep in study.sweeps.values() for axis in patch_axes(sweep)]
    names = dict.fromkeys(("sweep", "contact_model", *laws, *patches, *of_point, *of_pairs, *of_contact))
    return rows[list(names)].rename(columns={name: f"{name} [{units[name]}]" for name in names if units.get(name)})


def _rows(name: str, sweep: xarray.Dataset) -> pd.DataFrame:
    of_contact = [v for v in sweep.data_vars if "contact_model" in sweep[v].dims]
    by_contact = sweep[of_contact].sel(contact_model=sweep.pair_contact_model).drop_vars("contact_model")
    every = sweep.drop_dims("contact_model").assign(by_contact.data_vars)
    flat = every.to_dataframe().reset_index()
    axes = patch_axes(sweep)
    if axes:
        flat = flat.dropna(how="all", subset=[v for v in every.data_vars if axes[0] in every[v].dims])
    flat = flat.rename(columns={"pair_contact_model": "contact_model", "pair_wear_law": "wear_law", "pair_law": "law"})
    flat.insert(0, "sweep", name)
    return flat.drop(columns="pair")
