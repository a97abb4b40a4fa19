"""`wearlaw verify`: finished results are as they were written, or the files that are not are named."""

from __future__ import annotations

import json
import os
import random
from collections.abc import Callable
from pathlib import Path

import pytest
import zarr

import wearlaw as wl
from tests.core import damage
from tests.core.cases import assert_refused, wearlaw
from tests.core.sweeps import CONDITIONS, OUTPUTS, contents, interrupted_after, overwrite, predictor, replace, swap
from wearlaw.output.folder import fresh_folder
from wearlaw.output.manifest import MANIFEST
from wearlaw.output.results import RESULTS
from wearlaw.output.verification import MOST

FILES = {RESULTS: "numbers", "tables/wear.csv": "more numbers", "figures/wear.png": "a picture"}


def results(folder: Path, overwrite: bool = False) -> None:
    """Write results into a folder as a command does."""
    with fresh_folder(folder, overwrite, RESULTS) as fresh:
        for name, text in FILES.items():
            (fresh / name).parent.mkdir(exist_ok=True)
            (fresh / name).write_text(text)


@pytest.fixture
def out(folder: Path) -> Path:
    """Give a folder of results."""
    results(folder / "out")
    return folder / "out"


@pytest.fixture
def store(folder: Path, small_blocks: None) -> Path:  # noqa: ARG001
    """Give the store of a sweep of 2 outputs in 10 blocks."""
    wl.sweep(predictor(), **CONDITIONS, outputs=OUTPUTS, store=folder / "map.zarr")
    return folder / "map.zarr"


def test_results_that_are_as_they_were_written_are_said_to_be(out: Path) -> None:
    before = contents(out)
    found = wearlaw("verify", "out")
    assert (found.exit_code, found.stdout) == (0, f"out: all as written, 3 files of wearlaw {wl.__version__}\n")
    assert contents(out) == before


@pytest.mark.usefixtures("blank_figures")
def test_a_run_can_be_verified(folder: Path) -> None:
    (folder / "case.toml").write_text(damage.CASE, encoding="utf-8")
    assert wearlaw("run", "case.toml", "-o", "out").exit_code == 0
    assert wearlaw("verify", "out").exit_code == 0
    overwrite(folder / "out" / RESULTS, 4000, b"x")
    assert_refused(wearlaw("verify", "out"), f"  changed: {RESULTS} (other bytes)\n")


def folder_in_place(path: Path) -> None:
    path.unlink()
    path.mkdir()


