"""What the distribution holds; `.ci/run` compares the files of sdist and wheel with those of the project."""

from __future__ import annotations

import email
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
    assert sorted(PYPROJECT["project"]["entry-points"]["wearlaw"].values()) == ["wearlaw.rigs", *names[1:]]
    assert tools["importlinter"]["root_packages"] == names
    assert [one.get("modules") or one["forbidden_modules"] for one in contracts[:2]] == [names[1:]] * 2
    assert contracts[2]["source_modules"] == names[1:]
