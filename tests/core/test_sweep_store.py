"""Sweeps on disk: interrupted, resumed, finished, and in the way of each other."""

from __future__ import annotations

import os
import runpy
import shutil
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib import pyplot as plt

import wearlaw as wl
from tests.core.cases import full_disk
from tests.core.sweeps import CONDITIONS, OUTPUTS, contents, interrupted_after, overwrite, predictor, replace, swap
from wearlaw import Q
from wearlaw.sweeping import journal
from wearlaw.sweeping.evaluation import BlockRecord, write_block
from wearlaw.sweeping.points import Block

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("small_blocks")

GIVEN: dict[str, Any] = {**CONDITIONS, "outputs": OUTPUTS}


def interrupted(store: Path, monkeypatch: pytest.MonkeyPatch, workers: int = 1, after: int = 4) -> None:
    """Interrupt a sweep after some of its 10 blocks."""
    with monkeypatch.context() as patched:
        interrupted_after(after, patched)
        with pytest.raises(KeyboardInterrupt):
            wl.sweep(predictor(), **GIVEN, store=store, workers=workers)


@cache
def whole() -> dict[str, bytes]:
    """Return the files of an uninterrupted sweep, for which all who ask have small blocks."""
    with TemporaryDirectory() as folder:
        wl.sweep(predictor(), **GIVEN, store=Path(folder) / "whole.zarr")
        return contents(Path(folder) / "whole.zarr")


def test_a_store_holds_the_results_and_is_read_when_used(tmp_path: Path) -> None:
    stored = wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr")
    assert not isinstance(stored.wear_rate.variable._data, np.ndarray)
    xr.testing.assert_identical(stored.load(), wl.sweep(predictor(), **GIVEN))
    assert [path.name for path in tmp_path.iterdir()] == ["map.zarr"]


def test_a_table_can_be_stored(tmp_path: Path) -> None:
    table = pd.DataFrame(
        {"creepage [%]": np.linspace(1.0, 2.0, 50), "normal_force [kN]": 5.0, "friction_coefficient": 0.3}
    )
    stored = wl.sweep(predictor(), table, store=tmp_path / "map.zarr")
    xr.testing.assert_identical(stored.load(), wl.sweep(predictor(), table))


@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_leaves_what_was_done_marked_as_incomplete(
    workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch, workers)
    left = xr.open_zarr(tmp_path / "map.zarr", chunks=None, consolidated=False)
    assert left.attrs["status"] == "incomplete"
    done = int(left.wear_rate.notnull().sum())
    assert 3 * 24 <= done < 240  # in one process the fourth block is interrupted itself
    whole = wl.sweep(predictor(), **GIVEN)
    assert int((left.wear_rate == whole.wear_rate).sum()) == done


@pytest.mark.validates(
    "reproducibility",
    "A sweep that was interrupted and resumed",
    source="the same sweep without interruption",
    held_to="to the byte",
)
@pytest.mark.parametrize("workers", [1, 2])
def test_a_resumed_sweep_has_the_same_bytes_as_an_uninterrupted_one(
    workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(tmp_path / "resumed.zarr", monkeypatch, workers)
    seen: list[int] = []
    monkeypatch.setattr("wearlaw.sweeping.progress.Bar.__call__", lambda _, points: seen.append(points))
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "resumed.zarr", workers=workers, resume=True)
    assert contents(tmp_path / "resumed.zarr") == whole()
    assert seen[0] >= 3 * 24  # done before, and not again
    assert not (tmp_path / "resumed.zarr.journal").exists()


def beside(store: Path) -> Path:
    return store.with_name(f"{store.name}.journal")


