"""CONTRIBUTING.md: each of its commands is one that the project runs itself, and each file that it names is there."""

from __future__ import annotations

import ast
import re
import textwrap
import tomllib

from tests.environments import ROOT

TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def text_of(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


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


def house() -> str:
    """Return the picture of the house: models and applications, and the rooms of the core in the order of imports."""
    contracts = tomllib.loads(text_of("pyproject.toml"))["tool"]["importlinter"]["contracts"]
    models, applications = contracts[1]["modules"], contracts[2]["forbidden_modules"]
    arrow, layers = (one["layers"] for one in contracts if one["type"] == "layers")
    rooms = [name for layer in layers for name in layer.split(" | ")]
    inner = [name for layer in arrow for name in layer.split(" | ")]
    apart = [name for name in applications if name not in inner]
    return "\n".join(
        [
            f"applications    {' -> '.join(arrow)}",
            *(f"  {name:22} {first_line(f'plugins/{name}')}" for name in [*inner, *apart]),
            "models",
            *(f"  {line}" for line in textwrap.wrap(", ".join(models), 112, break_on_hyphens=False)),
            "core",
            *(f"  {name:22} {first_line(f'core/wearlaw/{name}')}" for name in rooms),
        ]
    )


def test_the_picture_of_the_house_is_that_of_the_code() -> None:
    assert f"```text\n{house()}\n```" in TEXT
