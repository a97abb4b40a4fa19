"""What several commands print: notes and a progress bar, both on standard error."""

from __future__ import annotations

from collections.abc import Iterable

import click
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


class progress:  # noqa: N801  (used as a function)
    """A progress bar on standard error, shown on a terminal while the context lasts."""

    def __init__(self, total: int) -> None:
        columns = (
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
        )
        console = Console(stderr=True)
        self._bar = Progress(*columns, console=console, disable=not console.is_terminal, transient=True)
        self._task = self._bar.add_task("evaluating", total=total)

    def __enter__(self) -> progress:
        self._bar.start()
        return self

    def __call__(self, points: int) -> None:
        """Advance the bar."""
        self._bar.advance(self._task, points)

    def stage(self, text: str) -> None:
        """Say what is done now."""
        self._bar.update(self._task, description=text)

    def __exit__(self, *_: object) -> None:
        self._bar.stop()


def print_notes(notes: Iterable[str]) -> None:
    """Print notes on standard error, a line each."""
    for note in notes:
        click.echo(f"note: {note}", err=True)
