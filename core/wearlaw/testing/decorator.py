"""The decorator that makes pytest tests of the checks of a model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, TypeVar

from wearlaw.errors import InputError, did_you_mean
from wearlaw.testing.kit import Check, checks

if TYPE_CHECKING:
    from wearlaw.models.contact_model import Model

TestFunction = TypeVar("TestFunction", bound=Callable[[Check], None])


def conformance(
    model: Model, *, expected_failures: Mapping[str, str] | None = None
) -> Callable[[TestFunction], TestFunction]:
    """Return a decorator that runs a test function of one argument, `check`, with every check of a model.

    Parameters
    ----------
    model : Rig, ContactModel or WearLaw
        With the options that are to be checked.
    expected_failures : mapping of str to str, optional
        Names of checks that are known to fail, each with the reason; the test fails once one of them passes.

    Raises
    ------
    InputError
        If an expected failure is no check of this model.
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
