"""wearlaw: rolling-contact wear, with wear laws and contact models as plugins.

>>> import wearlaw as wl
>>> from wearlaw import Q
>>> predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
>>> predict(normal_force=Q(7.4143, "kN"), creepage=Q(1, "%"), friction_coefficient=0.46).wear_rate
27.70 µg/m/mm²
"""

import sys as _sys
from typing import TYPE_CHECKING

from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.contact import elastic_limit, hertz, hertz_ellipse, kalker
from wearlaw.contact.conditions import Coefficient, Condition, Creepage, FallingFriction, Friction
from wearlaw.contact.contact import Contact, LawVariable, LineFields
from wearlaw.contact.material import Material, steel
from wearlaw.contact.problem import Body, CreepForces, Geometry, Problem, Strips
from wearlaw.contact.quadrature import Nodes
from wearlaw.errors import (
    CalibrationWarning,
    CaseError,
    CompositionError,
    ConditionsError,
    ConfigurationError,
    DataError,
    FitError,
    FitWarning,
    FrozenError,
    InputError,
    ModelError,
    OutputError,
    PlasticityWarning,
    PluginWarning,
    RangeWarning,
    ResumeWarning,
    SweepError,
    UnitError,
    UnknownModelError,
    WearlawError,
    WearlawWarning,
    WorkerWarning,
    shown,
)
from wearlaw.fields import ContactModelField, MaterialField, WearLawField, read_law
from wearlaw.hookspecs import INTERFACE_VERSION, Command, ResourceKind, hookimpl
from wearlaw.kernels import accelerate, accelerated, compiled_loop
from wearlaw.late import load as _load
from wearlaw.loader import (
    contact_model,
    contact_models,
    law,
    laws,
    material,
    materials,
    parameter_sets,
    patch_mean,
    readers,
    rig,
    rigs,
    stage,
    stages,
    wear_law,
    wear_laws,
)
from wearlaw.models.contact_model import (
    ContactModel,
    CreepForceModel,
    FieldVariable,
    Forces,
    LineContactModel,
    Scale,
    Solve,
    Stage,
)
from wearlaw.models.law import BreakpointMap, Calibration, Law, LocalOutcome, Numbers, Outcome, WearLaw
from wearlaw.models.model import Claim
from wearlaw.models.reader import Reader
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.pipeline.prediction import Prediction
from wearlaw.text_files import beside, read_file
from wearlaw.units.quantities import (
    Density,
    Length,
    Q,
    Quantity,
    QuantityLike,
    Speed,
    Stress,
    Unit,
    coefficient,
    parse,
    scalar_si,
)
from wearlaw.version import __version__

__all__ = [
    "INTERFACE_VERSION",
    "Array",
    "Body",
    "BreakpointMap",
    "Calibration",
    "CalibrationWarning",
    "Case",
    "CaseError",
    "CheckedClaim",
    "Claim",
    "Coefficient",
    "Command",
    "Comparison",
    "CompositionError",
    "Condition",
    "ConditionsError",
    "Configuration",
    "ConfigurationError",
    "Contact",
    "ContactModel",
    "ContactModelField",
    "CreepForceModel",
    "CreepForces",
    "Creepage",
    "Curve",
    "DataError",
    "Density",
    "Disc",
    "FallingFriction",
    "FieldVariable",
    "FigureData",
    "Fit",
    "FitError",
    "FitWarning",
    "Forces",
    "Friction",
    "FrozenError",
    "Geometry",
    "InputError",
    "Law",
    "LawVariable",
    "Length",
    "LineContactModel",
    "LineFields",
    "LocalOutcome",
    "Material",
    "MaterialField",
    "ModelError",
    "Nodes",
    "Numbers",
    "Outcome",
    "OutputError",
    "Panel",
    "Pipeline",
    "PlasticityWarning",
    "PlotAxis",
    "PluginWarning",
    "Prediction",
    "Problem",
    "Q",
    "Quantity",
    "QuantityLike",
    "RangeWarning",
    "Reader",
    "ResourceKind",
    "ResumeWarning",
    "Rig",
    "Scale",
    "Section",
    "Solve",
    "Speed",
    "Stage",
    "Stress",
    "Strips",
    "Study",
    "SweepError",
    "Table",
    "TwinDisc",
    "Uncertainty",
    "Unit",
    "UnitError",
    "UnknownModelError",
    "Verdict",
    "WearLaw",
    "WearLawField",
    "WearTests",
    "WearlawError",
    "WearlawWarning",
    "WheelRail",
    "WorkerWarning",
    "__version__",
    "accelerate",
    "accelerated",
    "beside",
    "coefficient",
    "compare",
    "compiled_loop",
    "contact_model",
    "contact_models",
    "creepage_for",
    "elastic_limit",
    "explore",
    "fit",
    "hertz",
    "hertz_ellipse",
    "hookimpl",
    "kalker",
    "law",
    "laws",
    "load_case",
    "lognormal",
    "material",
    "materials",
    "normal",
    "parameter_sets",
    "parse",
    "patch_mean",
    "published_range",
    "read_contact",
    "read_file",
    "read_law",
    "read_table",
    "read_tests",
    "readers",
    "rig",
    "rigs",
    "run",
    "scalar_si",
    "shown",
    "stage",
    "stages",
    "steel",
    "sweep",
    "uncertainty",
    "uniform",
    "wear_coefficient",
    "wear_law",
    "wear_laws",
    "wear_out",
]

