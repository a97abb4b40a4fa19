"""Long runs of cases on the command line, and their uncertainty."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pandas as pd
import pytest

import wearlaw as wl
from tests.cases import POINT, assert_refused, changed, full_disk, table, wearlaw, write
from tests.plugins.sweeps.sweeps import contents, interrupted_after
from wearlaw_apps.sweeps import room  # private: the memory of the machine

pytestmark = pytest.mark.usefixtures("blank_figures")

LONG = {**POINT, "creepage": {"from": "0.1 %", "to": "10 %", "points": 100, "spacing": "log"}}
"""Four blocks."""


def long_case(path: Path, **changes: Any) -> str:
    fields = {"contact_models": ["exact"], "wear_laws": ["kth"], "profiles": {}, "sweeps": {"long": LONG}, **changes}
    return str(write(path, table(**fields)))


def interrupted(case: str, monkeypatch: pytest.MonkeyPatch, blocks: int = 6) -> None:
    """Interrupt a run of 12 blocks: 4 for each end of the law's range, and 4 for its middle."""
    with monkeypatch.context() as patched:
        interrupted_after(blocks, patched)
        result = wearlaw("run", case, "-o", "out")
    assert result.exit_code == 130
    assert result.stderr.splitlines()[-1] == "Stopped; finished blocks are in 'out.partial', and --resume goes on"
    assert not Path("out").exists()


@cache
def whole() -> dict[str, bytes]:
    """Return the files of an uninterrupted run, for which all who ask have small blocks."""
    with TemporaryDirectory() as folder:
        result = wearlaw("run", long_case(Path(folder) / "big.toml"), "-o", f"{folder}/whole")
        assert result.exit_code == 0, result.output
        assert "blocks" not in result.stderr
        return contents(Path(folder) / "whole")


