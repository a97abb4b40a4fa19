"""Commands for authors of models: check a model, and begin a plugin."""

from __future__ import annotations

import shlex
import time
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import click

from wearlaw import loader
from wearlaw.errors import ConfigurationError, InputError, UnknownModelError, did_you_mean, shown
from wearlaw.fields import is_law_file, read_law
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.law import Law
from wearlaw.models.model import Model
from wearlaw_apps.output.commands import fields, values
from wearlaw_apps.show import accuracies
from wearlaw_kit.kit import Check, checks, tried, validate_expected
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

    It holds a package of about 30 lines, its entry point, its tests, a README and a CI workflow, and passes its tests,
    ruff and mypy --strict as it is. NAME is what the model will be called in wearlaw.wear_law("NAME") or
    wearlaw.rig("NAME") and in case files: lower-case letters, digits and underscores. For a stage, a law of another
    outcome or a material, begin with a wear law and replace its module by one of the documentation.
    """
    if kind is None:
        raise click.UsageError("say what the plugin provides: --wear-law, --contact-model or --rig")
    folder = write_plugin(name, kind, output)
    click.echo(f"{folder} holds a {kind.replace('_', ' ')} to replace: wearlaw_{name}/__init__.py. Next:")
    install = 'python -m pip install -e ".[test]"'
    for line in (f"cd {shlex.quote(str(folder))}", install, "pytest", "wearlaw plugins", f"wearlaw check {name}"):
        click.echo(f"  {line}")


@click.command()
@click.argument("name", required=False)
@click.option(
    "--option", "options", metavar="FIELD=VALUE", multiple=True, help="Set a field of the model; may be repeated."
)
@click.option("--case", "case_name", metavar="CASE", help="The case that a section is tried on.")
@click.option("--distribution", metavar="NAME", help="Check all models of an installed distribution.")
@click.option("--only", metavar="CHECK", multiple=True, help="Run this check alone; may be repeated.")
@click.option("--durations", is_flag=True, help="State the time of every check.")
@click.option(
    "--expect-failure",
    "expected",
    metavar="CHECK=REASON",
    multiple=True,
    help="A check that is known to fail, with the reason; if it passes, that is a failure. May be repeated.",
)
def check(
    name: str | None,
    options: tuple[str, ...],
    case_name: str | None,
    distribution: str | None,
    only: tuple[str, ...],
    durations: bool,
    expected: tuple[str, ...],
) -> None:
    """Check that an installed model keeps what wearlaw relies on. Prints a line a check; exit code 1 if any fails.

    A model is tried with its `example_fields`, unless you set them. A line states the time of a check that takes a
    second or more.

    \b
    wearlaw check usfd
    wearlaw check usfd --option fitted_for=exact
    wearlaw check half_space --only forces_are_continuous --durations
    wearlaw check --distribution wearlaw-mine       all models of a plugin
    wearlaw check my_set                            a parameter set of a plugin
    wearlaw check fit/law.toml                      the law in a file
    wearlaw check my_section --case my_case         a section of reports
    wearlaw check twin_disc --option track_width="8 mm"
    wearlaw check my_law --expect-failure "rate_is_finite=divides by zero at zero pressure"
    """  # noqa: D301
    if (name is None) == (distribution is None):
        raise click.UsageError("give the name of a model, or --distribution")
    settings, reasons = values("--option", options), fields("--expect-failure", expected, "CHECK=REASON")
    sources: list[Any] = [_installed(name)] if name is not None else _provided(str(distribution))
    models = [
        _made(source, settings)
        if isinstance(source, type)
        else source.model_copy(update=settings)
        if isinstance(source, Law)
        else tried(source, case_name)
        for source in sources
    ]
    chosen = [(model, list(checks(model))) for model in models]
    available = {model_check.name for _, model_checks in chosen for model_check in model_checks}
    for unknown in (check_name for check_name in only if check_name not in available):
        raise InputError(
            f"--only: no check of {name or distribution} is called '{unknown}'{did_you_mean(unknown, available)}"
        )
    total: Counter[str] = Counter()
    for model, model_checks in chosen:
        if name is None:
            click.echo(f"{model.kind} {model.name}")
        of_model = reasons if name is not None else {c.name: reasons[c.name] for c in model_checks if c.name in reasons}
        validate_expected("--expect-failure", model, model_checks, of_model)
        total += _checked(model, [c for c in model_checks if c.name in (only or available)], of_model, durations)
    as_expected = f"{total['failed as expected']} failed as expected, " if total["failed as expected"] else ""
    click.echo(f"{total['ok']} ok, {total['failed']} failed, {as_expected}{total['not claimed']} not claimed")
    if total["failed"]:
        click.get_current_context().exit(1)


def _checked(model: Any, model_checks: list[Check], reasons: Mapping[str, str], durations: bool) -> Counter[str]:
    """Run checks of a model, print their lines, and return how many had which outcome."""
    least = 0.0 if durations else 1.0
    outcomes = Counter(_outcome(model_check, reasons.get(model_check.name), least) for model_check in model_checks)
    if isinstance(model, ContactModel):
        for line in accuracies(model):
            click.echo(line)
    for claim, reason in model.exemptions.items():
        click.echo(f"not claimed {claim}: {reason}")
    return outcomes + Counter({"not claimed": len(model.exemptions)})


def _provided(distribution: str) -> list[type[Model] | Law]:
    """Return the classes of the models of a distribution, and its parameter sets."""
    by_distribution: dict[str, list[type[Model] | Law]] = {}
    for kind in (*loader.MODELS, "parameter set"):
        for providers in loader.discovered()[kind].providers.values():
            for model, origin in providers:
                by_distribution.setdefault(loader.normal(origin.distribution), []).append(model)
    sought = loader.normal(distribution)
    if sought not in by_distribution:
        raise UnknownModelError(
            f"no installed distribution {shown(distribution)} has models{did_you_mean(sought, by_distribution)}"
        )
    return by_distribution[sought]


def _made(model: type[Model], options: Mapping[str, object]) -> Model:
    """Return the model with these fields, and others from its `example_fields`."""
    try:
        return model(**{**model.example_fields, **options})
    except ConfigurationError as error:
        missing = dict.fromkeys(problem.path[0] for problem in error.problems if problem.message == "is missing")
        if not missing:
            raise
        hint = f"give {' '.join(f'--option {field}=VALUE' for field in missing)}"
        raise InputError(
            f"{error}\n{hint}, or values to try the {model.kind} with in {model.__name__}.example_fields"
        ) from None


def _outcome(check: Check, expected: str | None, least: float) -> str:
    """Run a check, print its line, with the reason if it is expected to fail, and return what to count it as."""
    start = time.process_time()
    try:
        check()
    except AssertionError as error:
        if expected is not None:
            click.echo(f"failed as expected {check.name}{_duration(start, least)}: {expected}")
            return "failed as expected"
        reason = str(error) or check.doc
        click.echo(f"FAILED {check.name}{_duration(start, least)}: {reason.strip().splitlines()[0]}")
        return "failed"
    if expected is not None:
        click.echo(f"FAILED {check.name}{_duration(start, least)}: it passes, but is expected to fail: {expected}")
        return "failed"
    click.echo(f"ok {check.name}{_duration(start, least)}")
    return "ok"


def _duration(start: float, least: float) -> str:
    """Return the time that a check took of the processor [s], if that is not less than a number."""
    taken = time.process_time() - start
    return f" ({taken:.0f} s)" if taken >= 1.0 else f" ({taken:.3f} s)" if taken >= least else ""


def _installed(name: str) -> type[Model] | Law | Callable[..., Any]:
    """Return the class of the model with this name, the law of a parameter set or of a file, or a section."""
    if is_law_file(name):
        return read_law(name)
    installed = loader.discovered()
    kinds = ("wear law", "law", "contact model", "stage", "rig", "reader", "parameter set", "section")
    for kind in kinds:
        if name in installed[kind]:
            model: type[Model] | Law | Callable[..., Any] = installed.find(kind, name)
            return model
    for kind, shelf in installed.shelves.items():
        if name in shelf:
            raise UnknownModelError(f"{shown(name)} is a {kind}, which has no checks; wearlaw show {name} explains it")
    raise UnknownModelError(
        installed.unknown("model", name, [model_name for kind in kinds for model_name in installed[kind].items()])
    )
