"""Wear tests as the variables that figures show."""

from __future__ import annotations

from typing import Any

import numpy as np

from wearlaw.arrays import Array
from wearlaw.conditions import LOADS
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.units import from_si, in_unit
from wearlaw.variables import OF_POINT, UNITS
from wearlaw.wear_tests.columns import COLUMNS
from wearlaw.wear_tests.tests import WearTests

OF_TRACTION = (
    "traction_coefficient", "tangential_force", "wear_index", "averaged_wear_index", "wear_index_density",
)  # fmt: skip
"""What is known of tests that have a traction."""


def known_variables(tests: WearTests) -> tuple[str, ...]:
    """Return the variables that are known of tests."""
    conditions = [name for name in OF_POINT if name != "friction_coefficient" or name in tests.columns]
    traction = OF_TRACTION if "traction_coefficient" in tests.columns else ()
    return (*conditions, *traction, *(("wear_rate",) if "wear_rate" in tests.columns else ()))


def measured_points(tests: WearTests, rig: TwinDisc) -> dict[str, Array]:
    """Return the variables of tests, each of shape (tests,), in the unit in which it is shown; NaN where unknown.

    The averaged wear index, which no test measures, is Tγ: so Tassini et al. (2010) compare them.
    """
    load = next(name for name in LOADS if name in tests.columns)
    friction = tests.columns.get("friction_coefficient", np.ones(len(tests)))  # nothing here depends on it
    given: Any = {load: from_si(tests.columns[load], COLUMNS[load].unit)}
    problem = rig.problem(creepage=tests.creepage, friction_coefficient=friction, **given)
    force = tests.traction_coefficient.magnitude * problem.normal_force
    wear_index = force * abs(problem.creepage)
    values = {
        **tests.columns,
        **{name: getattr(problem, name) for name in OF_POINT},
        "tangential_force": force,
        "wear_index": wear_index,
        "averaged_wear_index": wear_index,
        "wear_index_density": wear_index / problem.patch_area,
    }
    return {name: in_unit(values[name], UNITS[name]) for name in known_variables(tests)}
