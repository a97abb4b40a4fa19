"""The checks of a model, as named functions that raise an `AssertionError`, and as tests of pytest."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TypeAlias, TypeVar

from wearlaw.errors import InputError, WearlawWarning, did_you_mean
from wearlaw.models.contact_model import ContactModel, Model
from wearlaw.models.law import Law
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw.models.stage import Stage
from wearlaw.models.wear_law import WearLaw
from wearlaw.pipeline.pipeline import Rig
from wearlaw_kit import (
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
    stage_checks,
    unit_checks,
)
from wearlaw_kit.examples import ModelRaisedError, as_failure
from wearlaw_kit.shapes import Claims

CheckFunction: TypeAlias = Callable[..., None]

TestFunction = TypeVar("TestFunction", bound="Callable[[Check], None]")

COMMON: tuple[CheckFunction, ...] = (unit_checks.units_of_parameters_do_not_matter,)
"""Checks of every model."""

OF_CONTACTS = (contact_nodes, contact_checks, contact_force, contact_limits, contact_energy, contact_fields)

CLAIMS: Claims = {
    claim: tuple(function for module in OF_CONTACTS for function in module.CLAIMS.get(claim, ()))
    for claim in dict.fromkeys(claim for module in OF_CONTACTS for claim in module.CLAIMS)
}
"""Claims of contact models that have a name of their own, with their checks; any other claim is the name of a check."""

OF_SHAPES = (
    law_shape.rate_has_the_right_shape,
    contact_checks.contact_has_the_shape_of_the_problem,
)
"""Checks without which no other check is run: arrays of a wrong shape may broadcast, and fill the memory."""


FOR_ANY_MODEL = frozenset(
    function.__name__
    for function in (
        *OF_SHAPES,
        law_shape.rate_is_finite,
        law_shape.rate_is_never_negative,
        contact_checks.contact_is_finite,
        contact_checks.no_node_gains_energy,
        stage_checks.pipelines_take_the_contact,
        stage_checks.contact_is_finite,
        stage_checks.contact_does_not_gain_energy,
        rig_checks.problem_is_finite_and_positive,
        rig_checks.problem_has_the_shape_of_the_conditions,
        rig_checks.units_of_conditions_are_checked,
        rig_checks.values_that_are_no_numbers_are_refused,
        unit_checks.units_of_conditions_do_not_matter,
        *COMMON,
    )
)
"""Checks of shape, finite values, sign and units, from which no model can be exempt, whatever its theory."""


class NotRunError(AssertionError):
    """A check was not run, because what the model returns has a wrong shape."""


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
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", WearlawWarning)  # models are tried far outside their ranges
                self._run()
        except (AssertionError, KeyboardInterrupt):
            raise
        except BaseException as error:
            failure = as_failure(error)
            raise failure from (None if isinstance(error, BaseExceptionGroup) else error)


def checks(model: Model) -> Iterator[Check]:
    """Yield the checks of a model, each on a new instance with the fields of the model.

    Checks that do not apply to the model are left out: those of claims in `Model.exemptions`, of nodes for a law of the
    whole patch, of geometries that a contact model does not solve, and of optional methods that are missing.

    Parameters
    ----------
    model : Rig, ContactModel, Stage or Law
        The model, with the options to check.

    Raises
    ------
    InputError
        If this is not a model, or is a rig without an `example`, or is exempt from what must hold for any model.
    """
    functions, idle = _of(model)
    if held := sorted(FOR_ANY_MODEL & {*model.exemptions}):
        raise InputError(
            f"{model.kind} '{model.name}': `exemptions` names {', '.join(held)}, which must hold for any {model.kind};"
            " take them out, and correct the model if a check fails"
        )
    known = [function.__name__ for function in functions]
    left_out = {function.__name__ for function in idle}
    for claim in model.exemptions:
        left_out |= {function.__name__ for function in CLAIMS.get(claim, ())} or {claim}

    def exemptions_are_claims() -> None:
        """`exemptions` names claims of the kit, each with a reason."""
        for claim, reason in model.exemptions.items():
            hint = did_you_mean(claim, [*known, *CLAIMS])
            assert claim in known or claim in CLAIMS, f"`exemptions`: no claim is called '{claim}'{hint}"
            assert str(reason or "").strip(), f"the exemption from '{claim}' has no reason"

    shape = _Shape(model, functions)
    for function in functions:
        if function.__name__ not in left_out:
            yield _check(function.__name__, function, partial(shape.run, function))
    yield _check(exemptions_are_claims.__name__, exemptions_are_claims, exemptions_are_claims)


def conformance(
    model: Model, *, expected_failures: Mapping[str, str] | None = None
) -> Callable[[TestFunction], TestFunction]:
    """Return a decorator that runs a test function of one argument, `check`, with every check of a model.

    Parameters
    ----------
    model : Rig, ContactModel, Stage or Law
        The model, with the options to check.
    expected_failures : mapping of str to str, optional
        Checks that are known to fail, each with the reason. The test fails once one of them passes.

    Raises
    ------
    InputError
        If an expected failure is not a check of this model, or has no reason.

    Notes
    -----
    A claim in `Model.exemptions` becomes a skipped test with its reason.
    """
    import pytest

    expected = dict(expected_failures or {})
    found = list(checks(model))
    validate_expected("expected_failures", model, found, expected)

    def parameter(check: Check) -> object:
        marks = [pytest.mark.xfail(strict=True, reason=expected[check.name])] if check.name in expected else []
        return pytest.param(check, id=check.name, marks=marks)

    exempt = [
        pytest.param(None, id=claim, marks=pytest.mark.skip(reason=f"not claimed: {reason}"))
        for claim, reason in model.exemptions.items()
    ]

    def decorate(test: TestFunction) -> TestFunction:
        mark = pytest.mark.parametrize("check", [*(parameter(check) for check in found), *exempt])
        decorated: TestFunction = mark(test)
        return decorated

    return decorate


def validate_expected(subject: str, model: Model, found: Iterable[Check], expected: Mapping[str, str]) -> None:
    """Raise an `InputError` for an expected failure that is not one of the checks found, or has no reason.

    Parameters
    ----------
    subject : str
        What the user wrote, to begin the message.
    """
    names = [check.name for check in found]
    for name, reason in expected.items():
        if name not in names:
            raise InputError(f"{subject}: no check of '{model.name}' is called '{name}'{did_you_mean(name, names)}")
        if not reason.strip():
            raise InputError(f"{subject}: the expected failure of '{name}' has no reason")


class _Shape:
    """Runs the checks of one model, and none of them if what it returns has a wrong shape."""

    def __init__(self, model: Model, functions: Iterable[CheckFunction]) -> None:
        self.model = model
        self.of_shape = next((function for function in functions if function in OF_SHAPES), None)

    def run(self, function: Callable[..., None]) -> None:
        """Run a check on a new instance of the model."""
        if function is self.of_shape and self.failure is not None:
            raise self.failure
        if self.failure is not None and not isinstance(self.failure, ModelRaisedError):
            raise NotRunError(f"not run, since the model returns a wrong shape: {self.failure}")
        if function is not self.of_shape:
            function(self.model.model_copy())

    @cached_property
    def failure(self) -> AssertionError | None:
        """The failure of the check of shapes, which is run once, or None."""
        try:
            if self.of_shape is not None:
                self.of_shape(self.model.model_copy())
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            failure = as_failure(error)
            failure.__cause__ = None if failure is error else error
            return failure
        return None


def _of(model: Model) -> tuple[list[CheckFunction], list[CheckFunction]]:
    """Return the checks of models of this kind, and those that do not apply to the model."""
    if isinstance(model, Rig):
        return _of_rig(model)
    if isinstance(model, Law):
        return _of_patch_law(model) if model.outcome.of == "patch" else _of_law(model)
    if isinstance(model, Stage):
        return [*stage_checks.CHECKS, *COMMON], []
    if isinstance(model, ContactModel):
        return _of_contact_model(model)
    raise InputError(
        f"checks: needs a rig, a contact model, a stage or a law, such as wl.wear_law('usfd'); got {model!r}"
    )


def _of_rig(rig: Rig) -> tuple[list[CheckFunction], list[CheckFunction]]:
    # Several patches have creepages of their own, which are in proportion to no condition.
    one = rig.creepage in rig_checks.varied(rig) and not rig_checks.makes_several_patches(rig)
    idle = [] if one else [*rig_checks.OF_CREEPAGE]
    functions = [*rig_checks.CHECKS, *rig_checks.OF_CREEPAGE, unit_checks.units_of_conditions_do_not_matter]
    return [*functions, *COMMON], idle


def _of_patch_law(law: Law) -> tuple[list[CheckFunction], list[CheckFunction]]:
    idle: list[CheckFunction] = [law_shape.rate_is_never_negative] if law.outcome.signed else []
    idle += law_checks.OF_NODES_OF_ANY_LAW if law.scale == "patch" else ()
    functions = [*law_shape.OF_ANY_LAW, *law_checks.OF_ANY_LAW, *law_checks.OF_NODES_OF_ANY_LAW]
    return [*functions, law_branches.precision_is_double, *COMMON], idle


def _of_law(law: Law) -> tuple[list[CheckFunction], list[CheckFunction]]:
    idle: list[CheckFunction] = [*law_checks.OF_SEVERAL_NODES] if law.scale == "patch" else []
    if not isinstance(law, WearLaw):
        idle += [*law_shape.OF_WEAR, declarations.band_is_ordered]
        idle += [law_shape.no_slip_no_wear] * (not law.zero_in_stick)
        idle += [law_shape.rate_is_never_negative] * law.outcome.signed
    if law.breakpoints(law.numbers) is None:
        idle += law_branches.OF_BREAKPOINTS
    if law.ramps(law.numbers) is None:
        idle += law_branches.OF_RAMPS
    functions = [*law_shape.CHECKS, *law_checks.CHECKS, *law_branches.CHECKS]
    return [*functions, *COMMON, *acceleration.CHECKS, *declarations.OF_LAWS], idle


def _of_contact_model(model: ContactModel) -> tuple[list[CheckFunction], list[CheckFunction]]:
    functions: list[CheckFunction] = [
        *contact_checks.CHECKS,
        *contact_nodes.CHECKS,
        *contact_force.CHECKS,
        *dict.fromkeys(function for of in CLAIMS.values() for function in of),  # one check may belong to two claims
        *contact_energy.CHECKS,
        *contact_fields.CHECKS,
    ]
    solved = {*model.geometries()}
    idle = [function for function in functions if not solved & vars(function).get("geometries", solved)]
    if model.refined() is None:
        idle += contact_energy.OF_REFINED
    if type(model).on_strips is ContactModel.on_strips:
        idle += contact_energy.OF_STRIPS
    if not isinstance(model, LineContactModel):
        idle += contact_fields.OF_FIELDS
    else:
        if type(model).crossings is LineContactModel.crossings:
            idle += contact_fields.OF_CROSSINGS
        if type(model).excess_dissipation is LineContactModel.excess_dissipation:
            idle += contact_fields.OF_EXCESS
    return [*functions, *COMMON, *acceleration.CHECKS], idle


def _check(name: str, function: Callable[..., None], run: Callable[[], None]) -> Check:
    return Check(name, inspect.getdoc(function) or "", run)
