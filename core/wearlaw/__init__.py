"""wearlaw: rolling-contact wear, with wear laws and contact models as plugins.

>>> import wearlaw as wl
>>> from wearlaw import Q
>>> predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
>>> predict(normal_force=Q(7.4143, "kN"), creepage=Q(1, "%"), friction_coefficient=0.46).wear_rate
27.70 µg/m/mm²
"""

import sys as _sys
from typing import TYPE_CHECKING

from wearlaw import errors
from wearlaw import late as _late
from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.contact import elastic_limit, hertz, hertz_ellipse
from wearlaw.contact.conditions import Coefficient, Condition, Creepage, Friction
from wearlaw.contact.contact import Contact
from wearlaw.contact.material import Material
from wearlaw.contact.parts import Body, CreepForces, LineFields, Strips
from wearlaw.contact.problem import Geometry, Problem
from wearlaw.contact.quadrature import Nodes
from wearlaw.errors import (
    CalibrationWarning,
    ConditionsError,
    ConfigurationError,
    InputError,
    PlasticityWarning,
    RangeWarning,
    UnitError,
    UnusualWarning,
    WearlawError,
    WearlawWarning,
    shown,
)
from wearlaw.fields import ContactModelField, MaterialField, WearLawField, read_law
from wearlaw.hookspecs import Command, ResourceKind, hookimpl
from wearlaw.kernels import accelerate, accelerated, compiled_loop
from wearlaw.loader import contact_model, installed, law, material, patch_mean, rig, stage, use, wear_law
from wearlaw.models.contact_model import ContactModel, CreepForceModel, Forces, LineContactModel, Solve, Stage
from wearlaw.models.law import BreakpointMap, Calibration, Law, LawVariable, Numbers, Outcome, WearLaw
from wearlaw.models.model import Claim, Exempt
from wearlaw.models.reader import Reader
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.pipeline.prediction import Prediction
from wearlaw.text_files import beside, read_file
from wearlaw.units.quantities import (
    Length,
    Q,
    Quantity,
    QuantityLike,
    Speed,
    Unit,
    coefficient,
    parse,
    scalar_si,
)
from wearlaw.units.variables import Variable
from wearlaw.version import __version__

__all__ = [
    "Array", "Body", "BreakpointMap", "Calibration", "CalibrationWarning", "Claim", "Coefficient", "Command",
    "Condition", "ConditionsError", "Configuration", "ConfigurationError", "Contact", "ContactModel",
    "ContactModelField", "CreepForceModel", "CreepForces", "Creepage", "Exempt", "Forces",
    "Friction", "Geometry", "InputError", "Law", "LawVariable", "Length", "LineContactModel", "LineFields",
    "Material", "MaterialField", "Nodes", "Numbers", "Outcome", "Pipeline", "PlasticityWarning",
    "Prediction", "Problem", "Q", "Quantity", "QuantityLike", "RangeWarning", "Reader", "ResourceKind", "Rig", "Solve",
    "Speed", "Stage", "Strips", "Unit", "UnitError", "UnusualWarning", "Variable", "WearLaw", "WearLawField",
    "WearlawError", "WearlawWarning", "__version__", "accelerate", "accelerated", "beside", "coefficient",
    "compiled_loop", "contact_model", "elastic_limit", "errors", "hertz", "hertz_ellipse", "hookimpl", "installed",
    "law", "material", "parse", "patch_mean", "read_file", "read_law", "rig", "scalar_si", "shown", "stage",
    "use", "wear_law",
]  # fmt: skip
__all__ += _late.__all__

if TYPE_CHECKING:
    from wearlaw.late import *  # noqa: F403

__getattr__ = _late.face("wearlaw", _late.PUBLIC)


def __dir__() -> list[str]:
    """Return the public names, including those that are loaded later; the rooms of the package are not for users."""
    return __all__


_late.register_types(_sys.modules[__name__])
