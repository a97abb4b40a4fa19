"""The reference page names whatever `import wearlaw` offers."""

from __future__ import annotations

import inspect
import re

import pytest

import wearlaw as wl
from tests.environments import ROOT

DOCUMENTED_WITH_OTHERS = {
    "Configuration": "the base of all records with fields",
    "PatchMean": "what `patch_mean` returns",
    "Quantity": "pint's, made by `Q`",
    "WearlawError": "the base of the errors in the table",
    "InputError": "the base of those caused by an input",
    "WearlawWarning": "the base of the warnings in the table",
    "hookimpl": "the page about hooks",
}


def offered() -> list[str]:
    """Return the names of public classes, functions and modules; the others are types and constants."""
    values = {name: getattr(wl, name) for name in wl.__all__}
    kinds = (inspect.isclass, inspect.isfunction, inspect.ismodule)
    found = [name for name, value in values.items() if any(kind(value) for kind in kinds)]
    return sorted(set(found) - DOCUMENTED_WITH_OTHERS.keys())


@pytest.mark.parametrize("name", offered())
def test_a_public_class_function_or_module_is_in_the_reference(name: str) -> None:
    page = (ROOT / "docs" / "reference.md").read_text(encoding="utf-8")
    directive = rf"^\.\. auto(class|function):: {name}$"
    error = rf"^\| `{name}` \|"
    module = rf"`wearlaw\.{name}`"
    assert re.search(rf"{directive}|{error}|{module}", page, re.MULTILINE)
