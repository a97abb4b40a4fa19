"""Check that new plugins pass ruff and mypy --strict as they are generated.

Usage: python tests/typing/scaffold.py

Plugins of both kinds are written with a short and a long name. Exits with 1 where a tool complains.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import get_args

from wearlaw.scaffold import LONGEST_NAME, Kind, write_plugin

TOOLS = (
    ("ruff", "check", "--no-cache", "--extend-select", "E501", "."),
    ("ruff", "format", "--no-cache", "--check", "--diff", "."),
    ("mypy", "--strict", "--cache-dir", "/dev/null", "."),
)


def complaints(plugin: Path) -> list[str]:
    """Return what the tools say of a plugin."""
    said = []
    for tool in TOOLS:
        done = subprocess.run([sys.executable, "-m", *tool], cwd=plugin, capture_output=True, text=True, check=False)
        if done.returncode:
            said.append(f"{plugin.name}: {' '.join(tool)}\n{done.stdout}{done.stderr}")
    return said


def main() -> int:
    """Check plugins of each kind and return the exit status."""
    with tempfile.TemporaryDirectory() as folder:
        plugins = [
            write_plugin(name, kind, Path(folder) / kind)
            for kind in get_args(Kind)
            for name in ("x", "z" * LONGEST_NAME)
        ]
        said = [line for plugin in plugins for line in complaints(plugin)]
    print("\n".join(said) if said else f"{len(plugins)} new plugins, no complaints")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
