"""Writing tables and figures into files, the same bytes each time."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args

import click
import matplotlib as mpl
import pandas as pd

from wearlaw_apps.output.commands import printing
from wearlaw_apps.output.curves import FigureData, FigureFormat
from wearlaw_apps.output.drawing import draw
from wearlaw_apps.output.spreadsheets import write_csv
from wearlaw_apps.output.style import STYLE

CommandT = TypeVar("CommandT", bound=Callable[..., Any])

METADATA: dict[FigureFormat, Any] = {"png": {"Software": None}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}
"""Metadata to suppress in each format, so that the same figure gives the same bytes."""


def save_figure(figure: FigureData, folder: Path, name: str, formats: Sequence[FigureFormat]) -> list[str]:
    """Write a figure, as the same bytes each time, with no date in it, and return the names of the files."""
    drawn = draw(figure)
    files: dict[FigureFormat, str] = {extension: f"{name}.{extension}" for extension in formats}
    for extension, file in files.items():
        with mpl.rc_context(STYLE):
            drawn.savefig(folder / file, metadata=METADATA[extension])
    return list(files.values())


def write_files(
    folder: Path,
    marker: str,
    record: Mapping[str, Any],
    tables: Mapping[str, pd.DataFrame],
    figures: Iterable[FigureData],
    figure_formats: Sequence[FigureFormat],
) -> list[str]:
    """Write tables by the names of their files, figures by their own, and a JSON record, and return all their names."""
    names = []
    for name, frame in tables.items():
        write_csv(frame, folder / f"{name}.csv")
        names.append(f"{name}.csv")
    for figure in figures:
        names += save_figure(figure, folder, figure.name, figure_formats)
    (folder / marker).write_text(json.dumps(record, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    return [*names, marker]


def writes_results(default: str) -> Callable[[CommandT], CommandT]:
    """Return what adds the options of a command that writes results and prints notes; `default` names their folder.

    The arguments are `output`, `overwrite` and `figure_formats`; `answer` obeys the others.
    """
    formats = click.option(
        "--figure-format",
        "figure_formats",
        type=click.Choice(get_args(FigureFormat)),
        multiple=True,
        default=["png"],
        show_default=True,
        help="Format of the figures; may be repeated.",
    )
    folder = f"Folder for the results [default: {default}]."
    output = click.option("-o", "--output", type=click.Path(path_type=Path), help=folder)
    replaced = "Replace the files of this command in that folder; others stay."
    overwrite = click.option("--overwrite", is_flag=True, help=replaced)
    return lambda command: output(overwrite(formats(printing(command))))
