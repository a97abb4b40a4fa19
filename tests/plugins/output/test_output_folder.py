"""A folder of results: filled on success alone, and without harm to other files."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import tree
from wearlaw.errors import OutputError
from wearlaw_apps.output.folder import FILES, results_folder  # private: what commands share

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
    with pytest.raises(OutputError, match=r"'.*out' is not empty; choose another folder"):
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
        with pytest.raises(OutputError, match=f"^output: .*{message}"):
            fill(tmp_path / name, overwrite=overwrite)
    assert tree(tmp_path) == before


def test_nothing_outside_is_removed_whatever_the_list_says(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, outside = tmp_path / "out", tmp_path / "outside"
    fill(out, "figures/old.png")
    (outside / "deep").mkdir(parents=True)
    for file in ("letter", "deep/letter", "results.csv"):
        (outside / file).write_text("mine")
    (out / "link").symlink_to(outside / "letter")
    (out / "folder").symlink_to(outside)
    (out / "circle").symlink_to("circle")
    (out / "mine").mkdir()
    wrong = ("../outside/letter", str(outside / "deep" / "letter"), "figures/../../outside/letter", "link",
             "folder/letter", "mine", "circle/x", "a\0b", ".", "..", "", "x" * 300)  # fmt: skip
    with (out / FILES).open("a") as listed:
        listed.write("".join(f"{name}\n" for name in (*wrong, "gone.csv", FILES)))
    before, inside = tree(outside), {"link", "folder", "circle", "mine"}
    fill(out, overwrite=True)
    assert tree(outside) == before
    assert {path.name for path in out.iterdir()} == {RESULTS, "figures", FILES} | inside
    assert not (out / "figures" / "old.png").exists()
    head, *told = capsys.readouterr().err.splitlines()
    assert head.startswith(f"note: {FILES} in '")
    assert head.endswith("it was left alone:")
    assert told == [f"  {name!r}" for name in wrong]
    fill(out, overwrite=True)
    assert not capsys.readouterr().err  # the new list has only what was written


@pytest.mark.parametrize("kind", ["a file", "a folder", "a link", "a link to a folder", "a file for a folder"])
def test_results_do_not_replace_what_wearlaw_did_not_write(kind: str, tmp_path: Path) -> None:
    out, mine = tmp_path / "out", tmp_path / "mine"
    fill(out)
    mine.mkdir()
    (mine / "new.csv").write_text("mine")
    place = out / "tables" / "new.csv"
    if "for a folder" in kind:
        (out / "tables").write_text("mine")
    elif kind == "a link to a folder":
        (out / "tables").symlink_to(mine)
    else:
        place.parent.mkdir()
        if kind == "a file":
            place.touch()
        elif kind == "a folder":
            place.mkdir()
        else:
            place.symlink_to(mine / "new.csv")
    before = tree(tmp_path)
    with pytest.raises(OutputError, match=r"^output: '.*new\.csv' cannot be written, since something that wearlaw"):
        fill(out, "tables/new.csv", overwrite=True)
    assert tree(tmp_path) == before


def test_a_list_of_another_encoding_is_told(tmp_path: Path) -> None:
    fill(tmp_path)
    (tmp_path / FILES).write_bytes(b"\x81\n")
    with pytest.raises(OutputError, match=r"cannot read '.*\.wearlaw-files': it is not text in UTF-8; .* with -o"):
        fill(tmp_path, overwrite=True)
