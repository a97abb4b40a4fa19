"""The shipped cases of wheelsets, run by the command with their profiles written to files."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

import wearlaw_wheelset as ws
from tests.core.cases import wearlaw, write
from wearlaw.plugins import loader  # private: what is installed, changed for a test
from wearlaw_studies.case import case_text, load_case  # private: a case without its files


def profiles_of(name: str) -> dict[str, ws.Profile]:
    rig: Any = load_case(name).rig
    return {field: value for field, value in rig if isinstance(value, ws.Profile)}


@pytest.mark.parametrize("name", [name for name in loader.installed()["case"].items() if profiles_of(name)])
def test_a_shipped_case_runs_with_profiles_from_files(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    case, profiles = tomllib.loads(case_text(name)), profiles_of(name)
    for field, profile in profiles.items():
        case["rig"][field] = f"{field}.{'prw' if profile.kind == 'wheel' else 'prr'}"
        ws.write_profile(case["rig"][field], profile)
    case["profiles"] = dict([*case.get("profiles", {}).items()][:1])
    case["figures"] = {}
    for sweep in case["sweeps"].values():
        for values in sweep.values():
            if isinstance(values, dict):
                values["points"] = 2
    result = wearlaw("run", str(write(Path("case.toml"), case)), "-o", "results")
    assert result.exit_code == 0, result.output
    table = pd.read_csv("results/tables/parameters.csv").set_index("parameter")
    for field in profiles:
        y = ws.read_profile(case["rig"][field]).points[0].magnitude
        assert table.value[f"{field}.y"] == f"{y.size} values from {y.min():.12g} to {y.max():.12g} mm"
