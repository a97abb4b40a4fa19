"""Distributions of other people, installed with wearlaw's wheel into a fresh environment, which all tests share."""

from __future__ import annotations

import json
import shutil
import textwrap
from pathlib import Path
from typing import get_args

import pytest

from tests.core.distributions import write_distribution
from tests.environments import ROOT, Environment, build
from wearlaw_kit.scaffold import Kind, write_plugin  # private: writes without a process for each

OUTSIDE = ROOT / "docs" / "examples" / "wearlaw-outside"

BROKEN = {
    "import_fails": ("import a_module_that_is_not_there", "ModuleNotFoundError: No module named 'a_module_that_is_"),
    "too_new": (
        "wearlaw_interface = 99",
        "TypeError: it is built for version 99 of the plugin interface, but this wearlaw has version ",
    ),
}
"""Plugins that cannot be loaded, each with its cause."""

CASE = """
    title = "One of each kind from outside, beside those of wearlaw"
    contact_models = ["rigid", "exact"]
    stages = ["wet"]
    wear_laws = [{ model = "made_up", slope = "6 ug/m/N" }, "kth"]
    laws = ["flash"]

    [rig]
    type = "weighted"
    material = "made_up_steel"

    [sweeps.creepage]
    mass = "20 kg"
    creepage = ["1 %", "5 %"]
    friction_coefficient = 0.46
"""

PREDICT = """
import json
import wearlaw as wl
steel = wl.material("made_up_steel")
contact = wl.rig("weighted", material=steel) | wl.contact_model("rigid") | wl.stage("wet", half_speed="1 m/s")
by_name = contact | wl.wear_law("made_up", slope="6 ug/m/N") | wl.law("flash")
written = {
    "rig": {"type": "weighted", "material": "made_up_steel"},
    "contact_model": "rigid",
    "stages": ["wet"],
    "laws": [{"model": "made_up", "slope": "6 ug/m/N"}, "flash"],
}
read = wl.Pipeline.model_validate_json(json.dumps(written))
assert read == by_name == wl.Pipeline.model_validate_json(by_name.model_dump_json())
r = read(mass="20 kg", creepage="1 %", friction_coefficient=0.4)
print(json.dumps([r.tangential_force.m_as("N"), r.wear_rate.m_as("ug/m/mm^2"), r["flash_temperature"].m_as("K")]))
"""


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """Return an environment with wearlaw and a distribution from outside."""
    folder = tmp_path_factory.mktemp("wheels")
    wheels = build(ROOT, folder), build(OUTSIDE, folder)
    return Environment(tmp_path_factory.mktemp("with outside"), *wheels)