if TYPE_CHECKING:
    from wearlaw_apps.contact_files.reading import read_contact
    from wearlaw_apps.explore.page import explore
    from wearlaw_apps.fits.comparison import Comparison, compare
    from wearlaw_apps.fits.distributions import lognormal, normal, published_range, uniform
    from wearlaw_apps.fits.fit import fit
    from wearlaw_apps.fits.read_tests import read_tests
    from wearlaw_apps.fits.result import Fit
    from wearlaw_apps.fits.uncertainty import Uncertainty, uncertainty
    from wearlaw_apps.fits.wear_tests import WearTests
    from wearlaw_apps.life import wear_out
    from wearlaw_apps.output.curves import Curve, FigureData, Panel, PlotAxis
    from wearlaw_apps.studies.case import Case, load_case
    from wearlaw_apps.studies.sections import CheckedClaim, Section, Verdict
    from wearlaw_apps.studies.study import Study, run
    from wearlaw_apps.sweeps.inverse import creepage_for
    from wearlaw_apps.sweeps.sweep import sweep
    from wearlaw_apps.tables import Table, read_table
    from wearlaw_models.laws.archard.coefficients import wear_coefficient
    from wearlaw_models.rigs.twin_disc import Disc, TwinDisc
    from wearlaw_models.rigs.wheel_rail import WheelRail

_LATE = {
    "wearlaw_apps.sweeps.inverse": ("creepage_for",),
    "wearlaw_models.laws.archard.coefficients": ("wear_coefficient",),
    "wearlaw_apps.contact_files.reading": ("read_contact",),
    "wearlaw_apps.explore.page": ("explore",),
    "wearlaw_apps.fits.comparison": ("Comparison", "compare"),
    "wearlaw_apps.fits.fit": ("fit",),
    "wearlaw_apps.fits.result": ("Fit",),
    "wearlaw_apps.fits.distributions": ("lognormal", "normal", "published_range", "uniform"),
    "wearlaw_apps.fits.uncertainty": ("Uncertainty", "uncertainty"),
    "wearlaw_apps.fits.read_tests": ("read_tests",),
    "wearlaw_apps.fits.wear_tests": ("WearTests",),
    "wearlaw_apps.life": ("wear_out",),
    "wearlaw_apps.output.curves": ("Curve", "FigureData", "Panel", "PlotAxis"),
    "wearlaw_apps.studies.case": ("Case", "load_case"),
    "wearlaw_apps.studies.sections": ("CheckedClaim", "Section", "Verdict"),
    "wearlaw_apps.studies.study": ("Study", "run"),
    "wearlaw_apps.sweeps.sweep": ("sweep",),
    "wearlaw_apps.tables": ("Table", "read_table"),
    "wearlaw_models.rigs.twin_disc": ("Disc", "TwinDisc"),
    "wearlaw_models.rigs.wheel_rail": ("WheelRail",),
}
"""Public names that come from plugins, by the module that is imported at their first use."""


def __getattr__(name: str) -> object:
    for module, names in _LATE.items():
        if name in names:
            return _load(module, name, f"wearlaw.{name}")
    of_wheelsets = name in ("Wheelset", "Profile", "read_profile", "write_profile")
    hint = f"; it is wearlaw_models.rigs.wheelset.{name}" if of_wheelsets else ""
    raise AttributeError(f"module 'wearlaw' has no attribute {name!r}{hint}")


def __dir__() -> list[str]:
    """Return the public names, including those that are loaded later; the rooms of the package are not for users."""
    return __all__


if _sys.modules.get("hypothesis") is not None:  # its entry point ran before the types existed
    from _wearlaw_hypothesis import register_types as _register_types

    _register_types(_sys.modules[__name__])
