"""The file that names plugins: what they provide at its first use, and the extra that each needs."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from wearlaw.errors import WearlawError

if TYPE_CHECKING:
    from wearlaw_apps.contact_files.reading import read_contact
    from wearlaw_apps.contact_files.subsurface import read_subsurface
    from wearlaw_apps.explore.page import explore
    from wearlaw_apps.fits.comparison import compare
    from wearlaw_apps.fits.distributions import lognormal, normal, published_range, uniform
    from wearlaw_apps.fits.fit import fit
    from wearlaw_apps.fits.read_tests import read_tests
    from wearlaw_apps.fits.uncertainty import uncertainty
    from wearlaw_apps.life.over_distance import wear_out
    from wearlaw_apps.life.uncertain import uncertain_life
    from wearlaw_apps.output.curves import Curve, FigureData, Panel, PlotAxis
    from wearlaw_apps.output.datasets import to_dataframe
    from wearlaw_apps.studies.case import load_case
    from wearlaw_apps.studies.sections import CheckedClaim, Section
    from wearlaw_apps.studies.study import Study, run
    from wearlaw_apps.sweeps.inverse import creepage_for
    from wearlaw_apps.sweeps.several import Pipelines as Pipelines
    from wearlaw_apps.sweeps.sweep import sweep
    from wearlaw_apps.sweeps.wear_profiles import wear_profiles
    from wearlaw_apps.tables import read_table
    from wearlaw_models.contact_models import kalker
    from wearlaw_models.friction import FallingFriction
    from wearlaw_models.laws.archard.coefficients import wear_coefficient
    from wearlaw_models.materials import steel
    from wearlaw_models.rigs.twin_disc import Disc, TwinDisc
    from wearlaw_models.rigs.wheel_rail import WheelRail
    from wearlaw_models.rigs.wheelset.contacts import ProfileContact
    from wearlaw_models.rigs.wheelset.free_motion import free_motion
    from wearlaw_models.rigs.wheelset.profile import Profile, read_profile, write_profile
    from wearlaw_models.rigs.wheelset.rig import Wheelset

__all__ = [
    "CheckedClaim", "Curve", "Disc", "FallingFriction", "FigureData", "Panel", "PlotAxis", "Profile", "ProfileContact",
    "Section", "Study", "TwinDisc", "WheelRail", "Wheelset", "compare", "creepage_for", "explore", "fit", "free_motion",
    "kalker", "load_case", "lognormal", "normal", "published_range", "read_contact", "read_profile", "read_subsurface",
    "read_table", "read_tests", "run", "steel", "sweep", "to_dataframe", "uncertain_life", "uncertainty", "uniform",
    "wear_coefficient", "wear_out", "wear_profiles", "write_profile",
]  # fmt: skip

PUBLIC = {
    "wearlaw_apps.contact_files.reading": ("read_contact",),
    "wearlaw_apps.contact_files.subsurface": ("read_subsurface",),
    "wearlaw_apps.explore.page": ("explore",),
    "wearlaw_apps.fits.comparison": ("compare",),
    "wearlaw_apps.fits.distributions": ("lognormal", "normal", "published_range", "uniform"),
    "wearlaw_apps.fits.fit": ("fit",),
    "wearlaw_apps.fits.read_tests": ("read_tests",),
    "wearlaw_apps.fits.uncertainty": ("uncertainty",),
    "wearlaw_apps.life.over_distance": ("wear_out",),
    "wearlaw_apps.life.uncertain": ("uncertain_life",),
    "wearlaw_apps.output.curves": ("Curve", "FigureData", "Panel", "PlotAxis"),
    "wearlaw_apps.output.datasets": ("to_dataframe",),
    "wearlaw_apps.studies.case": ("load_case",),
    "wearlaw_apps.studies.sections": ("CheckedClaim", "Section"),
    "wearlaw_apps.studies.study": ("Study", "run"),
    "wearlaw_apps.sweeps.inverse": ("creepage_for",),
    "wearlaw_apps.sweeps.sweep": ("sweep",),
    "wearlaw_apps.sweeps.wear_profiles": ("wear_profiles",),
    "wearlaw_apps.tables": ("read_table",),
    "wearlaw_models.contact_models": ("kalker",),
    "wearlaw_models.friction": ("FallingFriction",),
    "wearlaw_models.laws.archard.coefficients": ("wear_coefficient",),
    "wearlaw_models.materials": ("steel",),
    "wearlaw_models.rigs.twin_disc": ("Disc", "TwinDisc"),
    "wearlaw_models.rigs.wheel_rail": ("WheelRail",),
    "wearlaw_models.rigs.wheelset.contacts": ("ProfileContact",),
    "wearlaw_models.rigs.wheelset.free_motion": ("free_motion",),
    "wearlaw_models.rigs.wheelset.profile": ("Profile", "read_profile", "write_profile"),
    "wearlaw_models.rigs.wheelset.rig": ("Wheelset",),
}
"""Public names of wearlaw that plugins hold, by module."""

METHODS = {
    "wearlaw_apps.output.datasets": ("profile", "table", "to_dataset"),
    "wearlaw_apps.output.notebook": ("html", "of_prediction"),
    "wearlaw_apps.output.pictures": ("draw",),
    "wearlaw_apps.output.wear_profile": ("wear_profile",),
    "wearlaw_apps.sweeps.several": ("Pipelines",),
}
"""What methods of the core's classes call."""

