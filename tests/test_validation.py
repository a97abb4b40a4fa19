"""The page about validation: as the tests have it, complete, and with numbers that are asserted."""

from __future__ import annotations

import re

from docs import validation
from tests.environments import ROOT

PAGE = (ROOT / "docs/validation.md").read_text(encoding="utf-8")


def test_the_tables_of_the_page_are_those_of_the_tests() -> None:
    committed = {path.stem: path.read_text(encoding="utf-8") for path in validation.FOLDER.iterdir()}
    assert committed == validation.tables(), "renew them with: python docs/validation.py"


def test_the_page_shows_every_table_once() -> None:
    assert sorted(re.findall(r":file: validation/(\S+)\.csv", PAGE)) == sorted(validation.tables())
