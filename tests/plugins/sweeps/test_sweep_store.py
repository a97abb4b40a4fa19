"""Sweeps in a store: interrupted, killed, damaged, resumed, changed, and written by two."""

from __future__ import annotations

import contextlib
import os
import runpy
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import filelock
import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot as plt

import wearlaw as wl
from tests.plugins.sweeps.sweeps import CONDITIONS, OUTPUTS, contents, held, interrupted_after, predictor, told
from wearlaw import Q
from wearlaw.errors import OutputError, ResumeWarning

pytestmark = pytest.mark.usefixtures("small_blocks")

GIVEN: dict[str, Any] = {**CONDITIONS, "outputs": OUTPUTS}
"""A sweep of 10 blocks, each a chunk of 2 x 3 x 4 points."""


def interrupted(store: Path, monkeypatch: pytest.MonkeyPatch, workers: int = 1, after: int = 4) -> None:
    """Interrupt a sweep after some of its 10 blocks; in one process the last of these is interrupted itself.

    The last block of several processes waits for a gate, which is not there, so that the interrupt always comes first.
    """
    with monkeypatch.context() as patched:
        interrupted_after(after, patched)
        with pytest.raises(KeyboardInterrupt):
            wl.sweep(held(store.parent / "gate"), **GIVEN, store=store, workers=workers)
    (store.parent / "gate").touch()


def flip(path: Path, at: int) -> None:
    content = bytearray(path.read_bytes())
    content[at] ^= 0x10
    path.write_bytes(content)


def test_a_store_holds_the_results_and_is_read_when_used(tmp_path: Path) -> None:
    stored = wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr")
    assert not isinstance(stored.wear_rate.variable._data, np.ndarray)
    xr.testing.assert_identical(stored.load(), wl.sweep(predictor(), **GIVEN))
    assert [path.name for path in tmp_path.iterdir()] == ["map.zarr"]


