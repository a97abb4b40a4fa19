"""Sweeps on disk: interrupted, resumed, finished, and in the way of each other."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import wearlaw as wl
from tests.core.sweeps import CONDITIONS, OUTPUTS, contents, interrupted_after, predictor
from wearlaw import Q
from wearlaw.sweeping import journal

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("small_blocks")

GIVEN: dict[str, Any] = {**CONDITIONS, "outputs": OUTPUTS}


def interrupted(store: Path, monkeypatch: pytest.MonkeyPatch, workers: int = 1, after: int = 4) -> None:
    """Interrupt a sweep after some of its 10 blocks."""
    with monkeypatch.context() as patched:
        interrupted_after(after, patched)
        with pytest.raises(KeyboardInterrupt):
            predictor().sweep(**GIVEN, store=store, workers=workers)


def test_a_store_holds_the_results_and_is_read_when_used(tmp_path: Path) -> None:
    stored = predictor().sweep(**GIVEN, store=tmp_path / "map.zarr")
    assert not isinstance(stored.wear_rate.variable._data, np.ndarray)
    xr.testing.assert_identical(stored.load(), predictor().sweep(**GIVEN))
    assert [path.name for path in tmp_path.iterdir()] == ["map.zarr"]


def test_a_table_can_be_stored(tmp_path: Path) -> None:
    table = pd.DataFrame(
        {"creepage [%]": np.linspace(1.0, 2.0, 50), "normal_force [kN]": 5.0, "friction_coefficient": 0.3}
    )
    stored = predictor().sweep(table, store=tmp_path / "map.zarr")
    xr.testing.assert_identical(stored.load(), predictor().sweep(table))


@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_leaves_what_was_done_marked_as_incomplete(
    workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch, workers)
    left = xr.open_zarr(tmp_path / "map.zarr", chunks=None, consolidated=False)
    assert left.attrs["status"] == "incomplete"
    done = int(left.wear_rate.notnull().sum())
    assert 3 * 24 <= done < 240  # in one process the fourth block is interrupted itself
    whole = predictor().sweep(**GIVEN)
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
    predictor().sweep(**GIVEN, store=tmp_path / "resumed.zarr", workers=workers, resume=True)
    predictor().sweep(**GIVEN, store=tmp_path / "whole.zarr")
    assert contents(tmp_path / "resumed.zarr") == contents(tmp_path / "whole.zarr")
    assert seen[0] >= 3 * 24  # done before, and not again
    assert not (tmp_path / "resumed.zarr.journal").exists()


def test_a_journal_that_was_cut_off_loses_only_its_last_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch)
    path = tmp_path / "map.zarr.journal"
    text = path.read_text(encoding="utf-8")
    path.write_text(text[:-20], encoding="utf-8")
    predictor().sweep(**GIVEN, store=tmp_path / "map.zarr", resume=True)
    predictor().sweep(**GIVEN, store=tmp_path / "whole.zarr")
    assert contents(tmp_path / "map.zarr") == contents(tmp_path / "whole.zarr")


def test_what_a_worker_left_that_died_as_it_wrote_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch)
    cut_off = tmp_path / "map.zarr" / "wear_rate" / "c" / "0.0123.partial"
    cut_off.touch()
    predictor().sweep(**GIVEN, store=tmp_path / "map.zarr", resume=True)
    assert not cut_off.exists()


def test_a_finished_sweep_is_not_done_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = predictor().sweep(**GIVEN, store=tmp_path / "map.zarr")
    monkeypatch.setattr("wearlaw.sweeping.sweep.run", None)
    again = predictor().sweep(**GIVEN, store=tmp_path / "map.zarr", resume=True)
    xr.testing.assert_identical(again.load(), first.load())


def test_an_unfinished_sweep_of_which_nothing_is_done_begins_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch, after=0)
    ds = predictor().sweep(**GIVEN, store=tmp_path / "map.zarr", resume=True)
    assert ds.wear_rate.notnull().all()


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
        predictor().sweep(**GIVEN, store=store)
    else:
        interrupted(store, monkeypatch)
    before = contents(tmp_path)
    with pytest.raises(wl.OutputError, match=message):
        predictor().sweep(**{**GIVEN, **changes}, store=store, resume=True)
    assert contents(tmp_path) == before


def test_a_changed_law_or_version_is_not_resumed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "map.zarr"
    interrupted(store, monkeypatch)
    other = predictor(wl.wear_law("usfd", fitted_for="exact", q_s="56 ug/m/mm^2"))
    with pytest.raises(wl.OutputError, match=r"predict.wear_law.q_s: was .*, is 56"):
        other.sweep(**GIVEN, store=store, resume=True)
    with monkeypatch.context() as patched:
        patched.setattr(journal, "__version__", "99.0")
        with pytest.raises(wl.OutputError, match=r"wearlaw: was .*, is 99\.0"):
            predictor().sweep(**GIVEN, store=store, resume=True)
    monkeypatch.setattr("wearlaw.shelf.Shelf.distribution", lambda *_: "another 1.2.3")
    with pytest.raises(wl.OutputError, match=r"plugins.wear law usfd: was wearlaw .*, is another 1.2.3"):
        predictor().sweep(**GIVEN, store=store, resume=True)


def test_what_is_in_the_way_is_refused_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    predictor().sweep(**GIVEN, store=tmp_path / "finished.zarr")
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
            predictor().sweep(**GIVEN, store=tmp_path / name, resume=resume)
    assert contents(tmp_path) == before


def test_a_spoilt_journal_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch)
    (tmp_path / "map.zarr.journal").write_text("spoilt\n", encoding="utf-8")
    with pytest.raises(wl.OutputError, match="is no record of a sweep"):
        predictor().sweep(**GIVEN, store=tmp_path / "map.zarr", resume=True)


def test_without_zarr_it_is_said_how_to_install_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(wl.InputError, match=r'zarr is not installed; python -m pip install "wearlaw\[dask\]"'):
        predictor().sweep(**GIVEN, store=tmp_path / "map.zarr")


EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "wear_map.py"


def test_the_worked_example_draws_its_picture_from_what_it_stored(tmp_path: Path) -> None:
    command = [sys.executable, "-W", "error", str(EXAMPLE), "4", "100", "5"]
    subprocess.run(command, cwd=tmp_path, check=True, env={**os.environ, "WEARLAW_ACCELERATE": "0"})
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
from wearlaw.sweeping import points

signal.signal(signal.SIGINT, signal.default_int_handler)  # tests in the background of a shell have it ignored
points.BLOCK = 500
wl.accelerate(False)
predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
predict.sweep(
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
    assert errors.strip().endswith("KeyboardInterrupt")
    assert errors.count("Traceback") <= 2  # none of a worker
    assert 3 < path.read_bytes().count(b"\n") < 1000
