"""Variables that models of anyone declare: their words, one dimension a name, and classes that are defined again."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any, ClassVar

import pytest

import wearlaw as wl
from wearlaw.units.variables import OWNERS, UNITS, VARIABLES, name_of  # private: the one table of variables

FIELDS: dict[str, Any] = {"frozen": True, "kw_only": True, "eq": False}


@pytest.fixture(autouse=True)
def _restored() -> Iterator[None]:
    tables: tuple[dict[str, Any], ...] = (VARIABLES, UNITS, OWNERS)
    before = [dict(one) for one in tables]
    yield
    for table, one in zip(tables, before, strict=True):
        table.clear()
        table.update(one)


def problem_with(*variables: Any, called: str = "Swung") -> type[wl.Problem]:
    """Return a class of problems with results."""
    return dataclasses.dataclass(**FIELDS)(type(called, (wl.Problem,), {"results": variables, "__module__": __name__}))


def law_with(predicted: wl.Outcome) -> type[wl.Law]:
    """Return a class of laws with an outcome."""

    class Swinging(wl.Law):
        name: ClassVar[str] = "swinging"
        outcome: ClassVar[wl.Outcome] = predicted

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            return contact.wear_index

    return Swinging


def test_words_have_defaults() -> None:
    plain = wl.Variable("swing_angle", unit="deg")
    assert (plain.long_name, plain.meaning, plain.symbol) == ("swing angle", "Swing angle", "")


def test_what_a_class_declares_is_in_the_table_under_its_own_words() -> None:
    assert name_of("swing_angle") == "swing angle"
    problem_with(wl.Variable("swing_angle", unit="deg", long_name="swing θ"))
    law_with(wl.Outcome("swing_work", unit="J", of="patch", long_name="work of swinging W"))
    assert (name_of("swing_angle"), UNITS["swing_angle"]) == ("swing θ", "deg")
    assert (name_of("swing_work"), UNITS["swing_work"]) == ("work of swinging W", "J")


def test_a_name_with_another_dimension_is_an_error_that_names_both_classes() -> None:
    problem_with(wl.Variable("swing", unit="deg"))
    with pytest.raises(
        wl.UnitError, match=r"'swing': it has the unit 'mm' in \S+Other, and it has .*'deg' in \S+Swung"
    ):
        problem_with(wl.Variable("swing", unit="mm"), called="Other")
    with pytest.raises(wl.UnitError, match=r"'wear_index': it has the unit 'mm' in \S+Swung, and .*'N' in wearlaw"):
        problem_with(wl.Variable("wear_index", unit="mm"))
    problem_with(wl.Variable("swing", unit="mrad"), called="Other")  # an angle as well
    assert UNITS["swing"] == "deg"


def test_an_outcome_and_a_result_of_a_rig_have_different_names() -> None:
    with pytest.raises(wl.InputError, match="this name has a meaning, wear index Tγ; choose another one"):
        wl.Outcome("wear_index", unit="N", of="patch")
    law_with(wl.Outcome("swing", unit="deg", of="patch"))
    with pytest.raises(
        wl.InputError, match=r"it is a result of a rig in \S+Swung, and it is an outcome in \S+Swinging"
    ):
        problem_with(wl.Variable("swing", unit="deg"))


def test_a_class_that_is_defined_again_may_change_its_variable() -> None:
    problem_with(wl.Variable("swing", unit="deg"))
    problem_with(wl.Variable("swing", unit="mm", long_name="swing s"))
    assert (name_of("swing"), UNITS["swing"]) == ("swing s", "mm")


@pytest.mark.parametrize(
    ("make", "error", "said"),
    [
        (lambda: wl.Variable("swing angle", unit="deg"), wl.InputError, "variable: its name must be made of letters"),
        (lambda: problem_with(wl.Variable("swing", unit="swings")), wl.UnitError, "variable 'swing': .*swings"),
        (lambda: problem_with("swing"), wl.InputError, r"Swung.results: must be a tuple of variables, such as"),
    ],
)
def test_wrong_variables_are_refused(make: Any, error: type[Exception], said: str) -> None:
    with pytest.raises(error, match=said):
        make()