RATE, FORCE = "wear_rate", "tangential_force"
# A block is a chunk of 2 x 3 x 4 points, 192 bytes, for each of the outputs; three are done.
DAMAGE: dict[str, tuple[Callable[[Path], None], int]] = {
    "cut off": (lambda store: os.truncate(store / RATE / "c/0/0/0", 100), 1),
    "empty": (lambda store: os.truncate(store / RATE / "c/1/0/0", 0), 1),
    "zeroed": (lambda store: overwrite(store / FORCE / "c/1/0/0", 64, bytes(64)), 1),
    "a bit": (lambda store: overwrite(store / FORCE / "c/1/0/0", 64, b"\x01"), 1),
    "deleted": (lambda store: (store / RATE / "c/2/0/0").unlink(), 1),
    "longer": (lambda store: overwrite(store / RATE / "c/0/0/0", 192, b"more"), 1),
    "garbage": (lambda store: overwrite(store / RATE / "c/0/0/0", 0, b"garbage" * 40), 1),
    "swapped": (lambda store: swap(store / RATE / "c/0/0/0", store / RATE / "c/1/0/0"), 2),
    "outputs swapped": (lambda store: swap(store / RATE / "c/0/0/0", store / FORCE / "c/0/0/0"), 1),
    "all of an output": (lambda store: shutil.rmtree(store / RATE), 3),
    "all": (shutil.rmtree, 3),
    "journal": (lambda store: replace(beside(store), '"points": 24', '"points": 25'), 3),
    "number of a block": (lambda store: replace(beside(store), "[1, {", "[7, {"), 1),
    "number of no block": (lambda store: replace(beside(store), "[1, {", "[10, {"), 1),
}
"""What may happen to a store, and how many of its blocks are lost by it."""


@pytest.mark.parametrize("what", DAMAGE)
def test_damaged_blocks_are_computed_again_and_said(what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "map.zarr"
    interrupted(store, monkeypatch)
    damage, count = DAMAGE[what]
    damage(store)
    seen: list[int] = []
    monkeypatch.setattr("wearlaw.sweeping.progress.Bar.__call__", lambda _, points: seen.append(points))
    message = f"^{count} of the 3 blocks kept in '.*map.zarr' were damaged, and are computed again$"
    with pytest.warns(wl.ResumeWarning, match=message) as said:
        wl.sweep(predictor(), **GIVEN, store=store, resume=True)
    assert {Path(one.filename).name for one in said} == {Path(__file__).name}
    assert seen[0] == 24 * (3 - count)
    assert contents(store) == whole()


@pytest.mark.parametrize("name", ["zarr.json", f"{RATE}/zarr.json", "creepage/c/0", "creepage/zarr.json"])
@pytest.mark.parametrize("text", [None, "", "garbage", "[]"])
def test_whatever_describes_the_results_is_written_anew(
    name: str, text: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch)
    if text is None:
        (tmp_path / "map.zarr" / name).unlink()
    else:
        (tmp_path / "map.zarr" / name).write_text(text)
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)
    assert contents(tmp_path / "map.zarr") == whole()


def test_each_chunk_is_on_disk_before_the_journal_lists_its_block(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "map.zarr"
    synced: list[str] = []

    def sync(chunk: Path) -> None:
        assert (tmp_path / "map.zarr.journal").read_bytes().count(b"\n") == 1
        synced.append(str(chunk.relative_to(path)))

    monkeypatch.setattr("wearlaw.sweeping.storage.sync_file", sync)
    interrupted(path, monkeypatch)
    assert sorted(synced) == [f"{name}/c/{number}/0/0" for name in (FORCE, RATE) for number in range(3)]
    assert (tmp_path / "map.zarr.journal").read_bytes().count(b"\n") == 4


def test_a_chunk_that_is_gone_before_it_is_synced_is_found_to_be_damaged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def written_and_gone(store: str, block: Block, outputs: Any) -> None:
        write_block(store, block, outputs)
        if block.number == 1:
            (Path(store) / RATE / "c/1/0/0").unlink()

    with monkeypatch.context() as patched:
        patched.setattr("wearlaw.sweeping.evaluation.write_block", written_and_gone)
        interrupted(tmp_path / "map.zarr", monkeypatch)
    with pytest.warns(wl.ResumeWarning, match="^1 of the 3 blocks"):
        swept = wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)
    assert swept.wear_rate.notnull().all()


