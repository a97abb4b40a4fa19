"""Writing results: a folder of results is there whole or not at all, and costs nobody else a file."""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from matplotlib.figure import Figure

import wearlaw as wl
from tests.core.cases import full_disk, tree
from tests.core.sweeps import contents
from wearlaw.output.folder import fresh_folder
from wearlaw.output.manifest import MANIFEST
from wearlaw.output.results import CSV, RESULTS, write
from wearlaw.study.study import Study


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


def results(folder: Path, files: dict[str, str], overwrite: bool = False) -> None:
    """Write results into a folder as a command does."""
    with fresh_folder(folder, overwrite, RESULTS) as fresh:
        for name, text in files.items():
            (fresh / name).parent.mkdir(exist_ok=True)
            (fresh / name).write_text(text)


def texts(folder: Path) -> dict[str, str]:
    """Return the files in a folder, without the manifest."""
    return {name: text.decode() for name, text in contents(folder).items() if Path(name).name != MANIFEST}


OLD = {RESULTS: "old", "tables/old.csv": "old", "figures/both.png": "old"}
NEW = {RESULTS: "new", "tables/new.csv": "new", "figures/both.png": "new"}


def test_the_manifest_lists_all_files_with_their_sums_and_is_the_same_each_time(tmp_path: Path) -> None:
    results(tmp_path / "one", OLD)
    results(tmp_path / "two", OLD)
    manifest = json.loads((tmp_path / "one" / MANIFEST).read_bytes())
    sums = {name: {"bytes": 3, "sha256": hashlib.sha256(b"old").hexdigest()} for name in sorted(OLD)}
    assert manifest == {"wearlaw": wl.__version__, "files": sums}
    assert list(manifest["files"]) == sorted(OLD)
    assert tree(tmp_path / "one") == tree(tmp_path / "two")


def test_a_folder_that_is_not_to_be_replaced_has_no_manifest(tmp_path: Path) -> None:
    with fresh_folder(tmp_path / "out") as fresh:
        fill(fresh)
    assert tree(tmp_path / "out") == {RESULTS: b"new"}


def test_earlier_results_are_replaced_whole_when_asked(tmp_path: Path) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    before = tree(tmp_path)
    with pytest.raises(wl.OutputError, match="is not empty; choose another folder with -o, or add --overwrite"):
        enter(out, overwrite=False)
    assert tree(tmp_path) == before
    with fresh_folder(out, True, RESULTS) as fresh:
        fill(fresh)
        assert tree(out).items() <= tree(tmp_path / "out").items()
        assert texts(out) == OLD
    assert texts(tmp_path) == {f"out/{RESULTS}": "new"}
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert tree(out).keys() == {MANIFEST, RESULTS}


def test_what_wearlaw_did_not_write_survives(tmp_path: Path) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    others = {"thesis.tex": "years of work", "figures/mine.png": "mine", "notes/deep/a.txt": "a", "tables/a/b": "b"}
    for name, text in others.items():
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (out / name).write_text(text)
    (out / "empty").mkdir()
    (out / "link").symlink_to("notes")
    before = {name: (out / name).stat() for name in others}
    results(out, NEW, overwrite=True)
    assert texts(out) == {**NEW, **others}
    for name, stat in before.items():
        now = (out / name).stat()
        assert (now.st_ino, now.st_mtime_ns, now.st_mode) == (stat.st_ino, stat.st_mtime_ns, stat.st_mode)
    assert (out / "empty").is_dir()
    assert os.readlink(out / "link") == "notes"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    results(out, OLD, overwrite=True)
    assert texts(out) == {**OLD, **others}


OTHERS: list[tuple[str, str]] = [
    ("tables/new.csv", "tables/new.csv"),
    ("tables/new.csv/inside", "tables/new.csv"),
    ("extra", "extra"),
]
"""Files of others, and what is in the way of new ones."""


