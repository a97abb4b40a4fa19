"""What is written on the command line, as rigs and models."""

from __future__ import annotations

from pathlib import Path

import click

from wearlaw.errors import ConfigurationError, InputError, with_problems
from wearlaw.fitting.law_files import read_toml, read_wear_law
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.rig import Rig
from wearlaw.models.wear_law import WearLaw
from wearlaw.plugins import loader
from wearlaw.plugins.fields import RigField
from wearlaw.settings.configuration import Configuration


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
        raise InputError(with_problems(f"the rig '{path}' is wrong in:", error.problems)) from None


def listed(option: str, text: str) -> list[str]:
    """Return what stands between commas, at least one."""
    found = [part for part in (part.strip() for part in text.split(",")) if part]
    if not found:
        raise click.UsageError(f"{option}: name at least one, got '{text}'")
    return found


def fields(option: str, settings: tuple[str, ...]) -> dict[str, str]:
    """Return settings such as "q_s=56 ug/m/mm^2" by field."""
    for setting in settings:
        if "=" not in setting:
            raise click.UsageError(f"{option}: write it as FIELD=VALUE, got '{setting}'")
    return dict(setting.split("=", 1) for setting in settings)


def contact_model(text: str) -> ContactModel:
    """Return the contact model that "NAME" or "NAME:FIELD=VALUE:..." stands for."""
    name, *settings = text.split(":")
    return loader.contact_model(name, **fields(text, tuple(settings)))


def wear_law(text: str, fixed: dict[str, str] | None = None) -> WearLaw:
    """Return the wear law that "NAME", "NAME:FIELD=VALUE:..." or the path of a TOML file stands for.

    Parameters
    ----------
    text : str
        What is written on the command line.
    fixed : dict of str to str, optional
        Further fields.
    """
    if text.endswith(".toml"):
        law = read_wear_law(text)
        return law.model_copy(update=fixed) if fixed else law
    name, *settings = text.split(":")
    return loader.wear_law(name, **fields(text, tuple(settings)) | (fixed or {}))
