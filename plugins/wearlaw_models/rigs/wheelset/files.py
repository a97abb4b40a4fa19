"""Files of profiles: Simpack, MiniProf, GENSYS and two columns.

All readers return coordinates as wearlaw has them: y outwards, z down.
"""

from __future__ import annotations

import csv
import io
import math
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array

LARGEST = 4 * 1024 * 1024
"""Size of the largest file that is read [bytes]."""

Kind = Literal["wheel", "rail"]

KINDS: dict[str, Kind] = {
    ".prw": "wheel", ".whl": "wheel", ".wheel": "wheel", ".whe": "wheel",
    ".prr": "rail", ".ban": "rail", ".rail": "rail", ".rai": "rail",
}  # fmt: skip
"""Kind of profile by the ending of a file."""
SIMPACK, MINIPROF, GENSYS = (".prw", ".prr"), (".whl", ".ban", ".mpt"), (".wheel", ".rail")
SPREADSHEETS = (".xlsx", ".xlsm", ".ods")
COLUMNS = (".csv", ".txt", ".dat", ".asc", "", ".whe", ".rai", *GENSYS, *SPREADSHEETS)

REFUSED = {
    r"\s*(WHEEL|RAIL)PROFILE\b": "is the format of VAMPIRE, which is not read; save y, outwards, and z, down, as .csv",
    r"""[^'"=%!#]*\d[\s,]+['"][^'"]+\.\w+['"]""": "belongs to a list of slices along the track, which is not read;"
    " a rail has one profile all along, so give one of the files in the list",
}  # fmt: skip
"""Lines of formats that are not read, with the reason."""


NUMBERS = (
    "approx.smooth", "point.dist.min", "shift.y", "shift.z", "rotate", "bound.y.min", "bound.y.max", "bound.z.min",
    "bound.z.max", "mirror.y", "mirror.z", "inversion", "units.len.f", "units.ang.f",
)  # fmt: skip
"""Keys of a Simpack file whose values are read."""
TEXTS = ("file", "file.mtime", "comment", "type", "units.len", "units.ang")
"""Keys of a Simpack file that say where the points are from."""

READ = 40
"""Lines at the top of a file that show its format."""
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?", re.ASCII)
DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+", re.ASCII)
HEAD = re.compile(r"[yz]\s*([\[(].*)?|.*\[.*\]")
"""The head of a column of coordinates."""
TAPING = "WheelDiameterTaperline"
"""Key of a MiniProf file for the distance of the taping line from the back of the flange."""
DIAMETER = "DiameterTaperline"
"""Key of a MiniProf file for the diameter at the taping line."""


NO_POINTS = "it has no points: lines of two numbers, y and z, between semicolons, tabs, blanks or commas"
"""The error for files without points."""


class FileError(wl.InputError):
    """A file of a profile is wrong; the message has no name of the file yet."""


@dataclass(frozen=True)
class Points:
    """The points of a file [m], outwards and down, each with its line; the kind is that of the content, if any.

    The points of a MiniProf wheel have the distance of the `taping` line from the back of the flange, from which their
    file counts [m]; their height counts from that line, wherever it is, and the diameter is there [m]. Points that are
    `scanned` by a hand may run back.
    """

    y: Array
    z: Array
    weights: Array | None
    lines: NDArray[np.intp]
    kind: Kind | None
    taping: float | None = None
    diameter: float | None = None
    scanned: bool = False

    def mirrored(self) -> Array:
        """Return y after a change of sign: of a MiniProf wheel about the back of its flange, from which X counts."""
        return -self.y - 2.0 * (self.taping or 0.0)


