"""Check that new plugins are sound as they are generated: by ruff and mypy --strict, and by their own CI workflow.

Their tests, which the workflow runs last, are left to `tests/third_party/test_outside.py`.

Usage: python tests/typing/scaffold.py ENVIRONMENT

ENVIRONMENT is the folder of a virtual environment that holds wearlaw and what it needs. The commands of the workflow of
one plugin of each kind are run in it and install what else they need, the tools among them. Exits with 1 where anything
fails.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import get_args

import yaml  # type: ignore[import-untyped]

from wearlaw_kit.scaffold import Kind, write_plugin  # private: writes without a process for each

WORKFLOW = Path(".github/workflows/tests.yml")
LAST = "pytest"


def inside(environment: Path) -> dict[str, str]:
    """Return the variables that enter an environment."""
    path = f"{environment / 'bin'}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "VIRTUAL_ENV": str(environment), "PATH": path}


def workflow(plugin: Path) -> list[str]:
    """Return the commands of a plugin's workflow before the last."""
    steps = yaml.safe_load((plugin / WORKFLOW).read_text(encoding="utf-8"))["jobs"]["tests"]["steps"]
    *commands, last = [step["run"] for step in steps if "run" in step]
    if last != LAST or not commands:
        sys.exit(f"{plugin / WORKFLOW}: runs {[*commands, last]}, where {LAST} should come last, after other commands")
    return commands


def complaints(folder: Path, commands: list[str], variables: Mapping[str, str]) -> list[str]:
    """Return what commands say that fail in a folder."""
    said = []
    for command in commands:
        shell = ["bash", "-e", "-c", command]
        done = subprocess.run(shell, cwd=folder, env=variables, capture_output=True, text=True, check=False)
        if done.returncode:
            said.append(f"{folder.name}: {command}\n{done.stdout}{done.stderr}")
    return said


def main(environment: Path) -> int:
    """Check plugins of each kind and return the exit status."""
    said: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        variables = {**inside(environment.resolve()), "MYPY_CACHE_DIR": str(folder / "mypy"), "WEARLAW": "wearlaw"}
        for kind in get_args(Kind):
            plugin = write_plugin(f"new_{kind}", kind, folder)
            commands = workflow(plugin)
            print("\n".join(f"{plugin.name}: {command}" for command in commands))
            said += complaints(plugin, commands, variables)
    print("\n".join(said) if said else "no complaints")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