@pytest.mark.parametrize(("name", "in_the_way"), OTHERS)
def test_a_new_file_does_not_replace_one_of_others_of_its_name(tmp_path: Path, name: str, in_the_way: str) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    (out / name).parent.mkdir(exist_ok=True)
    (out / name).write_text("mine")
    before = tree(out)
    message = (
        f"'{out}/{in_the_way}' was not written by wearlaw, and a new file has its name; .* The results are in '(.*)'"
    )
    with pytest.raises(wl.OutputError, match=message) as refused:
        results(out, {**NEW, "extra/one.csv": "new"} if name == "extra" else NEW, overwrite=True)
    assert tree(out) == before
    assert refused.match(re.escape(f"The results are in '{tmp_path / 'out-2'}'"))
    assert texts(tmp_path / "out-2").items() >= NEW.items()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out-2"]


def test_a_file_of_wearlaws_that_was_exchanged_for_a_link_leaves_what_it_leads_to(tmp_path: Path) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "thesis.tex").write_text("years of work")
    (out / "tables" / "old.csv").unlink()
    (out / "tables" / "old.csv").symlink_to(tmp_path / "elsewhere")
    results(out, NEW, overwrite=True)
    assert texts(out) == NEW
    assert texts(tmp_path / "elsewhere") == {"thesis.tex": "years of work"}


def enter(folder: Path, overwrite: bool) -> None:
    with fresh_folder(folder, overwrite, RESULTS):
        pytest.fail("the folder was given")


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("name", ["thesis.tex", RESULTS])
def test_a_folder_without_a_manifest_is_left_alone_even_with_overwrite(
    tmp_path: Path, name: str, overwrite: bool
) -> None:
    (tmp_path / name).write_text("years of work")
    message = r"does not hold results of wearlaw \(no .wearlaw.json\), and will not be overwritten"
    with pytest.raises(wl.OutputError, match=message):
        enter(tmp_path, overwrite)
    assert tree(tmp_path) == {name: b"years of work"}


def test_earlier_results_whose_manifest_holds_no_sums_are_replaced(tmp_path: Path) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    (out / MANIFEST).write_text(json.dumps({"wearlaw": "0.1.0", "files": sorted(OLD)}))
    (out / "thesis.tex").write_text("years of work")
    results(out, NEW, overwrite=True)
    assert texts(out) == {**NEW, "thesis.tex": "years of work"}


@pytest.mark.parametrize(
    "manifest",
    [
        "",
        "[]",
        "1",
        '{"files": 3}',
        '{"wearlaw": "0.1.0"}',
        "\x00\xff",
        '{"files": {"results.nc": 3}}',
        '{"files": [[]]}',
    ],
)
def test_a_manifest_that_is_none_is_as_good_as_none(tmp_path: Path, manifest: str) -> None:
    results(tmp_path / "out", OLD)
    (tmp_path / "out" / MANIFEST).write_text(manifest, encoding="latin-1")
    before = tree(tmp_path)
    with pytest.raises(wl.OutputError, match="does not hold results of wearlaw"):
        enter(tmp_path / "out", overwrite=True)
    assert tree(tmp_path) == before


def test_results_of_another_command_are_left_alone_even_with_overwrite(tmp_path: Path) -> None:
    results(tmp_path / "out", OLD)
    before = tree(tmp_path)
    with (
        pytest.raises(wl.OutputError, match="holds results of another command, and will not be overwritten"),
        fresh_folder(tmp_path / "out", True, "fit.json"),
    ):
        pytest.fail("the folder was given")
    assert tree(tmp_path) == before


@pytest.mark.parametrize("sums", [None, {"bytes": 3, "sha256": "0"}])
def test_a_manifest_that_names_files_elsewhere_removes_nothing_there(tmp_path: Path, sums: Any) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    (tmp_path / "thesis.tex").write_text("years of work")
    listed = [*OLD, "../thesis.tex", "../../thesis.tex", str(tmp_path / "thesis.tex")]
    written = listed if sums is None else dict.fromkeys(listed, sums)
    (out / MANIFEST).write_text(json.dumps({"files": written}))
    results(out, NEW, overwrite=True)
    assert texts(tmp_path) == {"thesis.tex": "years of work", **{f"out/{name}": text for name, text in NEW.items()}}


