"""Predictors and made-up tests that the tests of comparing share."""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from tests.plugins.fits.fits import EXACT
from wearlaw import Q
from wearlaw_apps.fits import Comparison, WearTests
from wearlaw_apps.fits.comparison import Compared  # private: for its type

CREEPAGE = [0.2, 0.5, 1.0, 2.0, 5.0, 12.0, 18.0, 20.0]
SCATTER = np.array([1.1, 0.9, 1.05, 0.97, 1.02, 0.93, 1.08, 0.99])
TRACTION = [0.13, 0.3, 0.42, 0.45, 0.46, 0.46, 0.46, 0.46]


def usfd(**options: Any) -> wl.WearLaw:
    return wl.wear_law("usfd", **{"fitted_for": "exact", **options})


def made(**columns: Any) -> WearTests:
    """Return tests whose wear rates are those of the USFD law on the exact contact, unless others are given."""
    conditions: dict[str, Any] = {
        "creepage": Q(CREEPAGE, "%"),
        "max_pressure": "1500 MPa",
        "friction_coefficient": 0.46,
    }
    rates = (EXACT | usfd())(**conditions).wear_rate
    return WearTests.from_arrays(**{**conditions, "wear_rate": rates, **columns})


def scattered(**columns: Any) -> WearTests:
    return made(wear_rate=made().wear_rate * SCATTER, **columns)


def by_label(comparison: Comparison) -> dict[str, Compared]:
    return {one.names.label: one for one in comparison.compared}


def order(comparison: Comparison) -> list[str]:
    return [one.names.label for one in comparison.compared]
