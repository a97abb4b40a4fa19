"""The hook surface is documented and tested."""

from __future__ import annotations

import inspect
from pathlib import Path

import pytest

from wearlaw import hookspecs  # private: the hooks by name

ROOT = Path(__file__).parents[2]
HOOKS = {name: hook for name, hook in inspect.getmembers(hookspecs, inspect.isfunction) if name.startswith("wearlaw_")}


@pytest.mark.parametrize("name", HOOKS)
def test_every_hook_is_in_the_docs_with_its_signature(name: str) -> None:
    signature = inspect.signature(HOOKS[name])
    documented = (ROOT / "docs" / "other-models.md").read_text(encoding="utf-8")
    assert f"| `{name}{signature}`" in documented.replace("\\|", "|")
