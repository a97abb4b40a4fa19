"""What the distribution holds, and what it does without extras, or with each alone, the packages of others hidden."""

from __future__ import annotations

import email
import re
import subprocess
import sys
import tomllib
import zipfile
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from pathlib import Path

import pytest
from packaging.requirements import Requirement

import wearlaw
from tests.environments import ROOT, build
from tests.extras import USES

PACKAGES = [
    ROOT / "core" / "wearlaw",
    *sorted(path.parent for path in (ROOT / "plugins").glob("wearlaw_*/__init__.py")),
]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    return zipfile.ZipFile(build(ROOT, tmp_path_factory.mktemp("wheel")))


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.name)
def test_each_package_says_that_it_is_typed_in_the_wheel(package: Path, wheel: zipfile.ZipFile) -> None:
    assert {f"{package.name}/__init__.py", f"{package.name}/py.typed"} <= {*wheel.namelist()}


def test_the_wheel_has_the_version_and_the_licence_of_the_project(wheel: zipfile.ZipFile) -> None:
    folder = f"wearlaw-{wearlaw.__version__}.dist-info"
    metadata = email.message_from_bytes(wheel.read(f"{folder}/METADATA"))
    assert (metadata["Version"], metadata["License-Expression"]) == (wearlaw.__version__, "BSD-3-Clause")
    assert wheel.read(f"{folder}/licenses/LICENSE") == (ROOT / "LICENSE").read_bytes()


def test_every_model_has_its_entry_point() -> None:
    rooms = (ROOT / "plugins" / "wearlaw_models").glob("*/*")
    models = {f"wearlaw_models.{path.parent.name}.{path.stem}" for path in rooms if path.suffix in {"", ".py"}}
    found = PROJECT["entry-points"]["wearlaw"].values()
    others = {"__init__", "__pycache__", "kalker"}  # the theory of Kalker is for models to share
    assert {name for name in models if name.rpartition(".")[2] not in others} == {
        name for name in found if name.startswith("wearlaw_models.")
    }


HEAVY = [
    *("pandas", "xarray", "matplotlib", "rich", "zarr", "filelock", "loky"),
    *("jinja2", "plotly", "h5netcdf", "h5py", "tomli_w"),
]


def test_help_of_a_command_needs_no_extra_and_names_it() -> None:
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({HEAVY}))\nfrom wearlaw.cli import main; main(['fit', '--help'])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "Fit the parameters of a wear law to your tests." in done.stdout
    assert 'install it with: python -m pip install "wearlaw[fits]"' in " ".join(done.stdout.split())


@pytest.mark.parametrize(
    ("code", "needs"),
    [
        ("wl.sweep", 'wearlaw.sweep needs xarray; install it with: python -m pip install "wearlaw[sweeps]"'),
        ("wl.fit", 'wearlaw.fit needs pandas; install it with: python -m pip install "wearlaw[fits]"'),
        ("from wearlaw.cli import main; main(['run', 'tassini2010'])", 'pip install "wearlaw[studies]"'),
    ],
)
def test_a_missing_package_is_an_error_that_names_its_extra(code: str, needs: str) -> None:
    code = f"import sys; sys.modules.update(dict.fromkeys({HEAVY}))\nimport wearlaw as wl\n{code}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert needs in done.stderr


def normal(name: str) -> str:
    return re.sub("[-_.]+", "-", name).lower()


def required(extra: str) -> set[str]:
    """Return all distributions that wearlaw needs with an extra, itself among them."""
    found, waiting = set(), [("wearlaw", extra)]
    while waiting:
        name, extra = one = waiting.pop()
        if one in found:
            continue
        found.add(one)
        own = [*PROJECT["dependencies"], *PROJECT["optional-dependencies"].get(extra, ())]
        try:
            lines = own if name == "wearlaw" else requires(name) or []
        except PackageNotFoundError:  # for another system
            continue
        for needed in map(Requirement, lines):
            if needed.marker is None or needed.marker.evaluate({"extra": extra}):
                waiting += [(normal(needed.name), inner) for inner in needed.extras or {""}]
    return {name for name, _ in found}


HIDING = """\
import runpy, sys
from importlib.machinery import PathFinder

class Hiding(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        return None if name in {hidden} else super().find_spec(name, path, target)

sys.meta_path[sys.meta_path.index(PathFinder)] = Hiding
sys.argv = ["extras.py", {extra!r}]
runpy.run_path({path!r}, run_name="__main__")
"""


@pytest.mark.parametrize("extra", USES)
def test_an_extra_alone_does_what_it_is_for(extra: str) -> None:
    there = required(extra)
    distributions = packages_distributions().items()
    hidden = {module for module, names in distributions if not there & {*map(normal, names)}}
    code = HIDING.format(hidden=hidden, extra=extra, path=str(ROOT / "tests" / "extras.py"))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
