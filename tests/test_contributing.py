"""CONTRIBUTING.md: its sessions, links and picture of the house are those of the project; one version everywhere."""

from __future__ import annotations

import ast
import re
import textwrap
import tomllib
from collections.abc import Iterator

from tests.environments import ROOT
from tests.release import inconsistencies

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
