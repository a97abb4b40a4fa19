"""The cells of spreadsheets (.xlsx) as text, by the parts of ECMA-376 that hold them."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from wearlaw.errors import DataError
from wearlaw.text_files import reason_of

LARGEST = 256 * 2**20
"""Size of the largest sheet that is read [bytes]."""

SHEET = re.compile(r"xl/worksheets/sheet\d+\.xml")


def text_of(path: Path, label: str) -> bytes:
    """Return the cells of the only sheet that has any, with tabs between them and a line for each row.

    Raises
    ------
    DataError
        If it cannot be read, is no spreadsheet, or has several sheets with cells; the message begins with the label.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            names = {info.filename: info.file_size for info in archive.infolist()}
            sheets = [name for name in names if SHEET.fullmatch(name)]
            if sum(names[name] for name in sheets) > LARGEST:
                raise DataError(f"{label} has more than {LARGEST // 2**20} MiB; save it as CSV")
            texts: list[str] = []
            if "xl/sharedStrings.xml" in names:
                root = ElementTree.fromstring(archive.read("xl/sharedStrings.xml"))
                texts = ["".join(entry.itertext()) for entry in root]
            tables = {name: list(_rows(ElementTree.fromstring(archive.read(name)), texts)) for name in sheets}
    except OSError as error:
        raise DataError(f"{label} cannot be read: {reason_of(error)}") from None
    except (zipfile.BadZipFile, ElementTree.ParseError, KeyError, ValueError, IndexError) as error:
        raise DataError(f"{label} is no spreadsheet in .xlsx ({error}); save its sheet as CSV") from None
    used = [rows for rows in tables.values() if rows]
    if len(used) != 1:
        raise DataError(f"{label} has {len(used)} sheets with cells; keep the one to read, or save it as CSV")
    return "\n".join(used[0]).encode()


def _rows(sheet: ElementTree.Element, texts: list[str]) -> Iterator[str]:
    """Yield the lines of a sheet, all of one width, with empty lines where it has no rows."""
    rows: dict[int, dict[int, str]] = {}
    for row in sheet.findall(".//{*}row"):
        cells: dict[int, str] = {}
        for cell in row.findall("{*}c"):
            value = "".join(part.text or "" for part in [*cell.findall("{*}v"), *cell.findall("{*}is//{*}t")])
            value = texts[int(value)] if cell.get("t") == "s" else value
            place = 0
            for letter in cell.get("r", "").rstrip("0123456789"):
                place = 26 * place + ord(letter) - ord("A") + 1
            cells[place or len(cells) + 1] = " ".join(value.split())
        if any(cells.values()):
            rows[int(row.get("r", len(rows) + 1))] = cells
    width = max((place for cells in rows.values() for place in cells), default=0)
    for number in range(1, max(rows, default=0) + 1):
        cells = rows.get(number, {})
        yield "\t".join(cells.get(place, "") for place in range(1, width + 1)) if cells else ""
