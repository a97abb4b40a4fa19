"""Writing tables and figures into files, the same bytes each time."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from errno import EDQUOT, ENOSPC
from pathlib import Path
from typing import Any, TypeVar, get_args

import click
import matplotlib as mpl
import pandas as pd

from wearlaw.errors import OutputError
from wearlaw.text_files import reason_of
from wearlaw_output.commands import verbose
from wearlaw_output.curves import FigureData, FigureFormat
from wearlaw_output.drawing import draw
from wearlaw_output.styled import latex_table

CommandT = TypeVar("CommandT", bound=Callable[..., Any])

METADATA: dict[FigureFormat, Any] = {"png": {"Software": None}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}
"""Metadata to suppress in each format, so that the same figure gives the same bytes."""


@contextmanager
def writing() -> Iterator[None]:
    """Raise an `OutputError` if files cannot be written while this context lasts."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        advice = (
            "make room, or choose another folder with -o"
            if error.errno in (ENOSPC, EDQUOT)
            else "choose another with -o"
        )
        raise OutputError(f"output: cannot write the results: {reason_of(error)}; {advice}") from None


_FORMULA = re.compile(r"(?:^|(?<=[;\t\r\n]))(?=[=+\-@\t\r\n\uff1d\uff0b\uff0d\uff20])")
"""The places where a spreadsheet would read a formula in a text; a semicolon or tab can begin a cell of it."""

_NUMBER = re.compile(r"[+\-]?(\d[\d.]*|\.\d+|inf|nan)([eE][+\-]?\d+)?( [\w%°·/*^.²³⁻¹-]*)?")
"""A number, with a unit or without."""


def disarmed(frame: pd.DataFrame) -> pd.DataFrame:
    """Return a table for a spreadsheet, in which an apostrophe keeps a text such as "=1+1" from being a formula.

    Numbers stay as they are. Such a text comes from outside, as in the labels of wear tests.
    """
    found = frame.rename(columns=_disarmed)
    for number, dtype in enumerate(frame.dtypes):
        if not pd.api.types.is_numeric_dtype(dtype):
            found.isetitem(number, [_disarmed(value) for value in frame.iloc[:, number]])
    return found


def _disarmed(value: Any) -> Any:
    return _FORMULA.sub("'", value) if isinstance(value, str) and not _NUMBER.fullmatch(value) else value


def save_table(frame: pd.DataFrame, folder: Path, name: str, latex: bool, footnotes: Sequence[str] = ()) -> list[str]:
    """Write a table as CSV, and for LaTeX with its footnotes if asked for, and return the names of the files."""
    disarmed(frame).to_csv(folder / f"{name}.csv", index=False, encoding="utf-8", errors="replace")
    if not latex:
        return [f"{name}.csv"]
    (folder / f"{name}.tex").write_text(latex_table(frame, footnotes), encoding="utf-8")
    return [f"{name}.csv", f"{name}.tex"]


def save_figure(figure: FigureData, folder: Path, name: str, formats: Sequence[FigureFormat]) -> list[str]:
    """Write a figure, as the same bytes each time, with no date in it, and return the names of the files."""
    drawn = draw(figure)
    files: dict[FigureFormat, str] = {extension: f"{name}.{extension}" for extension in formats}
    for extension, file in files.items():
        with mpl.rc_context({"pdf.fonttype": 42, "svg.hashsalt": "wearlaw"}):
            drawn.savefig(folder / file, dpi=150, metadata=METADATA[extension])
    return list(files.values())


def named(figure: FigureData | None) -> dict[str, FigureData]:
    """Return a figure, if there is one, by its name."""
    return {} if figure is None else {figure.name: figure}


def write_files(
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


def written_formats(command: CommandT) -> CommandT:
    """Add the options `figure_formats`, `latex` and `--verbose` to a command that writes results and prints notes."""
    formats = click.option(
        "--figure-format",
        "figure_formats",
        type=click.Choice(get_args(FigureFormat)),
        multiple=True,
        default=["png"],
        show_default=True,
        help="Format of the figures; may be repeated.",
    )
    latex = click.option("--latex", is_flag=True, help="Write the tables for LaTeX too.")
    return formats(latex(verbose(command)))
