"""A progress bar with rate and time left, on standard error."""

from __future__ import annotations

import click
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, Task, TextColumn, TimeRemainingColumn
from rich.text import Text


class _Rate(ProgressColumn):
    """Points per second."""

    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{speed:,.0f}/s")


class Bar:
    """A progress bar, shown on a terminal or in a notebook while the context lasts.

    The first advance does not count for the rate, since it may stand for earlier work.

    Parameters
    ----------
    total : int
        Number of points.
    shown : bool
        Whether to show the bar, unless a command is run with `--quiet` or `--json`.
    """

    def __init__(self, total: int, shown: bool = True) -> None:
        columns = (
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            MofNCompleteColumn(),
            _Rate(),
            TimeRemainingColumn(),
        )
        console = Console(stderr=True)
        context = click.get_current_context(silent=True)
        quiet = context is not None and (context.meta.get("quiet") or context.meta.get("json"))
        visible = shown and not quiet and (console.is_terminal or console.is_jupyter)
        self._bar = Progress(*columns, console=console, disable=not visible, transient=True)
        self._task = self._bar.add_task("evaluating", total=total)

    def __enter__(self) -> Bar:
        self._bar.start()
        return self

    def __call__(self, points: int) -> None:
        """Advance the bar."""
        self._bar.advance(self._task, points)

    def stage(self, text: str) -> None:
        """Show the current stage."""
        self._bar.update(self._task, description=text)

    def __exit__(self, *_: object) -> None:
        self._bar.stop()
