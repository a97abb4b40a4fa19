"""Sweeps and a study that several test modules share."""

from __future__ import annotations

from tests.core import cases
from tests.core.cases import case
from wearlaw_studies.study import Study, run

LOADS = ["1000 MPa", "1500 MPa"]
FRICTIONS = [0.3, 0.4, 0.5]
CREEPAGES = {"from": "-2 %", "to": "5 %", "points": 8}
LATTICE = {"max_pressure": LOADS, "creepage": CREEPAGES, "friction_coefficient": FRICTIONS}
MEASURED = {**cases.SWEEP, "traction_coefficient": 0.2}


def lattice_study() -> Study:
    """Run a case with a sweep over creepage and one over three conditions."""
    return run(case(sweeps={"creepage": cases.SWEEP, "lattice": LATTICE}))