COMMANDS = {"plugins": "wearlaw_apps.show:list_plugins", "show": "wearlaw_apps.show:show"}
"""Commands that are there whatever plugin is broken."""

EXTRAS = {
    "wearlaw_apps.contact_files": "fits",
    "wearlaw_apps.explore": "explore",
    "wearlaw_apps.fits": "fits",
    "wearlaw_apps.life": "studies",
    "wearlaw_apps.output": "fits",
    "wearlaw_apps.studies": "studies",
    "wearlaw_apps.sweeps": "sweeps",
    "wearlaw_apps.tables": "sweeps",
    "wearlaw_kit.strategies": "check",
    "wearlaw_models.rigs.wheelset.free_motion": "sweeps",
}
"""The extra that installs what a module needs, by the longest prefix; `fits` holds `sweeps`, `studies` holds both, and
`explore` all."""


def extra_of(module: str) -> str | None:
    """Return the extra of a module, or None if it needs none."""
    while module and module not in EXTRAS:
        module = module.rpartition(".")[0]
    return EXTRAS.get(module)


class MissingPackageError(WearlawError, ModuleNotFoundError):
    """A package that an application needs is not installed."""


@contextmanager
def needed_for(use: str, extra: str | None) -> Iterator[None]:
    """Say how to install a package that is missing, while this context lasts; without an extra the error stays.

    A package that is there may still fail to import, because it is too old, or lacks a package or library of its own.
    """
    try:
        yield
    except ImportError as error:
        chain = (error, error.__cause__, error.__context__)  # pandas names what it misses in its text alone
        cause = next((link for link in chain if isinstance(link, ImportError) and link.name), error)
        if extra is None or (cause.name or "").startswith("wearlaw"):
            raise
        what = f"needs {cause.name}" if isinstance(cause, ModuleNotFoundError) else f"cannot be loaded: {error}"
        message = f'{use} {what}; install it with: python -m pip install "wearlaw[{extra}]"'
        raise MissingPackageError(message, name=cause.name) from error


def load(module: str, name: str, use: str) -> Any:
    """Return a name from a module or a module from a package, such as that of a command; it may need an extra."""
    with needed_for(use, extra_of(module)):
        return getattr(__import__(module, fromlist=[name]), name)


def method(name: str, use: str) -> Any:
    """Return what a method of a class of the core calls."""
    (module,) = (module for module, names in METHODS.items() if name in names)
    return load(module, name, use)


def face(package: str, names_of: Mapping[str, tuple[str, ...]]) -> Callable[[str], object]:
    """Return the `__getattr__` of a package whose public names are loaded at their first use, by module."""

    def public(name: str) -> object:
        for module, names in names_of.items():
            if name in names:
                return load(module, name, f"{package}.{name}")
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return public


def register_types(wearlaw: ModuleType) -> None:
    """Tell hypothesis of the types of wearlaw, if its entry point ran before they existed."""
    if sys.modules.get("hypothesis") is not None:
        import_module("_wearlaw_hypothesis").register_types(wearlaw)
