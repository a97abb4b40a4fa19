"""Units that several test modules go through."""

from __future__ import annotations

import numpy as np

import wearlaw as wl

LENGTH = wl.Unit("mm")

# The factor to SI of each unit, from the definitions of the prefixes and of the inch, foot and pound (exact by
# the agreement of 1959) and of the standard gravity (CGPM 1901).
TO_SI = {
    "mm": 1e-3,
    "m": 1.0,
    "um": 1e-6,
    "inch": 0.0254,
    "kN": 1e3,
    "kNm": 1e3,
    "lbf": 0.45359237 * 9.80665,
    "MPa": 1e6,
    "GPa": 1e9,
    "kN/m": 1e3,
    "N/mm^2": 1e6,
    "ug/m/mm^2": 1e-3,
    "ug/m/N": 1e-9,
    "mm^2/km": 1e-9,
    "kg/m^3": 1.0,
    "g/cm^3": 1e3,
    "rpm": 2.0 * np.pi / 60.0,
    "%": 1e-2,
    "": 1.0,
}
