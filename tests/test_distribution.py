"""What the distribution holds; `.ci/run` compares the files of sdist and wheel with those of the project."""

from __future__ import annotations

import email
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

import wearlaw
from tests.environments import ROOT, build

PACKAGES = [ROOT / "core" / "wearlaw", *sorted((ROOT / "plugins").glob("wearlaw_*"))]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


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


def test_pyproject_names_every_package_wherever_packages_are_named() -> None:
    names = [package.name for package in PACKAGES]
    tools = PYPROJECT["tool"]
    contracts = [contract for contract in tools["importlinter"]["contracts"] if contract["type"] != "layers"]
    assert [
        Path(path).name for path in tools["hatch"]["build"]["targets"]["wheel"]["packages"] if path[-3:] != ".py"
    ] == names
    without_hooks = {"wearlaw_output", "wearlaw_sweeps"}
    found = PYPROJECT["project"]["entry-points"]["wearlaw"].values()
    assert sorted(found) == [name for name in names[1:] if name not in without_hooks]
    assert tools["importlinter"]["root_packages"] == names
    assert contracts[0]["forbidden_modules"] == names[1:]
    models, applications = contracts[1]["modules"], contracts[2]["forbidden_modules"]
    assert sorted([*models, *applications]) == names[1:]
    assert contracts[2]["source_modules"] == contracts[3]["source_modules"] == models


def test_the_small_extra_for_checks_needs_hypothesis_and_pytest_only() -> None:
    extras = PYPROJECT["project"]["optional-dependencies"]
    assert [line.split(">=")[0] for line in extras["check"]] == ["hypothesis", "pytest"]
    assert {*extras["check"]} <= {*extras["test"]}
    others = {line.split(">=")[0] for name in extras for line in extras[name]} - {"hypothesis", "pytest"}
    blocked = [name.replace("-", "_").replace("pytest_xdist", "xdist") for name in sorted(others)]
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({blocked}))\n"
        "import wearlaw; from wearlaw_kit import checks, conformance\n"
        "law = wearlaw.wear_law('kth'); conformance(law)\n"
        "print(sum(check() is None for check in checks(law)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 10
