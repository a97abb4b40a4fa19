"""The command about uncertainty."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from wearlaw.cli.formats import written_formats
from wearlaw.cli.printing import print_notes, print_results
from wearlaw.sweeping.progress import Bar

if TYPE_CHECKING:
    from wearlaw.figures.formats import FigureFormat


@click.command()
@click.argument("case")
@click.option("--samples", type=int, default=2**14, show_default=True, help="How many, rounded up to a power of two.")
@click.option("--seed", type=int, default=0, show_default=True, help="The same seed gives the same samples.")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="Folder for the results [default: CASE-uncertainty]."
)
@click.option("--overwrite", is_flag=True, help="Replace the files of this command in that folder; others stay.")
@written_formats
def uncertainty(
    case: str,
    samples: int,
    seed: int,
    output: Path | None,
    overwrite: bool,
    figure_formats: tuple[FigureFormat, ...],
    latex: bool,
) -> None:
    """Say how uncertain predictions are: CASE is a case file with tables [uncertainty.NAME].

    Every contact model of the case is paired with every wear law. Written are wear_rates.csv with medians and 95 %
    intervals, sobol_indices.csv with the share of the variance that each input explains, and a figure of each pair.
    """
    from wearlaw.output.folder import fresh_folder
    from wearlaw.output.uncertainty import UNCERTAINTY, write_uncertainty
    from wearlaw.study.case import load_case
    from wearlaw.study.uncertainty import uncertainty_of

    loaded = load_case(case)
    folder = output if output is not None else Path(f"{Path(case).stem}-uncertainty")
    total = len(loaded.uncertainty) * len(loaded.contact_models) * len(loaded.wear_laws)
    with fresh_folder(folder, overwrite, UNCERTAINTY) as fresh, Bar(total) as shown:
        found = uncertainty_of(loaded, samples, seed, shown)
        shown.stage("writing results")
        names = write_uncertainty(loaded, found, seed, fresh, figure_formats, latex)
    if found.samples != samples:
        click.echo(f"Samples: {samples} rounded up to {found.samples}, a power of two, as Sobol sequences need it")
    print_notes(found.notes)
    for table in (found.wear_rates, found.indices):
        if len(table):
            click.echo(table.to_string(index=False, float_format=lambda number: f"{number:.4g}"))
    print_results(folder, names)


COMMANDS = (uncertainty,)
