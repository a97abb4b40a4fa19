"""What the package's errors have in common."""

from __future__ import annotations

import inspect
import pickle
import re

import pytest

import wearlaw as wl
from wearlaw import errors
from wearlaw.errors import (  # private: how messages are made
    DataError,
    Fault,
    OutputError,
    UnknownModelError,
    did_you_mean,
)

CLASSES = [found for _, found in inspect.getmembers(errors, inspect.isclass) if issubclass(found, Exception)]


@pytest.mark.parametrize("error", CLASSES)
def test_every_error_and_warning_has_the_base_of_its_kind_and_is_public(error: type[Exception]) -> None:
    base = wl.WearlawWarning if issubclass(error, Warning) else wl.WearlawError
    assert issubclass(error, base)
    assert error.__name__ in errors.__all__


def test_a_configuration_error_lists_every_problem_with_its_path() -> None:
    error = wl.ConfigurationError("TwinDisc", [Fault(("disc_1", "diameter"), "is missing"), Fault((), "is odd")])
    assert str(error) == "TwinDisc:\n  disc_1.diameter: is missing\n  is odd"
    assert str(wl.ConfigurationError("Disc", [Fault(("diameter",), "is odd")])) == "Disc: diameter: is odd"


def test_a_configuration_error_survives_pickling() -> None:
    error = wl.ConfigurationError("Disc", [Fault(("diameter",), "is odd")])
    loaded = pickle.loads(pickle.dumps(error))
    assert (loaded.subject, loaded.problems, str(loaded)) == (error.subject, error.problems, str(error))


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("Exakt", ["fastsim", "exact"], "exact"),
        ("KTH", ["usfd", "kth"], "kth"),
        ("creepage", ["normal_force", "longitudinal_creepage", "lateral_creepage"], "longitudinal_creepage"),
        ("friction", ["traction_coefficient", "friction_coefficient"], "friction_coefficient"),
        ("low_speed", ["coefficient.high_speed", "coefficient.low_speed"], "coefficient.low_speed"),
    ],
)
def test_did_you_mean_sees_through_capitals_and_finds_a_word_in_a_longer_name(
    word: str, known: list[str], meant: str
) -> None:
    assert did_you_mean(word, known) == f"; did you mean '{meant}'?"


def test_single_letters_are_no_words_of_a_longer_name() -> None:
    assert did_you_mean("m", ["m_c", "tr_sc"]) == "."


def test_a_line_of_a_message_is_cut_however_long_what_it_names() -> None:
    long = "x" * 100_000
    for error, begin in (
        (wl.ConfigurationError("Disc", [Fault((long,), "is odd")]), "Disc: xxx"),
        (wl.ConfigurationError("Disc", [Fault((long,), "is odd")] * 2), "Disc:\n  xxx"),
        (DataError("the tests are wrong in:", [long]), "the tests are wrong in:\n  xxx"),
        (wl.InputError(f"is wrong\n{long}"), "is wrong\nxxx"),
        (OutputError(long), "xxx"),
    ):
        assert str(error).startswith(begin)
        assert max(map(len, str(error).splitlines())) < 1000


@pytest.mark.parametrize("name", [["a"], {}, None, 1])
@pytest.mark.parametrize("kind", ["rig", "contact_model", "stage", "law", "wear_law", "material"])
def test_a_name_that_is_no_text_is_not_found(kind: str, name: object) -> None:
    with pytest.raises(UnknownModelError, match=rf"is called {re.escape(repr(name))}"):
        getattr(wl, kind)(name)
