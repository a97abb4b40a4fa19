"""Wear tests as arrays, that several test modules share."""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from wearlaw import Q

NAN = np.nan


def made(**changes: Any) -> wl.WearTests:
    """Return three tests, the second without wear and the third without traction, with some columns changed."""
    columns: dict[str, Any] = {
        "creepage": Q([0.5, 1.0, 5.0], "%"),
        "normal_force": Q([7.0, 7.5, 8.0], "kN"),
        "traction_coefficient": [0.2, 0.4, NAN],
        "wear_rate": Q([10.0, NAN, 50.0], "ug/m/mm^2"),
        "labels": ["a", "b", "c"],
        "source": "a test",
    }
    return wl.WearTests.from_arrays(**{k: v for k, v in (columns | changes).items() if v is not None})
