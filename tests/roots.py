"""Scipy's Brent method, with the return type used here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from scipy import optimize


def brentq(function: Callable[[float], Any], low: float, high: float, **options: Any) -> float:
    """Return where a function passes zero between two places at which it has different signs."""
    found: Any = optimize.brentq(function, low, high, **options)
    return float(found)
