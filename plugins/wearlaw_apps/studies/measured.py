"""The measured tests that a case shows beside its predictions, as the variables of figures."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from pydantic import field_validator, model_validator

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.errors import InputError
from wearlaw.loader import contact_model, wear_law
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.text_files import beside
from wearlaw.units.quantities import from_si, in_unit
from wearlaw.units.variables import UNITS
from wearlaw_apps.fits.measured_wear import in_outcomes
from wearlaw_apps.fits.read_tests import read_tests, text_of_tests
from wearlaw_apps.fits.wear_tests import COLUMNS, LOADS, WearTests

OF_TESTS = ("half_width", "max_pressure", "normal_force", "normal_force_per_width", "creepage", "friction_coefficient")
"""Variables of the conditions of tests, on a rig with line contact."""

OF_TRACTION = ("traction_coefficient", "tangential_force", "wear_index", "wear_index_density")
"""Variables of tests with a measured traction."""


class MeasuredTests(Configuration):
    """Measured tests, to show beside the predictions."""

    label: str
    """Their name in the legend."""
    tests: str
    """The name of shipped tests, or the path of a CSV file relative to the case file."""
    sep: str | None = None
    """What separates the cells of the file; None for the first of semicolon, tab and comma that its header has."""
    decimal: str = "."
    """The decimal mark of the file."""
    columns: dict[str, str] | None = None
    """Heads of columns by their names in wearlaw, such as { revolutions = "Revs" }."""

    @field_validator("tests")
    @classmethod
    def _beside(cls, tests: str) -> str:
        return tests if tests in loader.discovered()["test set"] else str(beside(tests))

    @model_validator(mode="after")
    def _readable(self) -> MeasuredTests:
        """Read the tests with the case, so that errors appear before it runs."""
        _ = self.text, self.data
        return self

    @cached_property
    def text(self) -> str:
        """The tests as CSV."""
        return text_of_tests(self.tests)

    @cached_property
    def data(self) -> WearTests:
        """The tests."""
        return read_tests(self.tests, sep=self.sep, decimal=self.decimal, columns=self.columns)

    def on(self, rig: Rig) -> WearTests:
        """Return the tests with wear in other measures, such as a mass loss, as wear rates on a rig."""
        if not self.data.ways:
            return self.data
        # A wear rate depends on no numbers of the law.
        pipeline: Pipeline[...] = Pipeline(rig=rig, contact_model=contact_model("global"), laws=(wear_law("usfd"),))
        friction = None if "friction_coefficient" in self.data.columns else 1.0
        return in_outcomes(self.data, pipeline, friction, None)[0]

    @property
    def shipped(self) -> bool:
        """Whether a plugin ships the tests, rather than a file holding them."""
        return self.tests in loader.discovered()["test set"]


def known_variables(tests: WearTests) -> tuple[str, ...]:
    """Return the variables that tests have."""
    conditions = [name for name in OF_TESTS if name != "friction_coefficient" or name in tests.columns]
    traction = OF_TRACTION if "traction_coefficient" in tests.columns else ()
    return (*conditions, *traction, *(("wear_rate",) if "wear_rate" in tests.columns or tests.ways else ()))


def check_rig(tests: WearTests, rig: Rig) -> None:
    """Raise an error if tests do not belong to a rig.

    Raises
    ------
    InputError
        If the rig does not take their conditions, or does not make line contacts.
    """
    conditions, accepted = _conditions(tests), rig.conditions()
    other = [name for name in conditions if accepted and name not in accepted]
    if other:
        raise InputError(
            f"the tests give {', '.join(conditions)}, but rig '{rig.name}' takes {', '.join(accepted)};"
            " leave [measured] out"
        )
    problem = rig.checked_problem(conditions)
    if problem.geometry != "line" or problem.dims:
        raise InputError(f"the tests are of one line contact, but rig '{rig.name}' makes others; leave [measured] out")


def _conditions(tests: WearTests) -> dict[str, Any]:
    """Return the conditions of tests as a rig takes them."""
    load = next(name for name in LOADS if name in tests.columns)
    friction = tests.columns.get("friction_coefficient", np.ones(len(tests)))  # no variable here depends on it
    loads = from_si(tests.columns[load], COLUMNS[load].unit)
    return {load: loads, "creepage": tests.creepage, "friction_coefficient": friction}


def measured_points(tests: WearTests, rig: Rig) -> dict[str, Array]:
    """Return the variables of tests, each of shape (tests,) in its usual unit, NaN where unknown."""
    problem = rig.checked_problem(_conditions(tests))
    force = tests.traction_coefficient.magnitude * problem.normal_force
    wear_index = force * abs(problem.creepage)
    values = {
        **tests.columns,
        **{name: getattr(problem, name) for name in OF_TESTS},
        "tangential_force": force,
        "wear_index": wear_index,
        "wear_index_density": wear_index / problem.patch_area,
    }
    return {name: in_unit(values[name], UNITS[name]) for name in known_variables(tests)}
