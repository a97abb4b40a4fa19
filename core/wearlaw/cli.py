"""The command line: it parses, calls the rest of the package, and prints."""

from __future__ import annotations

import json
import shlex
import sys
import warnings
from collections.abc import Callable, Iterable
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich import box
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from wearlaw import plugins
from wearlaw.errors import PluginWarning, UnknownModelError, WearlawError
from wearlaw.shelf import unknown
from wearlaw.version import __version__

if TYPE_CHECKING:
    import xarray

    from wearlaw.models import Model
    from wearlaw.scaffold import Kind, Licence
    from wearlaw.study import Study
    from wearlaw.testing import Check


class _Commands(click.Group):
    """Commands that end with one clear line, not a traceback, when wearlaw raises an error on purpose."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except WearlawError as error:
            raise click.ClickException(str(error)) from None


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="wearlaw")
def main() -> None:
    """Predict rolling-contact wear of wheels and rails.

    \b
    Begin with:
      wearlaw run tassini2010               the twin-disc study of Tassini et al. (2010)
      wearlaw case tassini2010 > my.toml    a copy of its case file, to edit
      wearlaw run my.toml -o my-results/    your own study
      wearlaw new-plugin NAME --wear-law    your own wear law
    """  # noqa: D301  (\b tells click to keep the lines)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a pipe or an old terminal may not have Greek letters


@main.command()
@click.argument("case")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for the results [default: CASE-results].")
@click.option("--overwrite", is_flag=True, help="Replace the results of an earlier run in that folder.")
def run(case: str, output: Path | None, overwrite: bool) -> None:
    """Run a study: CASE is a case file, or the name of one that is shipped (tassini2010).

    Every contact model of the case is paired with every wear law. Results are written as results.nc (netCDF),
    results.csv, figures/*.png and case.toml, the case with every default spelt out.
    """
    from wearlaw.case import load_case
    from wearlaw.output import fresh_folder, write
    from wearlaw.study import evaluations
    from wearlaw.study import run as run_case

    loaded = load_case(case)
    folder = output if output is not None else Path(f"{Path(case).stem}-results")
    with fresh_folder(folder, overwrite) as fresh:
        with _progress(evaluations(loaded)) as advance:
            study = run_case(loaded, advance)
        names = write(study, fresh)
    _print_notes(study)
    for name, sweep in study.sweeps.items():
        Console().print(_summary(name, sweep))
    _print_used(study)
    click.echo(f"Results in {folder}:")
    for name in names:
        click.echo(f"  {folder / name}")


@main.command()
@click.argument("name")
def case(name: str) -> None:
    """Print a case file: NAME is the name of a shipped one (tassini2010), or a path."""
    from wearlaw.case import case_text

    click.echo(case_text(name).encode(), nl=False)  # TOML is UTF-8, whatever the terminal speaks


@main.command("plugins")
def list_plugins() -> None:
    """List the installed contact models and wear laws, and what failed to load."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PluginWarning)  # what is left out is listed below
        found = plugins.installed()
    table = Table("kind", "name", "distribution", "version", box=None, pad_edge=False)
    for kind, name, origin in found.listing():
        table.add_row(kind, name, origin.distribution, origin.version)
    Console().print(table)
    for plugin in found.broken:
        click.echo(f"left out: {plugin}", err=True)


@main.command()
@click.argument("name")
def show(name: str) -> None:
    """Explain a model: its fields with units, defaults and sources, its range, and what it declares."""
    from wearlaw.describe import describe

    click.echo(describe(_model_class(name)))


@main.command()
def schema() -> None:
    """Print the JSON Schema of a case file with the options of the installed models."""
    from wearlaw.case import case_schema

    click.echo(json.dumps(case_schema(), indent=2, ensure_ascii=False).encode())


@main.command("new-plugin")
@click.argument("name")
@click.option("--wear-law", "kind", flag_value="wear_law", help="Start from a wear law: Archard's.")
@click.option("--contact-model", "kind", flag_value="contact_model", help="Start from a contact model: full slip.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    default=Path(),
    help="Folder in which wearlaw-NAME is made [default: the working folder].",
)
@click.option(
    "--license",
    "licence",
    type=click.Choice(["bsd-3-clause", "mit", "none"]),
    default="none",
    show_default=True,
    help="Licence of the plugin; with none, LICENSE says how to choose one.",
)
def new_plugin(name: str, kind: Kind | None, output: Path, licence: Licence) -> None:
    """Begin a plugin: write a small distribution, wearlaw-NAME, with a wear law or a contact model to replace.

    It holds a module of about 30 lines, its entry point, its tests with the conformance checks, a README, a licence
    and a CI workflow, and passes its tests, ruff and mypy --strict as it is. NAME is what the model will be called in
    wearlaw.wear_law("NAME") and in case files: lower-case letters, digits and underscores.
    """
    from wearlaw.scaffold import write_plugin

    if kind is None:
        raise click.UsageError("say what it provides: --wear-law or --contact-model")
    folder = write_plugin(name, kind, output, licence)
    click.echo(f"{folder} holds a {kind.replace('_', ' ')} to replace: wearlaw_{name}.py. Next:")
    click.echo(f"  cd {shlex.quote(str(folder))}")
    for line in ('python -m pip install -e ".[test]"', "pytest", "wearlaw plugins", f"wearlaw check {name}"):
        click.echo(f"  {line}")


@main.command()
@click.argument("name")
@click.option(
    "--option", "options", metavar="FIELD=VALUE", multiple=True, help="Set a field of the model; may be repeated."
)
def check(name: str, options: tuple[str, ...]) -> None:
    """Check that an installed model keeps what wearlaw relies on: one line a check, exit code 1 if any fails.

    \b
    wearlaw check usfd
    wearlaw check usfd --option fitted_for=exact
    """  # noqa: D301
    from wearlaw.models import ContactModel

    model = _model_class(name)(**_fields(options))
    outcomes = [_outcome(one) for one in _checks(model)]
    not_claimed = model.exemptions if isinstance(model, ContactModel) else {}
    for claim, reason in not_claimed.items():
        click.echo(f"not claimed {claim}: {reason}")
    click.echo(f"{outcomes.count(True)} ok, {outcomes.count(False)} failed, {len(not_claimed)} not claimed")
    if not all(outcomes):
        sys.exit(1)


def _fields(options: tuple[str, ...]) -> dict[str, str]:
    for option in options:
        if "=" not in option:
            raise click.UsageError(f"--option: write it as FIELD=VALUE, got '{option}'")
    return dict(option.split("=", 1) for option in options)


def _checks(model: Model) -> Iterable[Check]:
    try:
        from wearlaw.testing import checks
    except ModuleNotFoundError as error:
        if error.name != "hypothesis":
            raise
        raise click.ClickException(str(error)) from None
    return checks(model)


def _outcome(check: Check) -> bool:
    """Run one check, print a line about it, and return whether it passed."""
    try:
        check()
    except AssertionError as error:
        reason = str(error) or check.doc
        click.echo(f"FAILED {check.name}: {reason.strip().splitlines()[0]}")
        return False
    click.echo(f"ok {check.name}")
    return True


def _model_class(name: str) -> type[Model]:
    """Return the contact model or the wear law of a name."""
    found = plugins.installed()
    if name in found.wear_laws.providers:
        return found.wear_laws.find(name, found.broken)
    if name in found.contact_models.providers:
        return found.contact_models.find(name, found.broken)
    known = [*found.contact_models.items(), *found.wear_laws.items()]
    raise UnknownModelError(unknown("model", name, known, found.broken))


class _progress:  # noqa: N801  (used as a function)
    """A progress bar on standard error, shown on a terminal while the context lasts."""

    def __init__(self, total: int) -> None:
        columns = (TextColumn("evaluating"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        console = Console(stderr=True)
        self._bar = Progress(*columns, console=console, disable=not console.is_terminal, transient=True)
        self._task = self._bar.add_task("evaluating", total=total)

    def __enter__(self) -> Callable[[int], None]:
        self._bar.start()
        return lambda points: self._bar.advance(self._task, points)

    def __exit__(self, *_: object) -> None:
        self._bar.stop()


def _print_notes(study: Study) -> None:
    for note in study.notes:
        click.echo(f"note: {note}", err=True)


def _print_used(study: Study) -> None:
    """Print the version of wearlaw, and a line for each other distribution with what came from it."""
    from wearlaw.study import used

    provided: dict[str, list[str]] = {f"wearlaw {__version__}": []}
    for kind, names in used(study.case).items():
        for name, distribution in names.items():
            provided.setdefault(distribution, []).append(f"{kind} {name}")
    (ours, _), *others = provided.items()
    click.echo(f"Computed with {ours}")
    for distribution, things in others:
        click.echo(f"  and {distribution}: {', '.join(things)}")


def _summary(name: str, sweep: xarray.Dataset) -> Table:
    """Return a short table of wear rates: the pairs at a few values of the sweep's main axis."""
    from wearlaw.study import along_main_axis, main_axis
    from wearlaw.variables import label

    axis = main_axis(sweep)
    line = along_main_axis(sweep)
    count = line.sizes[axis]
    chosen = sorted({round(step * (count - 1) / (_COLUMNS - 1)) for step in range(_COLUMNS)})
    title = f"Sweep '{name}': {label('wear_rate')} by {label(axis)}"
    table = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE, pad_edge=False)
    table.add_column("", overflow="fold")
    for value in line[axis].values[chosen]:
        table.add_column(f"{value:.4g}", justify="right", no_wrap=True)
    for pair in line.pair.values:
        one = line.sel(pair=pair).isel({axis: chosen})
        rows = {pair: one.wear_rate.values}
        if (one.wear_rate_high > one.wear_rate_low).any():
            rows |= {"  low end": one.wear_rate_low.values, "  high end": one.wear_rate_high.values}
        for head, rates in rows.items():
            table.add_row(head, *(f"{rate:.4g}" for rate in rates))
    return table


_COLUMNS = 5
"""Columns of the short table."""