@pytest.mark.validates(
    "reproducibility",
    "A sweep that was interrupted and resumed",
    source="the same sweep without interruption",
    held_to="to the byte",
)
@pytest.mark.parametrize("workers", [1, 2])
def test_a_resumed_sweep_gives_the_same_as_an_uninterrupted_one(
    workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted(tmp_path / "map.zarr", monkeypatch, workers)
    whole = wl.sweep(held(tmp_path / "gate"), **GIVEN)
    left = xr.open_zarr(tmp_path / "map.zarr", chunks=None, consolidated=False)
    assert left.attrs["status"] == "incomplete"
    finished = int(left.wear_rate.notnull().sum())
    assert 3 * 24 <= finished < 240
    assert int((left.wear_rate == whole.wear_rate).sum()) == finished
    advances = told(monkeypatch)
    with pytest.warns(ResumeWarning, match=r"\d of 10 blocks are kept in '.*map.zarr'; the others are"):
        resumed = wl.sweep(held(tmp_path / "gate"), **GIVEN, store=tmp_path / "map.zarr", workers=workers, resume=True)
    assert advances[0] >= 3 * 24  # not computed again
    xr.testing.assert_identical(resumed.load(), whole)  # warnings of finished blocks included
    assert resumed.wear_rate.to_numpy().tobytes() == whole.wear_rate.to_numpy().tobytes()


RECORD, CHUNK = "blocks/record/c/1", "wear_rate/c/1/0/0"
DAMAGE: dict[str, Callable[[Path], object]] = {
    "a byte": lambda store: flip(store / CHUNK, 77),
    "a byte of the record": lambda store: flip(store / RECORD, 20),
    "cut off": lambda store: os.truncate(store / CHUNK, 100),
    "missing": lambda store: (store / CHUNK).unlink(),
}


@pytest.mark.parametrize("what", DAMAGE)
def test_a_damaged_block_of_a_complete_store_is_computed_again(what: str, tmp_path: Path) -> None:
    store = tmp_path / "map.zarr"
    whole = wl.sweep(predictor(), **GIVEN, store=store).load()
    DAMAGE[what](store)
    with pytest.warns(ResumeWarning, match="9 of 10 blocks are kept"):
        resumed = wl.sweep(predictor(), **GIVEN, store=store, resume=True)
    xr.testing.assert_identical(resumed.load(), whole)


def test_a_damaged_coordinate_is_written_again(tmp_path: Path) -> None:
    store = tmp_path / "map.zarr"
    whole = wl.sweep(predictor(), **GIVEN, store=store).load()
    flip(store / "creepage" / "c" / "0", 9)
    with pytest.raises(ValueError, match="checksum"):
        xr.open_zarr(store, chunks=None, consolidated=False).load()
    xr.testing.assert_identical(wl.sweep(predictor(), **GIVEN, store=store, resume=True).load(), whole)


def test_a_store_whose_array_is_not_described_is_refused(tmp_path: Path) -> None:
    store = tmp_path / "map.zarr"
    wl.sweep(predictor(), **GIVEN, store=store)
    (store / "wear_rate" / "zarr.json").write_text("garbage")
    with pytest.raises(OutputError, match=r"map.zarr' is damaged .*; remove it to start again"):
        wl.sweep(predictor(), **GIVEN, store=store, resume=True)


CHANGES: list[tuple[dict[str, Any], str]] = [
    ({"creepage": Q(np.geomspace(0.1, 9.0, 20), "%")}, "creepage: "),
    ({"outputs": ["wear_rate"]}, "outputs.tangential_force: "),
    ({"friction_coefficient": 0.3}, "conditions.friction_coefficient: "),
]


@pytest.mark.parametrize(("changes", "message"), CHANGES)
def test_other_conditions_or_outputs_are_refused(changes: dict[str, Any], message: str, tmp_path: Path) -> None:
    store = tmp_path / "map.zarr"
    wl.sweep(predictor(), **GIVEN, store=store)
    before = contents(tmp_path)
    with pytest.raises(OutputError, match=message):
        wl.sweep(predictor(), **{**GIVEN, **changes}, store=store, resume=True)
    assert contents(tmp_path) == before


def test_another_law_or_version_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "map.zarr"
    interrupted(store, monkeypatch)
    predict = held(tmp_path / "gate")
    other = predict.with_law(predict.wear_law.model_copy(update={"slope": Q(2.0, "mm")}))
    with pytest.raises(OutputError, match=r"predict.laws.0.slope: "):
        wl.sweep(other, **GIVEN, store=store, resume=True)
    with monkeypatch.context() as patched:
        patched.setattr("wearlaw_apps.sweeps.provenance.__version__", "99.0")  # private: another version of wearlaw
        with pytest.raises(OutputError, match="wearlaw: "):
            wl.sweep(predict, **GIVEN, store=store, resume=True)
    monkeypatch.setattr(
        "wearlaw.loader.Shelf.distribution", lambda *_: "another 1.2.3"
    )  # private: what is installed, changed for a test
    with pytest.raises(OutputError, match="wear law held: "):
        wl.sweep(predict, **GIVEN, store=store, resume=True)


def test_what_is_in_the_way_is_refused_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "finished.zarr")
    interrupted(tmp_path / "unfinished.zarr", monkeypatch)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.txt").touch()
    (tmp_path / "file").touch()
    before = contents(tmp_path)
    for name, resume in (
        ("finished.zarr", False),
        ("unfinished.zarr", False),
        ("other", False),
        ("other", True),
        ("file", True),
        ("file/map.zarr", False),
    ):
        with pytest.raises(OutputError, match=name.partition("/")[0]):
            wl.sweep(predictor(), **GIVEN, store=tmp_path / name, resume=resume)
    assert contents(tmp_path) == before


