"""wearlaw: rolling-contact wear, with wear laws and contact models as plugins.

>>> import wearlaw as wl
>>> from wearlaw import Q
>>> predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
>>> predict(normal_force=Q(7.4143, "kN"), creepage=Q(1, "%"), friction_coefficient=0.46).wear_rate
27.70 µg/m/mm²
"""

import sys as _sys

from wearlaw import hertz
from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.errors import (
    CalibrationWarning,
    CaseError,
    CompositionError,
    ConditionsError,
    ConfigurationError,
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
from wearlaw.specification import ContactModelField, WearLawField
from wearlaw.units import Density, Length, Q, Quantity, QuantityLike, Speed, Stress, Unit, parse, scalar_si
from wearlaw.version import __version__

__all__ = [
    "INTERFACE_VERSION",
    "Array",
    "BreakpointMap",
    "Calibration",
    "CalibrationWarning",
    "CaseError",
    "Claim",
    "CompositionError",
    "ConditionsError",
    "Configuration",
    "ConfigurationError",
    "Contact",
    "ContactModel",
    "ContactModelField",
    "ContactPipeline",
    "ContactSolution",
    "Density",
    "Disc",
    "FieldVariable",
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
    "PatchMean",
    "Pipeline",
    "PluginWarning",
    "Prediction",
    "Q",
    "Quantity",
    "QuantityLike",
    "RangeWarning",
    "Scale",
    "Speed",
    "Stress",
    "TwinDisc",
    "Unit",
    "UnitError",
    "UnknownModelError",
    "WearLaw",
    "WearLawField",
    "WearlawError",
    "WearlawWarning",
    "__version__",
    "accelerate",
    "as_wear_law",
    "contact_model",
    "contact_models",
    "hertz",
    "hookimpl",
    "kernel",
    "material",
    "materials",
    "parameter_sets",
    "parse",
    "patch_mean",
    "scalar_si",
    "steel",
    "wear_law",
    "wear_laws",
]

if _sys.modules.get("hypothesis") is not None:  # its entry point came too early to know the types
    from _wearlaw_hypothesis import register_types as _register_types

    _register_types()
