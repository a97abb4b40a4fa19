"""The page about validation: as the tests have it, complete, and with numbers that are asserted."""

from __future__ import annotations

import re

import pytest

from docs import validation
from docs.validation import read
from tests.environments import ROOT

PAGE = (ROOT / "docs/validation.md").read_text(encoding="utf-8")


def test_the_tables_of_the_page_are_those_of_the_tests() -> None:
    committed = {path.stem: path.read_text(encoding="utf-8") for path in validation.FOLDER.iterdir()}
    assert committed == validation.tables(), "renew them with: python docs/validation.py"


def test_the_page_shows_every_table_once() -> None:
    assert sorted(re.findall(r":file: validation/(\S+)\.csv", PAGE)) == sorted(validation.tables())


def test_a_number_of_a_mark_is_what_the_test_receives_and_what_the_page_shows() -> None:
    given = {"at": 2.0, "within": 1e-9, "share": 0.05}
    mark = pytest.mark.validates(
        "topic", "T of {at:g} %", source="Johnson", held_to="{within:g} and {share:.0%}", **given
    )
    assert validation.numbers(mark) == given
    shown = read(mark, "tests/test_toy.py", "test_toy")
    assert (shown.claim, shown.held_to) == ("T of 2 %", "1e-9 and 5 %")


def test_a_bound_that_is_written_out_is_refused() -> None:
    mark = pytest.mark.validates("topic", "T", source="Johnson", held_to="1e-9")
    with pytest.raises(ValueError, match=r"tests/test_toy\.py::test_toy: held_to = '1e-9' has a digit"):
        read(mark, "tests/test_toy.py", "test_toy")
