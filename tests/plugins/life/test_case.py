"""The shipped case of a wheel's life with its section, and `wearlaw life`."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest
from click.testing import CliRunner

import wearlaw as wl
import wearlaw_apps.life
from tests.plugins.life.test_life import line
from wearlaw_apps.life import section  # private: a shorter distance
from wearlaw_apps.life.command import life  # private: the command

TEXT = wearlaw_apps.life.wearlaw_resources()["case"]["wheel_life"].replace('sections = ["life"]\n', "")

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")


@pytest.fixture
def case(tmp_path: Path) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


def test_section_has_the_life_and_which_states_wear_where(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(section, "OVER", wl.Q(100, "km"))
    found = section.section(wl.run(wl.load_case(str(case))))
    assert "no prediction of service" in found.text
    conicity = found.tables["life"]["equivalent_conicity [-]"]
    assert conicity.iloc[-1] > conicity.iloc[0]  # states that are held wear the other way
    assert "In 1000 km it loses" in found.text
    assert found.tables["life"]["distance [km]"].iloc[-1] == pytest.approx(100.0)
    _, states = found.figures
    deepest = [[curve.x[curve.y.argmax()] for curve in panel.curves] for panel in states.panels]
    left, right = deepest
    assert right[-1] < -10.0 < right[0]  # towards the flange where the wheelset is displaced to that side
    assert left == right[::-1]


def test_command_writes_tables_a_figure_and_the_worn_profile(case: Path, tmp_path: Path) -> None:
    table, folder = tmp_path / "line.csv", tmp_path / "out"
    line(3).to_csv(table, index=False, sep=";", decimal=",")
    given = ["--set", "vertical_load=60 kN", "--set", "friction_coefficient=0.3", "--set", "sides=each"]
    result = CliRunner().invoke(
        life, [str(case), str(table), "--over", "20 km", "--decimal", ",", *given, "-o", str(folder)]
    )
    assert result.exit_code == 0, result.output
    names = {"life.csv", "profiles.csv", "worn_left.csv", "worn_right.csv", "life.png", "life.json"}
    assert {path.name for path in folder.iterdir()} >= names
    measures = pd.read_csv(folder / "life.csv")
    assert measures["distance [km]"].iloc[-1] == pytest.approx(20.0)
    record = json.loads((folder / "life.json").read_text())
    assert record["ended"] == "over"
    assert record["notes_of_steps"]
    assert not (tmp_path / "out.partial").exists()
    assert "Life of a wheel: 20 km" in result.output


def test_command_turns_wheels_and_draws_from_a_published_range(case: Path, tmp_path: Path) -> None:
    table, folder = tmp_path / "line.csv", tmp_path / "out"
    line(3).to_csv(table, index=False)
    case.write_text(TEXT.replace('{ model = "usfd", fitted_for = "exact" }', '"kth"'), encoding="utf-8")
    limits = ["--until", "mass=0.0002 kg", "--turn", "depth=0.0002 mm", "--least-diameter", "900 mm"]
    given = ["--set", "vertical_load=60 kN", "--set", "friction_coefficient=0.3", *limits]
    options = ["--published", "coefficient", "--samples", "2", "-o", str(folder)]
    result = CliRunner().invoke(life, [str(case), str(table), "--over", "1000 km", *given, *options])
    assert result.exit_code == 0, result.output
    assert len(pd.read_csv(folder / "cuts.csv")) >= 1
    distances = pd.read_csv(folder / "limits.csv").set_index("measure").loc["mass [kg]"]
    assert distances["low [km]"] < distances["median [km]"] < distances["high [km]"]
    assert "2 lives of a wheel with uncertain coefficient" in result.output
