"""The table of mutation testing names test files that are there, and that are not slow."""

from __future__ import annotations

import ast

import pytest

from tests.environments import ROOT

SLOW = (ROOT / "tests/slow.txt").read_text(encoding="utf-8").split()


def table() -> dict[str, str]:
    """Return the test files of each module; `mutation.py` itself needs cosmic-ray."""
    source = ast.parse((ROOT / "tests/mutation.py").read_text(encoding="utf-8"))
    assigned = [node for node in source.body if isinstance(node, ast.Assign)]
    (value,) = (node.value for node in assigned if ast.unparse(node.targets[0]) == "TESTS")
    found: dict[str, str] = ast.literal_eval(value)
    return found


@pytest.mark.parametrize(("module", "tests"), table().items())
def test_the_files_of_a_module_are_there_and_in_the_tier_of_the_readme(module: str, tests: str) -> None:
    paths = [f"tests/{test}" for test in tests.split()]
    assert [path for path in paths if not (ROOT / path).is_file()] == []
    assert [path for path in paths for slow in SLOW if path == slow or path.startswith(f"{slow}/")] == []
    room = "core" if module.startswith("wearlaw.") else "plugins"
    code = ROOT / room / module.replace(".", "/")
    assert code.is_dir() or code.with_suffix(".py").is_file()
