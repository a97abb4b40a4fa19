"""Made-up tests that the tests of fitting share."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Q
from wearlaw.errors import FitError
from wearlaw_apps.fits import WearTests

RIG = wl.TwinDisc.suros()
EXACT, GLOBAL = RIG | wl.contact_model("exact"), RIG | wl.contact_model("global")
ALL = ("m_m", "q_s", "m_c", "tr_sc")
CREEPAGE = np.concatenate([np.geomspace(0.1, 1.3, 7), np.linspace(2.0, 13.0, 6), np.linspace(15.0, 20.0, 7)])
PRESSURE, FRICTION = Q(1500, "MPa"), 0.46


def usfd(contact: str) -> Any:
    return RIG | wl.contact_model(contact) | wl.wear_law("usfd", fitted_for=contact)


def made_up(predict: Any, scatter: float = 0.0, seed: int = 0, creepage: Any = CREEPAGE, **more: Any) -> WearTests:
    """Return tests that follow a pipeline but for lognormal scatter."""
    conditions: Any = {
        "creepage": Q(creepage, "%"),
        "max_pressure": PRESSURE,
        "friction_coefficient": np.full(len(creepage), FRICTION),
    }
    factor = np.exp(scatter * np.random.default_rng(seed).standard_normal(len(creepage)))
    return WearTests.from_arrays(**conditions, wear_rate=predict(**conditions).wear_rate * factor, **more)


def traction_tests(traction: Any, creepage: Any, **more: Any) -> WearTests:
    return WearTests.from_arrays(
        creepage=Q(creepage, "%"), max_pressure=PRESSURE, traction_coefficient=traction, **more
    )


def in_microgram(quantity: Any) -> Any:
    return quantity.to("ug/m/mm^2").magnitude


class Sloping(wl.WearLaw):
    """A line, straight or bent."""

    name: ClassVar[str] = "sloping"

    offset: Annotated[wl.Quantity, wl.Unit("ug/m/mm^2", positive=False)] = Q(1.0, "ug/m/mm^2")
    """Rate without energy."""
    slope: Annotated[wl.Quantity, wl.Unit("ug/m/N", positive=False)] = Q(2.0, "ug/m/N")
    """Slope."""
    bend: Annotated[wl.Quantity, wl.Unit("ug*mm^2/m/N^2", positive=False)] = Q(0.0, "ug*mm^2/m/N^2")
    """Bend."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return p["offset"] + contact.wear_index_density * (p["slope"] + p["bend"] * contact.wear_index_density)

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}


sloping = Sloping()
USFD = GLOBAL | wl.wear_law("usfd")
FULL_SLIP: Any = {"max_pressure": Q(1500, "MPa"), "creepage": Q(3, "%"), "friction_coefficient": 0.4}


def refused(says: str, predict: Any, tests: WearTests, free: Any, **settings: Any) -> None:
    with pytest.raises(FitError, match=says):
        wl.fit(predict, tests, free=free, **{"bootstrap": 0, **settings})
