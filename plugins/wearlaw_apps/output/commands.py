"""Shared by the commands: options, reading their values, and printing results."""

from __future__ import annotations

import json
import math
import re
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
import numpy as np

from wearlaw import loader
from wearlaw.configuration import Configuration
from wearlaw.errors import ConfigurationError, InputError, shown, with_problems
from wearlaw.fields import is_law_file, read_law
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law
from wearlaw.pipeline.pipeline import Rig, RigField
from wearlaw.text_files import read_toml
from wearlaw.units.registry import symbol
from wearlaw_apps.output.notes import by_kind

if TYPE_CHECKING:
    import pandas as pd

CommandT = TypeVar("CommandT", bound=Callable[..., Any])

_SOURCE = re.compile(r" \((?:[^()]|\([^()]*\)){40,}\)")
"""A remark in parentheses that is as long as a source of the literature."""

LINE = 120
"""Letters of a note that is printed in short, if the terminal is not wider."""


class _WithRig(Configuration, extra="ignore"):
    """A file with a rig, such as a case file."""

    rig: RigField
    """The test rig."""


def read_rig(path: Path | None) -> Rig:
    """Return the rig of the table [rig] in a TOML file, or SUROS without one.

    Raises
    ------
    InputError
        If there is no such file, or no such table in it, or its fields are wrong.
    """
    if path is None:
        return _WithRig(rig={"preset": "suros"}).rig  # type: ignore[arg-type]
    try:
        return _WithRig(**read_toml("the rig", path)).rig
    except ConfigurationError as error:
        raise InputError(with_problems(f"the rig {shown(path)} is wrong in:", error.problems)) from None


def listed(option: str, text: str) -> list[str]:
    """Return the parts between commas, at least one."""
    parts = [part for part in (part.strip() for part in text.split(",")) if part]
    if not parts:
        raise click.UsageError(f"{option}: name at least one, got {shown(text)}")
    return parts


def fields(option: str, settings: tuple[str, ...], form: str = "FIELD=VALUE") -> dict[str, str]:
    """Return settings of a form such as "q_s=56 ug/m/mm^2" by field."""
    for setting in settings:
        if "=" not in setting:
            raise click.UsageError(f"{option}: write it as {form}, got {shown(setting)}")
    return dict(setting.split("=", 1) for setting in settings)


def values(option: str, settings: tuple[str, ...]) -> dict[str, str | float]:
    """Return settings such as "q_s=56 ug/m/mm^2" or "strips=20" by field; a number without a unit is a number."""
    return {field: value(text) for field, text in fields(option, settings).items()}


def value(text: str) -> str | float:
    """Return the number that a text is, or else the text."""
    try:
        return int(text) if text.lstrip("+-").isdecimal() else float(text)
    except ValueError:
        return text


def contact_model(text: str) -> ContactModel:
    """Return the contact model of "NAME" or "NAME:FIELD=VALUE:...", where NAME may be "DISTRIBUTION:NAME"."""
    name, settings = _parted(text)
    return loader.contact_model(name, **values(text, settings))


def stage(text: str) -> Stage:
    """Return the stage of "NAME" or "NAME:FIELD=VALUE:..."."""
    name, settings = _parted(text)
    return loader.stage(name, **values(text, settings))


def _parted(text: str) -> tuple[str, tuple[str, ...]]:
    """Return the name in a text such as "NAME:FIELD=VALUE", and the parts that set fields, which have a "="."""
    name, *settings = re.split(r":(?![\\/])", text)  # not within "C:/law.toml"
    while settings and "=" not in settings[0]:
        name = f"{name}:{settings.pop(0)}"
    return name, tuple(settings)


def law_of(text: str, fixed: Mapping[str, str | float] | None = None) -> Law:
    """Return the law of "NAME" or "NAME:FIELD=VALUE:...", where NAME may be the path of a TOML file.

    Parameters
    ----------
    text : str
        As on the command line.
    fixed : mapping of str to str or float, optional
        Further fields.
    """
    name, settings = _parted(text)
    fields = {**values(text, settings), **(fixed or {})}
    if is_law_file(name):
        return read_law(name).model_copy(update=fields)
    try:
        return loader.law(name, **fields)
    except ConfigurationError as error:
        if not any(problem.message == "is missing" for problem in error.problems):
            raise
        raise InputError(f"{error}; write the law as {_form(name, fields)}") from None