@pytest.fixture(scope="module")
def troubles(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return the variables of an environment with broken distributions beside those that work."""
    folder = tmp_path_factory.mktemp("troubles")
    for name, (module, _) in BROKEN.items():
        write_distribution(folder, name, module, "9.9")
    return {"PYTHONPATH": str(folder)}


@pytest.fixture(scope="module")
def generated(environment: Environment, tmp_path_factory: pytest.TempPathFactory) -> dict[Kind, Path]:
    """Return the folders of new plugins, installed as their author would; the program wrote that with a wear law."""
    folder = tmp_path_factory.mktemp("generated")
    assert environment.wearlaw("new-plugin", "my_wear_law", "--wear-law", cwd=folder).returncode == 0
    plugins: dict[Kind, Path] = {
        "wear_law": folder / "wearlaw-my_wear_law",
        **{kind: write_plugin(f"my_{kind}", kind, folder) for kind in get_args(Kind) if kind != "wear_law"},
    }
    environment.install(*(argument for plugin in plugins.values() for argument in ("-e", plugin)))
    return plugins


def models(listed: str) -> dict[str, list[str]]:
    """Return the distribution and version of each model that `wearlaw plugins` lists."""
    rows = [line.split() for line in listed.splitlines()[1:]]
    return {row[-3]: row[-2:] for row in rows}


def test_the_wheels_are_what_is_imported_and_nothing_of_the_running_environment(environment: Environment) -> None:
    code = (
        "import importlib.metadata, wearlaw, wearlaw_models.contact_models.exact, wearlaw_outside\n"
        "for module in (wearlaw, wearlaw_models.contact_models.exact, wearlaw_outside):\n    print(module.__file__)\n"
        "print(*(one.name for one in importlib.metadata.distributions() if 'wearlaw' in one.name))"
    )
    *files, distributions, predicted = environment.run("-W", "error", "-c", f"{code}\n{PREDICT}").splitlines()
    assert len(files) == 3
    assert all(Path(file).is_relative_to(environment.folder) for file in files), files
    assert {"wearlaw", "wearlaw-outside"} <= {*distributions.split()}
    assert distributions.split().count("wearlaw") == 1
    assert_predicted(predicted)


def assert_predicted(printed: str) -> None:
    force, rate, temperature = json.loads(printed)
    assert force == pytest.approx(0.2 * 20.0 * 9.81, rel=1e-12)  # half of μN, to rounding
    assert rate > 0
    assert temperature > 0


def test_they_work_in_a_case_file(environment: Environment, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(textwrap.dedent(CASE))
    done = environment.wearlaw("run", "mine.toml", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    report = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert report.count("wearlaw-outside 1.2.3") == 7, "rig, contact model, stage, both laws, material and its type"
    csv = (tmp_path / "out" / "results.csv").read_text()
    for law in ("made_up,", "kth,", ",flash"):
        for model in ("rigid", "exact"):
            assert csv.count(f"creepage,{model} with wet,{law},") == 2


def test_its_command_is_one_of_the_program(environment: Environment) -> None:
    assert "weigh" in environment.wearlaw("--help").stdout
    assert environment.wearlaw("weigh", "20 kg").stdout == "196.2 N\n"
    refused = environment.wearlaw("weigh", "heavy")
    assert refused.returncode == 1
    assert "Error: " in refused.stderr


def test_the_outside_distribution_passes_its_own_tests(environment: Environment, tmp_path: Path) -> None:
    shutil.copytree(OUTSIDE / "tests", tmp_path / "tests")
    # What its contact model is exempt from is skipped.
    assert " passed, 1 skipped in " in environment.run("-m", "pytest", "-W", "error", cwd=tmp_path)


def test_the_wheel_holds_the_templates(generated: dict[Kind, Path], tmp_path: Path) -> None:
    here = write_plugin("my_wear_law", "wear_law", tmp_path)
    written = {path.relative_to(here): path.read_bytes() for path in here.rglob("*") if path.is_file()}
    assert {path: (generated["wear_law"] / path).read_bytes() for path in written} == written


@pytest.mark.parametrize("kind", get_args(Kind))
def test_a_new_plugin_passes_its_own_tests_as_generated(
    generated: dict[Kind, Path], kind: Kind, environment: Environment
) -> None:
    passed = environment.run("-m", "pytest", "-p", "no:cacheprovider", cwd=generated[kind])
    # What the contact model of the template is exempt from is skipped.
    assert (" passed, 1 skipped in " if kind == "contact_model" else " passed in ") in passed
    assert not {"failed", "xfailed", "error", "warning", "warnings"} & set(passed.split())


def test_the_examples_in_the_readmes_of_new_plugins_run(generated: dict[Kind, Path], environment: Environment) -> None:
    pages = [(plugin / "README.md").read_text(encoding="utf-8") for plugin in generated.values()]
    examples = [page.partition("```python\n")[2].partition("```")[0] for page in pages]
    printed = environment.run("-c", "\n".join(examples))
    assert printed.count("Prediction of 1 operating point") == len(generated)


def test_new_and_outside_models_are_listed_with_their_distributions_until_they_are_uninstalled(
    generated: dict[Kind, Path], environment: Environment
) -> None:
    found = models(environment.wearlaw("plugins").stdout)
    assert {"exact", "fastsim", "global", "brr", "kth", "usfd"} < set(found)
    for name in ("weighted", "rigid", "wet", "made_up", "flash", "made_up_steel", "HeatedSteel"):
        assert found[name] == ["wearlaw-outside", "1.2.3"]
    for kind in generated:
        assert found[f"my_{kind}"] == [f"wearlaw-my_{kind}", "0.1.0"]
    environment.pip("uninstall", "--yes", *(plugin.name for plugin in generated.values()))
    shown = environment.wearlaw("show", "my_wear_law")
    assert shown.returncode == 1
    assert shown.stderr.startswith("Error: no model, material, case, test set or section is called 'my_wear_law'.")


def test_broken_distributions_are_named_each_with_its_cause_and_the_others_listed(
    environment: Environment, troubles: dict[str, str]
) -> None:
    done = environment.wearlaw("plugins", variables=troubles)
    said = done.stderr.splitlines()
    assert len(said) == len(BROKEN)
    for name, (_, cause) in BROKEN.items():
        start = f"left out: {name} 9.9 (plugin '{name}'): "
        (line,) = [line for line in said if line.startswith(start)]
        assert line.removeprefix(start).startswith(cause)
    assert {"made_up", "rigid", "exact", "fastsim", "global", "brr", "kth"} < set(models(done.stdout))


def test_beside_broken_distributions_the_others_go_on_working(
    environment: Environment, troubles: dict[str, str]
) -> None:
    assert_predicted(environment.run("-c", PREDICT, variables=troubles))