def points_of(
    path: Path,
    kind: Kind | None,
    units: str,
    sep: str | None = None,
    decimal: str = ".",
    part: int | None = None,
    sheet: str | None = None,
) -> tuple[Points, Kind]:
    """Return the points of a file, and their kind; the options are those of `read_profile`.

    Raises
    ------
    FileError
        If the file is missing, too large, not regular or not text, or if its content is wrong.
    """
    ending = path.suffix.lower()
    by_ending: Kind | None = KINDS.get(ending)
    readers = {} if ending in (*KINDS, *COLUMNS, ".mpt") else dict(wl.installed("file reader"))
    text = "" if ending in SPREADSHEETS or ending[1:] in readers else _text_of(path)
    lines = text.splitlines()
    for number, line in enumerate(lines[:READ], 1):
        for pattern, reason in REFUSED.items():
            if re.match(pattern, line):
                raise FileError(f"line {number}: {wl.shown(line.strip()[:40])} {reason}")
    first = next((line for line in lines if re.match(r"\s*[^\s!%#]", line)), "")
    if ending[1:] in readers:
        points = _by_reader(readers[ending[1:]], path)
    elif (ending in SIMPACK and not _is_point(first)) or any(re.match(r"\s*spline\.begin", line) for line in lines):
        points = _simpack(lines, units)
    elif ending in MINIPROF or _is_miniprof(lines):
        points = _miniprof(lines, by_ending or kind, units, part)
    elif ending in (*COLUMNS, *SIMPACK) or kind is not None:
        source = path if ending in SPREADSHEETS else io.StringIO(_tabbed(lines, sep, decimal))
        points = _columns(source, units, decimal, sheet)
        if ending in GENSYS:  # y is positive towards the middle of the track
            points = replace(points, y=-points.y)
    else:
        hint = 'if it has two columns, y and z, give kind="rail" or kind="wheel"'
        raise FileError(f"the ending {wl.shown(ending)} is not known; {hint}")
    sure = kind or by_ending or points.kind
    if sure is None:
        hint = f'give kind="wheel" or kind="rail", in a case {{file = "{path.name}", kind = "wheel"}}'
        raise FileError(f"it does not say whether it is a wheel or a rail; {hint}")
    told = {"the argument kind": kind, "its ending": by_ending, "its header": points.kind}
    if not {*told.values()} <= {sure, None}:
        says = ", ".join(f"{source} says {value}" for source, value in told.items() if value)
        raise FileError(f"it is not clear whether it is a wheel or a rail: {says}")
    return points, sure


def _by_reader(reader: Callable[[Path], Any], path: Path) -> Points:
    """Return the points of the profile that a reader of a plugin returns."""
    profile = reader(path)
    try:
        y, z = (1e-3 * value.m_as("mm") for value in profile.points)
        return Points(y, z, None, np.arange(y.size), profile.kind)
    except AttributeError:
        raise FileError(
            f"the reader of '{path.suffix}' returned a {type(profile).__name__}, not a wl.Profile"
        ) from None


def _text_of(path: Path) -> str:
    try:
        content = wl.read_file(path, LARGEST)
    except FileNotFoundError:
        raise FileError(f"there is no such file in {wl.shown(path.parent.absolute())}") from None
    except wl.InputError as error:
        raise FileError(f"it cannot be read: {error}") from None
    if b"\0" in content and not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise FileError("it is not text; export the points of the profile as text")
    for encoding in ("utf-16",) if content.startswith((b"\xff\xfe", b"\xfe\xff")) else ("utf-8-sig", "cp1252"):
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    raise FileError("it is not text in UTF-8; save it in UTF-8")


def _number(text: str, line: int, what: str) -> float:
    """Return a number; Fortran writes D for the exponent."""
    if NUMBER.fullmatch(text):
        return float(text.translate({ord("d"): "e", ord("D"): "e"}))
    comma = "; write decimals with a point" if NUMBER.fullmatch(text.replace(",", ".")) else ""
    raise FileError(f"line {line}: {what} must be a number, got '{text[:40]}'{comma}")


def _factor(units: str) -> float:
    """Return a unit of length in metres."""
    return float(wl.Unit("mm").si(wl.Q(1.0, units), "units"))


