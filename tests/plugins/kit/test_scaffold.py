"""New plugins: what is written. `tests/third_party/test_outside.py` installs them and runs their tests."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path
from typing import get_args

import pytest
from click.testing import Result

from tests.cases import assert_refused, wearlaw
from wearlaw.hookspecs import INTERFACE_VERSION  # private: authors write the number
from wearlaw_kit.scaffold import Kind  # private: the kinds that the command offers

pytestmark = pytest.mark.usefixtures("folder")


def new_plugin(*arguments: str) -> Result:
    return wearlaw("new-plugin", *arguments)


@pytest.mark.parametrize("kind", get_args(Kind))
def test_a_new_plugin_is_a_whole_distribution(kind: Kind) -> None:
    result = new_plugin("two_slopes", f"--{kind.replace('_', '-')}", "-o", "two words")
    assert result.exit_code == 0
    assert "  cd 'two words/wearlaw-two_slopes'\n" in result.stdout
    assert "  wearlaw check two_slopes\n" in result.stdout
    written = {
        path.relative_to("two words").as_posix(): path for path in Path("two words").rglob("*") if path.is_file()
    }
    assert {*written} == {
        f"wearlaw-two_slopes/{file}"
        for file in (".github/workflows/tests.yml", "README.md", "pyproject.toml", "test_two_slopes.py")
    } | {f"wearlaw-two_slopes/wearlaw_two_slopes/{file}" for file in ("__init__.py", "py.typed")}
    module = written["wearlaw-two_slopes/wearlaw_two_slopes/__init__.py"].read_text(encoding="utf-8")
    assert "class TwoSlopes(" in module
    assert f"wearlaw_interface = {INTERFACE_VERSION}\n" in module


def test_whatever_the_author_adds_to_the_package_is_in_the_wheel() -> None:
    pytest.importorskip("build")
    pytest.importorskip("hatchling")
    new_plugin("two_slopes", "--wear-law")
    folder = Path("wearlaw-two_slopes")
    (folder / "wearlaw_two_slopes" / "tables").mkdir()
    for added in ("formula.py", "tables/__init__.py", "tables/slopes.csv"):
        (folder / "wearlaw_two_slopes" / added).write_text("")
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", str(folder)]
    subprocess.run(build, check=True, capture_output=True)
    (wheel,) = (folder / "dist").glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        held = {name for name in archive.namelist() if not name.startswith("wearlaw_two_slopes-")}
    files = ("__init__.py", "py.typed", "formula.py", "tables/__init__.py", "tables/slopes.csv")
    assert held == {f"wearlaw_two_slopes/{file}" for file in files}


@pytest.mark.parametrize("name", ["", "two words", "Zobory", "2slopes", "class", "a-b", "../up", "é"])
def test_a_name_that_is_no_lower_case_identifier_is_refused(name: str) -> None:
    assert_refused(new_plugin("--wear-law", "--", name), "name: must be a Python name of lower-case letters")


@pytest.mark.parametrize(("name", "holder"), [("usfd", "the wear law of "), ("fits", "the plugin ")])
def test_a_taken_name_is_refused_with_who_has_it(name: str, holder: str) -> None:
    assert_refused(new_plugin(name, "--contact-model"), f"name: '{name}' is taken by {holder}")


def test_what_is_there_is_never_overwritten() -> None:
    Path("wearlaw-zobory").mkdir()
    assert_refused(new_plugin("zobory", "--wear-law"), "output: 'wearlaw-zobory' exists and is left as it is")
    assert not [*Path("wearlaw-zobory").iterdir()]


def test_a_folder_that_cannot_be_written_is_one_clear_error() -> None:
    assert_refused(new_plugin("zobory", "--wear-law", "-o", "/proc"), "output: cannot write to ")


def test_without_a_kind_all_are_named() -> None:
    assert_refused(new_plugin("zobory"), "say what the plugin provides: --wear-law,", exit_code=2)
