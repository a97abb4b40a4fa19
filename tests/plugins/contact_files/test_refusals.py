"""Files that are none of CONTACT, or damaged: the message says what is wrong, with line and column."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.contact_files.files import FILES, SUBSURFACE, changed, of_version, rows_of, write_rows
from wearlaw import Array
from wearlaw.errors import DataError

TREAD = FILES["tread"]
FIRST_ELEMENT = 14
"""Line of the first element, from 1."""


def replaced(line: int, column: int, text: str) -> Callable[[list[str]], list[str]]:
    """Return a change of one cell, by its line and column from 1."""

    def change(lines: list[str]) -> list[str]:
        cells = lines[line - 1].split()
        cells[column - 1] = text
        return [*lines[: line - 1], " ".join(cells) + "\n", *lines[line:]]

    return change


CHANGES: dict[str, tuple[Callable[[list[str]], list[str]], str]] = {
    "NaN": (replaced(20, 5, "NaN"), r"is wrong in:\n  line 20, column 5: 'NaN' is no finite number"),
    "stars": (replaced(20, 5, "**************"), r"line 20, column 5: '\*+' is no finite number \(Fortran writes this"),
    "word": (replaced(21, 6, "high"), "line 21, column 6: 'high' is no finite number"),
    "newer version": (replaced(2, 11, "2520"), r"line 2, column 11 \(FMT\): must be at most 2410, .*, got 2520"),
    "old version": (replaced(2, 11, "1010"), r"line 2, column 11 \(FMT\): must be at least 1220: .*, got 1010"),
    "no version": (replaced(2, 11, "0.5"), r"line 2, column 11 \(FMT\): .* such as 2410; is it a file of CONTACT\?"),
    "cut in a line": (lambda lines: [*lines[:50], lines[50][:60]], "line 51: ends without a line break; .* cut short"),
    "cut and closed": (lambda lines: [*lines[:50], lines[50][:60] + "\n"], "line 51: has 6 cells, not 11"),
    "cut in the head": (lambda lines: lines[:8], "line 8: ends after 4 rows of numbers, but the head of version 2410"),
    "comments alone": (lambda lines: [line for line in lines if line[0] == "%"], "holds no numbers"),
    "cut after the head": (lambda lines: lines[:13], "line 12: no element is in contact; there is no wear"),
    "element of another grid": (
        replaced(31, 1, "700"), r"line 31, column 1 \(I\): must be a whole number from 1 to 688, .* 43 x 16 .*, got 700"
    ),
    "element with a fraction": (replaced(31, 1, "70.5"), r"line 31, column 1 \(I\): must be a whole number"),
    "element twice": (
        lambda lines: [*lines[:30], lines[29], *lines[30:]],
        r"line 31, column 1 \(I\): must be greater than that of the row before it",
    ),
    "state": (replaced(32, 2, "7"), r"line 32, column 2 \(IGS\): must be 0, 1, 2 or 3, got 7"),
    "tension": (replaced(33, 5, "-1.0"), r"line 33, column 5 \(PN\): must not be negative, got -1"),
    "negative slip": (replaced(33, 11, "-0.1"), r"line 33, column 11 \(SREL\): must not be negative"),
    "negative friction": (replaced(33, 4, "-0.1"), r"line 33, column 4 \(MU\): must not be negative"),
    "grid": (replaced(8, 1, "0"), r"line 8, column 1 \(MX\): must be from 1 to"),
    "element of no size": (replaced(8, 5, "0.0"), r"line 8, column 5 \(DX\): must be positive, got 0"),
    "rolling askew": (replaced(8, 7, "0.5"), r"line 8, column 7 \(CHI\): must be 0 or π, .*, got 0.5"),
    "shift": (replaced(10, 1, "1"), r"line 10, column 1 \(T\): must be 2 or 3, for rolling; .*, got 1"),
    "material": (replaced(10, 2, "9"), r"line 10, column 2 \(M\): must be from 0 to 7"),
    "modulus": (replaced(10, 3, "0"), r"line 10, column 3 \(GG1\): must be positive"),
    "ratio": (replaced(10, 6, "0.7"), r"line 10, column 6 \(POISS2\): must lie between 0 and 0.5, got 0.7"),
    "standstill": (replaced(12, 3, "0.0"), r"line 12, column 3 \(VELOC\): must be positive"),
    "a long row": (
        lambda lines: [*lines[:30], lines[30].replace("\n", " 0.0" * 3_000_000 + "\n"), *lines[31:]],
        "line 31: is longer than any row of CONTACT",
    ),
    "a long row at once": (
        lambda lines: [*lines[:1], " 0.0" * 3_000_000 + "\n"],
        "line 2: is longer than any row of CONTACT",
    ),
    "more rows than the grid": (
        lambda lines: [*lines[:13], *lines[13:14] * 700],
        r"line 15, column 1 \(I\): must be greater than that of the row before it",
    ),
    "an element outside among those in contact": (
        replaced(15, 2, "0"), "ends after 130 elements, but the grid has 43 x 16 = 688, and the file lists those"
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CHANGES)
def test_a_damaged_file_is_refused_with_line_and_column(name: str, tmp_path: Path) -> None:
    change, message = CHANGES[name]
    path = changed(TREAD, tmp_path / "tread.0001a.mat", change)
    with pytest.raises(DataError, match=message) as caught:
        wl.read_contact(path)
    assert "tread.0001a.mat" in str(caught.value)


OTHERS = {
    "hdf5": (b"\x89HDF\r\n\x1a\n\x00\x00", "is not plain text"),
    "binary": (b"% a\n1 2 \x00\n", "holds no numbers"),
    "latin": (b"% \xe9\n1 2\n", "is not plain text"),
    "empty": (b"", "ends without a line break"),
    "columns": (b"1 2 2410\n" * 9, "has 3 columns, but CONTACT writes at least 11; is it one of its files"),
}


@pytest.mark.parametrize("name", OTHERS)
def test_a_file_of_another_program_is_named_as_what_it_is(name: str, tmp_path: Path) -> None:
    content, message = OTHERS[name]
    path = tmp_path / "other.mat"
    path.write_bytes(content)
    with pytest.raises(DataError, match=message):
        wl.read_contact(path)


def test_cells_of_an_older_version_are_in_its_own_rows(tmp_path: Path) -> None:
    rows = of_version(rows_of(TREAD), 1801)
    rows[2, 4] = -1.0
    with pytest.raises(DataError, match=r"line 4, column 5 \(DX\): must be positive, got -1"):
        wl.read_contact(write_rows(tmp_path / "old.mat", rows))


def test_numbers_whose_exponent_has_three_digits_are_read(tmp_path: Path) -> None:
    path = changed(TREAD, tmp_path / "a.mat", replaced(FIRST_ELEMENT, 6, "-0.686824-101"))
    contact = wl.read_contact(path, cksi=0.01, ceta=0.02, cphi="0 1/mm")
    assert np.sort(np.abs(contact.traction_x[contact.area > 0.0]))[0] == pytest.approx(0.686824e-95)


def below(change: Callable[[Array], Array], tmp_path: Path) -> Path:
    return write_rows(tmp_path / "below.subs", change(rows_of(SUBSURFACE)))


def test_damaged_stresses_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"line 101: ends after 99 points of the block .* 7 x 5 x 8; .* cut short"):
        wl.read_subsurface(below(lambda rows: rows[:100], tmp_path))
    with pytest.raises(DataError, match=r"has 5 columns, but a .subs file has 4, 8 or 14; is it one\?"):
        wl.read_subsurface(below(lambda rows: rows[:, :5], tmp_path))
    twice = rows_of(SUBSURFACE)
    twice[9] = twice[8]
    with pytest.raises(DataError, match="line 3: the points of this block are no grid of 7 x 5 x 8"):
        wl.read_subsurface(below(lambda _: twice, tmp_path))
    with pytest.raises(DataError, match=r"line 2, column 1 \(NX\): must be from 1 to"):
        wl.read_subsurface(below(lambda rows: 0.0 * rows, tmp_path))
    with pytest.raises(DataError, match=r"cannot read .*No such file"):
        wl.read_subsurface(tmp_path / "nowhere.subs")


def test_few_columns_of_stresses_are_read(tmp_path: Path) -> None:
    rows, whole = rows_of(SUBSURFACE), wl.read_subsurface(SUBSURFACE)
    eight = wl.read_subsurface(below(lambda _: rows[:, :8], tmp_path))
    assert list(eight) == ["ux", "uy", "uz", "sigma_hydrostatic", "sigma_von_mises"]
    assert eight.equals(whole[list(eight)])
    four = wl.read_subsurface(below(lambda _: rows[:, [0, 1, 2, 7]], tmp_path))
    assert list(four) == ["sigma_von_mises"]
    assert four.equals(whole[["sigma_von_mises"]])