class _Table:
    """Collects rows of numbers with their lines."""

    def __init__(self) -> None:
        self.rows: list[list[float]] = []
        self.lines: list[int] = []

    def add(self, cells: Sequence[str], line: int, least: int, most: int) -> None:
        """Add a row with so many cells at least, of which the first `most` are read."""
        if len(cells) < least:
            raise FileError(f"line {line}: a point has {least} numbers, found {len(cells)}")
        self.rows.append([_number(cell, line, "a coordinate") for cell in cells[:most]])
        self.lines.append(line)

    def columns(self) -> tuple[Array, NDArray[np.intp]]:
        """Return the numbers, one row for each column, and the lines."""
        if not self.rows:
            raise FileError(NO_POINTS)
        width = max(map(len, self.rows))
        rows = [row + [1.0] * (width - len(row)) for row in self.rows]
        return np.array(rows).T.copy(), np.array(self.lines)


def _simpack(lines: Sequence[str], units: str) -> Points:
    """Return the points of a Simpack profile, after the changes that its header asks for, in their order."""
    place: list[str] = []
    values: dict[str, float] = {}
    table, told = _Table(), False
    kind: Kind | None = None
    for number, raw in enumerate(lines, 1):
        text = re.split("[!%]", raw)[0].strip()  # texts in quotes, which may hold these marks, are not read
        if not text:
            continue
        section, _, edge = text.rpartition(".")
        key, equals, value = (part.strip() for part in text.partition("="))
        if edge in ("begin", "end") and section in ("header", "spline", "point"):
            _nest(place, section, edge, number)
            told |= text == "spline.end"
            if told:
                break
        elif place[-1:] == ["point"] and not equals:
            table.add(text.split(), number, 2, 3)
        elif not equals:
            raise FileError(
                f"line {number}: expected 'key = value' or the begin or end of a section, found '{text[:40]}'"
            )
        elif place == ["header"] and key == "type":
            if value not in ("0", "1"):
                raise FileError(f"line {number}: type must be 0 for a rail or 1 for a wheel, got '{value[:40]}'")
            kind = "wheel" if value == "1" else "rail"
        elif place == ["spline"] and key in NUMBERS:
            values[key] = _number(value, number, key)
        elif place == ["spline"] and key not in TEXTS:
            wl.errors.warn(
                f"line {number} of a profile: the key {wl.shown(key)} is not known and left out", wl.WearlawWarning
            )
    if not told:
        raise FileError(f"it ends in the section '{place[-1]}'; is it whole?" if place else "it has no spline.begin")
    columns, rows = table.columns()
    return _changed(columns, rows, values, kind, units)


def _nest(place: list[str], section: str, edge: str, line: int) -> None:
    """Enter or leave a section."""
    outer = ["spline"] if section == "point" else []
    expected = outer if edge == "begin" else [*outer, section]
    if place != expected:
        where = f"inside '{place[-1]}'" if place else "outside of any section"
        raise FileError(f"line {line}: '{section}.{edge}' stands {where}")
    place[:] = [*outer, section] if edge == "begin" else outer


