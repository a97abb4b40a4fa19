"""Predictions that the tests of uncertainty share."""

from __future__ import annotations

from typing import Any

import wearlaw as wl
from tests.plugins.fits.fits import GLOBAL
from wearlaw import Q

USFD = GLOBAL | wl.wear_law("usfd")
FULL_SLIP: Any = {"max_pressure": Q(1500, "MPa"), "creepage": Q(3, "%"), "friction_coefficient": 0.4}
