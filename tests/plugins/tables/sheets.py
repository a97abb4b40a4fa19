"""Spreadsheets, with the parts that Excel writes."""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape

NAMESPACE = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"


def xlsx(path: Path, *sheets: Sequence[Sequence[object]], inline: bool = False) -> Path:
    """Write sheets of rows, of which None is a cell that is not there, and return the path."""
    texts: list[str] = []

    def cell(place: int, row: int, value: object) -> str:
        name = f"{chr(ord('A') + place)}{row}"
        if value is None:
            return ""
        if not isinstance(value, str):
            return f'<c r="{name}" s="1"><v>{value!r}</v></c>'
        if inline:
            return f'<c r="{name}" t="inlineStr"><is><t>{escape(value)}</t></is></c>'
        texts.append(f"<si><r><t>{escape(value[:1])}</t></r><r><t>{escape(value[1:])}</t></r></si>")
        return f'<c r="{name}" t="s"><v>{len(texts) - 1}</v></c>'

    with zipfile.ZipFile(path, "w") as archive:
        for number, rows in enumerate(sheets, 1):
            lines = "".join(
                f'<row r="{row}">{"".join(cell(place, row, value) for place, value in enumerate(values))}</row>'
                for row, values in enumerate(rows, 1)
                if values
            )
            text = f'<worksheet xmlns="{NAMESPACE}"><sheetData>{lines}</sheetData></worksheet>'
            archive.writestr(f"xl/worksheets/sheet{number}.xml", text)
        archive.writestr("xl/sharedStrings.xml", f'<sst xmlns="{NAMESPACE}">{"".join(texts)}</sst>')
    return path