@pytest.mark.parametrize("resume", [False, True])
def test_a_second_writer_is_refused(resume: bool, tmp_path: Path) -> None:
    with (
        filelock.FileLock(tmp_path / "map.zarr.lock"),
        pytest.raises(OutputError, match="by another process"),
    ):
        wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=resume)
    wl.sweep(predictor(), **GIVEN, store=tmp_path / "map.zarr", resume=resume)


EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "wear_map.py"


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
from wearlaw_apps.sweeps import plan, points

signal.signal(signal.SIGINT, signal.default_int_handler)  # tests in the background of a shell have it ignored
points.BLOCK, plan.LARGEST, plan.START_S = 100, 0, 0.0
wl.accelerate(False)
predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
given = dict(
    creepage=wl.Q(np.linspace(0.1, 5, 100), "%"), normal_force=wl.Q(np.linspace(1, 9, 100), "kN"),
    friction_coefficient=0.3, outputs=["wear_rate", "tangential_force"],
)
"""
"""A sweep of 100 blocks, of which tests wait for the first half at most, so that none is over too early."""


def started(folder: Path, workers: int) -> subprocess.Popen[str]:
    """Start a sweep in a process."""
    return subprocess.Popen(
        [
            sys.executable,
            "-W",
            "ignore",
            "-c",
            f"{SCRIPT}\nwl.sweep(predict, **given, store='map.zarr', workers={workers})",
        ],
        cwd=folder,
        start_new_session=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def records(folder: Path) -> list[Path]:
    """Return a file for each finished block."""
    return [path for path in folder.glob("map.zarr/blocks/record/c/*") if path.suffix != ".partial"]


def wait_for(blocks: int, running: subprocess.Popen[str], folder: Path) -> None:
    while running.poll() is None and len(records(folder)) < blocks:
        time.sleep(0.005)


@pytest.mark.filterwarnings("ignore::wearlaw.errors.ResumeWarning")
@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL")
@pytest.mark.parametrize("workers", [1, 2])
def test_a_sweep_killed_at_any_moment_resumes_to_the_same_numbers(workers: int, tmp_path: Path) -> None:
    scope: dict[str, Any] = {}
    exec(SCRIPT, scope)
    whole = wl.sweep(scope["predict"], **scope["given"])
    random = np.random.default_rng(38)
    kept: list[int] = []
    for _ in range(5):
        shutil.rmtree(tmp_path / "map.zarr", ignore_errors=True)
        running = started(tmp_path, workers)
        wait_for(int(random.integers(50)), running, tmp_path)
        time.sleep(0.1 * random.random())
        if random.random() < 0.5:
            os.killpg(running.pid, signal.SIGKILL)
        else:
            running.kill()  # its workers finish their blocks
        running.wait()
        kept.append(len(records(tmp_path)))
        resumed = wl.sweep(scope["predict"], **scope["given"], store=tmp_path / "map.zarr", resume=True)
        xr.testing.assert_identical(resumed.load(), whole)
        assert resumed.attrs["status"] == "complete"
        with contextlib.suppress(ProcessLookupError):
            os.killpg(running.pid, signal.SIGKILL)
        running.communicate()
    assert len({*kept} - {0, 100}) > 1  # the moments fall into the sweep


@pytest.mark.skipif(os.name == "nt", reason="Windows sends Ctrl-C to consoles, not to processes")
def test_ctrl_c_in_a_terminal_ends_a_sweep_at_once_and_keeps_finished_blocks(tmp_path: Path) -> None:
    running = started(tmp_path, 2)
    wait_for(4, running, tmp_path)
    os.killpg(running.pid, signal.SIGINT)  # as a terminal does, to all its processes
    _, errors = running.communicate(timeout=30)
    assert running.returncode in (-signal.SIGINT, 130)
    assert errors.strip().endswith("KeyboardInterrupt")
    assert errors.count("Traceback") <= 1  # none of a worker
    assert 3 < len(records(tmp_path)) <= 100
