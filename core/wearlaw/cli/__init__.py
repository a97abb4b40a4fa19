"""The command line: it parses, calls the rest of the package, and prints."""

from __future__ import annotations

import signal
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from io import TextIOWrapper
from typing import IO, Any, NamedTuple

import click

from wearlaw.errors import WearlawError, described, did_you_mean, message_of, printable, quoted, readable
from wearlaw.version import __version__


class _Command(NamedTuple):
    """A command: its module in this package, its function there, and its line in the list of commands."""

    module: str
    function: str
    help: str


COMMANDS = {
    "case": _Command("case_commands", "case", "Print a case file, to edit a copy."),
    "check": _Command("model_commands", "check", "Check that a model keeps what wearlaw relies on."),
    "compare": _Command("data_commands", "compare", "Rank models by how well they predict your tests."),
    "fit": _Command("data_commands", "fit", "Fit the parameters of a wear law to your tests."),
    "new-plugin": _Command("model_commands", "new_plugin", "Write a small plugin to start from."),
    "plugins": _Command("model_commands", "list_plugins", "List what the installed plugins provide."),
    "run": _Command("study_commands", "run", "Run a study and write its results and report."),
    "schema": _Command("case_commands", "schema", "Print the JSON Schema of case files."),
    "show": _Command("model_commands", "show", "Explain anything that wearlaw plugins lists."),
    "uncertainty": _Command("study_commands", "uncertainty", "Say how uncertain the predictions of a case are."),
    "wear": _Command("wear_commands", "wear", "Predict the wear of contacts that another program solved."),
}
"""All commands. Their modules import pandas, matplotlib and more, so each is loaded when a command of it is used."""


@contextmanager
def _readable_usage_errors() -> Iterator[None]:
    """Make click's messages readable, which repeat arguments as they are."""
    try:
        yield
    except click.exceptions.NoArgsIsHelpError:  # its message is the help
        raise
    except click.UsageError as error:
        error.message = readable(printable(error.message))  # type: ignore[misc]
        raise


class Stopped(click.ClickException):
    """The line that an interrupted command prints."""

    exit_code = 128 + signal.SIGINT

    def show(self, file: IO[Any] | None = None) -> None:
        """Print the line, without click's "Error:"."""
        click.echo(readable(self.message), file=file, err=True)


class _Commands(click.Group):
    """The commands. An error of wearlaw, an interrupt, or a plugin that ends the program, prints one clear line."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        if cmd_name not in COMMANDS:
            return None
        module, function, _ = COMMANDS[cmd_name]
        command: click.Command = getattr(import_module(f"{__name__}.{module}"), function)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and not args[0].startswith("-") and args[0] not in COMMANDS:
            hint = did_you_mean(args[0], COMMANDS)
            raise click.UsageError(
                f"there is no command {quoted(args[0])}{hint} wearlaw --help lists the commands", ctx
            )
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        with formatter.section("Commands"):
            formatter.write_dl([(name, command.help) for name, command in COMMANDS.items()])

    def make_context(self, *args: Any, **options: Any) -> click.Context:
        with _readable_usage_errors():
            return super().make_context(*args, **options)

    def invoke(self, ctx: click.Context) -> Any:
        try:
            with _readable_usage_errors():
                return super().invoke(ctx)
        except WearlawError as error:
            raise click.ClickException("\n".join([message_of(error), *getattr(error, "__notes__", [])])) from None
        except KeyboardInterrupt:
            raise Stopped("Stopped") from None
        except Exception:
            raise
        except BaseException as error:  # such as a model's SystemExit(0), which would look like success
            place = traceback.extract_tb(error.__traceback__)[-1]
            reason = f"the command was ended by {described(error)}, raised in {place.filename}, line {place.lineno}"
            raise click.ClickException(readable(reason)) from error


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
      wearlaw wear case.0001.mat --law usfd the wear of a contact that another program solved
      wearlaw new-plugin NAME --wear-law    your own wear law
    """  # noqa: D301  (\b tells click to keep the lines)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a pipe or an old terminal may not have Greek letters