@pytest.mark.parametrize(
    ("at_first", "overwrite"),
    [("nothing", False), ("empty", False), ("nothing", True), ("empty", True), ("results", True)],
)
def test_the_second_of_two_runs_into_one_folder_keeps_its_results_beside(
    tmp_path: Path, at_first: str, overwrite: bool
) -> None:
    out = tmp_path / "out"
    if at_first == "empty":
        out.mkdir()
    elif at_first == "results":
        results(out, OLD)
    (tmp_path / "out-2").mkdir()
    message = f"'{out}' was meanwhile taken by another run or program, .* The results are in '{tmp_path / 'out-3'}'"
    with pytest.raises(wl.OutputError, match=message), fresh_folder(out, overwrite, RESULTS) as fresh:  # noqa: PT012
        fill(fresh, "second")
        results(out, NEW, overwrite)
    assert texts(tmp_path) == {f"out-3/{RESULTS}": "second", **{f"out/{name}": text for name, text in NEW.items()}}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out-2", "out-3"]
    results(tmp_path / "out-3", NEW, overwrite=True)  # these are whole, with their manifest


@pytest.mark.parametrize("later", ["files", "gone"])
def test_a_folder_that_was_exchanged_for_one_of_others_is_not_replaced(tmp_path: Path, later: str) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    with pytest.raises(wl.OutputError, match="was meanwhile taken"), fresh_folder(out, True, RESULTS) as fresh:  # noqa: PT012
        fill(fresh)
        out.rename(tmp_path / "moved")
        if later == "files":
            out.mkdir()
            (out / "thesis.tex").write_text("years of work")
    assert texts(tmp_path / "moved") == OLD
    assert texts(tmp_path / "out-2") == {RESULTS: "new"}
    assert out.exists() == (later == "files")


def test_another_run_that_comes_between_two_steps_of_a_replacement_is_not_undone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    rename = Path.rename

    def late(self: Path, target: Path) -> Path:
        if self == out:
            monkeypatch.setattr(Path, "rename", rename)
            results(out, NEW, overwrite=True)
        return rename(self, target)

    with pytest.raises(wl.OutputError, match="was meanwhile taken"), fresh_folder(out, True, RESULTS) as fresh:  # noqa: PT012
        fill(fresh, "second")
        monkeypatch.setattr(Path, "rename", late)
    assert texts(out) == NEW
    assert texts(tmp_path / "out-2") == {RESULTS: "second"}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out-2"]


def test_a_folder_that_goes_between_two_steps_of_a_replacement_is_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    rename = Path.rename

    def late(self: Path, target: Path) -> Path:
        if self == out:
            monkeypatch.setattr(Path, "rename", rename)
            rename(out, tmp_path / "moved")
        return rename(self, target)

    with pytest.raises(wl.OutputError, match="was meanwhile taken"), fresh_folder(out, True, RESULTS) as fresh:  # noqa: PT012
        fill(fresh)
        monkeypatch.setattr(Path, "rename", late)
    assert texts(tmp_path / "moved") == OLD
    assert texts(tmp_path / "out-2") == {RESULTS: "new"}


def test_a_folder_beside_that_is_taken_meanwhile_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    rename = Path.rename

    def late(self: Path, target: Path) -> Path:
        if target.name == "out-2" and not target.exists():
            results(tmp_path / "new", NEW)
            rename(tmp_path / "new", target)
        return rename(self, target)

    with pytest.raises(wl.OutputError, match=r"The results are in '.*out-3'"), fresh_folder(out) as fresh:  # noqa: PT012
        fill(fresh)
        results(out, OLD)
        monkeypatch.setattr(Path, "rename", late)
    assert texts(out) == OLD
    assert texts(tmp_path / "out-2") == NEW
    assert texts(tmp_path / "out-3") == {RESULTS: "new"}


