"""Commands about case files: run one, print one, and the schema of them all."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from wearlaw.cli.formats import written_formats
from wearlaw.cli.printing import print_notes, print_results
from wearlaw.sweeping.progress import Bar
from wearlaw.version import __version__

if TYPE_CHECKING:
    from wearlaw.figures.formats import FigureFormat
    from wearlaw.report.tables import NamedTable
    from wearlaw.study.study import Study
    from wearlaw.sweeping.checkpoint import Checkpoint


@click.command()
@click.argument("case")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for the results [default: CASE-results].")
@click.option("--overwrite", is_flag=True, help="Replace the files of an earlier run in that folder; others stay.")
@click.option("--workers", type=click.IntRange(1), default=1, show_default=True, help="Processes that take part.")
@click.option(
    "--resume", is_flag=True, help="Go on with what an interrupted run has left in FOLDER.partial, if it has."
)
@written_formats
def run(
    case: str,
    output: Path | None,
    overwrite: bool,
    workers: int,
    resume: bool,
    figure_formats: tuple[FigureFormat, ...],
    latex: bool,
) -> None:
    """Run a study: CASE is a case file, or the name of one that is shipped (tassini2010, wheel_on_rail).

    Every contact model of the case is paired with every wear law. Results are written as report.html, a page to open in
    a browser, results.nc (netCDF), results.csv, tables/*.csv, figures/*.png and case.toml, the case with every default
    spelt out.
    """
    from wearlaw.output.folder import fresh_folder
    from wearlaw.output.results import RESULTS, check_room, write
    from wearlaw.report.tables import summaries
    from wearlaw.study.case import load_case
    from wearlaw.study.study import evaluations, provenance
    from wearlaw.study.study import run as run_case
    from wearlaw.sweeping.checkpoint import Checkpoint

    loaded = load_case(case)
    folder = output if output is not None else Path(f"{Path(case).stem}-results")
    checkpoint = Checkpoint(folder.parent / f"{folder.name}.partial", provenance(loaded), resume)
    with _kept(checkpoint), fresh_folder(folder, overwrite, RESULTS) as fresh:
        check_room(loaded, folder)
        with Bar(evaluations(loaded)) as shown:
            study = run_case(loaded, shown, workers, checkpoint)
            names = write(study, fresh, figure_formats, latex, shown.stage)
    print_notes([*study.notes, *checkpoint.notes()])
    for table in summaries(study):
        Console().print(_summary(table))
    _print_used(study)
    print_results(folder, names)


@contextmanager
def _kept(checkpoint: Checkpoint) -> Iterator[None]:
    """Keep a checkpoint until the results are in a folder, and say after an interrupt where it is."""
    from wearlaw.output.folder import ElsewhereError

    try:
        yield
    except ElsewhereError:
        checkpoint.remove()
        raise
    except KeyboardInterrupt:
        if checkpoint.exists:
            click.echo(f"What is done is kept in '{checkpoint.folder}'; add --resume to go on with it.", err=True)
        raise
    checkpoint.remove()


@click.command()
@click.argument("name")
def case(name: str) -> None:
    """Print a case file: NAME is the name of a shipped one (tassini2010, wheel_on_rail), or a path."""
    from wearlaw.study.case import case_text

    click.echo(case_text(name).encode(), nl=False)  # TOML is UTF-8, whatever the terminal speaks


@click.command()
def schema() -> None:
    """Print the JSON Schema of a case file with the options of the installed models."""
    from wearlaw.study.case import case_schema

    click.echo(json.dumps(case_schema(), indent=2, ensure_ascii=False).encode())


def _print_used(study: Study) -> None:
    """Print the version of wearlaw, and a line for each other distribution with what came from it."""
    from wearlaw.study.study import used

    provided: dict[str, list[str]] = {f"wearlaw {__version__}": []}
    for kind, names in used(study.case).items():
        for name, distribution in names.items():
            provided.setdefault(distribution, []).append(f"{kind} {name}")
    (ours, _), *others = provided.items()
    click.echo(f"Computed with {ours}")
    for distribution, things in others:
        click.echo(f"  and {distribution}: {', '.join(things)}")


def _summary(summary: NamedTable) -> Table:
    """Return a short table of wear rates for the screen."""
    what, *values = summary.frame.columns
    title = Text(f"{summary.title}: {what}")
    table = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE, pad_edge=False)
    table.add_column("", overflow="fold")
    for value in values:
        table.add_column(value, justify="right", no_wrap=True)
    for pair, *rates in summary.frame.itertuples(index=False, name=None):
        table.add_row(Text(pair), *(f"{rate:.4g}" for rate in rates))
    return table


COMMANDS = (run, case, schema)