@pytest.mark.usefixtures("small_blocks")
def test_a_resumed_run_writes_the_same_bytes_as_an_uninterrupted_one_on_any_number_of_workers(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    resumed = wearlaw("run", case, "-o", "out", "--workers", "2", "--resume")
    assert resumed.exit_code == 0, resumed.output
    assert re.search(r"note: run: \d of 12 blocks are kept in 'out.partial'", resumed.stderr)
    assert not (folder / "out.partial").exists()
    assert contents(folder / "out") == whole()


@pytest.mark.usefixtures("small_blocks")
def test_a_changed_case_or_version_is_not_resumed_and_told_what_changed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    before = contents(folder / "out.partial")
    assert_refused(wearlaw("run", case, "-o", "out"), "'out.partial' holds the finished blocks of an interrupted run")
    long_case(folder / "big.toml", sweeps={"long": {**LONG, "friction_coefficient": 0.3}})
    assert_refused(wearlaw("run", case, "-o", "out", "--resume"), "conditions.friction_coefficient: was 0.46, is 0.3")
    long_case(folder / "big.toml")
    monkeypatch.setattr("wearlaw_apps.sweeps.provenance.__version__", "99.0")  # private: another version of wearlaw
    assert_refused(wearlaw("run", case, "-o", "out", "--resume"), "is 99.0")
    assert contents(folder / "out.partial") == before


def test_a_case_too_large_for_memory_or_disk_says_what_it_needs_before_it_starts(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    million = {**LONG, "creepage": {"from": "0.1 %", "to": "10 %", "points": 10_000_000}}
    case = long_case(folder / "big.toml", sweeps={"long": million})
    monkeypatch.setattr(room, "available_memory", lambda: 2**30)
    # 20 numbers twice and a row of the table of 800 bytes for each point: 10^7 (20 x 16 + 800) / 2^30 GiB
    assert_refused(wearlaw("run", case, "--csv"), "the results need 10.4 GiB of memory, but 1 GiB are free")
    assert_refused(wearlaw("run", case), "the results need 2.98 GiB of memory, but 1 GiB are free")  # no table
    monkeypatch.setattr(room, "available_memory", lambda: 2**40)
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("Usage", (), {"free": 2**30}))
    assert_refused(wearlaw("run", case, "--csv"), "the results need 6.71 GiB on disk, but")
    assert [path.name for path in folder.iterdir()] == ["big.toml"]


SCATTER = {
    **POINT,
    "creepage": {"uniform": ["0.5 %", "1.5 %"]},
    "friction_coefficient": {"normal": [0.46, 0.03]},
    "laws": {"kth": {"coefficient": "published_range"}},
}


def uncertain(path: Path, changes: dict[str, Any] | None = None) -> str:
    fields = table(contact_models=["exact"], wear_laws=["usfd", "kth"], uncertainty={"scatter": SCATTER})
    for field, value in (changes or {}).items():
        fields = changed(f"uncertainty.scatter.{field}", value, fields)
    return str(write(path, fields))


def test_uncertainty_of_a_case_is_that_of_its_pairs_with_samples_rounded_up_and_said_so(folder: Path) -> None:
    result = wearlaw("uncertainty", uncertain(folder / "case.toml"), "--samples", "1000", "-o", "out")
    assert result.exit_code == 0, result.output
    assert "Samples: 1000 rounded up to 1024, a power of two, as Sobol sequences need it" in result.stdout
    # Shares to a thousandth: their sampling error is larger.
    assert re.search(r"creepage +\d\.\d{1,3} ", result.stdout)
    assert not re.search(r"\d(e-\d|-0\.000|\.\d{4})", result.stdout)
    rates = pd.read_csv(folder / "out" / "wear_rates.csv")
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
    u = wl.uncertainty(
        predict,
        max_pressure="1500 MPa",
        creepage=wl.uniform("0.5 %", "1.5 %"),
        friction_coefficient=wl.normal(0.46, 0.03),
        law={"coefficient": wl.published_range()},
        samples=1024,
    )
    kth = rates[rates.pair == "kth on exact"].iloc[0]
    expected = [quantity.magnitude for quantity in (u.median, *u.interval(0.95))]
    assert kth[2:].tolist() == expected
    indices = pd.read_csv(folder / "out" / "sobol_indices.csv")
    assert list(indices[indices.pair == "kth on exact"].input) == ["creepage", "friction_coefficient", "coefficient"]
    assert list(indices[indices.pair == "usfd on exact"].input) == ["creepage", "friction_coefficient"]
    assert json.loads((folder / "out" / "uncertainty.json").read_text(encoding="utf-8"))["samples"] == 1024
    again = wearlaw("uncertainty", str(folder / "out" / "case.toml"), "--samples", "1024", "-o", "again")
    assert "rounded" not in again.stdout
    assert contents(folder / "out") == contents(folder / "again")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"creepage": {"unifrom": ["1 %", "2 %"]}}, "scatter.creepage.unifrom: unknown field; did you mean 'uniform'?"),
        ({"creepage": {}}, "scatter.creepage: give one of uniform, normal and lognormal; got none of them"),
        ({"creepage": {"uniform": ["2 %", "1 %"]}}, "uniform(2.0 %, 1.0 %): the upper end must lie above"),
        ({"creepage": {"uniform": ["1 N", "2 N"]}}, "creepage: "),
        ({"creepage": True}, "must be a value, or a table such as"),
        ({"friction_coefficient": -0.1}, "friction_coefficient: must be a positive finite number"),
        ({"laws.kht": {}}, "laws.kht: the case has no such law; did you mean 'kth'?"),
        (
            {"laws.kth.coeficient": "published_range"},
            "laws.kth.coeficient: wear law 'kth' has no published range of it",
        ),
        ({"laws.kth.hardness": "2 GPa"}, "scatter.laws.kth.hardness"),
    ],
)
def test_what_cannot_be_uncertain_is_refused_with_its_place(
    changes: dict[str, Any], message: str, folder: Path
) -> None:
    assert_refused(wearlaw("uncertainty", uncertain(folder / "case.toml", changes)), message)


def test_a_law_of_which_nothing_is_uncertain_is_left_out_and_said_so(folder: Path) -> None:
    certain = {"friction_coefficient": 0.46, "creepage": "1 %"}
    result = wearlaw("uncertainty", uncertain(folder / "case.toml", certain), "--samples", "64", "-o", "out")
    assert "note: scatter, usfd on exact is left out, since none of its inputs is uncertain" in result.stderr
    assert list(pd.read_csv(folder / "out" / "wear_rates.csv").pair) == ["kth on exact"]
    result = wearlaw("uncertainty", uncertain(folder / "case.toml", {**certain, "laws": {}}))
    assert_refused(result, "nothing in the case is uncertain")


def test_a_full_disk_is_one_clear_error_and_leaves_nothing_of_the_uncertainty(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wearlaw_apps.output.files.save_figure", full_disk)  # private: after tables were written
    result = wearlaw("uncertainty", uncertain(folder / "case.toml"), "--samples", "64", "-o", "out")
    assert_refused(result, "No space left on device; choose another folder with -o")
    assert [path.name for path in folder.iterdir()] == ["case.toml"]
