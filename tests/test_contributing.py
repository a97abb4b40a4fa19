"""README and CONTRIBUTING: commands, sessions, links and the picture of the house are the project's; one version."""

from __future__ import annotations

import ast
import re
import shlex
import shutil
import textwrap
import tomllib
from collections.abc import Iterator
from importlib.metadata import entry_points
from pathlib import Path

import pytest

import wearlaw as wl
from tests.cases import wearlaw
from tests.environments import ROOT
from tests.plugins.fits.cli_data import rates, rows, write_tests
from tests.release import inconsistencies
from wearlaw import (
    hookspecs,  # private: hooks are an interface by name
    loader,  # private: all that is installed, by kind
)

TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def text_of(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


PYPROJECT = tomllib.loads(text_of("pyproject.toml"))


def test_all_sessions_of_nox_are_told() -> None:
    sessions = re.findall(r"^def (\w+)\(session", text_of("noxfile.py"), re.MULTILINE)
    assert [name for name in sessions if f"nox -s {name}`" not in TEXT] == []


def test_the_files_that_contributing_and_security_link_to_are_there() -> None:
    links = re.findall(r"\]\((?!http)([^)#]+)", TEXT + text_of("SECURITY.md") + text_of("README.md"))
    assert {"docs/other-models.md", "CONTRIBUTING.md"} <= set(links)
    assert [link for link in links if not (ROOT / link).exists()] == []


def first_line(module: str) -> str:
    path = f"{module}/__init__.py" if (ROOT / module).is_dir() else f"{module}.py"
    return (ast.get_docstring(ast.parse(text_of(path))) or "").splitlines()[0]


def models() -> Iterator[str]:
    """Yield a line for each room of models, with the entry points of its plugins."""
    rooms: dict[str, list[str]] = {}
    for name, place in PYPROJECT["project"]["entry-points"]["wearlaw"].items():
        if place.startswith("wearlaw_models."):
            rooms.setdefault(place.split(".")[1], []).append(name)
    for room in ("rigs", "contact_models", "stages", "laws"):
        text = textwrap.wrap(", ".join(rooms.pop(room)), 96, break_on_hyphens=False)
        yield f"  {room:15} {text[0]}"
        yield from (f"  {'':15} {line}" for line in text[1:])
    assert not rooms


def house() -> str:
    """Return the picture of the house: the four packages, what each may use, and what is in them."""
    contracts = PYPROJECT["tool"]["importlinter"]["contracts"]
    arrow, layers = (contract["layers"] for contract in contracts if contract["type"] == "layers")
    applications, rooms = ([name for layer in parts for name in layer.split(" | ")] for parts in (arrow, layers))
    return "\n".join(
        [
            "wearlaw_apps: may use the core, and applications further right",
            f"  {' -> '.join(arrow)}",
            *(f"  {name:15} {first_line(f'plugins/wearlaw_apps/{name}')}" for name in applications),
            "wearlaw_kit: may use the core, output and show",
            f"  {'':15} {first_line('plugins/wearlaw_kit')}",
            "wearlaw_models: each may use the public names of wearlaw, and no other model",
            *models(),
            "wearlaw, the core: knows no plugin; each part may use those below it",
            *(f"  {name:15} {first_line(f'core/wearlaw/{name}')}" for name in rooms),
        ]
    )


def test_the_picture_of_the_house_is_that_of_the_code() -> None:
    assert f"```text\n{house()}\n```" in TEXT


def test_the_files_of_wearlaw_agree_on_its_version() -> None:
    assert list(inconsistencies(ROOT)) == []


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


COMMANDS = re.findall(r"^- `wearlaw ([^`]+)`", text_of("README.md"), re.MULTILINE)
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
