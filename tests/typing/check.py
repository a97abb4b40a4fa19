"""Check that mypy and pyright accept the right uses of wearlaw and reject the wrong ones.

Usage: python tests/typing/check.py [mypy] [pyright]

Every line of `cases/` that ends in `# expect-error` must have an error, and no other line may. The plugins that the
documentation shows must have none. Exits with 1 where that is not so.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
CASES = sorted((HERE / "cases").glob("*.py"))
PLUGIN = re.compile(r":caption: (?:[\w-]+/)?((?:\w+/)?\w+\.py)\n\n(.*?)\n```", re.DOTALL)
"""The name and the text of a module on a page."""
PAGES = ("write-a-law", "validate-in-ci", "other-models")
MARK = "# expect-error"

Found = dict[tuple[str, int], str]
"""Errors by the name of their file and their line, counted from one."""


def mypy(files: list[Path]) -> Found:
    """Return the errors that mypy finds in files."""
    command = ["mypy", "--strict", "--no-error-summary", "--no-pretty", "--explicit-package-bases"]
    command += ["--config-file", str(ROOT / "pyproject.toml"), *map(str, files)]
    done = _run(command, MYPYPATH=str(files[-1].parent))  # the folder of modules that import each other
    pattern = re.compile(r"(?P<path>.+?\.py):(?P<line>\d+):(?:\d+:)? error: (?P<text>.*)")
    found: Found = {}
    for line in done.stdout.splitlines():
        if match := pattern.match(line):
            found[Path(match["path"]).name, int(match["line"])] = match["text"]
        elif " note: " not in line:
            sys.exit(f"mypy did not run: {line}")
    if done.returncode > 1 or (done.returncode == 1) != bool(found):
        sys.exit(f"mypy did not run:\n{done.stdout}{done.stderr}")
    return found


def pyright(files: list[Path]) -> Found:
    """Return the errors that pyright finds in files."""
    command = ["pyright", "--outputjson", "--pythonpath", sys.executable, *map(str, files)]
    done = _run(command, PYTHONPATH=str(files[-1].parent))  # the folder of modules that import each other
    try:
        diagnostics = json.loads(done.stdout)["generalDiagnostics"]
    except (json.JSONDecodeError, KeyError):
        sys.exit(f"pyright did not run:\n{done.stdout}{done.stderr}")
    return {
        (Path(entry["file"]).name, entry["range"]["start"]["line"] + 1): entry["message"]
        for entry in diagnostics
        if entry["severity"] == "error"
    }


CHECKERS: dict[str, Callable[[list[Path]], Found]] = {"mypy": mypy, "pyright": pyright}


def plugins(folder: Path) -> list[Path]:
    """Write the modules of the pages about plugins into a folder, and return their paths."""
    text = "\n".join((ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8") for page in PAGES)
    modules = {folder / name: module for name, module in PLUGIN.findall(text) if not name.startswith("test_")}
    for path, module in modules.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"{module}\n", encoding="utf-8")
    return sorted(modules, key=lambda path: -len(path.parts))  # packages first, so that the last file is in the folder


def expected() -> set[tuple[str, int]]:
    """Return the lines that must have an error."""
    return {
        (case.name, number)
        for case in CASES
        for number, line in enumerate(case.read_text(encoding="utf-8").splitlines(), start=1)
        if line.endswith(MARK)
    }


def complaints(checker: str) -> list[str]:
    """Return the messages that a checker missed, and those that it should not have given."""
    with tempfile.TemporaryDirectory() as folder:
        found, due = CHECKERS[checker]([*CASES, *plugins(Path(folder))]), expected()
    missing = [f"{file}:{line}: {checker} finds no error where one is due" for file, line in sorted(due - set(found))]
    wrong = [f"{file}:{line}: {checker}: {found[file, line]}" for file, line in sorted(set(found) - due)]
    return missing + wrong


def main(names: list[str]) -> int:
    """Run the named checkers, or all of them, and return the exit status."""
    if unknown := set(names) - set(CHECKERS):
        sys.exit(f"unknown checker: {', '.join(sorted(unknown))}; there are {', '.join(CHECKERS)}")
    said = [line for name in names or CHECKERS for line in complaints(name)]
    print("\n".join(said) if said else f"{len(CASES)} files and the documentation: {len(expected())} expected errors")
    return 1 if said else 0


def _run(command: list[str], **variables: str) -> subprocess.CompletedProcess[str]:
    module, *arguments = command
    return subprocess.run(
        [sys.executable, "-m", module, *arguments],
        cwd=ROOT,
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        check=False,
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
