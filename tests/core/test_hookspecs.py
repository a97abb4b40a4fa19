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


def test_no_hook_is_documented_that_is_not_there() -> None:
    documented = (ROOT / "docs" / "other-models.md").read_text(encoding="utf-8")
    rows = [line for line in documented.splitlines() if line.startswith("| `wearlaw_")]
    assert len(rows) == len(HOOKS)


@pytest.mark.parametrize("name", HOOKS)
def test_every_hook_is_implemented_in_some_test(name: str) -> None:
    tests = [path for path in (ROOT / "tests").rglob("*.py") if path != Path(__file__)]
    assert any(f"def {name}(" in path.read_text(encoding="utf-8") for path in tests)


def test_the_docs_name_the_version_of_the_interface() -> None:
    documented = (ROOT / "docs" / "other-models.md").read_text(encoding="utf-8")
    assert f"The interface has version {hookspecs.INTERFACE_VERSION}." in documented
