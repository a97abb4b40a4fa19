"""The command that runs a case file."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import click
import pandas as pd

from wearlaw.cli import Stopped
from wearlaw.errors import OutputError, shown
from wearlaw_apps.output.commands import answer, folder_for, print_table
from wearlaw_apps.output.curves import FigureFormat
from wearlaw_apps.output.files import writes_results
from wearlaw_apps.output.folder import results_folder
from wearlaw_apps.output.notes import Notes
from wearlaw_apps.show import completed
from wearlaw_apps.studies.case import load_case
from wearlaw_apps.studies.report.tables import NamedTable, summaries
from wearlaw_apps.studies.study import evaluations
from wearlaw_apps.studies.study import run as run_case
from wearlaw_apps.studies.written import RESULTS, check_room, without_csv, write
from wearlaw_apps.sweeps.progress import Bar


@click.command()
@click.argument("case", shell_complete=completed("case"))
@click.option("--workers", type=click.IntRange(1), default=1, show_default=True, help="Number of processes.")
@click.option("--resume", is_flag=True, help="Go on from the finished blocks of an interrupted run, in FOLDER.partial.")
@click.option(
    "--csv/--no-csv",
    default=None,
    help="Write results.csv or leave it out [default: write it up to 1 048 575 rows, those that Excel reads].",
)
@writes_results("CASE-results")
def run(
    case: str,
    output: Path | None,
    overwrite: bool,
    workers: int,
    resume: bool,
    csv: bool | None,
    figure_formats: tuple[FigureFormat, ...],
) -> None:
    """Run a study: CASE is a case file, or the name of a shipped one.

    Shipped are two_discs, my_tests, wheel_on_rail, wheelset, wheel_life and tassini2010.

    Every contact model of the case is paired with every law. Results are written as report.html, a page to open in a
    browser, results.nc (netCDF), results.csv, tables/*.csv, figures/*.png and case.toml, the case with every default
    spelt out.
    """
    loaded = load_case(case)
    folder = output or folder_for(case, "results")
    notes = Notes()
    partial = _partial(folder, resume)
    try:
        with results_folder(folder, overwrite, RESULTS) as fresh:
            left_out = without_csv(loaded, csv)
            check_room(loaded, folder, left_out is None)
            with Bar(evaluations(loaded)) as bar, notes.of("run"):
                study = run_case(loaded, bar, workers, partial, resume)
                if left_out is not None:
                    study = replace(study, notes=(*study.notes, left_out))
                with notes.of("figures"):
                    names = write(study, fresh, figure_formats, bar.stage, left_out is None)
    except KeyboardInterrupt:
        if partial.exists():
            raise Stopped(f"Stopped; finished blocks are in {shown(partial)}, and --resume goes on") from None
        raise
    _discard(partial)
    tables = summaries(study)
    record = {"title": loaded.title, "tables": {table.name: _by_column(table.frame) for table in tables}}
    answer(folder, names, [*study.notes, *notes.texts], lambda: _print(tables), record)


def _print(tables: Sequence[NamedTable]) -> None:
    for table in tables:
        click.echo(f"{table.title}: {table.frame.columns[0]}")
        print_table(table.frame.set_index(table.frame.columns[0]).rename_axis(None))


def _by_column(frame: pd.DataFrame) -> pd.DataFrame:
    """Return a table of a sweep with its axis in the first column, and a column for each row, with units."""
    unit, of_axis = (f" [{unit}]" if unit else "" for unit in frame.attrs["units"])
    over = str(frame.columns[0]).partition(" by ")[2].partition(" [")[0]
    rows = frame.itertuples(index=False, name=None)
    columns = {f"{label}{unit}": list(map(float, values)) for label, *values in rows}
    return pd.DataFrame({f"{over}{of_axis}": frame.attrs["at"], **columns})


def _partial(folder: Path, resume: bool) -> Path:
    """Return the folder of finished blocks for a folder of results.

    Raises
    ------
    OutputError
        If it exists and is not to be resumed.
    """
    named = folder if folder.name else folder.resolve()  # "." has no name
    partial = named.with_name(f"{named.name}.partial")
    if partial.exists() and not resume:
        raise OutputError(
            f"output: {shown(partial)} holds the finished blocks of an interrupted run; add --resume to go on with it,"
            " remove it, or choose another folder with -o"
        )
    return partial


def _discard(partial: Path) -> None:
    for store in partial.glob("*.zarr"):
        shutil.rmtree(store, ignore_errors=True)
    with suppress(OSError):  # it does not exist, or other files are in it
        partial.rmdir()
