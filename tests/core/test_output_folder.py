"""Writing results: a folder of results is there whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from matplotlib.figure import Figure

import wearlaw as wl
from tests.core.cases import full_disk, tree
from wearlaw.output import CSV, RESULTS, fresh_folder, write
from wearlaw.study import Study


def fill(folder: Path, text: str = "new") -> None:
    (folder / RESULTS).write_text(text)


def test_a_folder_that_is_not_there_is_made_with_its_parents(tmp_path: Path) -> None:
    with fresh_folder(tmp_path / "a b" / "c" / "out", overwrite=False) as fresh:
        fill(fresh)
    assert tree(tmp_path).keys() == {"a b", "a b/c", "a b/c/out", f"a b/c/out/{RESULTS}"}


def test_a_new_folder_is_open_to_those_to_whom_new_folders_are(tmp_path: Path) -> None:
    (tmp_path / "usual").mkdir()
    with fresh_folder(tmp_path / "out", overwrite=False) as fresh:
        fill(fresh)
    assert (tmp_path / "out").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_an_empty_folder_is_filled(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    with fresh_folder(tmp_path / "out", overwrite=False) as fresh:
        fill(fresh)
    assert tree(tmp_path) == {"out": b"", f"out/{RESULTS}": b"new"}


def test_a_link_to_a_folder_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "real")
    with fresh_folder(tmp_path / "link", overwrite=False) as fresh:
        fill(fresh)
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real" / RESULTS).read_text() == "new"


def test_earlier_results_are_replaced_whole_when_asked(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    fill(out, "old")
    (out / "left over").write_text("old")
    before = tree(tmp_path)
    with pytest.raises(wl.OutputError, match="is not empty; choose another folder with -o, or add --overwrite"):
        enter(out, overwrite=False)
    assert tree(tmp_path) == before
    with fresh_folder(out, overwrite=True) as fresh:
        fill(fresh)
        assert tree(out) == {RESULTS: b"old", "left over": b"old"}
    assert tree(tmp_path) == {"out": b"", f"out/{RESULTS}": b"new"}


def enter(folder: Path, overwrite: bool) -> None:
    with fresh_folder(folder, overwrite):
        pytest.fail("the folder was given")


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_folder_with_other_files_is_left_alone_even_with_overwrite(tmp_path: Path, overwrite: bool) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(wl.OutputError, match="does not hold results of wearlaw, and will not be overwritten"):
        enter(tmp_path, overwrite)
    assert tree(tmp_path) == {"thesis.tex": b"years of work"}


@pytest.mark.parametrize("where", [".", "..", "../work", "x/.."])
def test_the_working_folder_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str) -> None:
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    with pytest.raises(wl.OutputError, match="is the working folder or above it"):
        enter(Path(where), overwrite=True)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda folder: folder / "file", "is a file, not a folder; choose another with -o"),
        (lambda folder: folder / "file" / "out", "cannot write to '.*/file/out': Not a directory; choose another"),
        (lambda folder: folder / "file" / "deep" / "out", "cannot write to '.*': Not a directory; choose another"),
        (lambda _: Path("/proc/out"), "cannot write to '/proc/out': "),
        (lambda folder: folder / ("long" * 100), "cannot write to '.*': File name too long; choose another"),
    ],
    ids=["file", "under a file", "deep under a file", "system folder", "long name"],
)
def test_a_folder_that_cannot_be_written_is_refused_at_once(
    tmp_path: Path, make: Callable[[Path], Path], message: str
) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(wl.OutputError, match=f"^output: .*{message}"):
        enter(make(tmp_path), overwrite=True)
    assert tree(tmp_path) == {"file": b"mine"}


def test_a_folder_that_something_else_filled_meanwhile_is_an_error_and_left_alone(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(wl.OutputError, match="cannot write to"), fresh_folder(out, overwrite=False) as fresh:  # noqa: PT012
        out.write_text("somebody's file")
        fresh.rename(fresh.with_name("gone"))
    assert tree(tmp_path) == {"out": b"somebody's file"}


def test_new_results_that_are_gone_before_they_are_in_place_leave_nothing(tmp_path: Path) -> None:
    with (
        pytest.raises(wl.OutputError, match=r"cannot write to '.*': No such file or directory"),
        fresh_folder(tmp_path / "out", overwrite=False) as fresh,
    ):
        fresh.rmdir()
    assert tree(tmp_path) == {}


class InterruptionError(Exception):
    """Not an error that the package knows."""


@pytest.mark.parametrize("error", [InterruptionError, KeyboardInterrupt, OSError])
@pytest.mark.parametrize("earlier", [False, True])
def test_after_an_interruption_everything_is_as_before(
    tmp_path: Path, point: Study, monkeypatch: pytest.MonkeyPatch, error: type[BaseException], earlier: bool
) -> None:
    out = tmp_path / "deep" / "out" if not earlier else tmp_path / "out"
    if earlier:
        out.mkdir()
        fill(out, "old")
    before = tree(tmp_path)

    def break_off(*_: Any) -> Figure:
        assert list(tmp_path.rglob(CSV)), "the break must come in the middle of writing"
        raise error

    monkeypatch.setattr("wearlaw.figures.drawing.draw", break_off)
    expected = wl.OutputError if error is OSError else error
    with pytest.raises(expected), fresh_folder(out, overwrite=True) as fresh:
        write(point, fresh)
    assert tree(tmp_path) == before


def test_a_full_disc_is_an_output_error(point: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pd.DataFrame, "to_csv", full_disk)
    with pytest.raises(wl.OutputError, match="output: cannot write the results: No space left on device"):
        write(point, tmp_path)