def _changed(columns: Array, rows: NDArray[np.intp], values: dict[str, float], kind: Kind | None, units: str) -> Points:
    """Return the points after the changes of a Simpack header, in the order of the numbers that the files print."""
    if values.get("approx.smooth", 0.0):
        wl.errors.warn(
            f"the profile asks for approx.smooth = {values['approx.smooth']:g}, whose meaning Simpack does not publish;"
            " the points are not smoothed by it, so give smoothing as a length",
            wl.WearlawWarning,
        )
    y, z = columns[0], columns[1]
    weights = columns[2] if columns.shape[0] > 2 else np.ones(y.size)
    keep = _spaced(y, z, values.get("point.dist.min", 0.0))
    y, z = y + values.get("shift.y", 0.0), z + values.get("shift.z", 0.0)
    turn = values.get("rotate", 0.0) / _positive(values, "units.ang.f", 1.0)
    if turn:
        y, z = np.cos(turn) * y - np.sin(turn) * z, np.sin(turn) * y + np.cos(turn) * z
    for name, value in (("y", y), ("z", z)):
        low, high = values.get(f"bound.{name}.min", 1.0), values.get(f"bound.{name}.max", 0.0)
        if low < high:
            keep &= (value >= low) & (value <= high)
    y = -y if values.get("mirror.y", 0.0) else y
    z = -z if values.get("mirror.z", 0.0) else z
    keep &= weights > 0.0
    order = np.flatnonzero(keep)[:: -1 if values.get("inversion", 0.0) else 1]
    if not order.size:
        raise FileError("its header leaves out all of its points, by point.dist.min, bounds or weights of zero")
    factor = 1.0 / _positive(values, "units.len.f", 1.0) if "units.len.f" in values else _factor(units)
    kept = weights[order] if np.ptp(weights[order]) > 0.0 else None
    return Points(factor * y[order], factor * z[order], kept, rows[order], kind)


def _positive(values: dict[str, float], key: str, otherwise: float) -> float:
    value = values.get(key, otherwise)
    if value <= 0.0:
        raise FileError(f"{key} must be positive, got {value:g}")
    return value


def _spaced(y: Array, z: Array, least: float) -> NDArray[np.bool_]:
    """Return which points are at least a distance from the last one before them that is kept."""
    keep = np.ones(y.size, dtype=np.bool_)
    last = 0
    for index in range(1, y.size if least > 0.0 else 0):
        keep[index] = math.hypot(y[index] - y[last], z[index] - z[last]) >= least
        last = index if keep[index] else last
    return keep


def _is_miniprof(lines: Sequence[str]) -> bool:
    marks = r"\s*#?\s*(MINIPROF|MINIWHEELPROF|\[FileInfo\]|ProgramName=|ColumnDef=)"
    return any(re.match(marks, line) for line in lines[:READ])


def _miniprof(lines: Sequence[str], kind: Kind | None, units: str, part: int | None) -> Points:
    """Return the points of a MiniProf file.

    In the newer generation the header has lines such as Key=Value, and in the older one it ends with an empty line.
    Words behind a point are remarks. X of a wheel is outwards from the back of the flange, and its Y positive towards
    the flange, so down, from any height. X of a rail is positive towards the gauge side, and its Y positive up; in some
    files it is positive down, which the points show.
    """
    texts = [re.split('[!"%#]', line)[0].strip() for line in lines]
    low, high = _part(texts, part)
    header: dict[str, str] = {}
    columns = ["X", "Y"]
    for number, text in enumerate(texts[:high], 1):
        key, equals, value = (side.strip() for side in text.partition("="))
        if not equals or NUMBER.match(key):
            continue
        header[key.lower()] = value
        low = max(low, number)
        if key == "ColumnDef":
            columns = [name.strip() for name in value.split(",")]
            if not {"X", "Y"} <= set(columns):
                raise FileError(f"line {number}: ColumnDef must name the columns X and Y, got '{value[:40]}'")
    if not low and any(re.search("MINI(WHEEL)?PROF", line, re.IGNORECASE) for line in lines[:READ]):
        low = next((number for number, line in enumerate(lines) if number and not line.strip()), 0)
        if not low:
            raise FileError("its header, of an older MiniProf, must end with an empty line; put one before the points")
    table, last = _Table(), max(columns.index("X"), columns.index("Y"))
    for number, text in enumerate(texts[low:high], low + 1):
        if text:
            table.add(_cells(text), number, last + 1, last + 1)
    values, rows = table.columns()
    x, y = values[columns.index("X")], values[columns.index("Y")]
    offset = {}
    for key in ("xoffset", "yoffset", TAPING.lower(), DIAMETER.lower()):
        text = header.get(key, "")
        offset[key] = _number(text, 1, f"{key} in the header") if text else 0.0
    told = header.get("xypoints", "")
    count = sum(_is_point(line) for line in lines[low:high])
    if told.isdigit() and count < int(told):
        raise FileError(f"XYPoints says {told} points, but it has {count}; is it whole?")
    factor = _factor(units)
    x, y = factor * (x + offset["xoffset"]), factor * (y + offset["yoffset"])
    if kind == "wheel":
        diameter = factor * offset[DIAMETER.lower()] or None
        taping = factor * offset[TAPING.lower()]
        return Points(x - taping, y, None, rows, None, taping=taping, diameter=diameter, scanned=True)
    return Points(-x, -y, None, rows, None, scanned=True)


