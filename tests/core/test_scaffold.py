"""New plugins: what is written. `tests/third_party/test_outside.py` installs them and runs their tests."""

from __future__ import annotations

import ast
import os
import tomllib
from pathlib import Path
from typing import Any, get_args

import pytest
from click.testing import Result

import wearlaw as wl
from tests.core.cases import Coarse, Linear, assert_refused, case, installer, wearlaw
from tests.core.distributions import LAB, LAW, Install
from wearlaw.cli.scaffold import Kind, Licence, write_plugin
from wearlaw.plugins import loader
from wearlaw.plugins.shelf import Origin
from wearlaw.study.case import case_text

pytestmark = pytest.mark.usefixtures("folder")

KINDS: dict[Kind, str] = {kind: f"--{kind.replace('_', '-')}" for kind in get_args(Kind)}
CHECKED: dict[Kind, str] = {"stage": "  wearlaw check zobory --option factor=0.5\n", "material": ""}
"""How kinds are checked that are not checked by their name alone."""


def new_plugin(*arguments: str) -> Result:
    return wearlaw("new-plugin", *arguments)


def files(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*")}


@pytest.mark.parametrize(("kind", "flag"), KINDS.items())
def test_what_to_type_next_is_what_works(kind: Kind, flag: str) -> None:
    result = new_plugin("zobory", flag, "-o", "two words")
    assert result.exit_code == 0
    assert result.stdout == (
        f"two words/wearlaw-zobory holds a {kind.replace('_', ' ')} to replace: wearlaw_zobory.py. Next:\n"
        "  cd 'two words/wearlaw-zobory'\n"
        '  python -m pip install -e ".[test]"\n'
        "  pytest\n"
        "  wearlaw plugins\n" + CHECKED.get(kind, "  wearlaw check zobory\n")
    )
    assert result.stderr == ""


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_plugin_is_a_whole_distribution(kind: Kind) -> None:
    plugin = write_plugin("two_slopes", kind, Path())
    assert plugin == Path("wearlaw-two_slopes")
    assert files(plugin) == {
        *(".github", ".github/workflows", ".github/workflows/tests.yml", ".gitignore", "LICENSE", "README.md"),
        *("pyproject.toml", "test_two_slopes.py", "wearlaw_two_slopes.py"),
    }
    for path in plugin.rglob("*"):
        assert path.is_dir() or "$" not in path.read_text(encoding="utf-8").replace("${{ matrix.python }}", "")
    module = ast.parse((plugin / "wearlaw_two_slopes.py").read_text(encoding="utf-8"))
    (model,) = [node for node in module.body if isinstance(node, ast.ClassDef)]
    assert model.name == "TwoSlopes"
    project: Any = tomllib.loads((plugin / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["entry-points"] == {"wearlaw": {"two_slopes": "wearlaw_two_slopes"}}
    assert project["optional-dependencies"] == {"test": ["wearlaw[check]"]}
    assert project["dependencies"] == [f"wearlaw>={wl.__version__}"]


@pytest.mark.parametrize(
    ("licence", "title", "spdx"),
    [
        ("bsd-3-clause", "BSD 3-Clause License", "BSD-3-Clause"),
        ("mit", "MIT License", "MIT"),
        ("none", "No licence has been chosen yet", None),
    ],
)
def test_the_licence_is_that_which_was_chosen(licence: str, title: str, spdx: str | None) -> None:
    assert licence in get_args(Licence)
    assert new_plugin("zobory", "--wear-law", "--license", licence).exit_code == 0
    assert Path("wearlaw-zobory/LICENSE").read_text(encoding="utf-8").startswith(title)
    project: Any = tomllib.loads(Path("wearlaw-zobory/pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project.get("license") == spdx


@pytest.mark.parametrize(
    "name",
    ["", "two words", "Zobory", "2slopes", "class", "a-b", "../up", "a/b", "_zobory", "zobory_", "a__b", "é", "a\n"],
)
def test_a_name_that_is_no_lower_case_identifier_is_refused(name: str, folder: Path) -> None:
    assert_refused(new_plugin("--wear-law", "--", name), "name: must be a Python name of lower-case letters")
    assert files(folder.parent) == {"my work"}


@pytest.mark.parametrize(
    "name", ["none", "true", "field", "class_var", "test_law", "check", "any", "annotated", "array_like", "force"]
)
def test_a_name_whose_class_would_mean_something_else_is_refused(name: str, folder: Path) -> None:
    assert_refused(new_plugin(name, "--wear-law"), f"name: {name!r} would name its class ")
    assert files(folder) == set()


def test_a_name_too_long_for_the_lines_is_refused() -> None:
    assert_refused(new_plugin(25 * "a", "--wear-law"), "name: must have at most 24 characters, got 25")


@pytest.mark.parametrize("flag", [flag for kind, flag in KINDS.items() if kind != "material"])
@pytest.mark.parametrize("name", ["usfd", "kth", "brr", "exact", "fastsim", "patch_mean", "twin_disc"])
def test_a_taken_name_is_refused_with_who_has_it(name: str, flag: str, folder: Path) -> None:
    kinds = ("wear law", "contact model", "stage", "rig")
    kind = next(kind for kind in kinds if name in loader.installed().of_kind(kind).items())
    plugin = "rigs" if kind == "rig" else name
    taker = f"the {kind} of wearlaw {wl.__version__} (plugin '{plugin}')"
    assert_refused(new_plugin(name, flag), f"name: '{name}' is taken by {taker}; choose another")
    assert files(folder) == set()


@pytest.mark.parametrize("model", [Coarse, Linear])
def test_a_name_that_a_model_but_no_plugin_bears_is_taken(
    model: type[wl.ContactModel] | type[wl.WearLaw], monkeypatch: pytest.MonkeyPatch
) -> None:
    installer(monkeypatch)(model)
    kind = "wear law" if issubclass(model, wl.WearLaw) else "contact model"
    taken = f"'{model.name}' is taken by the {kind} of wearlaw-testing 9.8.7 (plugin 'testing')"
    assert_refused(new_plugin(model.name, "--wear-law"), taken)


@pytest.mark.parametrize(
    ("name", "taker"),
    [
        ("crumbling", "wearlaw-dust 1.0 (plugin 'crumbling')"),
        ("lab_of_two", "Wearlaw.Lab-of-two 1.0 (plugin 'other')"),
    ],
)
def test_the_name_of_a_plugin_or_a_distribution_that_is_broken_is_taken(
    name: str, taker: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed = [Origin("crumbling", "wearlaw-dust", "1.0"), Origin("other", "Wearlaw.Lab-of-two", "1.0")]
    monkeypatch.setattr(loader.installed(), "plugins", [*loader.installed().plugins, *installed])
    assert_refused(new_plugin(name, "--wear-law"), f"'{name}' is taken by the plugin {taker}; choose another")
    assert new_plugin("lab", "--wear-law").exit_code == 0


def test_the_name_of_a_parameter_set_is_taken_since_a_wear_law_would_hide_it(install: Install) -> None:
    install("lab", LAB)
    taken = "name: 'lab_2026' is taken by the parameter set of lab 1.0 (plugin 'lab'); choose another"
    assert_refused(new_plugin("lab_2026", "--wear-law"), taken)
    assert_refused(new_plugin("lab_2026", "--contact-model"), taken)
    install("hiding", LAW.format(name="lab_2026"))
    with pytest.warns(wl.PluginWarning, match="parameter set 'lab_2026' has the name of a wear law of hiding 1.0"):
        assert wl.wear_law("lab_2026").name == "lab_2026", "the law hides the set, which is of usfd"
    assert wl.contact_model("exact").name == "exact"


MATERIAL = """
    import wearlaw as wl

    class RailSteel(wl.Material):
        hardness: wl.Stress

    @wl.hookimpl
    def wearlaw_materials():
        return {"RailSteel": RailSteel}
"""


def test_a_material_can_have_the_name_of_a_model_but_not_of_a_material_or_its_class(install: Install) -> None:
    install("steels", MATERIAL)
    taken = f"name: 'steel' is taken by the material of wearlaw {wl.__version__} (plugin 'sheffield'); choose another"
    assert_refused(new_plugin("steel", "--material"), taken)
    taken = "name: 'rail_steel' is taken by the material type of steels 1.0 (plugin 'steels'); choose another"
    assert_refused(new_plugin("rail_steel", "--material"), taken)
    assert new_plugin("twin_disc", "--material").exit_code == 0


@pytest.mark.parametrize("name", ["steel", "tassini2010"])
def test_the_name_of_a_material_or_a_case_is_free_since_they_are_looked_up_apart(
    name: str,
    install: Install,
) -> None:
    assert new_plugin(name, "--wear-law").exit_code == 0
    install("free", LAW.format(name=name))
    assert wl.wear_law(name).name == name
    assert wl.material("steel") == wl.steel()
    assert "title = " in case_text("tassini2010")
    read = case(contact_models=["exact"], wear_laws=[name], rig={"preset": "suros", "material": "steel"})
    assert read.wear_laws == (wl.wear_law(name),)
    assert read.rig == wl.TwinDisc.suros(material=wl.steel())


@pytest.mark.parametrize("content", ["folder", "empty folder", "file", "dangling link"])
def test_what_is_there_is_never_overwritten(content: str, folder: Path) -> None:
    taken = folder / "wearlaw-zobory"
    if content == "file":
        taken.write_text("thesis")
    elif content == "dangling link":
        taken.symlink_to("nowhere")
    else:
        taken.mkdir()
        if content == "folder":
            (taken / "thesis.tex").write_text("years of work")
    before = files(folder)
    assert_refused(new_plugin("zobory", "--wear-law"), "output: 'wearlaw-zobory' exists and is left as it is")
    assert files(folder) == before
    assert content != "file" or taken.read_text() == "thesis"


def test_a_folder_that_cannot_be_written_is_one_clear_error() -> None:
    assert_refused(new_plugin("zobory", "--wear-law", "-o", "/proc"), "output: cannot write the plugin: ")


def test_nothing_is_left_when_the_writing_fails(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_text = Path.write_text

    def failing(path: Path, *arguments: Any, **options: Any) -> int:
        if path.name == "README.md":
            raise OSError(28, os.strerror(28))
        return write_text(path, *arguments, **options)

    monkeypatch.setattr(Path, "write_text", failing)
    assert_refused(new_plugin("zobory", "--wear-law"), "output: cannot write the plugin: No space left on device")
    assert files(folder) == set()


def test_without_a_kind_all_are_named(folder: Path) -> None:
    assert_refused(new_plugin("zobory"), "say what the plugin provides: --wear-law, --law", exit_code=2)
    assert files(folder) == set()
