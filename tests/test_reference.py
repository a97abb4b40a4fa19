"""The reference page names whatever `import wearlaw` and the plugin of wheelsets offer."""

from __future__ import annotations

import re

import pytest

import wearlaw as wl
import wearlaw_wheelset
from tests.environments import ROOT

PAGE = (ROOT / "docs" / "reference.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", wl.__all__)
def test_a_public_name_is_in_the_reference(name: str) -> None:
    directive = rf"^\.\. auto(class|function):: {name}$"
    row = rf"^\|[^|]*`{name}`[^|]*\|"
    module = rf"^\.\. automodule:: wearlaw\.contact\.{name}$"
    assert re.search(rf"{directive}|{row}|{module}", PAGE, re.MULTILINE)


@pytest.mark.parametrize("name", wearlaw_wheelset.__all__)
def test_a_public_name_of_the_plugin_of_wheelsets_is_in_the_reference(name: str) -> None:
    assert re.search(rf"^\.\. auto(class|function):: wearlaw_wheelset\.{name}$", PAGE, re.MULTILINE)
