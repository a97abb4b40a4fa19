"""A disk without room: errors in words, before computing where possible; no signal, and nothing half-written."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import wearlaw as wl
from wearlaw_sweeps.room import set_size

pytest.importorskip("resource", reason="limits of processes are those of Unix")

CASE = """
title = "Two points"
rig = {preset = "suros"}
contact_models = ["global"]
wear_laws = ["usfd"]
[sweeps.one]
normal_force = "7 kN"
creepage = %s
friction_coefficient = 0.4
"""

LIMITED = """
import resource, sys
import wearlaw_studies.commands
from wearlaw.cli import main
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
main(sys.argv[1:])
"""
"""A program whose files cannot grow beyond a limit, as if the disk were full."""


def test_results_that_have_no_room_end_in_an_error(tmp_path: Path) -> None:
    """HDF5 ends the process by a signal if it cannot close its file."""
    (tmp_path / "case.toml").write_text(CASE % '["1 %", "2 %"]')
    command = [sys.executable, "-c", LIMITED, "run", "case.toml", "-o", "out"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    assert "Error: output: cannot write the results: File too large; make room, or choose another" in done.stderr
    assert os.listdir(tmp_path) == ["case.toml"]


@pytest.mark.parametrize("native", [True, False])
def test_the_room_of_a_file_is_taken_and_its_content_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, native: bool
) -> None:
    if not native:
        monkeypatch.delattr(os, "posix_fallocate", raising=False)
    path = tmp_path / "file"
    path.write_bytes(b"abcd")
    for size, content in ((3_000_000, b"abcd".ljust(3_000_000, b"\0")), (3, b"abc")):
        set_size(path, size)
        assert path.read_bytes() == content
        assert path.stat().st_blocks * 512 >= size - 4096


def sweep(store: Path) -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    force = wl.Q(np.linspace(5.0, 8.0, 3), "kN")
    wl.sweep(predict, normal_force=force, creepage="1 %", friction_coefficient=0.4, store=store)


def test_a_store_without_room_is_an_error_that_says_how_to_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("wearlaw_sweeps.workers.evaluate", full)
    message = "store: cannot write to '.*/map': No space left on device; make room, and add resume=True to go on"
    with pytest.raises(wl.OutputError, match=message):
        sweep(tmp_path / "map")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("itself", "(Too many levels of symbolic links|File exists)"),
        ("itself/map", "(Too many levels of symbolic links|File exists)"),
        ("file/map", "(Not a directory|File exists)"),
        ("broken", "File exists"),
        ("long" * 100, "File name too long"),
    ],
    ids=["circle", "in a circle", "under a file", "broken link", "long name"],
)
def test_a_store_that_cannot_be_made_is_refused_before_computing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, message: str
) -> None:
    monkeypatch.setattr("wearlaw_sweeps.workers.evaluate", lambda *_: pytest.fail("it computed"))
    (tmp_path / "itself").symlink_to("itself")
    (tmp_path / "broken").symlink_to("gone")
    (tmp_path / "file").touch()
    with pytest.raises(wl.OutputError, match=f"^store: .*{message}"):
        sweep(tmp_path / name)
    assert sorted(os.listdir(tmp_path)) == ["broken", "file", "itself"]