def _part(texts: Sequence[str], part: int | None) -> tuple[int, int]:
    """Return the lines between which the points of a part lie, in a file with several such as [Profile1Points]."""
    starts = [number for number, text in enumerate(texts, 1) if re.fullmatch(r"\[Profile\w*Points\]", text)]
    if part is None and len(starts) > 1:
        places = ", ".join(f"{number} from line {start}" for number, start in enumerate(starts, 1))
        raise FileError(f"it has several parts: {places}; say which to read, as in part=1")
    if not starts and part is None:
        return 0, len(texts)
    if part is not None and not 1 <= part <= len(starts):
        raise FileError(
            f"part must be from 1 to {len(starts)}, got {part}" if starts else "it has no parts; leave out part"
        )
    start = starts[(part or 1) - 1]
    ends = (number for number, text in enumerate(texts) if number >= start and text.startswith("["))
    return start, next(ends, len(texts))


def _is_point(line: str) -> bool:
    """Return whether a line holds numbers, commented out or not, before any remark."""
    cells = _cells(line.strip().lstrip('!"%#'))
    return len(cells) > 1 and all(NUMBER.fullmatch(cell) for cell in cells[:2])


def _cells(text: str) -> list[str]:
    return [cell for cell in re.split(r"[\s;]+|,(?=.*\.)", text) if cell]


def _tabbed(lines: Sequence[str], sep: str | None, decimal: str) -> str:
    """Return the lines of columns with tabs between the cells, without remarks and titles."""
    texts = [re.split("[!#%]", line)[0].strip() for line in lines]
    if sep is None:
        points = [text for text in texts if NUMBER.match(text)] or texts
        sep = next((mark for mark in ";|,".replace(decimal, "") if any(mark in text for text in points)), " ")
        for number, text in enumerate(texts, 1):
            cells = [cell for cell in re.split(r"[\s;]+", text) if DECIMAL_COMMA.fullmatch(cell)]
            if decimal == "." and len(cells) > 1:
                raise FileError(f"line {number}: '{cells[0]}' has a decimal comma; give decimal=\",\"")
            if sep == "," and re.match(r"[+-]?\d+,0\d", text):
                raise FileError(f"line {number}: '{text[:20]}' has decimal commas; put semicolons between the numbers")

    def cells_of(text: str) -> list[str]:
        if sep == " ":
            return re.findall(r'[^\s"\[(]+(?:\s*[\[(][^\])]*[\])])?', text)
        return [" ".join(cell.split()) for cell in next(csv.reader([text], delimiter=sep, skipinitialspace=True), [])]

    def are_numbers(cells: Sequence[str]) -> bool:
        return all(NUMBER.fullmatch(cell.replace(decimal, ".")) for cell in cells)

    rows, width, first = [], 0, []
    for number, cells in enumerate(map(cells_of, texts), 1):
        if len(cells) == 1 and (cells[0].isalpha() if width > 1 else cells[0].isdigit()):  # "end"; a number of points
            cells = []
        elif not width and cells and not are_numbers(cells[:1]):  # a header or a title
            names = [HEAD.fullmatch(cell.lower()) for cell in cells]
            cells = cells if any(names) else []
            width = len(cells)
        elif cells:
            if not width and not are_numbers((*cells, "")[:2]):
                raise FileError(f"line {number}: expected two numbers, y and z, found '{texts[number - 1][:40]}'")
            width = width or 2
            first += [cells[0]] if len(cells) > width == 2 else []
            cells = cells[:width] if are_numbers(cells[:2]) else cells
        rows.append("\t".join(re.sub(r"(?<=[\d.])[dD](?=[+-]?\d)", "e", cell) for cell in cells))
    count = len(first)
    if count > 1 and first in (first[:1] * count, [*map(str, range(count))], [*map(str, range(1, count + 1))]):
        raise FileError("its first column is constant or counts the points; name all columns above, as in 'n y z'")
    return "\n".join(rows)


