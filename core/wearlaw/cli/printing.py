"""What several commands print: notes, and where the results are."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import click


def print_notes(notes: Iterable[str]) -> None:
    """Print notes on standard error, a line each."""
    for note in notes:
        click.echo(f"note: {note}", err=True)


def print_results(folder: Path, names: Iterable[str]) -> None:
    """Print where the files of a folder of results are."""
    click.echo(f"Results in {folder}:")
    for name in names:
        click.echo(f"  {folder / name}")
