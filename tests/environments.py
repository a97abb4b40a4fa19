"""Fresh virtual environments with wearlaw's wheel, made without a network."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import venv
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

ROOT = Path(__file__).parents[1]

Variables: TypeAlias = Mapping[str, str]
"""Variables of the environment, beside those that are the same in all runs."""
Done: TypeAlias = subprocess.CompletedProcess[str]


def build(project: Path, folder: Path) -> Path:
    """Build the wheel of a project and return its path."""
    _run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder), cwd=project)
    normal = project.name.replace("-", "_") if project != ROOT else "wearlaw"
    (wheel,) = folder.glob(f"{normal}-*.whl")
    return wheel


class Environment:
    """A virtual environment in which only what is installed here comes before the running one's dependencies."""

    def __init__(self, folder: Path, *wheels: Path) -> None:
        self.folder = folder.resolve()
        venv.create(self.folder, with_pip=False, symlinks=os.name != "nt")
        self._bin = self.folder / ("Scripts" if os.name == "nt" else "bin")
        self.python = str(self._bin / "python")
        self.install(*wheels)
        inside = self.run("-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip()
        (Path(inside) / "dependencies.pth").write_text(str(self._dependencies()))

    def _dependencies(self) -> Path:
        """Make a folder with all that is installed in the running environment, except wearlaw, its plugins and dask.

        Most who install wearlaw have no dask, and pint and xarray would import it in every process.
        """
        folder = self.folder / "dependencies" / "site-packages"  # hypothesis reads all that is in no such folder
        folder.mkdir(parents=True)
        for site in {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}:
            for path in Path(site).iterdir():
                left_out = ("wearlaw", "dask", "distributed")
                if not (path.suffix == ".pth" or path.name.lstrip("_").startswith(left_out)):
                    (folder / path.name).symlink_to(path)
        return folder

    def install(self, *what: str | Path) -> None:
        """Install wheels or folders, and nothing that they depend on."""
        self.pip("install", "--no-index", "--no-deps", "--no-build-isolation", *map(str, what))

    def pip(self, *arguments: str) -> None:
        """Run the running environment's pip on this one."""
        pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", self.python)
        _run(*pip, *arguments, cwd=self.folder)

    def run(self, *arguments: str, cwd: Path | None = None, variables: Variables | None = None) -> str:
        """Run Python with arguments, away from the checkout, and return its output."""
        return _run(self.python, *arguments, cwd=cwd or self.folder, variables=variables).stdout

    def wearlaw(self, *arguments: str, cwd: Path | None = None, variables: Variables | None = None) -> Done:
        """Run the program as a user does, whatever its exit code."""
        return _run(str(self._bin / "wearlaw"), *arguments, cwd=cwd or self.folder, check=False, variables=variables)


def _run(*command: str, cwd: Path, check: bool = True, variables: Variables | None = None) -> Done:
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "PYTEST", "PIP_"))}
    clean |= {"COLUMNS": "100", "PYTHONUTF8": "1", **(variables or {})}
    done = subprocess.run(command, cwd=cwd, env=clean, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0 or not check, f"{command}\n{done.stdout}\n{done.stderr}"
    return done
