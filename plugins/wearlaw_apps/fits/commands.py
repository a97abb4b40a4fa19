"""Commands about wear tests: fit parameters to them, and compare predictions with them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from wearlaw.errors import FitError, PlasticityWarning, shown
from wearlaw.models.law import Law
from wearlaw.parameters import numbers
from wearlaw.units.quantities import text_of
from wearlaw.version import __version__
from wearlaw_apps.fits.comparison import Comparison, Names, Predictor, compare_named
from wearlaw_apps.fits.fit import fit as fit_parameters
from wearlaw_apps.fits.least_squares import LOSSES
from wearlaw_apps.fits.named_numbers import FRICTION
from wearlaw_apps.fits.pairs import Pair, compose
from wearlaw_apps.fits.read_tests import read_tests
from wearlaw_apps.fits.result import Fit
from wearlaw_apps.fits.wear_tests import WearTests
from wearlaw_apps.output.commands import (
    answer,
    contact_model,
    fields,
    folder_for,
    law_of,
    listed,
    read_rig,
    stage,
    value,
    values,
)
from wearlaw_apps.output.curves import FigureFormat
from wearlaw_apps.output.files import CommandT, write_files, writes_results
from wearlaw_apps.output.folder import results_folder
from wearlaw_apps.output.notes import Notes, caught_warnings
from wearlaw_apps.show import LAWS, completed
from wearlaw_apps.sweeps.progress import Bar

FIT, COMPARISON, LAW = "fit.json", "comparison.json", "law.toml"
"""Files of results."""


def common(command: CommandT) -> CommandT:
    """Add the options that both commands share."""
    for option in (
        click.option(
            "--scatter",
            type=click.Choice(["relative", "absolute"]),
            default="relative",
            show_default=True,
            help="Scatter of measurements, by a factor or by an amount; ignored if the tests state uncertainties.",
        ),
        click.option("--friction", type=float, help="Friction coefficient of tests without a column of it."),
        click.option("--body", metavar="BODY", help="Body whose mass, volume or depth was measured, or both."),
        click.option("--balance", "balance_resolution", metavar="MASS", help='Smallest step of the balance: "0.1 mg".'),
        click.option(
            "--columns",
            metavar="NAME=HEAD",
            multiple=True,
            help='A column by its head, as in normal_force="Load (N)"; may be repeated.',
        ),
        click.option("--sheet", help="Sheet of a spreadsheet [default: its only one]."),
        click.option("--decimal", default=".", show_default=True, help="Decimal mark of the tests."),
        click.option("--sep", help="What separates the cells of the tests [default: semicolon, tab or comma]."),
        click.option(
            "--rig",
            type=click.Path(path_type=Path),
            help="A TOML file with a table [rig], such as a case file [default: SUROS, 47 mm discs, 10 mm track].",
        ),
    ):
        command = option(command)
    return command


bounds_option = click.option(
    "--bounds",
    metavar="FIELD=LOW:HIGH",
    multiple=True,
    help="Least and greatest value of a free parameter, with units if it has one; may be repeated.",
)
stages_option = click.option(
    "--stage",
    "stages",
    metavar="STAGE",
    multiple=True,
    shell_complete=completed("stage"),
    help="Stage around the contact model: patch_mean, or NAME:FIELD=VALUE; may be repeated.",
)


@click.command()
@click.argument("tests", shell_complete=completed("test set"))
@click.option(
    "--contact",
    required=True,
    metavar="MODEL",
    shell_complete=completed("contact model"),
    help="Contact model: exact, or NAME:FIELD=VALUE.",
)
@stages_option
@click.option(
    "--law",
    metavar="LAW",
    shell_complete=completed(*LAWS),
    help="Law: usfd, NAME:FIELD=VALUE or a TOML file; none for traction.",
)
@click.option(
    "--free",
    required=True,
    metavar="FIELDS",
    help="Parameters to fit: fields of the law or of a stage, or friction_coefficient.",
)
@click.option("--label", help="Name of the fitted law in tables and figures [default: LAW fitted to TESTS].")
@click.option("--fixed", metavar="FIELD=VALUE", multiple=True, help="Set a field of the law; may be repeated.")
@common
@bounds_option
@click.option("--robust", type=click.Choice([*LOSSES]), default="linear", show_default=True, help="Loss of residuals.")
@click.option("--bootstrap", type=int, default=1000, show_default=True, help="Replicates; 0 for quick intervals.")
@click.option("--confidence", type=float, default=0.95, show_default=True, help="Of the intervals.")
@click.option("--seed", type=int, default=0, show_default=True, help="Of the random numbers.")
@writes_results("TESTS-fit")
def fit(
    tests: str,
    contact: str,
    stages: tuple[str, ...],
    law: str | None,
    free: str,
    label: str | None,
    fixed: tuple[str, ...],
    bounds: tuple[str, ...],
    rig: Path | None,
    friction: float | None,
    columns: tuple[str, ...],
    bootstrap: int,
    output: Path | None,
    overwrite: bool,
    figure_formats: tuple[FigureFormat, ...],
    **settings: Any,
) -> None:
    """Fit parameters of a wear law to tests: TESTS is a CSV file or a spreadsheet with units in its header.

    \b
    wearlaw fit my-tests.csv --contact exact --law usfd --free q_s,m_c,tr_sc -o fit/
    wearlaw fit my-tests.csv --contact exact --law usfd --free q_s --bounds "q_s=20 ug/m/mm^2:80 ug/m/mm^2"
    wearlaw fit my-tests.csv --contact exact --free friction_coefficient --bounds friction_coefficient=0.2:0.6
    wearlaw fit my-tests.csv --contact exact --stage third_body:reduction=0.9 --free reduction -o layer/

    The folder then holds law.toml, the fitted law, to be used wherever a law is asked for; parameters.csv with
    confidence intervals; residuals.csv; a figure; and fit.json with all that the fit comes from.
    """  # noqa: D301
    folder = output or folder_for(tests, "fit")
    notes = Notes()
    with results_folder(folder, overwrite, FIT) as fresh:
        names, law_fields = listed("--free", free), values("--fixed", fixed)
        if law is not None:
            name = Path(law.partition(":")[0]).stem
            law_fields["label"] = label or f"{name} fitted to {Path(tests).stem}"
        if both := [name for name in names if name in law_fields]:
            raise click.UsageError(f"--fixed: {shown(both[0])} is to be fitted; take it out of --fixed or of --free")
        measured = _tests(tests, columns, settings)
        if FRICTION not in names:
            _note_friction(measured, friction, notes)
        with notes.of("fit"), Bar(bootstrap) as bar:
            predict = _rig(rig, notes) | contact_model(contact)
            for text in stages:
                predict = predict | stage(text)
            if law is not None:
                predict = predict | law_of(law, law_fields)
                _note_fixed(predict.laws[0], names, notes)
            bar.stage("fitting")
            settings |= {"friction_coefficient": friction, "bounds": _bounds(bounds), "bootstrap": bootstrap}
            fitted = fit_parameters(predict, measured, names, on_progress=bar, **settings)
        with notes.of("figure"):
            files = _write_fit(fitted, notes.texts, fresh, figure_formats)
    record = {
        "parameters": fitted.parameters,
        "intervals": fitted.intervals,
        "rms_residual": fitted.rms,
        "aic": fitted.aic,
        "lack_of_fit": [asdict(test) for test in fitted.lack_of_fit],
    }
    answer(folder, files, notes.texts, lambda: click.echo(repr(fitted)), record)


def _tests(tests: str, columns: tuple[str, ...], options: dict[str, Any]) -> WearTests:
    """Return the tests of a file, and take from `options` those that say how it is read."""
    how = {name: options.pop(name) for name in ("sheet", "sep", "decimal", "balance_resolution")}
    return read_tests(tests, columns=fields("--columns", columns, "NAME=HEAD") if columns else None, **how)


def _bounds(settings: tuple[str, ...]) -> dict[str, tuple[str | float, str | float]]:
    """Return the least and greatest values of parameters by name."""
    bounds: dict[str, tuple[str | float, str | float]] = {}
    for field, text in fields("--bounds", settings, "FIELD=LOW:HIGH").items():
        low, colon, high = text.partition(":")
        if not colon:
            raise click.UsageError(f"--bounds: write it as FIELD=LOW:HIGH, got {shown(f'{field}={text}')}")
        bounds[field] = value(low.strip()), value(high.strip())
    return bounds


def _note_fixed(law: Law, free: list[str], notes: Notes) -> None:
    """Note the numbers of a law that are not fitted."""
    kept = [
        f"{name} = {value!r}"
        for name, value in numbers(law.explicit()).items()
        if name not in free and f"{law.name}.{name}" not in free
    ]
    if kept:
        notes.add(f"fit: not fitted, {', '.join(kept)}")


@click.command()
@click.argument("tests", shell_complete=completed("test set"))
@click.option(
    "--contacts",
    required=True,
    metavar="MODELS",
    shell_complete=completed("contact model", listed=True),
    help="Contact models: global,exact or NAME:FIELD=VALUE.",
)
@stages_option
@click.option(
    "--laws",
    required=True,
    metavar="LAWS",
    shell_complete=completed(*LAWS, listed=True),
    help="Laws: usfd,kth or NAME:FIELD=VALUE, or TOML files.",
)
@click.option(
    "--free", metavar="LAW=FIELDS", multiple=True, help="Also fit this one of the laws, on every contact; repeatable."
)
@click.option(
    "--cross-validate",
    metavar="FOLDS",
    help="Rank fits by tests that they have not seen: leave-one-out, or a number of folds; needs --free.",
)
@common
@bounds_option
@writes_results("TESTS-comparison")
def compare(
    tests: str,
    contacts: str,
    stages: tuple[str, ...],
    laws: str,
    free: tuple[str, ...],
    cross_validate: str | None,
    bounds: tuple[str, ...],
    rig: Path | None,
    friction: float | None,
    columns: tuple[str, ...],
    output: Path | None,
    overwrite: bool,
    figure_formats: tuple[FigureFormat, ...],
    **settings: Any,
) -> None:
    """Rank contact models and wear laws by how well they predict tests.

    TESTS is a CSV file or a spreadsheet with units in its header, such as creepage [%]. Every contact model is paired
    with every law.

    \b
    wearlaw compare my-tests.csv --contacts global,exact,fastsim --laws usfd,kth,brr -o cmp/
    wearlaw compare my-tests.csv --contacts exact,fastsim --laws usfd:fitted_for=exact,fit/law.toml -o cmp/
    wearlaw compare my-tests.csv --contacts global,exact --laws usfd,kth --free usfd=q_s,m_c -o cmp/
    wearlaw compare my-tests.csv --contacts exact --laws usfd,kth --free usfd=q_s,m_c --cross-validate 5 -o cv/
    wearlaw compare my-tests.csv --contacts exact,fastsim --stage patch_mean --laws usfd,brr -o cmp/

    A law is taken with its defaults unless options are given; a note says where its parameters were fitted for another
    contact. The folder then holds ranking.csv, the table that is printed; predictions.csv; a figure of measured against
    predicted wear rates; and comparison.json with all models.
    """  # noqa: D301
    folder = output or folder_for(tests, "comparison")
    parts: Any = int(cross_validate) if cross_validate and cross_validate.isdecimal() else cross_validate
    if parts and not free:
        raise click.UsageError("--cross-validate: say which parameters are free, as in --free usfd=q_s,m_c")
    notes = Notes()
    with results_folder(folder, overwrite, COMPARISON) as fresh:
        measured = _tests(tests, columns, settings)
        _note_friction(measured, friction, notes)
        chosen = {text: law_of(text) for text in listed("--laws", laws)}
        named = {law.label or text: law for text, law in chosen.items()}
        suffix = f" with {' and '.join(stages)}" if stages else ""
        models = {f"{text}{suffix}": contact_model(text) for text in listed("--contacts", contacts)}
        around = [stage(text) for text in stages]
        pairs = compose(_rig(rig, notes), models, named, notes, stages=around, remedy="add --stage patch_mean")
        predictors: list[tuple[Names, Predictor]] = [
            (Names(pair.label, pair.law, pair.contact_model), pair.pipeline) for pair in pairs
        ]
        freed, ends = _freed(free, named), _bounds(bounds)
        for field in ends.keys() - {field for fields_of_law in freed.values() for field in fields_of_law}:
            raise click.UsageError(f"--bounds: {shown(field)} is not free; add it to --free, as in --free LAW={field}")
        settings["friction_coefficient"] = friction
        for law, names in freed.items():
            settings["bounds"] = {field: ends[field] for field in names if field in ends}
            predictors += _fits([pair for pair in pairs if pair.law == law], names, measured, notes, settings)
        comparison = compare_named(predictors, measured, friction, notes, None, parts, settings["body"], progress=True)
        with notes.of("figure"):
            files = _write_comparison(comparison, notes.texts, fresh, figure_formats)
    shown_ranking = {"ranking": comparison.table()}
    answer(folder, files, notes.texts, lambda: click.echo(repr(comparison)), shown_ranking)


def _freed(settings: tuple[str, ...], laws: Mapping[str, Law]) -> dict[str, list[str]]:
    """Return the fields to fit by law, as --laws writes it; the name alone will do if only one law has it."""
    fields_of_law: dict[str, list[str]] = {}
    for setting in settings:
        name, _, freed = setting.rpartition("=")
        texts = [name] if name in laws else [text for text, law in laws.items() if law.name == name]
        if len(texts) != 1:
            raise click.UsageError(
                f"--free: write it as LAW=FIELDS, with a LAW of {','.join(laws)}, got {shown(setting)}"
            )
        if texts[0] in fields_of_law:
            raise click.UsageError(
                f"--free: {shown(name)} is given twice; write all its fields behind one, between commas"
            )
        fields_of_law[texts[0]] = listed("--free", freed)
    return fields_of_law


def _fits(
    pairs: list[Pair], free: list[str], tests: WearTests, notes: Notes, settings: Mapping[str, Any]
) -> list[tuple[Names, Predictor]]:
    """Return the fits of a law on each contact, without those that the tests do not determine."""
    fits: list[tuple[Names, Predictor]] = []
    refused = []
    with Bar(len(pairs)) as bar:
        bar.stage("fitting")
        for pair in pairs:
            names = Names(f"{pair.law} fitted on {pair.contact_model}", f"{pair.law} fitted", pair.contact_model)
            try:
                # The comparison says once of the tests that they are beyond the elastic limit.
                with notes.of(names.label), caught_warnings(PlasticityWarning):
                    fits.append((names, fit_parameters(pair.pipeline, tests, free, bootstrap=0, **settings)))
            except FitError as error:
                refused.append(f"{names.label} is left out: {error}")
            bar(1)
    if not fits:
        raise FitError(refused[0])
    for text in refused:
        notes.add(text)
    return fits


def _write_fit(fit: Fit, notes: Sequence[str], folder: Path, figure_formats: Sequence[FigureFormat]) -> list[str]:
    """Write a fit into an empty folder and return the names of the files, the fitted law first."""
    record = {
        "parameters": {name: text_of(value) for name, value in fit.parameters.items()},
        "intervals": {name: [text_of(end) for end in ends] for name, ends in fit.intervals.items()},
        "interval_method": fit.interval_method,
        "conversions": list(fit.conversions),
        "aic": fit.aic,
        "outliers": fit.outliers["label"].tolist(),
        "lack_of_fit": [asdict(test) for test in fit.lack_of_fit],
        "provenance": fit.provenance,
        "predict": fit.predict.model_dump(mode="json"),
        "notes": list(notes),
    }
    if fit.law is not None:
        fit.to_toml(folder / LAW)
    tables = {"parameters": fit.table(), "residuals": fit.residuals}
    names = write_files(folder, FIT, record, tables, [fit.figure_data()], figure_formats)
    return [LAW, *names] if fit.law is not None else names


def _write_comparison(
    comparison: Comparison, notes: Sequence[str], folder: Path, figure_formats: Sequence[FigureFormat]
) -> list[str]:
    """Write a comparison into an empty folder and return the names of the files, the ranking first."""
    record = {
        "wearlaw": __version__,
        "tests": comparison.tests.source,
        "cross_validated": comparison.cross_validated,
        "predictors": {
            predictor.names.label: predictor.pipeline.model_dump(mode="json") for predictor in comparison.compared
        },
        "notes": list(notes),
    }
    tables = {"ranking": comparison.table(), "predictions": comparison.predictions()}
    return write_files(folder, COMPARISON, record, tables, [comparison.figure_data()], figure_formats)


def _rig(path: Path | None, notes: Notes) -> Any:
    if path is None:
        notes.add("the rig is taken to be SUROS, 47 mm steel discs and a track of 10 mm; give yours with --rig")
    return read_rig(path)


def _note_friction(tests: WearTests, friction: float | None, notes: Notes) -> None:
    """Note an option --friction that the tests do not need."""
    if friction is not None and tests.friction_coefficient is not None:
        notes.add(f"--friction {friction:g} is not used, since the tests have a column friction_coefficient")
