"""The cells of spreadsheets (.xlsx, .ods) as text, after ECMA-376 and OpenDocument."""

from __future__ import annotations

import posixpath
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias
from xml.etree import ElementTree

from wearlaw.errors import DataError, did_you_mean, shown
from wearlaw.text_files import reason_of

ENDINGS = (".xlsx", ".xlsm", ".ods")
"""Endings of spreadsheets that are read."""

LARGEST = 256 * 2**20
"""Size of the largest spreadsheet that is read, unpacked [bytes]."""

SHEET = re.compile(r"xl/worksheets/sheet\d+\.xml")

Rows: TypeAlias = dict[int, dict[int, str]]
"""Texts of cells that are not empty, by the numbers of their row and column from 1."""


def text_of(path: Path, label: str, sheet: str | None = None) -> bytes:
    """Return the cells of a sheet, with tabs between them and a line for each row.

    Columns without cells are left out.

    Parameters
    ----------
    path : path
        The spreadsheet.
    label : str
        Its name in messages.
    sheet : str, optional
        The name of the sheet. Default: the only one that has cells.

    Raises
    ------
    DataError
        If it cannot be read, is no spreadsheet, or has no such sheet, or several with cells; the message begins with
        the label.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            if sum(info.file_size for info in archive.infolist()) > LARGEST:
                raise DataError(f"{label} has more than {LARGEST // 2**20} MiB; save it as CSV")
            tables = dict(_of_ods(archive) if "content.xml" in archive.namelist() else _of_xlsx(archive))
    except OSError as error:
        raise DataError(f"{label} cannot be read: {reason_of(error)}") from None
    except (zipfile.BadZipFile, ElementTree.ParseError, KeyError, ValueError, IndexError) as error:
        kind = path.suffix.lower()
        raise DataError(f"{label} is no spreadsheet in {kind} ({error}); save its sheet as CSV") from None
    if sheet is not None and sheet not in tables:
        names = ", ".join(map(shown, tables))
        raise DataError(f"{label} has no sheet {shown(sheet)}{did_you_mean(sheet, tables)} There are: {names}")
    used = {name: rows for name, rows in tables.items() if rows and sheet in (None, name)}
    if len(used) != 1:
        names = (
            f", {' and '.join(map(shown, used))}; name one by sheet=, on the command line --sheet, or" if used else ";"
        )
        raise DataError(f"{label} has {len(used)} sheets with cells{names} save the one to read as CSV")
    (rows,) = used.values()
    return "\n".join(_lines(rows)).encode()


def _of_xlsx(archive: zipfile.ZipFile) -> Iterator[tuple[str, Rows]]:
    """Yield the sheets of a workbook of ECMA-376, by name."""
    files = archive.namelist()
    texts: list[str] = []
    if "xl/sharedStrings.xml" in files:
        root = ElementTree.fromstring(archive.read("xl/sharedStrings.xml"))
        texts = ["".join(entry.itertext()) for entry in root]
    sheets = {name: posixpath.basename(name) for name in files if SHEET.fullmatch(name)}
    if "xl/workbook.xml" in files:
        links = ElementTree.fromstring(archive.read("xl/_rels/workbook.xml.rels"))
        targets = {link.get("Id"): posixpath.join("/xl", link.get("Target", "")).lstrip("/") for link in links}
        entries = ElementTree.fromstring(archive.read("xl/workbook.xml")).findall(".//{*}sheet")
        ids = [next(value for name, value in entry.items() if name.endswith("}id")) for entry in entries]
        named = {targets[key]: entry.get("name", "") for key, entry in zip(ids, entries, strict=True)}
        sheets = {file: name for file, name in named.items() if file in sheets}  # others are charts
    for file, name in sheets.items():
        rows: Rows = {}
        for row in ElementTree.fromstring(archive.read(file)).findall(".//{*}row"):
            cells: dict[int, str] = {}
            for cell in row.findall("{*}c"):
                value = "".join(part.text or "" for part in [*cell.findall("{*}v"), *cell.findall("{*}is//{*}t")])
                value = texts[int(value)] if cell.get("t") == "s" else value
                place = 0
                for letter in cell.get("r", "").rstrip("0123456789"):
                    place = 26 * place + ord(letter) - ord("A") + 1
                cells[place or len(cells) + 1] = value
            rows[int(row.get("r", len(rows) + 1))] = cells
        yield name, _in_use(rows)


def _of_ods(archive: zipfile.ZipFile) -> Iterator[tuple[str, Rows]]:
    """Yield the sheets of an OpenDocument, by name."""
    for table in ElementTree.fromstring(archive.read("content.xml")).findall(".//{*}table"):
        names = {name.rpartition("}")[2]: value for name, value in table.items()}
        rows: Rows = {}
        number = 1
        for row in table.findall(".//{*}table-row"):
            cells: dict[int, str] = {}
            place = 1
            for cell in row:
                about = {name.rpartition("}")[2]: value for name, value in cell.items()}
                text = " ".join("".join(part.itertext()) for part in cell.findall("{*}p"))
                number_of = about.get("value", text) if about.get("value-type") in _NUMBERS else text
                count = int(about.get("number-columns-repeated", 1))
                if number_of:
                    cells |= dict.fromkeys(range(place, place + count), number_of)
                place += count
            count = next((int(value) for name, value in row.items() if name.endswith("}number-rows-repeated")), 1)
            if cells:
                rows |= dict.fromkeys(range(number, number + count), cells)
            number += count
        yield names.get("name", ""), _in_use(rows)


_NUMBERS = ("float", "percentage", "currency")


def _in_use(rows: Rows) -> Rows:
    """Return rows without empty cells and without empty rows."""
    cleaned = {
        row: {place: text for place, value in cells.items() if (text := " ".join(value.split()))}
        for row, cells in rows.items()
    }
    return {row: cells for row, cells in cleaned.items() if cells}


def _lines(rows: Rows) -> Iterator[str]:
    """Yield the lines of a sheet, all of one width, with empty lines where it has no rows."""
    places = sorted({place for cells in rows.values() for place in cells})
    for number in range(1, max(rows) + 1):
        cells = rows.get(number, {})
        yield "\t".join(cells.get(place, "") for place in places)
