"""Patches for the tests of Kalker's march, and their march."""

from __future__ import annotations

from typing import Any

import numpy as np

from wearlaw_models.contact_models.fastsim.march import Ellipses  # private: patches with any flexibilities

CREEPAGES = ("longitudinal_creepage", "lateral_creepage", "spin")


def sample(points: int, elliptic: bool, **given: Any) -> Ellipses:
    """Return slender to wide patches from little to full slip, with creepages of both signs."""
    rng = np.random.default_rng(82)
    a = 10.0 ** rng.uniform(-3.0, -2.0, points)
    values = {
        "a": a,
        "b": 10.0 ** rng.uniform(-3.0, -2.0, points),
        "longitudinal_creepage": 10.0 ** rng.uniform(-4.0, -1.5, points) * rng.choice([-1.0, 1.0], points),
        "lateral_creepage": 10.0 ** rng.uniform(-4.0, -1.5, points) * rng.choice([-1.0, 1.0], points),
        "spin": rng.uniform(-1.0, 1.0, points),
        "longitudinal_flexibility": a * rng.uniform(5e-12, 10e-12, points),
        "lateral_flexibility": a * rng.uniform(5e-12, 10e-12, points),
        "spin_flexibility": a * rng.uniform(5e-12, 10e-12, points),
        "bound_centre": rng.uniform(1e8, 1e9, points),
    }
    changed = {name: np.broadcast_to(np.asarray(value, dtype=np.float64), points) for name, value in given.items()}
    return Ellipses(**{**values, **changed}, elliptic=elliptic)
