"""The surface results of a case of CONTACT: its .mat files, which are text.

Layout, signs and history are those of the program's own `matlab/loadcase.m` and `src/m_soutpt.f90` (E. A. H.
Vollebregt, https://github.com/eve70a/CONTACT).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw.errors import DataError
from wearlaw_apps.contact_files.table import Table, table_of

NEWEST, OLDEST = 2410, 1220
"""The versions of the format that are read: 100 times the year and 10 times the number of CONTACT's release."""

ELEMENTS = ("I", "IGS", "H", "MU", "PN", "PX", "PY", "UN", "UX", "UY", "SREL")
"""The columns of the elements that each version has."""

EXTERIOR, ADHESION, SLIP, PLASTIC = range(4)
"""States of an element."""

TRANSIENT, STEADY = 2, 3
"""Values of T of rolling contact."""

FLEXIBLE = (2, 3, 5, 6, 7)
"""Values of M whose row holds flexibilities in place of Poisson's ratio of body 2."""


class Grid(NamedTuple):
    """The potential contact: elements, its lower left corner and the sizes of an element [mm]."""

    mx: int
    my: int
    xl: float
    yl: float
    dx: float
    dy: float


@dataclass(frozen=True)
class Case:
    """A solved patch with the units, axes and signs of CONTACT."""

    path: Path
    version: int
    module: int
    """1 for wheel and rail, where body 1 is the rail; 3 for basic contact, where body 1 is the upper one."""
    wheel_radius: float
    """Rolling radius of the wheel [mm]; zero if the file does not hold it."""
    roller_radius: float
    """Nominal radius of a roller [mm]; zero without one."""
    angle: float
    """Contact angle in the axes of the track [rad]."""
    grid: Grid
    backwards: bool
    """Whether the rolling direction is that of -x."""
    step: float
    """Distance rolled in a time step, DQ [mm]."""
    steady: bool
    shear_moduli: tuple[float, float]
    """Of body 1 and 2 [N/mm²]."""
    poisson_ratios: tuple[float, float]
    flexibilities: tuple[float, float, float] | None
    """The three flexibilities of the simplified theory [mm³/N], if they differ from each other."""
    speed: float
    """Rolling speed of the patch, VELOC [mm/s]."""
    ix: NDArray[np.intp]
    """Place of each element in contact along x, from 0, and `iy` across, (elements,)."""
    iy: NDArray[np.intp]
    values: dict[str, Array]
    """Columns of the elements in contact by their names, (elements,)."""


def case_of(path: Path) -> Case:
    """Return the contents of a .mat file.

    Raises
    ------
    DataError
        If the file is not one of CONTACT, of a version that is not known, or wrong.
    """
    table = table_of(path)
    version = _version(table)
    grid_row = _rows_of_position(version)
    if len(table.values) < grid_row + 3:
        raise DataError(
            f"'{path}', line {table.lines[-1]}: ends after {len(table.values)} rows of numbers, but the head of version"
            f" {version} has {grid_row + 3}; the file is cut short there"
        )
    position = _position(table, version)
    return Case(
        path=path,
        version=version,
        **position,
        **_kinematics(table, grid_row),
        **_bodies(table, grid_row + 1),
        **_elements(table, grid_row, grid_row + 3),
    )


def _version(table: Table) -> int:
    """Return the version of the format, the last number of the first row."""
    if table.values.shape[1] < len(ELEMENTS):
        raise DataError(
            f"'{table.path}': has {table.values.shape[1]} columns, but CONTACT writes at least {len(ELEMENTS)}; is it"
            " one of its files?"
        )
    column = table.values.shape[1] - 1
    version = table.values[0, column]
    if version != int(version) or not 0 <= version < 10000:
        table.wrong(0, column, "FMT", "must be the version of CONTACT's format, such as 2410; is it a file of CONTACT?")
    if version > NEWEST:
        table.wrong(0, column, "FMT", f"must be at most {NEWEST}, the newest version of the format that is known")
    if version < OLDEST:
        table.wrong(
            0, column, "FMT", f"must be at least {OLDEST}: older files hold neither materials nor the local friction;"
            " run the case again with a newer CONTACT"
        )  # fmt: skip
    return int(version)


def _rows_of_position(version: int) -> int:
    """Return the number of rows before that of the grid."""
    return 3 if version >= 2320 else 2 if version >= 1801 else 1 if version >= 1401 else 0


