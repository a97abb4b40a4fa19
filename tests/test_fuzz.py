"""The fuzzer: its corpus is replayed, and it finds what is planted."""

from __future__ import annotations

import random
import sys
import warnings
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import NoReturn

import pytest

import wearlaw as wl
from tests.environments import ROOT
from tests.fuzz import harness
from tests.fuzz.harness import Files, check, finding, fuzz, smaller
from wearlaw_wheelset import _files

if sys.platform == "win32":
    pytest.skip("the fuzzer needs the clocks and limits of POSIX", allow_module_level=True)

from tests.fuzz import __main__ as program
from tests.fuzz.__main__ import TARGETS

pytest.importorskip("pyarrow")
pytest.importorskip("zarr")

CORPUS = ROOT / "tests" / "fuzz" / "corpus"
ENTRIES = sorted(f"{path.parent.name}/{path.name}" for path in CORPUS.glob("*/*"))


@pytest.mark.parametrize("name", ENTRIES)
def test_what_was_found_once_is_not_found_again(name: str) -> None:
    folder = CORPUS / name
    files = {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    assert finding(TARGETS[folder.parent.name], files) is None


@pytest.mark.parametrize("name", TARGETS)
def test_a_valid_case_is_one_without_an_error(name: str) -> None:
    """Changes to what is refused as it stands would test little."""
    for files in TARGETS[name].seeds():
        assert finding(TARGETS[name], files, valid=True) is None


@pytest.mark.parametrize("name", TARGETS)
def test_a_seed_draws_the_same_case_again(name: str) -> None:
    drawn = [TARGETS[name].draw(random.Random("7")) for _ in range(2)]
    assert drawn[0] == drawn[1]
    assert TARGETS[name].draw(random.Random("8")) != drawn[0]


# What counts as a finding ---------------------------------------------------------------------------------------------


class Small:
    """A target of one file of text, on which a function is called."""

    def __init__(self, function: Callable[[str], object]) -> None:
        self.function = function

    def seeds(self) -> Iterator[Files]:
        yield {"a.txt": b"valid"}

    def draw(self, random: random.Random) -> Files:
        return {"a.txt": str(random.randrange(100)).encode()}

    def run(self) -> None:
        self.function(Path("a.txt").read_text(encoding="utf-8"))


def found_by(function: Callable[[str], object], text: str = "valid") -> str | None:
    found = finding(Small(function), {"a.txt": text.encode()})
    return found.kind if found else None


def fail(error: BaseException) -> NoReturn:
    raise error


def spin() -> None:
    while True:
        pass


FOUND: dict[str, Callable[[str], object]] = {
    "KeyError": lambda _: fail(KeyError("x")),
    "SystemExit": lambda _: fail(SystemExit(0)),
    "RecursionError": lambda _: fail(RecursionError()),
    "UserWarning": lambda _: warnings.warn("of another", stacklevel=1),
    "result: five is four": lambda _: check(False, "five is four"),
    "file left half written": lambda _: Path("results.csv.partial").touch(),
    "Hang": lambda _: spin(),
}


@pytest.mark.parametrize("kind", FOUND)
def test_what_is_wrong_is_a_finding(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(harness, "HANG_S", 0.2)
    assert found_by(FOUND[kind]) == kind.removesuffix(" in lines")


def test_an_error_and_a_warning_of_wearlaw_are_none() -> None:
    assert found_by(lambda _: fail(wl.DataError("run.csv: line 2: is wrong\n  here"))) is None
    assert found_by(lambda _: warnings.warn("beyond", wl.RangeWarning, stacklevel=1)) is None


def test_a_failure_of_a_model_that_ships_is_one() -> None:
    def failed(_: str) -> None:
        try:
            raise KeyError("x")
        except KeyError as error:
            raise wl.ModelError("reader 'contact_mat' failed") from error

    assert found_by(failed) == "ModelError after KeyError"


def test_an_error_of_wearlaw_for_a_valid_case_is_one() -> None:
    found = finding(Small(lambda _: fail(wl.DataError("run.csv"))), {"a.txt": b""}, valid=True)
    assert found
    assert found.kind == "DataError"


def test_what_is_found_is_made_smaller_and_stays_what_it_is() -> None:
    target = Small(lambda text: fail(KeyError()) if "7" in text else fail(IndexError()) if len(text) < 9 else None)
    files = {"a.txt": b"1234567890123"}
    found = finding(target, files)
    assert found
    assert smaller(target, files, found) == {"a.txt": b"7"}


# What is planted ------------------------------------------------------------------------------------------------------

CASES = 300
"""Cases in which each planted fault must be found."""

Patch = Callable[[pytest.MonkeyPatch], None]


def broken_spelling(module: str) -> Patch:
    def patch(monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(f"{module}.did_you_mean", lambda *_: fail(KeyError("planted")))

    return patch


def wider_batches(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the patches of a batch a millionth wider than that of a point."""
    half_width = wl.hertz.half_width
    factor = 1.0 + 1e-6
    monkeypatch.setattr(wl.hertz, "half_width", lambda p, *a: half_width(p, *a) * (factor if p.size > 1 else 1.0))


def unchecked_values(monkeypatch: pytest.MonkeyPatch) -> None:
    """Take any number of a test."""
    monkeypatch.setattr("wearlaw_fits.wear_tests._faulty_values", lambda *_: [])


def lowered_copies(monkeypatch: pytest.MonkeyPatch) -> None:
    """Write profiles a ten thousandth of a millimetre too low."""
    rows = _files._rows
    monkeypatch.setattr(_files, "_rows", lambda y, z, mark: rows(y, z + 1e-4, mark))


def broken_refusals(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fail where a number of a file is refused."""
    monkeypatch.setattr("wearlaw_contact_files._table.Table.wrong", lambda *_: fail(KeyError("planted")))


PLANTED: dict[str, tuple[Patch, str]] = {
    "api": (wider_batches, "of a batch is not that of its point"),
    "case_files": (broken_spelling("wearlaw.settings.configuration"), "KeyError: 'planted'"),
    "wear_test_csv": (unchecked_values, "Broken"),
    "sweep_tables": (broken_spelling("wearlaw.tables"), "KeyError: 'planted'"),
    "profiles": (lowered_copies, "a copy differs"),
    "contact_result_files": (broken_refusals, "KeyError: 'planted'"),
}


@pytest.mark.parametrize("name", PLANTED)
def test_a_fault_that_is_planted_in_wearlaw_is_found(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    patch, details = PLANTED[name]
    patch(monkeypatch)
    left = iter(range(CASES))
    found = (found for _, _, found in fuzz(name, TARGETS[name], 0, lambda: next(left, None) is not None) if found)
    assert any(details in one.details for one in found)


def test_each_target_has_a_fault_planted() -> None:
    assert set(PLANTED) == set(TARGETS)


# The program ----------------------------------------------------------------------------------------------------------


def run(monkeypatch: pytest.MonkeyPatch, folder: Path, *arguments: str) -> int:
    monkeypatch.setattr("resource.setrlimit", lambda *_: None)
    monkeypatch.setattr("logging.disable", lambda: None)
    monkeypatch.setattr(sys, "argv", ["fuzz", *arguments, "--folder", str(folder)])
    return program.main()


def test_the_program_ends_well_if_nothing_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(TARGETS, "profiles", Small(lambda _: None))
    assert run(monkeypatch, tmp_path, "--target", "profiles", "--cases", "3", "--seed", "5") == 0
    printed = capsys.readouterr().out.split("\n")
    assert printed[0] == "seed 5"
    assert [row.split()[:2] for row in printed[-3:-1]] == [["profiles", "3"], ["all", "3"]]
    assert [*tmp_path.iterdir()] == []


def test_the_program_tells_each_finding_once_with_its_seed_and_keeps_the_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(TARGETS, "profiles", Small(lambda text: fail(KeyError("x")) if text != "valid" else None))
    assert run(monkeypatch, tmp_path, "--target", "profiles", "--cases", "3", "--seed", "5") == 1
    printed = capsys.readouterr().out
    assert printed.count("profiles, seed 5: KeyError in no function of wearlaw") == 1
    assert "seed 6" not in printed
    assert [path.name for path in chain(tmp_path.iterdir(), tmp_path.glob("*/*"))] == ["profiles-5", "a.txt"]
