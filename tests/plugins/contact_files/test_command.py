"""`wearlaw wear`, as a user meets it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

import wearlaw as wl
from tests.cases import assert_refused, files, wearlaw
from tests.plugins.contact_files.files import FILES
from wearlaw_apps.contact_files.command import _print  # private: one reader, without the look-up

pytestmark = [
    pytest.mark.usefixtures("blank_figures", "folder"),
    pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning", "ignore::wearlaw.RangeWarning"),
]


@pytest.fixture(autouse=True)
def results(folder: Path) -> None:
    for name in ("tread", "flange", "half_space"):
        shutil.copy(FILES[name], folder)


TREAD, FLANGE, HALF_SPACE = (FILES[name].name for name in ("tread", "flange", "half_space"))


def printed(text: str) -> dict[str, list[str]]:
    """Return the printed rows by their names."""
    rows = [line.split() for line in text.splitlines() if "[" in line or line.startswith(("stick", "friction"))]
    return {row[0]: row[-1:] if "[" not in row[1] else row[2:] for row in rows}


def test_forces_powers_and_wear_of_each_body_are_printed(folder: Path) -> None:
    result = wearlaw("wear", HALF_SPACE, "--law", "usfd")
    assert result.exit_code == 0
    rows = printed(result.stdout)
    found = wl.Prediction.of(wl.read_contact(HALF_SPACE), wl.wear_law("usfd"))
    assert rows["normal_force"] == ["8.2e+04"]
    assert rows["longitudinal_force"] == ["1.37e+04"]
    assert rows["power_of_creepages"] == ["1197"]
    assert rows["power_of_slip"] == ["1083"]
    assert rows["wear_rate_wheel"] == rows["wear_rate_rail"] == [f"{found.wear_rate.m:.4g}"]
    assert "wear_rate_wheel [µg/m/mm²]" in result.stdout
    assert "note: half_space.0001.mat: the slip of the nodes dissipates 1083 W, the creepages 1197 W; the laws" in (
        result.stderr
    )
    assert "wear: the parameters of wear law 'usfd' were fitted for line contacts" in result.stderr
    written = {"wear.csv", "profile_wheel.csv", "profile_rail.csv", "wear.png", "wear.json", ".wearlaw-files"}
    assert files(folder / "half_space.0001-wear") == written
    assert all(f"half_space.0001-wear/{name}" in result.stdout for name in written - {".wearlaw-files"})


def test_several_files_make_a_table_with_a_row_each() -> None:
    assert wearlaw("wear", TREAD, FLANGE, "--law", "kth", "-o", "both").exit_code == 0
    found = wl.Prediction.of(wl.read_contact([TREAD, FLANGE]), wl.wear_law("kth"))
    table = pd.read_csv("both/wear.csv")
    assert list(table["contact"]) == [TREAD, FLANGE]
    assert table["wear_rate_wheel [ug/m/mm^2]"].to_numpy() == pytest.approx(found.wear_rate.m)
    assert table["spin_moment [N*m]"].to_numpy() == pytest.approx(found.spin_moment.m)
    power = found.problem.rolling_speed * found.wear_index.m
    assert table["power_of_creepages [W]"].to_numpy() == pytest.approx(power)
    rail = pd.read_csv("both/profile_rail.csv")
    assert list(rail["contact"].unique()) == [TREAD, FLANGE]
    deepest = rail.groupby("contact")["depth [nm]"].max()
    assert deepest[FLANGE] == pytest.approx(float(found.wear_profile("rail").depth[1].max()))
    record = json.loads(Path("both/wear.json").read_text(encoding="utf-8"))
    assert record["laws"][0]["model"] == "kth"
    assert record["wearlaw"] == wl.__version__


def test_a_negative_zero_is_printed_as_zero(capsys: pytest.CaptureFixture[str]) -> None:
    _print(pd.DataFrame({"contact": ["a"], "spin_moment [N*m]": [-0.0], "lateral_force [N]": [-2.0]}))
    assert printed(capsys.readouterr().out) == {"spin_moment": ["0"], "lateral_force": ["-2"]}


def test_fields_of_the_reader_and_several_laws() -> None:
    one = ("wear", TREAD, "--law", "kth:body=rail", "--law", "usfd:body=wheel", "--option", "density=7000 kg/m^3")
    result = wearlaw(*one, "--option", "wheel_radius=400 mm", "--reader", "contact_mat")
    assert result.exit_code == 0
    rows = printed(result.stdout)
    contact = wl.read_contact(TREAD, density="7000 kg/m^3")
    assert rows["wear_rate_rail"] == [f"{wl.Prediction.of(contact, wl.wear_law('kth')).wear_rate.m:.4g}"]
    assert rows["wear_rate_wheel"] == [f"{wl.Prediction.of(contact, wl.wear_law('usfd')).wear_rate.m:.4g}"]
    assert_refused(wearlaw(*one), "is not empty; choose another folder with -o, or add --overwrite")
    assert wearlaw(*one, "--overwrite").exit_code == 0


def test_a_law_of_the_patch_takes_the_means(folder: Path) -> None:
    assert_refused(wearlaw("wear", TREAD, "--law", "brr"), "take the means first, contact.patch_mean() or --patch-mean")
    result = wearlaw("wear", TREAD, "--law", "brr", "--patch-mean")
    assert result.exit_code == 0
    assert files(folder / f"{Path(TREAD).stem}-wear") == {"wear.csv", "wear.json", ".wearlaw-files"}


def test_mistakes_are_one_message_and_leave_no_folder(folder: Path) -> None:
    Path("somewhere.py").touch()
    before = files(folder)
    refused = wearlaw("wear", "nowhere.mat", "--law", "usfd")
    assert_refused(refused, "there is no file 'nowhere.mat'")
    assert "somewhere.py" not in refused.stderr
    assert_refused(wearlaw("wear", TREAD, "--law", "usfd", "--option", "densty=1"), "did you mean 'density'?")
    assert_refused(wearlaw("wear", TREAD, "--law", "usf"), "no law is called 'usf'; did you mean 'usfd'?")
    assert wearlaw("wear", TREAD).exit_code == 2
    Path("cut.mat").write_text(Path(TREAD).read_text()[:3000])
    assert_refused(wearlaw("wear", "cut.mat", "--law", "usfd"), "the file is cut short there")
    assert files(folder) - {"cut.mat"} == before


def test_many_files_are_printed_in_blocks_as_wide_as_the_terminal(folder: Path) -> None:
    names = [f"flange.{number:04}.mat" for number in range(15)]
    for name in names:
        shutil.copy(FLANGE, folder / name)
    result = wearlaw("wear", *names, "--law", "kth", "-o", "many")
    assert result.exit_code == 0
    table, _, _ = result.stdout.partition("Results in")
    lines = table.splitlines()
    assert max(map(len, lines)) <= 100, "the width of the tests' terminal"
    assert [line.split()[:4] for line in lines if "flange" in line] == [names[:4], names[4:8], names[8:12]]
    assert "... and 3 more contacts in wear.csv" in lines
    assert len(pd.read_csv("many/wear.csv")) == 15