@pytest.mark.parametrize("error", [OSError(13, "Permission denied"), KeyboardInterrupt()])
@pytest.mark.parametrize("step", ["replaced", "out"])
def test_a_replacement_that_fails_halfway_is_undone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, step: str
) -> None:
    """`replaced` is where earlier results go, `out` where new ones come from there."""
    out = tmp_path / "out"
    results(out, OLD)
    (out / "thesis.tex").write_text("years of work")
    rename = Path.rename

    def fail(self: Path, target: Path) -> Path:
        if target.name == step:
            monkeypatch.setattr(Path, "rename", rename)
            raise error
        return rename(self, target)

    with pytest.raises((wl.OutputError, KeyboardInterrupt)), fresh_folder(out, True, RESULTS) as fresh:  # noqa: PT012
        fill(fresh)
        monkeypatch.setattr(Path, "rename", fail)
    assert texts(out) == {**OLD, "thesis.tex": "years of work"}
    kept = isinstance(error, OSError)
    assert sorted(path.name for path in tmp_path.iterdir()) == (["out", "out-2"] if kept else ["out"])


@pytest.mark.parametrize("error", [OSError(13, "Permission denied"), KeyboardInterrupt()])
def test_files_of_others_that_cannot_follow_are_named_and_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    (out / "thesis.tex").write_text("years of work")
    rename = Path.rename

    def fail(self: Path, target: Path) -> Path:
        if target.name == "thesis.tex":
            raise error
        return rename(self, target)

    message = "the results are in '.*out', but other files that were there are still in '(.*)': "
    with pytest.raises(wl.OutputError, match=message) as refused, fresh_folder(out, True, RESULTS) as fresh:  # noqa: PT012
        fill(fresh)
        monkeypatch.setattr(Path, "rename", fail)
    assert texts(out) == {RESULTS: "new"}
    found = re.search(message, str(refused.value))
    assert found is not None
    assert (Path(found[1]) / "thesis.tex").read_text() == "years of work"


def test_a_file_that_others_write_while_results_are_replaced_is_not_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    rename = Path.rename

    def late(self: Path, target: Path) -> Path:
        if target == out:
            (self.with_name("replaced") / "thesis.tex").write_text("years of work")
        return rename(self, target)

    with fresh_folder(out, True, RESULTS) as fresh:
        fill(fresh)
        monkeypatch.setattr(Path, "rename", late)
    (left,) = tmp_path.glob(".out-*")
    assert texts(left) == {"replaced/thesis.tex": "years of work"}
    assert texts(out) == {RESULTS: "new"}


def test_a_folder_that_cannot_be_moved_back_is_named_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out"
    results(out, OLD)
    rename = Path.rename

    def fail(self: Path, target: Path) -> Path:
        if target == out:
            raise OSError(13, "Permission denied")
        return rename(self, target)

    message = (
        "contents of '.*out' are now in '(.*)', and could not be moved back: Permission denied."
        " The results are in '.*out-2'"
    )
    with pytest.raises(wl.OutputError, match=message) as refused, fresh_folder(out, True, RESULTS) as fresh:  # noqa: PT012
        fill(fresh)
        monkeypatch.setattr(Path, "rename", fail)
    found = re.search(message, str(refused.value))
    assert found is not None
    assert texts(Path(found[1])) == OLD


RACER = """
import sys, time
from pathlib import Path
import wearlaw as wl
from wearlaw.output.folder import fresh_folder

while folder := sys.stdin.readline().strip():
    try:
        with fresh_folder(Path(folder), True, "results.nc") as fresh:
            (fresh / "results.nc").write_text(sys.argv[1])
            print("ready", flush=True)
            time.sleep(max(0.0, float(sys.stdin.readline()) - time.time()))
    except wl.OutputError as error:
        print(error, flush=True)
    else:
        print("done", flush=True)
"""
"""A process that writes into one folder after the other, and is told when each is to be done."""


class Racer:
    """A process that runs `RACER`."""

    def __init__(self, name: str, where: Path) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-c", RACER, name], cwd=where, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def tell(self, what: object) -> None:
        assert self._process.stdin is not None
        print(what, file=self._process.stdin, flush=True)

    def answer(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline().strip()

    def end(self) -> None:
        self._process.communicate()


@pytest.fixture(scope="module")
def racers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Racer]]:
    where = tmp_path_factory.mktemp("races")
    both = {name: Racer(name, where) for name in ("one", "other")}
    yield both
    for racer in both.values():
        racer.end()