def _columns(source: Path | io.StringIO, units: str, decimal: str, sheet: str | None) -> Points:
    """Return the points of two columns, y outwards and z down, with a header or without."""
    try:
        table = wl.read_table(source, decimal=decimal, sheet=sheet)
        named = {name.lower(): column for name, column in table.columns.items()}
        names = next((pair for pair in (("y", "z"), ("x", "y")) if {*pair} <= named.keys()), [*named][:2])
        columns = [named[name] for name in names]
        if len(columns) < 2:
            raise FileError(f"line {table.header}: a profile has two columns, y and z, found {len(columns)}")
        y, z = (
            _factor(units if column.unit is None else column.unit) * table.numbers(column.name) for column in columns
        )
        for column, values in zip(columns, (y, z), strict=True):
            for row in np.flatnonzero(np.isnan(values))[:1]:
                raise FileError(f"{table.where(int(row), column.name)}: is missing")
    except wl.errors.DataError as error:
        subject = str(error) if isinstance(source, Path) else NO_POINTS
        raise FileError("; ".join(error.problems[:3]) or subject) from None
    if not y.size:
        raise FileError(NO_POINTS)
    return Points(y, z, None, table.lines, None)


def write_points(path: Path, kind: str, y: Array, z: Array) -> None:
    """Write points in mm with nine decimals to a file whose ending gives its format, whole or not at all.

    Raises
    ------
    InputError
        If the ending is not known or belongs to the other kind of profile.
    OutputError
        If the file cannot be written.
    """
    ending = path.suffix.lower()
    endings = (".prw" if kind == "wheel" else ".prr", ".csv", ".txt")
    if ending not in endings:
        raise wl.InputError(
            f"cannot write {wl.shown(path)}: the ending of a {kind}'s file must be one of {', '.join(endings)}"
        )
    lines = (_as_simpack if ending in SIMPACK else _as_columns)(kind, 1e3 * y, 1e3 * z)
    text = "\n".join(lines) + "\n"
    temporary = path.parent / f".{uuid4().hex}"  # short, since the name of the file may be as long as names can be
    try:
        try:
            temporary.write_text(text, encoding="utf-8", newline="\n")
            os.replace(temporary, path)
        finally:
            temporary.unlink(missing_ok=True)
    except (OSError, ValueError) as error:
        raise wl.errors.OutputError(
            f"cannot write {wl.shown(path)}: {getattr(error, 'strerror', None) or error}"
        ) from None


def _rows(y: Array, z: Array, mark: str) -> list[str]:
    return [f"{across:.9f}{mark}{down:.9f}" for across, down in zip(y.tolist(), z.tolist(), strict=True)]


def _as_simpack(kind: str, y: Array, z: Array) -> list[str]:
    head = ["header.begin", "version = 1", f"type = {int(kind == 'wheel')}", "header.end", "spline.begin"]
    head += ["approx.smooth = 0.0", f"comment = 'wearlaw {wl.__version__}'", "mirror.y = 0", "mirror.z = 0"]
    head += ["inversion = 0", "units.len.f = 1000.0", "units.ang.f = 1.0", "point.begin"]
    return [*head, *_rows(y, z, " "), "point.end", "spline.end"]


def _as_columns(kind: str, y: Array, z: Array) -> list[str]:
    return [f"# profile of a {kind}: outwards, down", "y [mm],z [mm]", *_rows(y, z, ",")]