def test_a_journal_that_was_cut_off_loses_only_its_last_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch)
    path = tmp_path / "map.zarr.journal"
    text = path.read_text(encoding="utf-8")
    path.write_text(text[:-20], encoding="utf-8")
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)
    assert contents(tmp_path / "map.zarr") == whole()


def test_what_a_worker_left_that_died_as_it_wrote_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch)
    cut_off = tmp_path / "map.zarr" / "wear_rate" / "c" / "0.0123.partial"
    cut_off.touch()
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)
    assert not cut_off.exists()


def test_a_finished_sweep_is_not_done_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr")
    monkeypatch.setattr("wearlaw.sweeping.sweep.run", None)
    again = wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)
    xr.testing.assert_identical(again.load(), first.load())


def test_an_unfinished_sweep_of_which_nothing_is_done_begins_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch, after=0)
    ds = wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)
    assert ds.wear_rate.notnull().all()


def test_blocks_are_reported_in_their_order_whatever_that_in_the_journal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Workers finish blocks in any order; the first remark of the rig is that of the first block."""
    reported: list[list[BlockRecord]] = []

    def report(_: Any, blocks: Iterable[BlockRecord]) -> list[Warning]:
        reported.append(list(blocks))
        return []

    monkeypatch.setattr("wearlaw.sweeping.sweep.range_warnings", report)
    wl.sweep(predictor(), **GIVEN)
    interrupted(tmp_path / "map.zarr", monkeypatch)
    path = beside(tmp_path / "map.zarr")
    head, *lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(head + b"".join(reversed(lines)))
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)
    whole, resumed = reported
    assert resumed == whole


def in_turn(*steps: Callable[[Path], object]) -> Callable[[Path], object]:
    def change(store: Path) -> None:
        for step in steps:
            step(store)

    return change


COMPLETE_DAMAGE: dict[str, Callable[[Path], object]] = {
    "provenance": lambda store: replace(store / "zarr.json", '"provenance": "{', '"provenance": "'),
    "an output is gone": lambda store: shutil.rmtree(store / RATE),
    "an output is not described": lambda store: (store / RATE / "zarr.json").write_text("garbage"),
    "a folder is a file": in_turn(lambda store: shutil.rmtree(store / RATE), lambda store: (store / RATE).touch()),
    "a coordinate": lambda store: (store / "creepage/zarr.json").write_text("[]"),
}


@pytest.mark.parametrize("what", COMPLETE_DAMAGE)
@pytest.mark.filterwarnings("ignore:Object at .* is not recognized")
def test_a_finished_sweep_that_is_damaged_is_not_returned(what: str, tmp_path: Path) -> None:
    store = tmp_path / "map.zarr"
    wl.sweep(predictor(), **GIVEN, store=store)
    COMPLETE_DAMAGE[what](store)
    message = "map.zarr' holds a complete sweep, but is damaged; remove it to start again"
    with pytest.raises(wl.OutputError, match=message):
        wl.sweep(predictor(), **GIVEN, store=store, resume=True)


def test_an_unfinished_store_without_its_journal_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "map.zarr"
    interrupted(store, monkeypatch)
    beside(store).unlink()
    message = r"holds an unfinished sweep whose journal '.*map.zarr.journal' is missing; remove '.*map.zarr' to start"
    for resume in (True, False):
        with pytest.raises(wl.OutputError, match=message):
            wl.sweep(predictor(), **GIVEN, store=store, resume=resume)


IN_THE_WAY: dict[str, Callable[[Path], object]] = {
    "a folder for a block": lambda store: (store / RATE / "c/7/0/0").mkdir(parents=True),
    "a folder for a finished block": in_turn(
        lambda store: (store / RATE / "c/1/0/0").unlink(),
        lambda store: (store / RATE / "c/1/0/0/inside").mkdir(parents=True),
    ),
    "a pipe for a finished block": in_turn(
        lambda store: (store / RATE / "c/1/0/0").unlink(), lambda store: os.mkfifo(store / RATE / "c/1/0/0")
    ),
    "a file for a folder of blocks": in_turn(
        lambda store: shutil.rmtree(store / RATE / "c"), lambda store: (store / RATE / "c").touch()
    ),
    "a file for an output": in_turn(lambda store: shutil.rmtree(store / RATE), lambda store: (store / RATE).touch()),
    "a file for a coordinate": in_turn(
        lambda store: shutil.rmtree(store / "creepage"), lambda store: (store / "creepage").touch()
    ),
    "a folder for what describes an output": in_turn(
        lambda store: (store / RATE / "zarr.json").unlink(), lambda store: (store / RATE / "zarr.json").mkdir()
    ),
    "a folder for what describes all": in_turn(
        lambda store: (store / "zarr.json").unlink(), lambda store: (store / "zarr.json" / "inside").mkdir(parents=True)
    ),
    "a folder for what was cut off": lambda store: (store / RATE / "c/0.1.partial").mkdir(),
}
"""What may stand where a resumed sweep writes; files of others stay."""


@pytest.mark.skipif(os.name == "nt", reason="there are no named pipes")
@pytest.mark.filterwarnings("ignore:. of the 3 blocks kept in")
@pytest.mark.parametrize("what", IN_THE_WAY)
def test_what_is_in_the_place_of_results_makes_way(what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "map.zarr"
    interrupted(store, monkeypatch)
    IN_THE_WAY[what](store)
    (store / "notes.txt").write_text("mine")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Object at notes.txt is not recognized")
        wl.sweep(predictor(), **GIVEN, store=store, resume=True)
    assert contents(store) == {**whole(), "notes.txt": b"mine"}


def test_a_store_that_cannot_be_written_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(
        wl.OutputError, match=r"store: cannot write to '.*': (Not a directory|File exists); choose another"
    ):
        wl.sweep(predictor(), **GIVEN, store=tmp_path / "file" / "map.zarr")
    monkeypatch.setattr("wearlaw.sweeping.journal._append", full_disk)
    with pytest.raises(wl.OutputError, match=r"store: cannot write to '.*map.zarr': No space left on device; choose"):
        wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr")


CHANGES: list[tuple[dict[str, Any], str]] = [
    ({"creepage": Q(np.geomspace(0.1, 9.0, 20), "%")}, "creepage: was 20 values, 0.1 to 10 %, .*, is 20 .* 9 %"),
    ({"outputs": ["wear_rate"]}, "outputs.tangential_force: was N, is nothing"),
    ({"friction_coefficient": 0.3}, "conditions.friction_coefficient: was 4 values.*, is 0.3"),
]


@pytest.mark.parametrize("finished", [True, False])
@pytest.mark.parametrize(("changes", "message"), CHANGES)
def test_a_changed_sweep_is_not_resumed_and_told_what_changed(
    finished: bool, changes: dict[str, Any], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = tmp_path / "map.zarr"
    if finished:
        wl.sweep(predictor(), **GIVEN, store=store)
    else:
        interrupted(store, monkeypatch)
    before = contents(tmp_path)
    with pytest.raises(wl.OutputError, match=message):
        wl.sweep(predictor(), **{**GIVEN, **changes}, store=store, resume=True)
    assert contents(tmp_path) == before


def test_a_changed_law_or_version_is_not_resumed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "map.zarr"
    interrupted(store, monkeypatch)
    other = predictor(wl.wear_law("usfd", fitted_for="exact", q_s="56 ug/m/mm^2"))
    with pytest.raises(wl.OutputError, match=r"predict.laws.0.q_s: was .*, is 56"):
        wl.sweep(other, **GIVEN, store=store, resume=True)
    with monkeypatch.context() as patched:
        patched.setattr(journal, "__version__", "99.0")
        with pytest.raises(wl.OutputError, match=r"wearlaw: was .*, is 99\.0"):
            wl.sweep(predictor(), **GIVEN, store=store, resume=True)
    monkeypatch.setattr("wearlaw.plugins.shelf.Shelf.distribution", lambda *_: "another 1.2.3")
    with pytest.raises(wl.OutputError, match=r"plugins.wear law usfd: was wearlaw .*, is another 1.2.3"):
        wl.sweep(predictor(), **GIVEN, store=store, resume=True)


def test_what_is_in_the_way_is_refused_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "finished.zarr")
    interrupted(tmp_path / "unfinished.zarr", monkeypatch)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.txt").touch()
    (tmp_path / "file").touch()
    before = contents(tmp_path)
    for name, resume, message in (
        ("finished.zarr", False, "holds the results of a sweep"),
        ("unfinished.zarr", False, "holds an unfinished sweep; add resume=True"),
        ("other", False, "is not empty, and holds no sweep of wearlaw"),
        ("other", True, "is not empty, and holds no sweep of wearlaw"),
        ("file", True, "is a file, not a folder"),
    ):
        with pytest.raises(wl.OutputError, match=message):
            wl.sweep(predictor(), **GIVEN, store=tmp_path / name, resume=resume)
    assert contents(tmp_path) == before


def test_a_spoilt_journal_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch)
    (tmp_path / "map.zarr.journal").write_text("spoilt\n", encoding="utf-8")
    with pytest.raises(wl.OutputError, match="is not the journal of a sweep"):
        wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=True)


def test_without_zarr_it_is_said_how_to_install_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(wl.InputError, match=r'zarr is not installed; python -m pip install "wearlaw\[dask\]"'):
        wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr")


EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "wear_map.py"


def test_the_worked_example_draws_its_picture_from_what_it_stored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [str(EXAMPLE), "4", "100", "5"])
    plt.switch_backend("Agg")
    runpy.run_path(str(EXAMPLE), run_name="__main__")
    plt.close("all")
    assert (tmp_path / "map.png").stat().st_size > 10_000
    stored = xr.open_zarr(tmp_path / "map.zarr", chunks=None, consolidated=False)
    assert dict(stored.sizes) == {"friction_coefficient": 5, "normal_force": 4, "creepage": 100}
    r = predictor()(normal_force="1 kN", creepage="13 %", friction_coefficient=0.1)
    corner = stored.wear_rate.isel(friction_coefficient=0, normal_force=0, creepage=-1)
    # The axis ends some roundings beside 13 %, and the rate changes at most ten times as fast.
    assert float(corner) == pytest.approx(r.wear_rate.magnitude, rel=1e-14)


SCRIPT = """
import signal

