"""`wearlaw life`, as a user meets it."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest
from click.testing import CliRunner

from tests.plugins.life.test_life import line
from wearlaw_life._command import life  # private: the command


@pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")
def test_command_writes_tables_a_figure_and_the_worn_profile(tmp_path: Path) -> None:
    table, folder = tmp_path / "line.csv", tmp_path / "out"
    line(3).to_csv(table, index=False)
    given = ["--set", "vertical_load=60 kN", "--set", "friction_coefficient=0.3", "--set", "sides=each"]
    result = CliRunner().invoke(life, ["wheelset", str(table), "--over", "20 km", *given, "-o", str(folder)])
    assert result.exit_code == 0, result.output
    names = {"life.csv", "profiles.csv", "worn_left.csv", "worn_right.csv", "life.png", "life.json"}
    assert {path.name for path in folder.iterdir()} >= names
    measures = pd.read_csv(folder / "life.csv")
    assert measures["distance [km]"].iloc[-1] == pytest.approx(20.0)
    assert json.loads((folder / "life.json").read_text())["ended"] == "over"
    assert not (tmp_path / "out.partial").exists()
    assert "Life of a wheel: 20 km" in result.output
