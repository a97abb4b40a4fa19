"""Check that new plugins are sound as they are generated: by ruff and mypy --strict, and by their own CI workflow.

Usage: python tests/typing/scaffold.py

The commands of the workflow of one plugin of each kind are run in a fresh environment, into which they install what
they need. The tools that they have installed then see plugins with a short and a long name. Exits with 1 where
anything fails.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import venv
from collections.abc import Mapping
from pathlib import Path
from typing import get_args

import yaml  # type: ignore[import-untyped]

from wearlaw.scaffold import LONGEST_NAME, Kind, write_plugin

ROOT = Path(__file__).parents[2]

TOOLS = (
    "ruff check --no-cache --extend-select E501 .",
    "ruff format --no-cache --check --diff .",
    "mypy --strict .",
)

WORKFLOW = Path(".github/workflows/tests.yml")


def environment(folder: Path) -> dict[str, str]:
    """Make an environment that holds wearlaw and what it needs, and return the variables that enter it."""
    venv.create(folder, with_pip=True)
    subprocess.run([folder / "bin" / "python", "-m", "pip", "install", "--quiet", ROOT], check=True)
    path = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "VIRTUAL_ENV": str(folder), "PATH": path, "PYTEST_ADDOPTS": "-n auto"}


def workflow(plugin: Path) -> list[str]:
    """Return the commands of a plugin's workflow."""
    steps = yaml.safe_load((plugin / WORKFLOW).read_text(encoding="utf-8"))["jobs"]["tests"]["steps"]
    return [step["run"] for step in steps if "run" in step]


def complaints(plugin: Path, commands: list[str], variables: Mapping[str, str]) -> list[str]:
    """Return what commands say that fail in a plugin's folder."""
    said = []
    for command in commands:
        shell = ["bash", "-e", "-c", command]
        done = subprocess.run(shell, cwd=plugin, env=variables, capture_output=True, text=True, check=False)
        if done.returncode:
            said.append(f"{plugin.name}: {command}\n{done.stdout}{done.stderr}")
    return said


def main() -> int:
    """Check plugins of each kind and return the exit status."""
    said: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        fresh = {**environment(folder / "environment"), "MYPY_CACHE_DIR": str(folder / "mypy")}
        for kind in get_args(Kind):
            plugin = write_plugin(f"new_{kind}", kind, folder)
            commands = workflow(plugin)
            print("\n".join(f"{plugin.name}: {command}" for command in commands))
            said += complaints(plugin, commands, fresh) if commands else [f"{plugin.name}: its workflow runs nothing"]
            for word in ("x", "z" * LONGEST_NAME):
                said += complaints(write_plugin(word, kind, folder / kind), list(TOOLS), fresh)
    print("\n".join(said) if said else "no complaints")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