def pipe_in_place(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def lost_link_in_place(path: Path) -> None:
    path.unlink()
    path.symlink_to("nowhere")


CHANGES: dict[str, tuple[Callable[[Path], object], str]] = {
    "missing": (Path.unlink, "  missing: tables/wear.csv\n"),
    "cut": (lambda path: os.truncate(path, 5), "  changed: tables/wear.csv (was 12 bytes, is 5)\n"),
    "a byte": (lambda path: overwrite(path, 5, b"x"), "  changed: tables/wear.csv (other bytes)\n"),
    "a folder": (folder_in_place, "  changed: tables/wear.csv (no longer a file)\n"),
    "a pipe": (pipe_in_place, "  changed: tables/wear.csv (no longer a file)\n"),
    "a lost link": (lost_link_in_place, "  missing: tables/wear.csv\n"),
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_file_that_is_not_as_it_was_written_is_named_with_what_to_do(what: str, out: Path) -> None:
    change, line = CHANGES[what]
    change(out / "tables" / "wear.csv")
    (out / "thesis.tex").write_text("years of work")
    found = wearlaw("verify", "out")
    assert_refused(found, f"Error: 'out' is not as it was written:\n{line}")
    assert found.stderr.endswith("  added: thesis.tex\nTo repair it, run the command again with --overwrite\n")
    if what not in ("a folder", "a pipe"):
        results(out, overwrite=True)
        assert wearlaw("verify", "out").exit_code == 0


def test_added_files_are_listed_and_no_fault(out: Path) -> None:
    for number in range(MOST + 2):
        (out / f"mine-{number:02}.txt").touch()
    found = wearlaw("verify", "out")
    assert found.exit_code == 0
    _, *added, more = found.stdout.splitlines()
    assert added == [f"  added: mine-{number:02}.txt" for number in range(MOST)]
    assert more == "  added: 2 more"


def test_a_folder_of_an_earlier_version_is_told_apart(out: Path) -> None:
    (out / MANIFEST).write_text(json.dumps({"wearlaw": "0.0.9", "files": sorted(FILES)}))
    message = "'out' was written by an earlier wearlaw (0.0.9), whose .wearlaw.json holds no checksums, so that changes"
    assert_refused(wearlaw("verify", "out"), message)
    assert "cannot be found; no file is missing\n" in wearlaw("verify", "out").stderr
    (out / RESULTS).unlink()
    assert "cannot be found; some of its files are missing:\n  missing: results.nc\n" in wearlaw("verify", "out").stderr


@pytest.mark.usefixtures("small_blocks")
def test_what_holds_no_finished_results_is_refused_with_what_it_is(
    folder: Path, out: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert_refused(wearlaw("verify", "nowhere"), "'nowhere' is not there\n")
    (folder / "file").touch()
    assert_refused(wearlaw("verify", "file"), "'file' is not a folder\n")
    assert_refused(
        wearlaw("verify", "."), "holds no results of wearlaw that can be verified: its .wearlaw.json is missing"
    )
    (out / MANIFEST).write_text("garbage")
    assert_refused(wearlaw("verify", "out"), "its .wearlaw.json is damaged")
    (folder / "case.toml").write_text(damage.CASE, encoding="utf-8")
    interrupted_after(6, monkeypatch)
    assert wearlaw("run", "case.toml", "-o", "new").exit_code == 130
    assert_refused(wearlaw("verify", "new"), "'new' is not there; 'new.partial' holds an unfinished run\n")
    assert_refused(wearlaw("verify", "new.partial"), "the same wearlaw run with --resume goes on with it")


@pytest.mark.usefixtures("store")
def test_a_store_that_is_as_it_was_written_is_said_to_be() -> None:
    found = wearlaw("verify", "map.zarr")
    assert (found.exit_code, found.stdout) == (
        0,
        "map.zarr: all as written, 10 blocks of 2 outputs, and 9 other files\n",
    )


STORE_CHANGES: dict[str, tuple[Callable[[Path], object], list[str]]] = {
    "a block missing": (lambda store: (store / "wear_rate/c/1/0/0").unlink(), ["missing: wear_rate/c/1/0/0"]),
    "an output missing": (
        lambda store: (store / "wear_rate/zarr.json").unlink(),
        ["missing: wear_rate/zarr.json"],
    ),
    "blocks swapped": (
        lambda store: swap(store / "wear_rate/c/1/0/0", store / "wear_rate/c/2/0/0"),
        ["changed: wear_rate/c/1/0/0 (other bytes)", "changed: wear_rate/c/2/0/0 (other bytes)"],
    ),
    "a block cut": (lambda store: os.truncate(store / "wear_rate/c/1/0/0", 9), ["changed: wear_rate/c/1/0/0 (cannot"]),
    "a coordinate": (lambda store: overwrite(store / "creepage/c/0", 8, b"x"), ["changed: creepage/c/0 (other bytes)"]),
    "a unit": (
        lambda store: replace(store / "wear_rate/zarr.json", "ug/m/mm^2", "mg/m/mm^2"),
        ["changed: wear_rate/zarr.json (other bytes)"],
    ),
    "what it is": (lambda store: replace(store / "zarr.json", '"group"', '"array"'), ["changed: zarr.json (other"]),
    "notes": (
        lambda store: replace(store / "zarr.json", '"notes": "', '"notes": "all is well; '),
        ["changed: zarr.json (other bytes)"],
    ),
    "a pipe": (lambda store: pipe_in_place(store / "wear_rate/c/1/0/0"), ["changed: wear_rate/c/1/0/0 (no longer"]),
}


@pytest.mark.parametrize("what", STORE_CHANGES)
def test_what_is_not_as_it_was_written_in_a_store_is_named(what: str, store: Path) -> None:
    change, lines = STORE_CHANGES[what]
    change(store)
    (store / "wear_rate/c/notes.txt").touch()
    found = wearlaw("verify", "map.zarr")
    assert_refused(found, "Error: 'map.zarr' is not as it was written:\n  " + "\n  ".join(lines))
    known = what not in ("an output missing", "a unit")  # where the blocks of the output are
    assert ("  added: wear_rate/c/notes.txt\n" in found.stderr) == known
    assert found.stderr.endswith("To repair it, remove it and sweep again\n")


def test_a_store_without_what_is_needed_is_told_apart(folder: Path, store: Path) -> None:
    attributes = zarr.open_group(str(store), mode="r+").attrs
    sums = str(attributes["checksums"])
    number = str(json.loads(sums)["outputs"]["wear_rate"][3])
    for spoilt in ("garbage", "{}", 3, sums.replace(number, "7"), sums.replace(f",{number}", "")):
        attributes["checksums"] = spoilt
        assert_refused(wearlaw("verify", "map.zarr"), "zarr.json' is damaged (its checksums); remove 'map.zarr' and")
    del attributes["checksums"]
    assert_refused(wearlaw("verify", "map.zarr"), "is complete, but was written by a version of wearlaw that kept no")
    attributes["checksums"] = sums
    attributes["status"] = "incomplete"
    assert_refused(wearlaw("verify", "map.zarr"), "holds an unfinished sweep; the same call with resume=True goes on")
    (store / "zarr.json").write_text("garbage")
    assert_refused(wearlaw("verify", "map.zarr"), "zarr.json' is damaged")
    zarr.open_group(str(folder / "other.zarr"), mode="w")
    assert_refused(wearlaw("verify", "other.zarr"), "'other.zarr' holds no sweep of wearlaw\n")


@pytest.mark.parametrize("seed", range(20))
def test_no_change_of_bytes_escapes(seed: int, out: Path, store: Path) -> None:
    chance = random.Random(seed)
    for results in (out, store):
        before = contents(results)
        name = chance.choice(sorted({*before} - {MANIFEST, "zarr.json"}))  # which hold the checksums
        change = chance.choice([damage.cut, damage.zero, damage.flip, damage.insert, damage.garbage])
        content = bytearray(before[name])
        change(content, chance)
        (results / name).write_bytes(content)
        assert wearlaw("verify", str(results)).exit_code == (content != before[name]), (name, change)
