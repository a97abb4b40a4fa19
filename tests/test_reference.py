"""The reference page names whatever `import wearlaw` offers."""

from __future__ import annotations

import re

import pytest

import wearlaw as wl
from tests.environments import ROOT


@pytest.mark.parametrize("name", wl.__all__)
def test_a_public_name_is_in_the_reference(name: str) -> None:
    page = (ROOT / "docs" / "reference.md").read_text(encoding="utf-8")
    directive = rf"^\.\. auto(class|function):: {name}$"
    row = rf"^\|[^|]*`{name}`[^|]*\|"
    module = rf"^\.\. automodule:: wearlaw\.contact\.{name}$"
    assert re.search(rf"{directive}|{row}|{module}", page, re.MULTILINE)