def _position(table: Table, version: int) -> dict[str, Any]:
    """Return the module, the radii of the bodies and the contact angle."""
    none = {"module": 3, "wheel_radius": 0.0, "roller_radius": 0.0, "angle": 0.0}
    if version < 1801:
        return none
    row = _rows_of_position(version) - 1
    patch = table.whole(row, 8, "IPATCH", range(27))
    if patch == 0:
        return none
    first, second, place = table.values[0], table.values[1], table.values[row]
    roll, wheel, roller = (first[5], second[5], first[6]) if version >= 2320 else (first[9], place[9], place[10])
    radius = wheel + place[6] if wheel > 0.0 else 0.0  # at the contact, where z of the wheel is downwards
    return {"module": 1, "wheel_radius": radius, "roller_radius": max(roller, 0.0), "angle": place[3] + roll}


def _kinematics(table: Table, row: int) -> dict[str, Any]:
    """Return the grid, the direction and the speed of rolling."""
    mx, my = (table.whole(row, column, name, range(1, 10**7)) for column, name in enumerate(("MX", "MY")))
    xl, yl = table.values[row, 2:4].tolist()
    dx, dy = table.positive(row, 4, "DX"), table.positive(row, 5, "DY")
    chi = table.values[row, 6]
    if abs(math.sin(chi)) > 1e-5:  # π has six digits in a file
        table.wrong(row, 6, "CHI", "must be 0 or π, for rolling along x; other directions have no strips along them")
    tang = table.values[row + 1, 0]
    if tang not in (TRANSIENT, STEADY):
        table.wrong(row + 1, 0, "T", "must be 2 or 3, for rolling; a shift or a normal problem has no wear by rolling")
    return {
        "grid": Grid(mx, my, xl, yl, dx, dy),
        "backwards": bool(math.cos(chi) < 0.0),
        "step": table.positive(row, 7, "DQ"),
        "steady": bool(tang == STEADY),
        "speed": table.positive(row + 2, 2, "VELOC"),
    }


def _bodies(table: Table, row: int) -> dict[str, Any]:
    """Return the elastic constants of both bodies."""
    kind = table.whole(row, 1, "M", range(8))
    ratios = []
    for column in (4, 4 if kind in FLEXIBLE else 5):
        ratio = float(table.values[row, column])
        if not 0.0 <= ratio <= 0.5:
            table.wrong(row, column, f"POISS{column - 3}", "must lie between 0 and 0.5")
        ratios.append(ratio)
    flexibilities = tuple(table.values[row, 5:8].tolist()) if kind in FLEXIBLE else None
    if flexibilities is not None and len({*flexibilities}) == 1:
        flexibilities = None
    return {
        "shear_moduli": (table.positive(row, 2, "GG1"), table.positive(row, 3, "GG2")),
        "poisson_ratios": (ratios[0], ratios[1]),
        "flexibilities": flexibilities,
    }


def _elements(table: Table, grid_row: int, first: int) -> dict[str, Any]:
    """Return the elements in contact."""
    mx, my = (int(number) for number in table.values[grid_row, :2])
    rows = table.values[first:]
    numbers, state = rows[:, 0], rows[:, 1]
    in_range = (numbers == np.floor(numbers)) & (numbers >= 1) & (numbers <= mx * my)
    columns = dict(enumerate(ELEMENTS))
    faults = (
        (0, ~in_range, f"must be a whole number from 1 to {mx * my}, since the grid has {mx} x {my} elements"),
        (0, np.diff(numbers, prepend=0) <= 0, "must be greater than that of the row before it"),
        (1, ~np.isin(state, (EXTERIOR, ADHESION, SLIP, PLASTIC)), "must be 0, 1, 2 or 3"),
        *((column, rows[:, column] < 0, "must not be negative") for column in (3, 4, 10)),
    )
    for column, wrong, rule in faults:
        if wrong.any():
            table.wrong(first + int(np.argmax(wrong)), column, columns[column], rule)
    if (state == EXTERIOR).any() and numbers.size != mx * my:
        raise DataError(
            f"'{table.path}', line {table.lines[-1]}: ends after {numbers.size} elements, but the grid has {mx} x {my}"
            f" = {mx * my}, and the file lists those outside the contact too; it is cut short there"
        )
    touching = state != EXTERIOR
    if not touching.any() or not rows[touching, 4].sum() > 0.0:
        raise DataError(f"'{table.path}', line {table.lines[-1]}: no element is in contact; there is no wear")
    place = numbers[touching].astype(np.intp) - 1
    values = {name: rows[touching, column] for column, name in columns.items()}
    return {"ix": place % mx, "iy": place // mx, "values": values}
