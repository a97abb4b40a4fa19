"""Long runs of cases on the command line."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest

from tests.cases import POINT, assert_refused, full_disk, table, wearlaw, write
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


def test_a_full_disk_is_one_clear_error_and_leaves_nothing_of_the_run(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wearlaw_apps.studies.written.save_figure", full_disk)  # private: after tables were written
    result = wearlaw("run", long_case(folder / "case.toml"), "-o", "out")
    assert_refused(result, "No space left on device; choose another folder with -o")
    assert [path.name for path in folder.iterdir()] == ["case.toml"]
