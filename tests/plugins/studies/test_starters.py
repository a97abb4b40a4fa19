"""The short cases to start from: they run as printed, and after the edits that people make first."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.cases import wearlaw

STARTERS = ("two_discs", "my_tests", "wheel_on_rail", "wheelset")
OWN_STEEL = '{ youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = "7800 kg/m^3" }'
OWN_TESTS = "creepage [%],normal_force [kN],wear_rate [ug/m/mm^2]\n1,7.4,25\n5,7.4,80\n"

EDITS = [
    ("two_discs", 'disc_2 = { diameter = "47 mm"', 'disc_2 = { diameter = "100 mm"'),
    ("two_discs", 'disc_1 = { diameter = "47 mm", material = "steel" }',
     f'disc_1 = {{ diameter = "47 mm", material = {OWN_STEEL} }}'),
    ("two_discs", 'normal_force = "4.5 kN"', 'max_pressure = "900 MPa"'),
    ("two_discs", ', "kth"]', ']'),
    ("my_tests", '"lewis2004"', '"my-tests.csv"'),
    ("wheel_on_rail", '"300 mm"', '"80 mm"'),
    ("wheel_on_rail", '"strip_theory"', '"polach"'),
    ("wheelset", '"s1002"', '"worn.prw"'),
    ("wheelset", '"uic60"', '"rail.prr"'),
]  # fmt: skip


def run(folder: Path, text: str) -> Path:
    """Run a case beside a CSV file and two profiles, and return the folder of its results."""
    (folder / "case.toml").write_text(text, encoding="utf-8")
    (folder / "my-tests.csv").write_text(OWN_TESTS, encoding="utf-8")
    wl.write_profile(folder / "worn.prw", wl.Profile.s1002())
    wl.write_profile(folder / "rail.prr", wl.Profile.uic60())
    done = wearlaw("run", "case.toml", "-o", "out")
    assert done.exit_code == 0, done.output
    return folder / "out"


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize("name", STARTERS)
def test_a_starter_runs_as_printed_and_is_short(folder: Path, name: str) -> None:
    text = wearlaw("case", name).stdout
    assert sum(1 for line in text.splitlines() if line and not line.startswith("#")) <= 20
    rows = pd.read_csv(run(folder, text) / "results.csv")
    assert np.isfinite(rows["wear_rate [ug/m/mm^2]"]).all()


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize(("name", "before", "after"), EDITS)
def test_a_starter_runs_after_an_obvious_edit(folder: Path, name: str, before: str, after: str) -> None:
    text = wearlaw("case", name).stdout
    assert before in text
    # Fewer points than printed, for speed.
    changed = text.replace(before, after).replace("points = 61", "points = 3").replace("points = 100", "points = 9")
    out = run(folder, changed)
    assert (pd.read_csv(out / "results.csv")["wear_rate [ug/m/mm^2]"] > 0.0).any()
    if name == "my_tests":
        assert (out / "tests.csv").is_file()
        assert wl.load_case(str(out / "case.toml")).measured is not None


def test_a_section_that_judges_a_paper_refuses_another_rig_in_one_sentence(folder: Path) -> None:
    text = wearlaw("case", "tassini2010").stdout.replace("# track_width", "track_width")
    (folder / "case.toml").write_text(text, encoding="utf-8")
    refused = wearlaw("run", "case.toml")
    assert refused.exit_code == 1
    assert "section 'tassini2010_claims'" in refused.stderr
    assert "rig" in refused.stderr
    assert not (folder / "case-results").exists()
