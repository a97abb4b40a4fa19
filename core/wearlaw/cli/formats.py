"""The options that say in which formats tables and figures are written."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, get_args

import click

from wearlaw.figures.formats import FigureFormat

CommandT = TypeVar("CommandT", bound=Callable[..., Any])


def written_formats(command: CommandT) -> CommandT:
    """Add the options `figure_formats` and `latex` to a command."""
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
    return formats(latex(command))
