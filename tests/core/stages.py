"""The stages and conditions of which the tests of pipelines make theirs."""

from __future__ import annotations

import warnings
from typing import Any

import wearlaw as wl
from wearlaw import Q

RIG = wl.TwinDisc.suros()
CONDITIONS: Any = {"normal_force": Q(7.4143, "kN"), "creepage": Q(1, "%"), "friction_coefficient": 0.46}
RAILS = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
TOUGH = wl.steel(shear_yield_stress=None)
"""Steel of which no stress is too much, so that nothing warns of it."""
ON_RAILS: Any = {"normal_force": "80 kN", "friction_coefficient": 0.3, "longitudinal_creepage": "0.2 %"}
EXACT, FASTSIM, GLOBAL = (wl.contact_model(name) for name in ("exact", "fastsim", "global"))
ELLIPTIC = wl.contact_model("fastsim", bound="elliptic")
AS_PRINTED = wl.contact_model("exact", slip="as_printed")
FITTED = {name: wl.wear_law("usfd", fitted_for=name) for name in ("global", "exact", "fastsim")}
KTH, BRR = wl.wear_law("kth"), wl.wear_law("brr")


def silently(first: Any, *parts: Any) -> Any:
    """Return a pipeline composed without warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        for part in parts:
            first = first | part
        return first


def predicted(pipeline: Any, **conditions: Any) -> Any:
    """Return a prediction made without warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return pipeline(**conditions)
