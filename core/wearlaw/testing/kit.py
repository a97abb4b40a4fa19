"""The checks of a model, as named functions that raise an `AssertionError`, and as tests of pytest."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TypeAlias, TypeVar

from wearlaw.errors import InputError, did_you_mean
from wearlaw.models.contact_model import ContactModel, Model
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw.models.wear_law import WearLaw
from wearlaw.pipeline.pipeline import Rig
from wearlaw.testing import (
    acceleration,
    contact_checks,
    contact_energy,
    contact_fields,
    contact_force,
    contact_limits,
    contact_nodes,
    declarations,
    law_branches,
    law_checks,
    law_shape,
    rig_checks,
    unit_checks,
)
from wearlaw.testing.examples import as_failure
from wearlaw.testing.roundtrip import RoundTrip

CheckFunction: TypeAlias = Callable[..., None]

TestFunction = TypeVar("TestFunction", bound="Callable[[Check], None]")

COMMON: tuple[CheckFunction, ...] = (*declarations.COMMON, *unit_checks.CHECKS)
"""Checks of every model."""


@dataclass(frozen=True)
class Check:
    """One invariant of one model; calling it raises an `AssertionError` if the model breaks it.

    Attributes
    ----------
    name : str
        Such as "no_slip_no_wear".
    doc : str
        The property that must hold.
    """

    name: str
    doc: str
    _run: Callable[[], None] = field(repr=False)

    def __call__(self) -> None:
        """Run the check.

        Raises
        ------
        AssertionError
            If the model does not pass, or raises an error of its own.
        """
        try:
            self._run()
        except (AssertionError, KeyboardInterrupt):
            raise
        except BaseException as error:
            failure = as_failure(error)
            raise failure from (None if isinstance(error, BaseExceptionGroup) else error)


def checks(model: Model) -> Iterator[Check]:
    """Yield the checks of a rig, a contact model or a wear law.

    Checks that do not apply to the model are left out: those of claims in `ContactModel.exemptions`, of nodes for a law
    of the whole patch, of geometries that a contact model does not solve, and of optional methods that are missing.

    Parameters
    ----------
    model : Rig, ContactModel or WearLaw
        The model, with the options to check.

    Raises
    ------
    InputError
        If this is not a model, or is a rig without an `example`.
    """
    if isinstance(model, Rig):
        found = _of_rig(model)
    elif isinstance(model, WearLaw):
        found = _of_law(model)
    elif isinstance(model, ContactModel):
        found = _of_contact_model(model)
    else:
        raise InputError(
            f"checks: needs a rig, a contact model or a wear law, such as wl.wear_law('usfd'); got {model!r}"
        )
    gate = _Gate(model)
    for function in found:
        yield Check(function.__name__, inspect.getdoc(function) or "", partial(gate.run, partial(function, model)))
    trip = RoundTrip(model)
    for way in (trip.through_toml, trip.through_json, trip.through_pickle):
        yield Check(f"round_trip_{way.__name__}", inspect.getdoc(way) or "", partial(gate.run, way))


def conformance(
    model: Model, *, expected_failures: Mapping[str, str] | None = None
) -> Callable[[TestFunction], TestFunction]:
    """Return a decorator that runs a test function of one argument, `check`, with every check of a model.

    Parameters
    ----------
    model : Rig, ContactModel or WearLaw
        The model, with the options to check.
    expected_failures : mapping of str to str, optional
        Checks that are known to fail, each with the reason. The test fails once one of them passes.

    Raises
    ------
    InputError
        If an expected failure is not a check of this model.
    """
    import pytest

    expected = dict(expected_failures or {})
    found = list(checks(model))
    names = [check.name for check in found]
    for name in expected:
        if name not in names:
            hint = did_you_mean(name, names)
            raise InputError(f"expected_failures: no check of '{model.name}' is called '{name}'{hint}")

    def parameter(check: Check) -> object:
        marks = [pytest.mark.xfail(strict=True, reason=expected[check.name])] if check.name in expected else []
        return pytest.param(check, id=check.name, marks=marks)

    def decorate(test: TestFunction) -> TestFunction:
        mark = pytest.mark.parametrize("check", [parameter(check) for check in found])
        decorated: TestFunction = mark(test)
        return decorated

    return decorate


def _of_rig(rig: Rig) -> list[CheckFunction]:
    of_creepage = rig_checks.OF_CREEPAGE if rig.creepage in rig_checks.varied(rig) else ()
    return [*rig_checks.CHECKS, *of_creepage, *COMMON]


def _of_law(law: WearLaw) -> list[CheckFunction]:
    idle = [*(law_checks.OF_SEVERAL_NODES if law.scale == "patch" else law_checks.OF_THE_PATCH)]
    if law.breakpoints(law.numbers) is None:
        idle += law_branches.OF_BREAKPOINTS
    if law.ramps(law.numbers) is None:
        idle += law_branches.OF_RAMPS
    functions = [*law_shape.CHECKS, *law_checks.CHECKS, *law_branches.CHECKS]
    return [
        *(function for function in functions if function not in idle),
        *COMMON,
        *acceleration.CHECKS,
        *declarations.OF_LAWS,
    ]


def _of_contact_model(model: ContactModel) -> list[CheckFunction]:
    modules = (contact_nodes, contact_checks, contact_force, contact_limits, contact_energy, contact_fields)
    claims = [item for module in modules for item in module.CLAIMS.items()]
    idle = [function for claim, of in claims if claim in model.exemptions for function in of]
    if "line" not in model.geometries():
        idle += [*contact_checks.OF_LINES, *contact_limits.OF_LINES]
    if "ellipse" not in model.geometries():
        idle += [*contact_checks.OF_ELLIPSES, *contact_force.OF_ELLIPSES, *contact_limits.OF_ELLIPSES]
        idle += contact_energy.OF_REFINED_STRIPS
    if model.geometries() == ("line",):
        idle += [*contact_nodes.OF_STRIPS, *contact_force.OF_STRIPS]
    if model.refined() is None:
        idle += [*contact_energy.OF_REFINED, *contact_energy.OF_REFINED_STRIPS]
    if type(model).on_strips is ContactModel.on_strips or "ellipse" not in model.geometries():
        idle += contact_energy.OF_STRIPS
    if not isinstance(model, LineContactModel):
        idle += [*contact_energy.OF_FIELDS, *contact_fields.OF_FIELDS]
    else:
        if type(model).crossings is LineContactModel.crossings:
            idle += contact_fields.OF_CROSSINGS
        if type(model).excess_dissipation is LineContactModel.excess_dissipation:
            idle += contact_fields.OF_EXCESS
    functions: list[CheckFunction] = [
        *contact_checks.CHECKS,
        *contact_nodes.CHECKS,
        *contact_force.CHECKS,
        *dict.fromkeys(function for _, of in claims for function in of),  # one check may belong to two claims
        *contact_energy.CHECKS,
        *contact_fields.CHECKS,
    ]
    return [
        *(function for function in functions if function not in idle),
        *COMMON,
        *acceleration.CHECKS,
        *declarations.OF_CONTACT_MODELS,
    ]


class _Gate:
    """Runs checks until the model gives a contact of a wrong shape; then all fail with that message.

    On a contact of shape (batch, batch, nodes), the checks would fill the memory.
    """

    def __init__(self, model: Model) -> None:
        self._model = model
        self._wrong: str | None = None

    def run(self, check: Callable[[], None]) -> None:
        """Run a check, the first one after a look at the shapes of a few contacts."""
        if self._wrong is None:
            self._wrong = contact_checks.wrong_shape(self._model) if isinstance(self._model, ContactModel) else ""
        if self._wrong:
            raise AssertionError(self._wrong)
        try:
            check()
        except contact_checks.ShapeError as error:
            self._wrong = str(error)
            raise
