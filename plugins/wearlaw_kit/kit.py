"""The checks of a model, as named functions that raise an `AssertionError`, and as tests of pytest."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias, TypeVar

import wearlaw as wl
from wearlaw.errors import InputError, WearlawWarning, did_you_mean
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law
from wearlaw.models.model import Exempt, Model
from wearlaw.models.reader import Reader
from wearlaw.pipeline.pipeline import Rig
from wearlaw_kit import (  # each registers its rules  # noqa: F401
    contact,
    contact_forces,
    law,
    law_branches,
    reader,
    rig,
    rig_inputs,
    section,
    stage,
    units,
)
from wearlaw_kit.examples import exempt, failing
from wearlaw_kit.law_contacts import CONTACTS
from wearlaw_kit.reduced import CHECKED
from wearlaw_kit.rules import RULES, Rule, rule
from wearlaw_kit.section import TriedSection

MakeSection: TypeAlias = "Callable[[wl.Study], wl.Section]"

TestFunction = TypeVar("TestFunction", bound="Callable[[Check], None]")


LONGEST = 600
"""Characters of the message of a failure at the most; arrays of a batch can fill pages."""


@rule(Model, always=True)
def exemptions_are_claims(model: Model) -> None:
    """`exemptions` names claims of the kit, each with a reason, and none that must hold for any model of the kind."""
    rules = [kit_rule for kit_rule in RULES if isinstance(model, kit_rule.kind)]
    claims = [claim for kit_rule in rules for claim in kit_rule.claims]
    for claim, reason in model.exemptions.items():
        held = any(kit_rule.name == claim and not kit_rule.claims for kit_rule in rules)
        assert not held, f"`exemptions` names {claim}, which must hold for any {model.kind}; correct the model instead"
        assert claim in claims, f"`exemptions`: no claim is called '{claim}'{did_you_mean(claim, claims)}"
        exemption = as_exempt(reason)
        assert exemption.reason.strip(), f"the exemption from '{claim}' has no reason"
        for name in exemption.parts:
            parts = parts_of(model)
            assert name in parts, (
                f"the exemption from '{claim}' names no part of it: '{name}'{did_you_mean(name, parts)}"
            )
        assert exemption.upto is None or exemption.upto > 0.0, (
            f"`upto` of the exemption from '{claim}' is not above zero"
        )


def as_exempt(reason: str | Exempt) -> Exempt:
    """Return an exemption with its scope, that of a reason alone from the whole claim."""
    return reason if isinstance(reason, Exempt) else Exempt(str(reason or ""))


def parts_of(model: Model) -> tuple[str, ...]:
    """Return the names by which an exemption can name a part of a claim."""
    if isinstance(model, Rig):
        return (*model.conditions(), *type(model).model_fields)
    if isinstance(model, Law):
        return (*CONTACTS, *model.numbers, *model.monotone_in)
    return ("line", "ellipse", "strips", "longitudinal", "lateral", "spin", "spin_moment")


@rule(Model, always=True)
def source_is_stated(model: Model) -> None:
    """`source` says where the theory comes from: literature, a report, or whose idea it is."""
    assert str(getattr(model, "source", "")).strip(), (
        f'{type(model).__name__} has no source; write source: ClassVar[str] = "..." into the class, such as the'
        " authors, journal and year of its formula"
    )


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
            with warnings.catch_warnings(), failing():
                warnings.simplefilter("ignore", WearlawWarning)  # models are tried far outside their ranges
                self._run()
        except AssertionError as error:
            message = str(error)
            if len(message) > LONGEST:
                error.args = (f"{message[: LONGEST - 4]} ...",)
            raise


def checks(model: Model | MakeSection, case: Any = None) -> Iterator[Check]:
    """Yield the checks of a model, each on a new instance with the fields of the model, or of a section of reports.

    Checks that do not apply to the model are left out: those of claims in `Model.exemptions`, unless it is an `Exempt`
    for a part of the claim or up to a bound, of nodes for a law of the
    whole patch, of geometries that a contact model does not solve, and of optional methods that are missing.

    Parameters
    ----------
    model : Rig, ContactModel, Stage, Law, Reader or callable
        The model, with the options to check, or the function of a section.
    case : str or Case, optional
        The case, or its name, whose results the section is made from; it is run once.

    Raises
    ------
    InputError
        If this is not a model, is a rig or a reader without an `example`, or a section without a case.
    """
    model = tried(model, case)
    if not isinstance(model, Rig | ContactModel | Stage | Law | Reader | TriedSection):
        kinds = "a rig, a contact model, a stage, a law, a reader or the function of a section"
        raise InputError(f"checks: needs {kinds}, such as wl.wear_law('usfd'); got {model!r}")
    if isinstance(model, Rig) and not model.example:
        conditions = ", ".join(f'"{name}": ...' for name in model.conditions())
        raise InputError(
            f"checks: rig '{model.name}' has no conditions to try it with; write the conditions of one test into the"
            f' class {type(model).__name__}, with units as text such as "1 %":\n  example = {{{conditions}}}'
        )
    if isinstance(model, Reader) and not model.example:
        file = f'"file": Path(__file__).with_name("small{model.suffixes[0]}")'
        raise InputError(
            f"checks: reader '{model.name}' has no file to try it with; write a small one, and what its program says of"
            f' it, into the class {type(model).__name__}:\n  example = {{{file}, "rolling_speed": "30 m/s", ...}}'
        )
    for kit_rule in RULES:
        if not isinstance(model, kit_rule.kind):
            continue
        exemptions = [as_exempt(model.exemptions[claim]) for claim in kit_rule.claims if claim in model.exemptions]
        if not any(exemption.whole for exemption in exemptions) and kit_rule.applies(model):
            run = functools.partial(_run, kit_rule, model.model_copy(), *exemptions[:1])
            yield Check(kit_rule.name, kit_rule.doc, run)


def tried(model: Any, case: Any) -> Any:
    """Return a model, or a section with the case that it is tried on."""
    if isinstance(model, Model | type) or not callable(model):
        return model
    make: Any = model
    if case is None:
        raise InputError(
            'checks: a section is made from the results of a case; give its name, as in case="two_discs" or --case'
            " two_discs"
        )
    return TriedSection(make, wl.load_case(case) if isinstance(case, str) else case)


def _run(kit_rule: Rule, model: Any, exemption: Exempt | None = None) -> None:
    """Check a model on problems that have the conditions that it declares."""
    token = CHECKED.set(model.own_conditions() if isinstance(model, ContactModel | Stage | Law) else {})
    try:
        with exempt(exemption):
            kit_rule.check(model)
    finally:
        CHECKED.reset(token)


def conformance(
    model: Model | MakeSection, case: Any = None, *, expected_failures: Mapping[str, str] | None = None
) -> Callable[[TestFunction], TestFunction]:
    """Return a decorator that runs a test function of one argument, `check`, with every check of a model.

    Parameters
    ----------
    model, case
        As for `checks`.
    expected_failures : mapping of str to str, optional
        Checks that are known to fail, each with the reason. The test fails once one of them passes.

    Raises
    ------
    InputError
        If an expected failure is not a check of this model, or has no reason.

    Notes
    -----
    A whole claim in `Model.exemptions` becomes a skipped test with its reason.
    """
    import pytest

    expected = dict(expected_failures or {})
    subject = tried(model, case)
    model_checks = list(checks(subject))
    validate_expected("expected_failures", subject, model_checks, expected)

    def parameter(check: Check) -> object:
        marks = [pytest.mark.xfail(strict=True, reason=expected[check.name])] if check.name in expected else []
        return pytest.param(check, id=check.name, marks=marks)

    skipped = [
        pytest.param(None, id=claim, marks=pytest.mark.skip(reason=f"not claimed: {reason}"))
        for claim, reason in subject.exemptions.items()
        if as_exempt(reason).whole
    ]
    return pytest.mark.parametrize("check", [*map(parameter, model_checks), *skipped])


def validate_expected(
    subject: str, model: Model | TriedSection, model_checks: Iterable[Check], expected: Mapping[str, str]
) -> None:
    """Raise an `InputError` for expected failures that are no checks of the model, or have no reason.

    Parameters
    ----------
    subject : str
        What the user wrote, to begin the message.
    """
    names = [check.name for check in model_checks]
    for name, reason in expected.items():
        if name not in names:
            raise InputError(f"{subject}: no check of '{model.name}' is called '{name}'{did_you_mean(name, names)}")
        if not reason.strip():
            raise InputError(f"{subject}: the expected failure of '{name}' has no reason")
