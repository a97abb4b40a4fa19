"""The command that predicts the wear of contacts that another program solved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
import pandas as pd

from wearlaw.fields import specification
from wearlaw.pipeline.prediction import Prediction
from wearlaw.version import __version__
from wearlaw_apps.contact_files.reading import read_contact
from wearlaw_apps.contact_files.worn import POWER_OF_CREEPAGES, POWER_OF_SLIP, profile_tables, worn_figure, worn_table
from wearlaw_apps.output.commands import answer, fields, folder_for, law_of, print_table
from wearlaw_apps.output.curves import FigureFormat
from wearlaw_apps.output.files import write_files, writes_results
from wearlaw_apps.output.folder import results_folder
from wearlaw_apps.output.labels import readable
from wearlaw_apps.output.notes import Notes
from wearlaw_apps.show import LAWS, completed

MOST = 12
"""Most contacts that are printed."""

APART = 0.01
"""Share by which the two powers may differ without a note."""


WEAR = "wear.json"


@click.command()
@click.argument("files", nargs=-1, required=True)
@click.option(
    "--law",
    "laws",
    required=True,
    multiple=True,
    metavar="LAW",
    shell_complete=completed(*LAWS),
    help="Law: usfd, NAME:FIELD=VALUE:FIELD=VALUE or a TOML file; repeat it for other outcomes or bodies.",
)
@click.option("--reader", metavar="NAME", help="Reader of the files [default: the one that recognises them].")
@click.option(
    "--option",
    "options",
    metavar="FIELD=VALUE",
    multiple=True,
    help="Set a field of the reader, such as density; may be repeated. wearlaw show NAME lists them.",
)
@click.option("--patch-mean", is_flag=True, help="Replace each contact by its means, for laws stated for them.")
@writes_results("FILE-wear")
def wear(
    files: tuple[str, ...],
    laws: tuple[str, ...],
    reader: str | None,
    options: tuple[str, ...],
    patch_mean: bool,
    output: Path | None,
    overwrite: bool,
    figure_formats: tuple[FigureFormat, ...],
) -> None:
    """Predict the wear of contacts that another program solved: FILES are its result files, such as CONTACT's .mat.

    \b
    wearlaw wear case.0001.mat --law usfd
    wearlaw wear case.0001a.mat case.0001b.mat --law kth --option density="7800 kg/m^3" -o flange/
    wearlaw wear case.0001.mat --law usfd:body=wheel --law kth:body=rail

    It prints forces, dissipated powers and the wear of each body. The folder then holds wear.csv, the table that is
    printed; a table and a figure of the wear across each patch; and wear.json with the laws and the notes.
    """  # noqa: D301
    first, *others = files
    folder = output or folder_for(first, "wear")
    notes, chosen = Notes(), [law_of(text) for text in laws]
    settings = fields("--option", options)
    labels = _labels(files)
    with results_folder(folder, overwrite, WEAR) as fresh:
        contact = read_contact(files if others else first, reader=reader, **settings)
        with notes.of("wear"):
            prediction = Prediction.of(contact.patch_mean() if patch_mean else contact, *chosen)
        if not others and prediction.problem.batch_shape:
            labels = [f"{labels[0]} {number}" for number in range(1, prediction.problem.size + 1)]
        with notes.of("wear"):
            table = worn_table(prediction, labels)
            figure = worn_figure(prediction, labels, " and ".join(law.name for law in chosen))
            tables = {"wear": table, **profile_tables(prediction, labels)}
        _note_powers(table, notes)
        with notes.of("figure"):
            record = {
                "wearlaw": __version__,
                "laws": [specification(law) for law in chosen],
                "notes": list(notes.texts),
            }
            names = write_files(fresh, WEAR, record, tables, [figure] if figure else [], figure_formats)
    answer(folder, names, notes.texts, lambda: _print(table), {"wear": table})


def _labels(files: Sequence[str]) -> list[str]:
    """Return the names of the files without their folders, or the paths if names are equal."""
    names = [Path(file).name for file in files]
    return names if len({*names}) == len(names) else [*files]


def _note_powers(table: pd.DataFrame, notes: Notes) -> None:
    """Note contacts whose two powers differ."""
    for name, of_creepages, of_slip in table[["contact", POWER_OF_CREEPAGES, POWER_OF_SLIP]].itertuples(index=False):
        if abs(of_slip - of_creepages) > APART * abs(of_creepages):
            notes.add(
                f"{name}: the slip of the nodes dissipates {of_slip:.4g} W, the creepages {of_creepages:.4g} W; the"
                " laws see the slip of the nodes, whose error falls with finer elements"
            )


def _print(table: pd.DataFrame) -> None:
    """Print a row for each quantity, with a column for each of the first contacts; the file holds all."""
    across = table.set_index("contact").T.rename_axis(columns=None)
    heads = [head.partition(" [") for head in across.index]
    across.index = pd.Index([name + bracket + readable(unit) for name, bracket, unit in heads])
    print_table(across.iloc[:, :MOST])
    if across.shape[1] > MOST:
        click.echo(f"... and {across.shape[1] - MOST} more contacts in wear.csv")
