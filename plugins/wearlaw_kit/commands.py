"""Commands for authors of models: check a model, and begin a plugin."""

from __future__ import annotations

import shlex
import time
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import click

from wearlaw import loader
from wearlaw.errors import ConfigurationError, InputError, UnknownModelError, shown
from wearlaw.fields import is_law_file, read_law
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.law import Law
from wearlaw.models.model import Model
from wearlaw.pipeline.pipeline import Rig
from wearlaw_apps.output.commands import fields, values
from wearlaw_apps.show import accuracies
from wearlaw_kit.kit import Check, checks, validate_expected
from wearlaw_kit.scaffold import Kind, write_plugin


@click.command("new-plugin")
@click.argument("name")
@click.option("--wear-law", "kind", flag_value="wear_law", help="Start from a wear law: Archard's.")
@click.option("--contact-model", "kind", flag_value="contact_model", help="Start from a contact model: full slip.")
@click.option("--rig", "kind", flag_value="rig", help="Start from a rig: a weight on two rollers.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    default=Path(),
    help="Folder in which wearlaw-NAME is made [default: the working folder].",
)
def new_plugin(name: str, kind: Kind | None, output: Path) -> None:
    """Begin a plugin: write a small distribution, wearlaw-NAME, with a model to replace.

    It holds a module of about 30 lines, its entry point, its tests, a README and a CI workflow, and passes its tests,
    ruff and mypy --strict as it is. NAME is what the model will be called in wearlaw.wear_law("NAME") or
    wearlaw.rig("NAME") and in case files: lower-case letters, digits and underscores. For a stage, a law of another
    outcome or a material, begin with a wear law and replace its module by one of the documentation.
    """
    if kind is None:
        raise click.UsageError("say what the plugin provides: --wear-law, --contact-model or --rig")
    folder = write_plugin(name, kind, output)
    click.echo(f"{folder} holds a {kind.replace('_', ' ')} to replace: wearlaw_{name}.py. Next:")
    install = 'python -m pip install -e ".[test]"'
    for line in (f"cd {shlex.quote(str(folder))}", install, "pytest", "wearlaw plugins", f"wearlaw check {name}"):
        click.echo(f"  {line}")


@click.command()
@click.argument("name")
@click.option(
    "--option", "options", metavar="FIELD=VALUE", multiple=True, help="Set a field of the model; may be repeated."
)
@click.option(
    "--expect-failure",
    "expected",
    metavar="CHECK=REASON",
    multiple=True,
    help="A check that is known to fail, with the reason; if it passes, that is a failure. May be repeated.",
)
def check(name: str, options: tuple[str, ...], expected: tuple[str, ...]) -> None:
    """Check that an installed model keeps what wearlaw relies on. Prints a line a check; exit code 1 if any fails.

    A line states the time of a check that takes a second or more.

    \b
    wearlaw check usfd
    wearlaw check usfd --option fitted_for=exact
    wearlaw check my_set                            a parameter set of a plugin
    wearlaw check fit/law.toml                      the law in a file
    wearlaw check twin_disc --option track_width="8 mm"
    wearlaw check my_law --expect-failure "rate_is_finite=divides by zero at zero pressure"
    """  # noqa: D301
    source, settings = _installed(name), values("--option", options)
    model = _made(source, settings) if isinstance(source, type) else source.model_copy(update=settings)
    reasons = fields("--expect-failure", expected, "CHECK=REASON")
    model_checks = list(checks(model))
    validate_expected("--expect-failure", model, model_checks, reasons)
    outcomes = Counter(_outcome(model_check, reasons.get(model_check.name)) for model_check in model_checks)
    if isinstance(model, ContactModel):
        for line in accuracies(model):
            click.echo(line)
    for claim, reason in model.exemptions.items():
        click.echo(f"not claimed {claim}: {reason}")
    as_expected = f"{outcomes['failed as expected']} failed as expected, " if outcomes["failed as expected"] else ""
    click.echo(f"{outcomes['ok']} ok, {outcomes['failed']} failed, {as_expected}{len(model.exemptions)} not claimed")
    if outcomes["failed"]:
        click.get_current_context().exit(1)


def _made(model: type[Model], options: Mapping[str, object]) -> Model:
    """Return the model with these fields; a rig takes others from its `example_fields`."""
    example = model.example_fields if issubclass(model, Rig) else {}
    try:
        return model(**{**example, **options})
    except ConfigurationError as error:
        missing = dict.fromkeys(problem.path[0] for problem in error.problems if problem.message == "is missing")
        if not missing:
            raise
        hint = f"give {' '.join(f'--option {field}=VALUE' for field in missing)}"
        if issubclass(model, Rig):
            hint += f", or values to try the rig with in {model.__name__}.example_fields"
        raise InputError(f"{error}\n{hint}") from None


def _outcome(check: Check, expected: str | None) -> str:
    """Run a check, print its line, with the reason if it is expected to fail, and return what to count it as."""
    start = time.process_time()
    try:
        check()
    except AssertionError as error:
        if expected is not None:
            click.echo(f"failed as expected {check.name}{_duration(start)}: {expected}")
            return "failed as expected"
        reason = str(error) or check.doc
        click.echo(f"FAILED {check.name}{_duration(start)}: {reason.strip().splitlines()[0]}")
        return "failed"
    if expected is not None:
        click.echo(f"FAILED {check.name}{_duration(start)}: it passes, but is expected to fail: {expected}")
        return "failed"
    click.echo(f"ok {check.name}{_duration(start)}")
    return "ok"


def _duration(start: float) -> str:
    """Return the time that a check took of the processor, if that is a second or more."""
    taken = time.process_time() - start
    return f" ({taken:.0f} s)" if taken >= 1.0 else ""


def _installed(name: str) -> type[Model] | Law:
    """Return the class of the model with this name, or the law of a parameter set or of a file."""
    if is_law_file(name):
        return read_law(name)
    installed = loader.discovered()
    kinds = ("wear law", "law", "contact model", "stage", "rig", "reader", "parameter set")
    for kind in kinds:
        if name in installed[kind]:
            model: type[Model] | Law = installed.find(kind, name)
            return model
    for kind, shelf in installed.shelves.items():
        if name in shelf:
            raise UnknownModelError(f"{shown(name)} is a {kind}, which has no checks; wearlaw show {name} explains it")
    raise UnknownModelError(
        installed.unknown("model", name, [model_name for kind in kinds for model_name in installed[kind].items()])
    )
