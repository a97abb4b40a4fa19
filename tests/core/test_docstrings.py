"""The docstrings of fields: found in the source when they are asked for, wherever the class was made."""

from __future__ import annotations

from typing import Any

from pydantic import Field

import wearlaw as wl
from wearlaw.configuration import (
    field_docstrings,
)  # private: what `show`, schemas and signatures say of fields


class Described(wl.Configuration):
    """A class with docstrings of all kinds."""

    below: float = 1.0
    """Said below
    in two lines."""
    given: float = Field(default=1.0, description="Said by hand.")
    """Passed over."""
    silent: float = 1.0

    def method(self) -> None:
        """Belong to no field."""

    early: int = Field(default=1, alias="from")
    """Known by another name."""
    disc: wl.Disc | None = None
    """A record inside."""
    last: float = 1.0


class Inheriting(Described):
    """A class that annotates some fields anew."""

    below: float = 2.0
    silent: float = 2.0
    """Said at last."""


def test_a_field_is_described_by_hand_or_by_the_literal_below_it() -> None:
    assert field_docstrings(Described) == {
        "below": "Said below\nin two lines.",
        "given": "Said by hand.",
        "silent": "",
        "early": "Known by another name.",
        "disc": "A record inside.",
        "last": "",
    }


def test_an_inherited_field_is_described_where_it_was_annotated_last() -> None:
    assert field_docstrings(Inheriting) == {**field_docstrings(Described), "below": "", "silent": "Said at last."}


def test_a_class_whose_source_is_gone_works_without_descriptions() -> None:
    names: dict[str, Any] = {"wl": wl, "__name__": "a_module_that_is_gone"}
    exec("class Toy(wl.Configuration):\n    a: float = 1.0\n    'The a.'\n", names)
    assert field_docstrings(names["Toy"]) == {"a": ""}
    assert "description" not in names["Toy"].model_json_schema()["properties"]["a"]
    assert names["Toy"]().a == 1.0
