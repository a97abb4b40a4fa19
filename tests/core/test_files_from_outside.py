"""Reading files from outside: only regular ones, up to a size, without waiting."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import wearlaw as wl
from wearlaw.cli import main
from wearlaw.settings.text_files import read_file, read_start
from wearlaw.study.case import load_case

WAITING = 10
"""Seconds after which a reader hangs."""


def swept(path: Path) -> Any:
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    return wl.sweep(predict, path, friction_coefficient=0.4)


def of_rig(path: Path) -> None:
    options = [
        "--contact",
        "global",
        "--law",
        "usfd",
        "--free",
        "q_s",
        "--rig",
        str(path),
        "-o",
        str(path.with_name("fit")),
    ]
    result = CliRunner().invoke(main, ["fit", "lewis2004", *options])
    raise wl.InputError(result.output)


READERS: dict[str, Callable[[Any], Any]] = {
    "case": load_case,
    "law": wl.read_law,
    "wear law": wl.read_wear_law,
    "tests": wl.read_tests,
    "contact": lambda path: wl.read_contact(path, reader="contact_mat"),
    "table": swept,
    "rig": of_rig,
}


@pytest.fixture(params=list(READERS.values()), ids=list(READERS))
def read(request: pytest.FixtureRequest) -> Iterator[Callable[[Path], Any]]:
    """Give each reader in turn; one that waits for a pipe fails."""

    def stop(*_: object) -> None:
        raise AssertionError("the reader hangs")

    if hasattr(signal, "SIGALRM"):
        signal.signal(signal.SIGALRM, stop)
        signal.alarm(WAITING)
    yield request.param
    if hasattr(signal, "SIGALRM"):
        signal.alarm(0)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes in folders")
def test_a_pipe_is_refused_at_once(read: Callable[[Path], Any], tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    with pytest.raises(
        wl.InputError, match=r"cannot read .*pipe': it is a pipe; save what it gives to a file, and give"
    ):
        read(path)


@pytest.mark.skipif(not os.path.exists("/dev/null"), reason="there is no such device")
def test_a_device_is_refused(read: Callable[[Path], Any], tmp_path: Path) -> None:
    path = tmp_path / "device"
    path.symlink_to("/dev/null")
    with pytest.raises(wl.InputError, match=r"cannot read .*device': it is a device; save what it gives to a file"):
        read(path)


def test_links_that_lead_nowhere_are_named(read: Callable[[Path], Any], tmp_path: Path) -> None:
    broken, itself = tmp_path / "broken", tmp_path / "itself"
    broken.symlink_to("gone")
    itself.symlink_to("itself")
    with pytest.raises(wl.InputError, match=r"cannot read .*broken': it is a link to 'gone', which does not exist"):
        read(broken)
    with pytest.raises(wl.InputError, match=r"cannot read .*itself': Too many levels of symbolic links"):
        read(itself)


class OfBytes(os.PathLike[bytes]):
    """A path whose text is bytes, such as `os.scandir` gives for a folder named by bytes."""

    def __fspath__(self) -> bytes:
        return b"file"


def test_a_path_of_bytes_is_refused(read: Callable[[Any], Any]) -> None:
    if read is of_rig:
        pytest.skip("a command line holds text")
    with pytest.raises(wl.InputError, match=r"^\w+: must be the path of .*; got b'file'"):
        read(OfBytes())


@pytest.mark.parametrize("name", ["a\0b", "x" * 300, "a\ud800b"])
def test_impossible_names_are_errors_in_words(read: Callable[[Path], Any], tmp_path: Path, name: str) -> None:
    if read is of_rig and len(name) < 300:
        pytest.skip("a command line cannot hold such a character")
    with pytest.raises(
        wl.InputError, match=r"cannot read .*: (a name cannot have (a null|the) character|File name too long)"
    ):
        read(tmp_path / name)


@pytest.mark.parametrize(
    ("kind", "size"), [("case", 1), ("law", 1), ("wear law", 1), ("rig", 1), ("tests", 4), ("contact", 256)]
)
def test_a_file_is_read_up_to_a_stated_size(tmp_path: Path, kind: str, size: int) -> None:
    path = tmp_path / "large"
    path.touch()
    os.truncate(path, size * 2**20 + 1)
    with pytest.raises(
        wl.InputError, match=f"cannot read .*large': it has more than {size} MiB, the most that is read"
    ):
        READERS[kind](path)


def test_a_file_of_the_largest_size_is_read_whole(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"0123456789")
    assert read_file(path, 10) == b"0123456789"
    with pytest.raises(wl.InputError, match="it has more than"):
        read_file(path, 9)
    assert read_start(path, 4) == b"0123"
    with pytest.raises(FileNotFoundError):
        read_file(tmp_path / "none", 10)


@pytest.mark.parametrize("ending", ["\n", "\r", "\r\n"])
def test_a_table_may_be_longer_than_a_line_may_be(tmp_path: Path, ending: str) -> None:
    """The limit holds for each line."""
    path = tmp_path / "long.csv"
    row = "7.0000000000000000000,1.0000000000000000000"
    text = ending.join(["normal_force [kN],creepage [%]", *[row] * 30_000])
    path.write_text(text + ending, newline="")
    assert path.stat().st_size > 2**20
    assert swept(path).sizes["row"] == 30_000


@pytest.mark.parametrize("place", ["header", "row", "row without an end"])
def test_a_line_that_is_too_long_for_a_table_is_refused(tmp_path: Path, place: str) -> None:
    path = tmp_path / "line.csv"
    long = "1" * 3 * 2**20
    head = "normal_force [kN],creepage [%]\n7,1\n"
    path.write_text(
        {"header": f"{long}\n7\n", "row": f"{head}{long},1\n", "row without an end": f"{head}{long}"}[place]
    )
    with pytest.raises(
        wl.DataError, match=r"table '.*line.csv': has a line of more than 1048576 bytes; is it a table\?"
    ):
        swept(path)


def test_an_empty_file_is_no_table(tmp_path: Path) -> None:
    path = tmp_path / "empty.csv"
    path.touch()
    with pytest.raises(wl.DataError, match=r"table: '.*empty.csv' is empty"):
        swept(path)
