"""Writes the tables of the validation page from the `validates` marks of the tests."""

import csv
import importlib
import io
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from string import Formatter
from typing import Any, NamedTuple

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "validation"
HEAD = ("claim", "held to", "independent source", "test")
TEXTS = {"source", "held_to"}
"""Keywords of a mark that are text; the others are numbers that its test receives."""


class Validation(NamedTuple):
    """A claim with the test that holds it."""

    topic: str
    claim: str
    source: str
    held_to: str
    path: str
    test: str


def numbers(mark: Any) -> dict[str, Any]:
    """Return the numbers of a mark by name; the test receives each as an argument."""
    return {name: value for name, value in mark.kwargs.items() if name not in TEXTS}


def read(mark: Any, path: str, test: str) -> Validation:
    """Return the claim of a mark; raise a ValueError for a digit in its text, which could drift from its numbers."""
    topic, claim = mark.args
    held_to = mark.kwargs["held_to"]
    if any(re.search(r"\b[0-9]", text) for text, *_ in Formatter().parse(held_to)):
        raise ValueError(f"{path}::{test}: held_to = {held_to!r} has a digit; give it as a number of the mark")
    given = numbers(mark)
    return Validation(topic, shown(claim, given), mark.kwargs["source"], shown(held_to, given), path, test)


def shown(text: str, given: dict[str, Any]) -> str:
    """Return a text with its numbers in the style of the documentation: 5 % and 1e-9."""
    return re.sub(r"(?<=\d)%", " %", re.sub(r"(?<=e[+-])0(?=\d)", "", text.format(**given)))


def validations() -> Iterator[Validation]:
    """Yield the claims in the order of the test files, files outside folders first, and of the tests in them."""
    for file in sorted((ROOT / "tests").rglob("test_*.py"), key=lambda path: (len(path.parts), path)):
        if "@pytest.mark.validates(" not in file.read_text(encoding="utf-8"):
            continue
        path = file.relative_to(ROOT)
        for test, function in vars(importlib.import_module(".".join(path.with_suffix("").parts))).items():
            for mark in getattr(function, "pytestmark", ()):
                if test.startswith("test_") and mark.name == "validates":
                    yield read(mark, path.as_posix(), test)


def tables() -> dict[str, str]:
    """Return the table of each topic as CSV; the name of a test is shown as a sentence."""
    rows = defaultdict(list)
    for one in validations():
        name = one.test.removeprefix("test_").replace("_", " ")
        path = one.path.removeprefix("tests/")
        rows[one.topic].append((one.claim, one.held_to, one.source, f"`{path}`: {name}"))
    found = {}
    for topic, lines in rows.items():
        file = io.StringIO()
        csv.writer(file, lineterminator="\n").writerows((HEAD, *lines))
        found[topic] = file.getvalue()
    return found


def write() -> None:
    """Write the tables into the folder beside the page that shows them."""
    for topic, table in tables().items():
        (FOLDER / f"{topic}.csv").write_text(table, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    write()
