"""Long runs of cases on the command line, and their uncertainty."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.core.cases import POINT, assert_refused, changed, full_disk, table, wearlaw, write
from tests.core.sweeps import contents, interrupted_after, overwrite
from wearlaw.output import results as output
from wearlaw.sweeping import checkpoint, storage

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
    again = f"wearlaw run --resume {shlex.quote(case)} -o out"
    assert result.stderr.splitlines()[-1] == (
        f"Stopped; finished blocks are kept in 'out.partial', go on with: {again}"
    )
    assert not Path("out").exists()


@cache
def whole() -> dict[str, bytes]:
    """Return the files of an uninterrupted run, for which all who ask have small blocks."""
    with TemporaryDirectory() as folder:
        result = wearlaw("run", long_case(Path(folder) / "big.toml"), "-o", f"{folder}/whole")
        assert result.exit_code == 0, result.output
        assert "damaged" not in result.stderr
        return contents(Path(folder) / "whole")


@pytest.mark.usefixtures("small_blocks")
def test_a_resumed_run_writes_the_same_bytes_as_an_uninterrupted_one_on_any_number_of_workers(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    assert len(list((folder / "out.partial").glob("*/journal"))) >= 2
    resumed = wearlaw("run", case, "-o", "out", "--workers", "2", "--resume")
    assert resumed.exit_code == 0, resumed.output
    assert not (folder / "out.partial").exists()
    assert contents(folder / "out") == whole()


@pytest.mark.usefixtures("small_blocks")
def test_what_is_done_is_not_done_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    seen: list[int] = []
    monkeypatch.setattr("wearlaw.sweeping.progress.Bar.__call__", lambda _, points: seen.append(points))
    wearlaw("run", case, "-o", "out", "--resume")
    assert seen[0] == 100
    assert sum(seen) == 300


RATE = "long-0/wear_rate.f64"
"""A file of four blocks, 25 numbers or 200 bytes each."""


def swapped(path: Path) -> None:
    content = path.read_bytes()
    path.write_bytes(content[200:400] + content[:200] + content[400:])


DAMAGE: dict[str, tuple[Callable[[Path], object], int]] = {
    "cut off": (lambda left: os.truncate(left / RATE, 500), 2),
    "empty": (lambda left: os.truncate(left / RATE, 0), 4),
    "missing": (lambda left: (left / RATE).unlink(), 4),
    "zeroed": (lambda left: overwrite(left / RATE, 208, bytes(8)), 1),
    "a bit": (lambda left: overwrite(left / RATE, 208, b"\x01"), 1),
    "swapped": (lambda left: swapped(left / RATE), 2),
    "outputs swapped": (lambda left: (left / RATE).replace(left / "long-0/mean_slip.f64"), 4),
    "garbage": (lambda left: (left / RATE).write_bytes(b"garbage"), 4),
    "another format": (
        lambda left: (left / RATE).write_bytes(b"\x93NUMPY" + bytes(121) + (left / RATE).read_bytes()),
        4,
    ),
}
"""What may happen to the folder that an interrupted run leaves, and how many blocks are lost by it."""


@pytest.mark.usefixtures("small_blocks", "blank_figures")
@pytest.mark.parametrize("what", DAMAGE)
def test_damaged_blocks_are_computed_again_and_said(what: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch, blocks=8)
    listed = sum(path.read_bytes().count(b"\n") - 1 for path in folder.glob("out.partial/*/journal"))
    assert listed > 4
    damage, count = DAMAGE[what]
    damage(folder / "out.partial")
    resumed = wearlaw("run", case, "-o", "out", "--resume")
    assert resumed.exit_code == 0, resumed.output
    note = f"note: {count} of the {listed} blocks kept in 'out.partial' were damaged, and are computed again\n"
    assert note in resumed.stderr
    assert contents(folder / "out") == whole()


@pytest.mark.usefixtures("small_blocks", "blank_figures")
def test_longer_files_lose_what_is_too_much_and_no_block(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    with (folder / "out.partial" / RATE).open("ab") as file:
        file.write(b"more")
    assert "damaged" not in wearlaw("run", case, "-o", "out", "--resume").stderr
    assert contents(folder / "out") == whole()


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("name", ["long-0", "long-0/journal", RATE, "run.json"])
def test_what_is_in_the_way_of_a_resumed_run_is_named(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    path = folder / "out.partial" / name
    if path.is_dir():
        shutil.rmtree(path)
        path.write_text("a file in the place of a folder")
    else:
        path.unlink()
        path.mkdir()
    result = wearlaw("run", case, "-o", "out", "--resume")
    assert_refused(result, "out.partial")
    assert "remove" in result.stderr


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("line", ["[0, 1]", "null", '{"block": 0}'])
def test_a_spoilt_journal_is_refused_with_what_to_remove(
    line: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    with (folder / "out.partial" / "long-0" / "journal").open("a", encoding="utf-8") as file:
        file.write(line + "\n")
    message = f"is not the journal of a sweep that can be resumed; remove it and '{Path('out.partial') / 'long-0'}'"
    assert_refused(wearlaw("run", case, "-o", "out", "--resume"), message)


@pytest.mark.usefixtures("small_blocks")
def test_a_file_in_the_place_of_the_checkpoint_is_kept(folder: Path) -> None:
    (folder / "out.partial").write_text("thesis")
    result = wearlaw("run", long_case(folder / "big.toml"), "-o", "out", "--resume")
    assert_refused(result, "'out.partial' is in the way, and holds no unfinished run")
    assert (folder / "out.partial").read_text() == "thesis"


@pytest.mark.usefixtures("small_blocks", "blank_figures")
def test_results_are_on_disk_before_the_journal_lists_their_block(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    flushed: list[str] = []

    def flush(self: np.memmap[Any, Any]) -> None:
        path = Path(str(self.filename))
        assert (path.parent / storage.JOURNAL).read_bytes().count(b"\n") == 1
        flushed.append(f"{path.parent.name}/{path.name}")

    monkeypatch.setattr(np.memmap, "flush", flush)
    assert wearlaw("run", long_case(folder / "big.toml"), "-o", "out").exit_code == 0
    assert flushed.count(RATE) == 1
    assert {Path(name).parent.name for name in flushed} == {"long-0", "long-0-wear_rate_low", "long-0-wear_rate_high"}


def test_resuming_where_nothing_was_left_is_running(folder: Path) -> None:
    result = wearlaw("run", long_case(folder / "big.toml"), "--resume", "--figure-format", "svg")
    assert result.exit_code == 0
    assert (folder / "big-results" / "report.html").exists()


@pytest.mark.usefixtures("small_blocks")
def test_a_changed_case_or_version_is_not_resumed_and_told_what_changed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    before = contents(folder / "out.partial")
    assert_refused(wearlaw("run", case, "-o", "out"), "'out.partial' holds the finished blocks of an interrupted run")
    long_case(folder / "big.toml", sweeps={"long": {**LONG, "friction_coefficient": 0.3}})
    assert_refused(
        wearlaw("run", case, "-o", "out", "--resume"), "case.sweeps.long.friction_coefficient: was 0.46, is 0.3"
    )
    long_case(folder / "big.toml")
    monkeypatch.setattr("wearlaw.study.study.__version__", "99.0")
    assert_refused(wearlaw("run", case, "-o", "out", "--resume"), "is 99.0")
    assert contents(folder / "out.partial") == before


@pytest.mark.usefixtures("small_blocks")
def test_the_record_of_what_is_run_is_written_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    record = folder / "out.partial" / checkpoint.RUN
    os.utime(record, ns=(0, 0))
    monkeypatch.setattr("wearlaw.cli.study_commands.discard", lambda *_: None)
    assert wearlaw("run", case, "-o", "out", "--resume").exit_code == 0
    assert record.stat().st_mtime_ns == 0


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("record", ["", '{"wearlaw": ', "\x00\xff"])
def test_a_spoilt_record_of_what_is_run_is_refused(record: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = long_case(folder / "big.toml")
    interrupted(case, monkeypatch)
    (folder / "out.partial" / checkpoint.RUN).write_text(record, encoding="latin-1")
    message = "run.json' is not the record of a run; remove 'out.partial' to start again"
    assert_refused(wearlaw("run", case, "-o", "out", "--resume"), message)


def test_something_else_in_the_place_of_the_checkpoint_is_kept(folder: Path) -> None:
    (folder / "out.partial").mkdir()
    (folder / "out.partial" / "thesis.txt").touch()
    result = wearlaw("run", long_case(folder / "big.toml"), "-o", "out", "--resume")
    assert_refused(result, "'out.partial' is in the way, and holds no unfinished run")
    assert (folder / "out.partial" / "thesis.txt").exists()


def test_a_case_too_large_for_memory_or_disk_says_what_it_needs_before_it_starts(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    million = {**LONG, "creepage": {"from": "0.1 %", "to": "10 %", "points": 10_000_000}}
    case = long_case(folder / "big.toml", sweeps={"long": million})
    monkeypatch.setattr(storage, "available_memory", lambda: 2**30)
    # 20 numbers twice and a row of the table of 800 bytes for each point: 10^7 (20 x 16 + 800) / 2^30 GiB
    assert_refused(wearlaw("run", case, "--csv"), "the results need 10.4 GiB of memory, but 1 GiB are free")
    assert_refused(wearlaw("run", case), "the results need 2.98 GiB of memory, but 1 GiB are free")  # no table
    monkeypatch.setattr(storage, "available_memory", lambda: 2**40)
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("Usage", (), {"free": 2**30}))
    assert_refused(wearlaw("run", case, "--csv"), "the results need 6.71 GiB on disk, but")
    assert [path.name for path in folder.iterdir()] == ["big.toml"]


@pytest.mark.usefixtures("small_blocks", "blank_figures")
def test_a_run_whose_folder_was_taken_keeps_its_results_beside_and_no_checkpoint(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = long_case(folder / "big.toml")
    write_results = output.write

    def late(*arguments: Any) -> list[str]:
        assert (folder / "out.partial").is_dir()
        (folder / "out").mkdir()
        (folder / "out" / "thesis.txt").touch()
        return write_results(*arguments)

    with monkeypatch.context() as patched:
        patched.setattr("wearlaw.cli.study_commands.write", late)
        assert_refused(wearlaw("run", case, "-o", "out"), f"The results are in '{folder / 'out-2'}'")
    assert sorted(path.name for path in folder.iterdir()) == ["big.toml", "out", "out-2"]
    assert contents(folder / "out-2") == whole()


@pytest.mark.usefixtures("small_blocks")
def test_a_checkpoint_that_another_run_made_meanwhile_is_left_to_it(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = long_case(folder / "big.toml")
    monkeypatch.setattr("wearlaw.cli.study_commands.check_room", lambda *_: (folder / "out.partial").mkdir())
    message = "'out.partial' was meanwhile created by another run; choose another folder with -o"
    assert_refused(wearlaw("run", case, "-o", "out"), message)
    assert contents(folder).keys() == {"big.toml"}
    assert (folder / "out.partial").is_dir()


@pytest.mark.usefixtures("small_blocks")
def test_a_checkpoint_that_cannot_be_written_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checkpoint, "write_whole", full_disk)
    message = "cannot write to 'out.partial': No space left on device; choose another folder with -o"
    assert_refused(wearlaw("run", long_case(folder / "big.toml"), "-o", "out"), message)


def test_a_small_run_makes_no_checkpoint(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checkpoint, "Files", None)
    assert wearlaw("run", long_case(folder / "small.toml"), "--figure-format", "svg").exit_code == 0


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
    assert re.search(r"creepage( +0\.\d{3}){4}\n", result.stdout)
    assert not re.search(r"\d(e-\d|-0\.000)", result.stdout)
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


def test_a_note_that_all_pairs_share_is_printed_once(folder: Path) -> None:
    alike = {name: value for name, value in SCATTER.items() if name != "laws"}
    path = write(
        folder / "case.toml",
        table(contact_models=["exact"], wear_laws=["kth", "usfd"], uncertainty={"scatter": alike}),
    )
    notes = wearlaw("uncertainty", str(path), "--samples", "64", "-o", "out").stderr.splitlines()
    assert [note.partition(": the")[0] for note in notes if "shakedown" in note] == ["note: scatter"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"creepage": {"unifrom": ["1 %", "2 %"]}}, "scatter.creepage.unifrom: unknown field; did you mean 'uniform'?"),
        ({"creepage": {}}, "scatter.creepage: give one of uniform, normal and lognormal; got none of them"),
        (
            {"creepage": {"uniform": ["2 %", "1 %"]}},
            "the upper end of uniform(2.0 %, 1.0 %) must lie above the lower one",
        ),
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


def test_a_case_without_uncertainty_says_what_to_add(folder: Path) -> None:
    assert_refused(wearlaw("uncertainty", long_case(folder / "case.toml")), "add a table such as [uncertainty.scatter]")


def test_a_seed_that_is_none_is_refused(folder: Path) -> None:
    result = wearlaw("uncertainty", uncertain(folder / "case.toml"), "--seed", "-1")
    assert_refused(result, "seed: must be a whole number, zero or positive; got -1")


def test_a_law_of_which_nothing_is_uncertain_is_left_out_and_said_so(folder: Path) -> None:
    certain = {"friction_coefficient": 0.46, "creepage": "1 %"}
    result = wearlaw("uncertainty", uncertain(folder / "case.toml", certain), "--samples", "64", "-o", "out")
    assert "note: scatter: usfd on exact is left out, since none of its inputs is uncertain" in result.stderr
    assert list(pd.read_csv(folder / "out" / "wear_rates.csv").pair) == ["kth on exact"]
    result = wearlaw("uncertainty", uncertain(folder / "case.toml", {**certain, "laws": {}}))
    assert_refused(result, "nothing in the case is uncertain")


def test_a_case_whose_only_uncertain_law_cannot_be_used_is_refused(folder: Path) -> None:
    """BRR is stated for the whole patch, which the exact model resolves, so that no pair has it."""
    fields = table(contact_models=["exact"], wear_laws=["usfd", "brr"], uncertainty={"scatter": SCATTER})
    slope = {"normal": ["0.25 mm^3/km/N", "0.01 mm^3/km/N"]}
    certain = {"friction_coefficient": 0.46, "creepage": "1 %", "laws": {"brr": {"mild_slope": slope}}}
    for field, value in certain.items():
        fields = changed(f"uncertainty.scatter.{field}", value, fields)
    result = wearlaw("uncertainty", str(write(folder / "case.toml", fields)))
    assert_refused(result, "nothing in the case is uncertain")


def test_a_wear_rate_that_does_not_vary_has_no_indices(folder: Path) -> None:
    only_friction = {"creepage": "0.001 %", "friction_coefficient": {"uniform": [0.4, 0.5]}, "laws": {}}
    fields = table(contact_models=["global"], wear_laws=["kth"], uncertainty={"scatter": {**SCATTER, **only_friction}})
    result = wearlaw("uncertainty", str(write(folder / "case.toml", fields)), "--samples", "64", "-o", "out")
    assert "the wear rate is the same in all samples" in result.stderr
    assert not (folder / "out" / "sobol_indices.csv").exists()


def test_a_full_disk_is_one_clear_error_and_leaves_nothing_of_the_uncertainty(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wearlaw.output.analyses.save_figure", full_disk)  # after tables were written
    result = wearlaw("uncertainty", uncertain(folder / "case.toml"), "--samples", "64", "-o", "out")
    assert_refused(result, "output: cannot write the results: No space left on device")
    assert [path.name for path in folder.iterdir()] == ["case.toml"]


def test_the_sizes_that_are_checked_are_those_of_the_files(folder: Path) -> None:
    case = long_case(folder / "case.toml", sweeps={"long": changed("creepage.points", 5000, dict(LONG))})
    wearlaw("run", case, "-o", "out", "--figure-format", "svg")
    row = (folder / "out" / output.CSV).stat().st_size / 5000
    assert 0.5 * output.ROW_ON_DISK < row < output.ROW_ON_DISK
