"""Distributions of other people, built and installed with wearlaw's wheel into a fresh environment."""

from __future__ import annotations

import json
import shutil
import textwrap
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.environments import ROOT, Environment, build

HERE = Path(__file__).parent

BROKEN = {
    "import_fails": ("import a_module_that_is_not_there", "ModuleNotFoundError: No module named 'a_module_that_is_"),
    "misspelt": (
        "import wearlaw\n\n@wearlaw.hookimpl\ndef wearlaw_wear_law():\n    return []",
        "PluginValidationError: unknown hook 'wearlaw_wear_law'",
    ),
    "raises": (
        "import wearlaw\n\n@wearlaw.hookimpl\ndef wearlaw_wear_laws():\n    raise KeyError('lost')",
        "KeyError: 'lost'",
    ),
    "too_new": (
        "wearlaw_interface = 99",
        "TypeError: it is built for version 99 of the plugin interface, this wearlaw has version ",
    ),
}
"""Plugins that cannot be loaded, each with its cause."""

USURPER = """
    import wearlaw as wl

    class Usurper(wl.WearLaw):
        name = "usfd"
        source = "a test"

        def rate(self, contact):
            return 0.0 * contact.pressure

    @wl.hookimpl
    def wearlaw_wear_laws():
        return [Usurper]
"""

CASE = """
    title = "A law and a model from outside, beside those of wearlaw"
    contact_models = ["rigid", "exact"]
    wear_laws = [{ model = "made_up", slope = "6 ug/m/N" }, "kth"]

    [rig]
    preset = "suros"

    [sweeps.creepage]
    max_pressure = "1500 MPa"
    creepage = ["1 %", "5 %"]
    friction_coefficient = 0.46
"""

PREDICT = """
import json
import wearlaw as wl
predict = wl.TwinDisc.suros() | wl.contact_model("rigid") | wl.wear_law("made_up", slope="6 ug/m/N")
r = predict(normal_force="5 kN", creepage="1 %", friction_coefficient=0.4)
print(json.dumps([r.tangential_force.to("N").magnitude, r.wear_rate.to("ug/m/mm^2").magnitude]))
"""


@dataclass
class Wheels:
    """Everything that is installed, built once."""

    ours: Path
    outside: Path
    broken: list[Path]


def project(folder: Path, name: str, module: str) -> Path:
    """Write the project of a plugin that is one module."""
    here = folder / f"wearlaw-{name.replace('_', '-')}"
    here.mkdir()
    (here / f"wearlaw_{name}.py").write_text(textwrap.dedent(module))
    (here / "pyproject.toml").write_text(
        f'[build-system]\nrequires = ["hatchling"]\nbuild-backend = "hatchling.build"\n'
        f'[project]\nname = "{here.name}"\nversion = "9.9"\n'
        f'[project.entry-points.wearlaw]\n{name} = "wearlaw_{name}"\n'
        f'[tool.hatch.build]\ninclude = ["wearlaw_{name}.py"]\n'
    )
    return here


@pytest.fixture(scope="session")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> Wheels:
    folder = tmp_path_factory.mktemp("wheels")
    sources = {name: module for name, (module, _) in BROKEN.items()} | {"usurper": USURPER}
    broken = [build(project(folder, name, module), folder) for name, module in sources.items()]
    return Wheels(build(ROOT, folder), build(HERE / "wearlaw-outside", folder), broken)