@pytest.mark.parametrize("at_first", ["nothing", "empty", "results"])
@pytest.mark.parametrize("number", range(10))
def test_of_two_processes_that_end_at_once_one_has_the_folder_and_the_other_says_where_its_results_are(
    racers: dict[str, Racer], tmp_path: Path, at_first: str, number: int
) -> None:
    """Repeated, since it is left to chance which comes first, and between which steps of the other one comes."""
    out = tmp_path / "out"
    if at_first == "empty":
        out.mkdir()
    elif at_first == "results":
        results(out, OLD)
        (out / "thesis.tex").write_text("years of work")
    for racer in racers.values():
        racer.tell(out)
    assert {racer.answer() for racer in racers.values()} == {"ready"}
    start = time.time() + 0.02 + 0.0001 * number
    for racer in racers.values():
        racer.tell(start)
    said = {name: racer.answer() for name, racer in racers.items()}
    (winner,) = (name for name, answer in said.items() if answer == "done")
    (loser,) = {*said} - {winner}
    assert said[loser] == (
        f"output: '{out}' was meanwhile taken by another run or program, and is left unchanged."
        f" The results are in '{tmp_path / 'out-2'}'"
    )
    kept = {"out/thesis.tex": "years of work"} if at_first == "results" else {}
    assert texts(tmp_path) == {f"out/{RESULTS}": winner, f"out-2/{RESULTS}": loser, **kept}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out-2"]


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
        (lambda folder: folder / ("long" * 100), "cannot write to '.*'.*: File name too long; choose another"),
        (lambda folder: folder / "new" / ("long" * 100) / "out", "cannot write to '.*'.*: File name too long; choose"),
        (
            lambda folder: folder.joinpath(*["deep"] * 1000),
            "cannot write to '.*'.*: File name too long; choose another",
        ),
        (lambda folder: folder / "a\0b", "cannot write to '.*': a name cannot have a null character; choose another"),
    ],
    ids=["file", "under a file", "deep under", "system folder", "long name", "under a long name", "long path", "null"],
)
def test_a_folder_that_cannot_be_written_is_refused_at_once(
    tmp_path: Path, make: Callable[[Path], Path], message: str
) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(wl.OutputError, match=f"^output: .*{message}"):
        enter(make(tmp_path), overwrite=True)
    assert tree(tmp_path) == {"file": b"mine"}


@pytest.mark.parametrize("name", ["itself", "itself/out"])
def test_links_in_a_circle_are_refused_at_once(tmp_path: Path, name: str) -> None:
    (tmp_path / "itself").symlink_to("itself")
    with pytest.raises(
        wl.OutputError, match=r"output: cannot write to '.*itself.*': Too many levels of symbolic links;"
    ):
        enter(tmp_path / name, overwrite=True)
    assert os.listdir(tmp_path) == ["itself"]


def test_the_top_of_a_disk_is_refused_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It cannot be replaced, although it is empty."""
    monkeypatch.setattr("os.path.ismount", lambda path: path == tmp_path.resolve())
    with pytest.raises(wl.OutputError, match=r"is the top of a disk; choose a folder in it with -o"):
        enter(tmp_path, overwrite=False)


def test_a_file_that_took_the_place_of_the_folder_meanwhile_is_left_alone(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(wl.OutputError, match="was meanwhile taken by another"), fresh_folder(out) as fresh:  # noqa: PT012
        fill(fresh)
        out.write_text("somebody's file")
    assert texts(tmp_path) == {"out": "somebody's file", f"out-2/{RESULTS}": "new"}


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
        results(out, OLD)
    before = tree(tmp_path)

    def break_off(*_: Any) -> Figure:
        assert list(tmp_path.rglob(CSV)), "the break must come in the middle of writing"
        raise error

    monkeypatch.setattr("wearlaw.output.results.draw", break_off)
    expected = wl.OutputError if error is OSError else error
    with pytest.raises(expected), fresh_folder(out, True, RESULTS) as fresh:
        write(point, fresh)
    assert tree(tmp_path) == before


def test_a_full_disc_is_an_output_error(point: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pd.DataFrame, "to_csv", full_disk)
    with pytest.raises(wl.OutputError, match="output: cannot write the results: No space left on device"):
        write(point, tmp_path)
