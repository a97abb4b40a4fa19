"""Two processes never write the same unfinished results."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import wearlaw as wl
from tests.core.cases import assert_refused, wearlaw
from tests.core.damage import CASE
from tests.core.sweeps import CONDITIONS, OUTPUTS, contents, interrupted_after, predictor
from wearlaw.sweeping import lock
from wearlaw.sweeping.checkpoint import LOCK
from wearlaw.sweeping.journal import Journal
from wearlaw.sweeping.lock import open_locked

HOLDER = """
import sys
from pathlib import Path
from wearlaw.sweeping.lock import open_locked

file = open_locked(Path(sys.argv[1]))
print("locked", flush=True)
sys.stdin.read()
"""


@contextmanager
def held(path: Path) -> Iterator[subprocess.Popen[str]]:
    """Let another process hold the lock of a file."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "locked\n"
        yield holder


def test_a_lock_is_refused_while_another_process_has_it_and_ends_as_that_is_killed(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    path.write_text("head")
    with held(path) as holder:
        with pytest.raises(
            wl.OutputError, match="journal' is in use by another run that is still going on; wait until"
        ):
            open_locked(path)
        holder.send_signal(getattr(signal, "SIGKILL", signal.SIGTERM))
        holder.wait()
        with open_locked(path) as file:
            assert file.read() == b"head"


def test_a_lock_ends_with_its_file_and_holds_within_a_process(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    with open_locked(path, create=True), pytest.raises(wl.OutputError, match="is in use"):
        open_locked(path)
    open_locked(path).close()


@pytest.mark.skipif(os.name == "nt", reason="Windows removes no file in use")
def test_a_file_that_is_removed_or_replaced_before_it_is_locked_is_not_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The other run removes its journal as it ends, between the two steps here."""
    path = tmp_path / "journal"
    for again in (False, True):
        path.touch()

        def late(_: Any, again: bool = again) -> None:
            path.unlink()
            if again:
                path.touch()

        monkeypatch.setattr(lock, "_lock", late)
        with pytest.raises(wl.OutputError, match="was in use by another run, which has just ended; try again"):
            open_locked(path)


@pytest.mark.skipif(os.name == "nt", reason="there is no flock")
def test_a_file_system_without_locks_is_written_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def flock(*_: Any) -> None:
        raise OSError(37, "No locks available")

    monkeypatch.setattr("fcntl.flock", flock)
    open_locked(tmp_path / "journal", create=True).close()


@pytest.mark.parametrize("kind", ["folder", "link to nothing", "pipe"])
def test_what_is_no_file_is_refused_at_once(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "journal"
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("nothing")
    for create in (False, True):
        with pytest.raises(wl.OutputError, match="journal' is not a file; remove it"):
            open_locked(path, create)


@pytest.mark.usefixtures("small_blocks", "blank_figures")
def test_the_second_of_two_runs_that_resume_is_refused_and_changes_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "case.toml").write_text(CASE, encoding="utf-8")
    run = ("run", "case.toml", "-o", "out")
    with monkeypatch.context() as patched:
        interrupted_after(6, patched)
        assert wearlaw(*run).exit_code == 130
    before = contents(folder)
    with held(folder / "out.partial" / LOCK):
        message = "'out.partial' belongs to a run that is still going on; wait for its end, or choose"
        assert_refused(wearlaw(*run, "--resume"), message)
        assert_refused(wearlaw(*run), message)
        assert contents(folder) == before
    assert wearlaw(*run, "--resume").exit_code == 0


@pytest.mark.usefixtures("small_blocks", "blank_figures")
def test_a_run_keeps_others_out_from_its_first_block_to_its_end(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "case.toml").write_text(CASE, encoding="utf-8")
    seen: list[int] = []
    add = Journal.add

    def added(self: Journal, *arguments: Any) -> None:
        add(self, *arguments)
        with pytest.raises(wl.OutputError, match="is in use by another run"):
            open_locked(folder / "out.partial" / LOCK)
        seen.append(1)

    monkeypatch.setattr(Journal, "add", added)
    assert wearlaw("run", "case.toml", "-o", "out").exit_code == 0
    assert len(seen) == 12


@pytest.mark.usefixtures("small_blocks")
def test_the_second_of_two_sweeps_into_a_store_is_refused_and_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("zarr")
    store = tmp_path / "map.zarr"

    def sweep(**more: Any) -> Any:
        return wl.sweep(predictor(), **CONDITIONS, outputs=OUTPUTS, store=store, **more)

    with monkeypatch.context() as patched:
        interrupted_after(4, patched)
        with pytest.raises(KeyboardInterrupt):
            sweep()
    before = contents(tmp_path)
    with held(tmp_path / "map.zarr.journal"):
        with pytest.raises(wl.OutputError, match=r"map.zarr.journal' is in use by another run that is still going on"):
            sweep(resume=True)
        assert contents(tmp_path) == before
        shutil.move(store, tmp_path / "elsewhere")  # as before the first block of the other sweep
        with pytest.raises(wl.OutputError, match=r"map.zarr.journal' is in use by another run that is still going on"):
            sweep()
        shutil.move(tmp_path / "elsewhere", store)
    assert contents(tmp_path) == before
    assert sweep(resume=True).wear_rate.notnull().all()
