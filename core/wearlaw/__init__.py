"""wearlaw: rolling-contact wear, with wear laws and contact models as plugins.

>>> import wearlaw as wl
>>> from wearlaw import Q
>>> predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
>>> predict(normal_force=Q(7.4143, "kN"), creepage=Q(1, "%"), friction_coefficient=0.46).wear_rate
27.70 µg/m/mm²
"""

import sys as _sys
from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING

from wearlaw import hertz
from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
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
    PluginWarning,
    RangeWarning,
    UnitError,
    UnknownModelError,
    WearlawError,
    WearlawWarning,
)
from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis
from wearlaw.functions import as_wear_law
from wearlaw.hookspecs import INTERFACE_VERSION, hookimpl
from wearlaw.kernels import accelerate, kernel
from wearlaw.line import LineFields, LineProblem
from wearlaw.line_model import FieldVariable, LineContactModel
from wearlaw.material import Material, steel
from wearlaw.models import BreakpointMap, Calibration, Claim, ContactModel, LocalWear, Scale, WearLaw
from wearlaw.pipeline import ContactPipeline, PatchMean, Pipeline, patch_mean
from wearlaw.plugins import (
    contact_model,
    contact_models,
    material,
    materials,
    parameter_sets,
    wear_law,
    wear_laws,
)
from wearlaw.quadrature import Nodes
from wearlaw.records import Contact
from wearlaw.result import ContactSolution, Prediction
from wearlaw.rig import Disc, TwinDisc
from wearlaw.sections import CheckedClaim, Section
from wearlaw.specification import ContactModelField, WearLawField
from wearlaw.uncertainty.distributions import lognormal, normal, published_range, uniform
from wearlaw.units import Density, Length, Q, Quantity, QuantityLike, Speed, Stress, Unit, parse, scalar_si
from wearlaw.version import __version__
from wearlaw.wear_tests.reader import read_tests
from wearlaw.wear_tests.tests import WearTests

__all__ = [
    "INTERFACE_VERSION",
    "Array",
    "BreakpointMap",
    "Calibration",
    "CalibrationWarning",
    "CaseError",
    "CheckedClaim",
    "Claim",
    "Comparison",
    "CompositionError",
    "ConditionsError",
    "Configuration",
    "ConfigurationError",
    "Contact",
    "ContactModel",
    "ContactModelField",
    "ContactPipeline",
    "ContactSolution",
    "Curve",
    "DataError",
    "Density",
    "Disc",
    "FieldVariable",
    "FigureData",
    "Fit",
    "FitError",
    "FitWarning",
    "FrozenError",
    "InputError",
    "Length",
    "LineContactModel",
    "LineFields",
    "LineProblem",
    "LocalWear",
    "Material",
    "ModelError",
    "Nodes",
    "OutputError",
    "Panel",
    "PatchMean",
    "Pipeline",
    "PlotAxis",
    "PluginWarning",
    "Prediction",
    "Q",
    "Quantity",
    "QuantityLike",
    "RangeWarning",
    "Scale",
    "Section",
    "Speed",
    "Stress",
    "Study",
    "TwinDisc",
    "Unit",
    "UnitError",
    "UnknownModelError",
    "WearLaw",
    "WearLawField",
    "WearTests",
    "WearlawError",
    "WearlawWarning",
    "__version__",
    "accelerate",
    "as_wear_law",
    "compare",
    "contact_model",
    "contact_models",
    "fit",
    "hertz",
    "hookimpl",
    "kernel",
    "lognormal",
    "material",
    "materials",
    "normal",
    "parameter_sets",
    "parse",
    "patch_mean",
    "published_range",
    "read_tests",
    "read_wear_law",
    "scalar_si",
    "steel",
    "uniform",
    "wear_law",
    "wear_laws",
]

if _TYPE_CHECKING:
    from wearlaw.comparison.compare import compare
    from wearlaw.comparison.result import Comparison
    from wearlaw.fitting.fit import fit
    from wearlaw.fitting.law_files import read_wear_law
    from wearlaw.fitting.result import Fit
    from wearlaw.study import Study

_LATER = {
    "Comparison": "wearlaw.comparison.result",
    "Study": "wearlaw.study",
    "compare": "wearlaw.comparison.compare",
    "Fit": "wearlaw.fitting.result",
    "fit": "wearlaw.fitting.fit",
    "read_wear_law": "wearlaw.fitting.law_files",
}
"""What takes a tenth of the time of `import wearlaw`, and most scripts do without."""


def __getattr__(name: str) -> object:
    if name not in _LATER:
        raise AttributeError(f"module 'wearlaw' has no attribute {name!r}")
    return getattr(_import_module(_LATER[name]), name)


if _sys.modules.get("hypothesis") is not None:  # its entry point came too early to know the types
    from _wearlaw_hypothesis import register_types as _register_types

    _register_types()
