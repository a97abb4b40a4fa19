"""The command line: it parses, calls the rest of the package, and prints."""

from __future__ import annotations

import sys
import traceback
from io import TextIOWrapper
from typing import Any

import click

from wearlaw.cli import data_commands, model_commands, study_commands, uncertainty_commands
from wearlaw.errors import WearlawError, described, message_of
from wearlaw.version import __version__


class _Commands(click.Group):
    """Commands that end with one clear line when wearlaw raises an error on purpose, or a plugin ends the program."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except WearlawError as error:
            raise click.ClickException(message_of(error)) from None
        except KeyboardInterrupt as interrupt:
            for note in getattr(interrupt, "__notes__", []):
                click.echo(note, err=True)
            raise
        except Exception:
            raise
        except BaseException as error:  # such as a model's SystemExit(0), after which all would seem well
            place = traceback.extract_tb(error.__traceback__)[-1]
            raise click.ClickException(
                f"the command was ended by {described(error)}, raised in {place.filename}, line {place.lineno}"
            ) from error


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="wearlaw")
def main() -> None:
    """Predict rolling-contact wear of wheels and rails.

    \b
    Begin with:
      wearlaw run tassini2010               the twin-disc study of Tassini et al. (2010)
      wearlaw case tassini2010 > my.toml    a copy of its case file, to edit
      wearlaw run my.toml -o my-results/    your own study
      wearlaw uncertainty my.toml           how uncertain its predictions are
      wearlaw fit my-tests.csv --help       parameters of a law, fitted to your own tests
      wearlaw compare my-tests.csv --help   which model predicts your tests best
      wearlaw new-plugin NAME --wear-law    your own wear law
    """  # noqa: D301  (\b tells click to keep the lines)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a pipe or an old terminal may not have Greek letters


for _module in (study_commands, uncertainty_commands, data_commands, model_commands):
    for _command in _module.COMMANDS:
        main.add_command(_command)
