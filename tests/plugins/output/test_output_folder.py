"""A folder of results: filled on success alone, and without harm to other files."""

from __future__ import annotations

from pathlib import Path

import pytest

import wearlaw as wl
from tests.cases import tree
from wearlaw_output.folder import FILES, results_folder  # private: what commands share

RESULTS = "results.nc"


def fill(folder: Path, *names: str, overwrite: bool = False) -> None:
    """Write results with these files beside the main one."""
    with results_folder(folder, overwrite, RESULTS) as fresh:
        for name in (RESULTS, *names):
            (fresh / name).parent.mkdir(exist_ok=True)
            (fresh / name).write_text(f"new {name}")


@pytest.mark.parametrize("there", [False, True])
def test_a_new_or_empty_folder_is_filled(there: bool, tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    if there:
        out.mkdir(parents=True)
    fill(out, "tables/one.csv")
    assert tree(out).keys() == {RESULTS, "tables", "tables/one.csv", FILES}


def test_earlier_results_are_replaced_when_asked_and_other_files_stay(tmp_path: Path) -> None:
    fill(tmp_path / "out", "results.csv", "figures/old.png")
    (tmp_path / "out" / "figures" / "mine.png").touch()
    with pytest.raises(wl.OutputError, match=r"'.*out' is not empty; choose another folder"):
        fill(tmp_path / "out")
    fill(tmp_path / "out", "figures/new.png", overwrite=True)  # a results.csv of other numbers would mislead
    assert tree(tmp_path / "out").keys() == {RESULTS, "figures", "figures/new.png", "figures/mine.png", FILES}


@pytest.mark.parametrize("overwrite", [False, True])
def test_what_wearlaw_did_not_write_is_refused_and_kept(overwrite: bool, tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / RESULTS).write_text("mine")
    with results_folder(tmp_path / "fit", False, "fit.json") as fresh:
        (fresh / "fit.json").touch()
    (tmp_path / "file").touch()
    before = tree(tmp_path)
    for name, message in {
        "mine": f"does not hold results of wearlaw \\(no {FILES}\\)",
        "fit": "holds results of another command",
        "file": "'.*file' is a file, not a folder; choose another with -o",
        "file/out": "cannot write to '.*out': (Not a directory|File exists)",
        "long" * 100: "File name too long",
    }.items():
        with pytest.raises(wl.OutputError, match=f"^output: .*{message}"):
            fill(tmp_path / name, overwrite=overwrite)
    assert tree(tmp_path) == before