import numpy as np
import wearlaw as wl
from wearlaw.sweeping import journal, points

signal.signal(signal.SIGINT, signal.default_int_handler)  # tests in the background of a shell have it ignored
points.BLOCK = 500
journal.SYNC_S = 0.0  # a line for each block at once
wl.accelerate(False)
predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
wl.sweep(
    predict,
    creepage=wl.Q(np.linspace(0.1, 5, 500), "%"), normal_force=wl.Q(np.linspace(1, 9, 1000), "kN"),
    friction_coefficient=0.3, store="map.zarr", workers=2,
)
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows sends Ctrl-C to consoles, not to processes")
def test_ctrl_c_in_a_terminal_ends_a_sweep_at_once_and_keeps_what_was_done(tmp_path: Path) -> None:
    running = subprocess.Popen(
        [sys.executable, "-c", SCRIPT], cwd=tmp_path, start_new_session=True, stderr=subprocess.PIPE, text=True
    )
    path = tmp_path / "map.zarr.journal"
    while running.poll() is None and not (path.exists() and path.read_bytes().count(b"\n") > 3):
        time.sleep(0.02)
    os.killpg(running.pid, signal.SIGINT)  # as a terminal does, to all its processes
    _, errors = running.communicate(timeout=30)
    assert running.returncode in (-signal.SIGINT, 130)
    assert errors.strip().endswith(
        "KeyboardInterrupt\nfinished blocks are kept in 'map.zarr'; the same call with resume=True goes on"
    )
    assert errors.count("Traceback") <= 2  # none of a worker
    assert 3 < path.read_bytes().count(b"\n") < 1000