def _form(name: str, fields: Mapping[str, str | float]) -> str:
    """Return a law with its required fields, and those with an example, as it stands on the command line."""
    parts = [name]
    kind = "wear law" if name in loader.discovered()["wear law"] else "law"
    for field, about in loader.discovered().find(kind, name).model_fields.items():
        if field in fields or about.is_required() or about.examples:
            shown = fields.get(field, (about.examples or ["VALUE"])[0])
            parts.append(f'{field}="{shown}"' if " " in str(shown) else f"{field}={shown}")
    return ":".join(parts)


def folder_for(path: str, ending: str) -> Path:
    """Return the folder for the results of a file unless the user names one, such as "case-results"."""
    return Path(f"{Path(path).stem}-{ending}")


def echo_file(text: str) -> None:
    """Print the text of a file, in UTF-8 into a file or pipe, whatever the terminal speaks."""
    click.echo(text if sys.stdout.isatty() else text.encode(), nl=False)


def print_table(frame: pd.DataFrame) -> None:
    """Print a table with four digits, in blocks of columns as wide as the terminal."""
    width = shutil.get_terminal_size((LINE, 24)).columns
    click.echo(frame.to_string(line_width=width, na_rep="", float_format=lambda number: f"{number + 0.0:.4g}") + "\n")


def printing(command: CommandT) -> CommandT:
    """Add the options that `answer` obeys to a command."""

    def keep(context: click.Context, option: click.Parameter, value: bool) -> None:
        context.meta[str(option.name)] = value

    for name, text in (
        ("--json", "Print the results as JSON, numbers with their units."),
        ("--quiet", "Print the results alone: no notes, no progress, no names of files."),
        ("--verbose", "Print whole notes."),
    ):
        command = click.option(name, is_flag=True, expose_value=False, callback=keep, help=text)(command)
    return command


def answer(
    folder: Path, names: Iterable[str], notes: Iterable[str], shown: Callable[[], None], record: Mapping[str, Any]
) -> None:
    """Print notes, results as `shown` prints them, and files; or as `--quiet` and `--json` ask, the record as JSON."""
    asked, names, notes = click.get_current_context().meta, list(names), by_kind(notes)
    if asked.get("json"):
        whole = {**record, "notes": notes, "files": [str(folder / name) for name in names]}
        click.echo(json.dumps(_plain(whole), indent=2, ensure_ascii=False, allow_nan=False))
        return
    if not asked.get("quiet"):
        print_notes(notes)
    shown()
    if not asked.get("quiet"):
        for line in (f"Results in {folder}:", *(f"  {folder / name}" for name in names)):
            click.echo(line)


def _plain(value: Any) -> Any:
    """Return a value for JSON: numbers with units, tables as columns, and null for what is missing."""
    if hasattr(value, "columns"):
        heads = {head: str(head).partition(" [") for head in value.columns}
        return {name: {**({"unit": unit[:-1]} if unit else {}), "values": _plain(value[head].tolist())}
                for head, (name, _, unit) in heads.items()}  # fmt: skip
    if hasattr(value, "magnitude"):
        return {"value": _plain(value.magnitude), "unit": symbol(value.units, "~C")}
    if isinstance(value, Mapping):
        return {str(name): _plain(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if isinstance(value, np.generic | np.ndarray):
        return _plain(value.tolist())
    missing = isinstance(value, float) and not math.isfinite(value)
    return None if missing or type(value).__name__ == "NAType" else value


def print_notes(notes: Iterable[str]) -> None:
    """Print notes on standard error, as far as a line goes and without sources, or whole by `--verbose`."""
    whole, cut = click.get_current_context().meta.get("verbose", False), False
    width = max(shutil.get_terminal_size((LINE, 24)).columns, LINE)
    for note in notes:
        text = f"note: {note}"
        if not whole and (len(text) > width or "\n" in text):
            text, cut = textwrap.shorten(_SOURCE.sub("", text), width, placeholder=" …"), True
        click.echo(text, err=True)
    if cut:
        click.echo("(--verbose prints whole notes)", err=True)
