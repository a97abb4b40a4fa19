"""The README: what it promises beside its examples, which `conftest.py` runs."""

from __future__ import annotations

import re
import shlex
import shutil
from importlib.metadata import entry_points
from pathlib import Path

import pytest

import wearlaw as wl
from tests.cases import wearlaw
from tests.environments import ROOT
from tests.plugins.fits.cli_data import rates, rows, write_tests
from wearlaw import (
    hookspecs,  # private: hooks are an interface by name
    loader,  # private: all that is installed, by kind
)

TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def test_everything_that_comes_with_wearlaw_comes_by_the_hooks_of_plugins(monkeypatch: pytest.MonkeyPatch) -> None:
    ours = [one for one in entry_points(group="wearlaw") if one.dist is not None and one.dist.name == "wearlaw"]
    hooks = {name for name in dir(hookspecs) if hasattr(getattr(hookspecs, name), "wearlaw_spec")}
    implemented = {
        name: {hook for hook in dir(module) if hasattr(getattr(module, hook), "wearlaw_impl")}
        for name, module in ((one.name, one.load()) for one in ours)
    }
    assert {name for name, found in implemented.items() if not found or found - hooks} == set()
    monkeypatch.setattr(loader, "_entry_points", lambda: iter(()))
    loader._FOUND.clear()
    try:
        assert not any(shelf.items() for shelf in loader.discovered().shelves.values())
    finally:
        loader._FOUND.clear()


COMMANDS = re.findall(r"^- `wearlaw ([^`]+)`", TEXT, re.MULTILINE)
ELSEWHERE = {"run": "`.ci/run` runs the study", "check": "needs the plugin installed; tests/third_party does it"}


@pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")
def test_the_commands_in_the_list_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_tests(rows(rates()))
    Path("tests.csv").rename("my-tests.csv")
    shutil.copy(ROOT / "plugins/wearlaw_apps/contact_files/carter.0001.mat", "case.0001.mat")
    for command in COMMANDS:
        line, _, into = command.partition(" > ")
        words = shlex.split(line.replace("NAME", "usfd"))
        if words[0] not in ELSEWHERE:
            result = wearlaw(*words)
            assert result.exit_code == 0, f"{command}: {result.output}"
            if into:
                Path(into).write_text(result.stdout, encoding="utf-8")
    assert wl.load_case("my-case.toml").title == wl.load_case("two_discs").title
    found = {path.name for path in tmp_path.iterdir()}
    assert {"my-case.toml", "wearlaw-mine", "case.0001-wear"} <= found
    assert {line.split()[0] for line in COMMANDS} >= {"case", "show", "schema", "fit", "compare", "wear", *ELSEWHERE}