@pytest.fixture(scope="session")
def environment(wheels: Wheels, tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """Return an environment with wearlaw and a distribution from outside."""
    return Environment(tmp_path_factory.mktemp("with outside"), wheels.ours, wheels.outside)


@pytest.fixture(scope="session")
def troubled(wheels: Wheels, tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """Return an environment with broken distributions beside those that work."""
    return Environment(tmp_path_factory.mktemp("troubled"), wheels.ours, wheels.outside, *wheels.broken)


def listed(environment: Environment) -> dict[str, list[str]]:
    """Return the rows of `wearlaw plugins` by the name of the model."""
    rows = [line.split() for line in environment.wearlaw("plugins").stdout.splitlines()[1:]]
    return {row[-3]: row[-2:] for row in rows}


def test_the_wheels_are_what_is_imported_and_nothing_of_the_running_environment(environment: Environment) -> None:
    code = "import wearlaw, wearlaw_exact, wearlaw_outside\nfor m in (wearlaw, wearlaw_exact, wearlaw_outside):\n"
    files = environment.run("-W", "error", "-c", f"{code}    print(m.__file__)").stdout.splitlines()
    assert len(files) == 3
    assert all(Path(file).is_relative_to(environment.folder) for file in files), files
    found = "import importlib.metadata as m; print(*(d.name for d in m.distributions() if 'wearlaw' in d.name))"
    assert sorted(environment.run("-c", found).stdout.split()) == ["wearlaw", "wearlaw-outside"]


def test_the_outside_law_and_model_are_listed_with_their_distribution(environment: Environment) -> None:
    rows = listed(environment)
    assert rows["made_up"] == rows["rigid"] == ["wearlaw-outside", "1.2.3"]
    assert {"exact", "fastsim", "global", "brr", "kth", "usfd"} < set(rows)


def test_they_work_in_a_pipeline(environment: Environment) -> None:
    force, rate = json.loads(environment.run("-W", "error", "-c", PREDICT).stdout)
    assert force == pytest.approx(2000.0, rel=1e-12)  # μN, to rounding
    assert rate > 0


def test_they_work_in_a_case_file(environment: Environment, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(textwrap.dedent(CASE))
    done = environment.wearlaw("run", "mine.toml", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "\n  and wearlaw-outside 1.2.3: contact model rigid, wear law made_up\nResults in out:\n" in done.stdout
    csv = (tmp_path / "out" / "results.csv").read_text()
    for law in ("made_up", "kth"):
        for model in ("rigid", "exact"):
            assert csv.count(f"creepage,{model},{law},") == 2


def test_the_law_passes_the_checks(environment: Environment) -> None:
    done = environment.wearlaw("check", "made_up", "--option", "slope=6 ug/m/N")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "\nok " in done.stdout


def test_the_outside_distribution_passes_its_own_tests(environment: Environment, tmp_path: Path) -> None:
    shutil.copytree(HERE / "wearlaw-outside" / "tests", tmp_path / "tests")
    done = environment.run("-m", "pytest", "-W", "error", cwd=tmp_path)
    assert " passed in " in done.stdout


def test_once_uninstalled_it_is_gone(wheels: Wheels, tmp_path: Path) -> None:
    environment = Environment(tmp_path / "here", wheels.ours, wheels.outside)
    assert "made_up" in listed(environment)
    environment.pip("uninstall", "--yes", "wearlaw-outside")
    assert not {"made_up", "rigid"} & set(listed(environment))
    shown = environment.wearlaw("show", "made_up")
    assert shown.returncode == 1
    assert shown.stderr.startswith("Error: no model is called 'made_up'.")


def test_broken_distributions_are_named_each_with_its_cause(troubled: Environment) -> None:
    said = troubled.wearlaw("plugins").stderr.splitlines()
    assert len(said) == len(BROKEN)
    for name, (_, cause) in BROKEN.items():
        start = f"left out: wearlaw-{name.replace('_', '-')} 9.9 (plugin '{name}'): "
        (line,) = [line for line in said if line.startswith(start)]
        assert line.removeprefix(start).startswith(cause)


def test_beside_broken_distributions_the_others_go_on_working(troubled: Environment) -> None:
    assert {"made_up", "rigid", "exact", "fastsim", "global", "brr", "kth"} < set(listed(troubled))
    force, _ = json.loads(troubled.run("-c", PREDICT).stdout)
    assert force == pytest.approx(2000.0, rel=1e-12)  # μN, to rounding


def test_a_taken_name_is_refused_with_both_distributions(troubled: Environment) -> None:
    shown = troubled.wearlaw("show", "usfd")
    assert shown.returncode == 1
    assert "wear law 'usfd' is provided more than once, by wearlaw 0.1.0 (plugin 'usfd') and wearlaw-usurper 9.9" in (
        shown.stderr
    )
