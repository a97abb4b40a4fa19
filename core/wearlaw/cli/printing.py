"""What several commands print: notes, on standard error."""

from __future__ import annotations

from collections.abc import Iterable

import click


def print_notes(notes: Iterable[str]) -> None:
    """Print notes on standard error, a line each."""
    for note in notes:
        click.echo(f"note: {note}", err=True)
