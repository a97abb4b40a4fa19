"""Commands that print case files and their schema. They load nothing that only a run needs."""

from __future__ import annotations

import json

import click

from wearlaw_apps.output.commands import echo_file
from wearlaw_apps.show import completed
from wearlaw_apps.studies.case import case_schema, case_text


@click.command()
@click.argument("name", shell_complete=completed("case"))
def case(name: str) -> None:
    """Print a case file to start from.

    NAME is two_discs, my_tests, wheel_on_rail, wheelset, wheel_life, tassini2010, or a path.
    """
    echo_file(case_text(name))


@click.command()
def schema() -> None:
    """Print the JSON Schema of a case file with the options of the installed models."""
    echo_file(json.dumps(case_schema(), indent=2, ensure_ascii=False) + "\n")
