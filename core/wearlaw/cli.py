"""The command line."""

from __future__ import annotations

import signal
import sys
import warnings
from io import TextIOWrapper
from typing import IO, Any

import click

from wearlaw import loader
from wearlaw.errors import WearlawError, described, did_you_mean, shown
from wearlaw.hookspecs import Command
from wearlaw.late import COMMANDS, MissingPackageError, load
from wearlaw.version import __version__

OWN = (
    Command("plugins", COMMANDS["plugins"], "List what the installed plugins provide."),
    Command("show", COMMANDS["show"], "Explain anything that wearlaw plugins lists."),
)
"""The commands that are there whatever plugin is broken; their module is imported when one is called."""


def commands() -> dict[str, Command]:
    """Return all commands by name, those of plugins among them; a name of wearlaw itself cannot be taken."""
    from_plugins = loader.discovered()["command"].items()
    return dict(sorted((from_plugins | {command.name: command for command in OWN}).items()))


class Stopped(click.ClickException):
    """The line that an interrupted command prints."""

    exit_code = 128 + signal.SIGINT

    def show(self, file: IO[Any] | None = None) -> None:
        """Print the line, without click's "Error:"."""
        click.echo(self.message, file=file, err=True)


class _Commands(click.Group):
    """The commands. An error of wearlaw or an interrupt prints one clear line."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002
        return list(commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        builtin = {command.name: command for command in OWN}  # which tell what failed to load in their own way
        asked = builtin.get(cmd_name)
        if asked is None and cmd_name in loader.discovered()["command"]:
            asked = loader.discovered().find("command", cmd_name)
        if asked is None:
            hint = did_you_mean(cmd_name, commands())
            raise click.UsageError(
                f"there is no command {shown(cmd_name)}{hint} wearlaw --help lists the commands", ctx
            )
        module, _, function = asked.function.partition(":")
        try:
            command: click.Command = load(module, function, f"wearlaw {cmd_name}")
        except MissingPackageError as error:
            return _Missing(cmd_name, help=asked.help, epilog=str(error))
        except Exception as error:
            of = loader.discovered()["command"].origin(cmd_name)
            message = f"command {shown(cmd_name)} of {of} cannot be loaded: {described(error)}"
            raise click.ClickException(message) from error
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        with formatter.section("Commands"):
            formatter.write_dl([(name, command.help) for name, command in commands().items()])

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Use the files of `--plugin`, which may stand anywhere, before anything is looked up."""
        others, left = [], iter(args)
        for arg in left:
            option, _, file = arg.partition("=")
            if option != "--plugin":
                others.append(arg)
                continue
            try:
                loader.use(file or next(left))
            except (StopIteration, WearlawError) as error:
                raise click.UsageError(str(error) or "--plugin needs a file", ctx) from None
        return super().parse_args(ctx, others)

    def invoke(self, ctx: click.Context) -> Any:
        before = warnings.formatwarning  # it shows the place in the code, which helps nobody at a prompt
        warnings.formatwarning = lambda message, category, *_, **__: f"{category.__name__}: {message}\n"
        try:
            return super().invoke(ctx)
        except WearlawError as error:
            raise click.ClickException("\n".join([str(error), *getattr(error, "__notes__", [])])) from None
        except KeyboardInterrupt:
            raise Stopped("Stopped") from None
        finally:
            warnings.formatwarning = before


class _Missing(click.Command):
    """A command whose packages are not installed: its help says so, and an error if it is called."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if not {*args} & {*ctx.help_option_names}:
            raise click.ClickException(str(self.epilog))
        return super().parse_args(ctx, ["--help"])


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="wearlaw")
def main() -> None:
    """Predict rolling-contact wear of wheels and rails.

    \b
    Begin with:
      wearlaw run tassini2010               the twin-disc study of Tassini et al. (2010)
      wearlaw case two_discs > my.toml      a short case file, to edit
      wearlaw run my.toml -o my-results/    your own study
      wearlaw explore wheelset              sliders and live figures in a browser
      wearlaw fit my-tests.csv --help       parameters of a law, fitted to your own tests
      wearlaw compare my-tests.csv --help   which model predicts your tests best
      wearlaw wear case.0001.mat --law usfd the wear of a contact that another program solved
      wearlaw life my.toml line.csv --help  how a wheel wears on a line
      wearlaw new-plugin NAME --wear-law    your own wear law

    --plugin my_law.py, in any command, uses a Python file as a plugin.
    """  # noqa: D301  (\b tells click to keep the lines)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a pipe or an old terminal may not have Greek letters
