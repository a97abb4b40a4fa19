"""Stresses below the surface: the .subs files of CONTACT.

This module is no part of the plugin that wearlaw loads, since xarray takes as long to load as the rest.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import xarray

import wearlaw as wl
from wearlaw.errors import DataError
from wearlaw_apps.contact_files.table import Table, table_of

DISPLACEMENTS = ("ux", "uy", "uz")
INVARIANTS = ("sigma_hydrostatic", "sigma_von_mises")
TENSOR = ("sigma_xx", "sigma_xy", "sigma_xz", "sigma_yy", "sigma_yz", "sigma_zz")

COLUMNS = {
    4: ("sigma_von_mises",),
    8: (*DISPLACEMENTS, *INVARIANTS),
    14: (*DISPLACEMENTS, *INVARIANTS, *TENSOR),
}
"""The values of a point after its x, y and z, by the number of columns."""

WORDS = {
    "sigma_hydrostatic": "mean of the normal stresses",
    "sigma_von_mises": "equivalent stress by von Mises",
}


def read_subsurface(path: str | os.PathLike[str], block: int = 1) -> xarray.Dataset:
    """Return the displacements and stresses below the surface that CONTACT wrote to a .subs file.

    Parameters
    ----------
    path : str or path
        The file.
    block : int
        Which of its grids of points, from 1.

    Returns
    -------
    xarray.Dataset
        Over x, y and z [mm]: the displacements `ux`, `uy`, `uz` [mm], `sigma_hydrostatic` and `sigma_von_mises` [MPa],
        and the six stresses `sigma_xx` to `sigma_zz` [MPa] if the file has them. x runs against the rolling direction,
        as in all of wearlaw, and vectors and stresses have their components in the rolling direction, along y and
        along z. z points into body 1 of CONTACT: upwards into the wheel in module 3, downwards into the rail in
        module 1. Displacements and stresses are those of the body on that side of the surface, and tension is positive.
        `attrs["blocks"]` is the number of grids in the file.

    Raises
    ------
    DataError
        If the file is wrong, with its line.
    InputError
        If there is no such block.
    """
    table = table_of(Path(path))
    width = table.values.shape[1]
    if width not in COLUMNS:
        raise DataError(
            f"'{table.path}', line {table.lines[0]}: has {width} columns, but a .subs file has 4, 8 or 14; is it one?"
        )
    blocks = _blocks(table)
    if block not in range(1, len(blocks) + 1):
        raise wl.InputError(f"block: '{table.path}' has blocks 1 to {len(blocks)}, got {block!r}")
    first, counts = blocks[block - 1]
    points = table.values[first : first + int(np.prod(counts))]
    axes = [np.unique(points[:, column]) for column in range(3)]
    shape = tuple(axis.size for axis in axes)
    place = tuple(np.searchsorted(axis, points[:, column]) for column, axis in enumerate(axes))
    if shape != counts or np.unique(np.ravel_multi_index(place, shape)).size != len(points):
        grid = " x ".join(map(str, counts))
        raise DataError(f"'{table.path}', line {table.lines[first]}: the points of this block are no grid of {grid}")
    variables = {}
    for column, name in enumerate(COLUMNS[width], 3):
        values = np.empty(shape)
        values[place] = points[:, column]
        attributes = {"units": "mm" if name in DISPLACEMENTS else "MPa"}
        if name in WORDS:
            attributes["long_name"] = WORDS[name]
        variables[name] = ("x", "y", "z"), values[::-1], attributes
    positions = {
        name: (name, values, {"units": "mm"}) for name, values in zip("xyz", (-axes[0][::-1], *axes[1:]), strict=True)
    }
    return xarray.Dataset(variables, positions, {"blocks": len(blocks)})


def _blocks(table: Table) -> list[tuple[int, tuple[int, int, int]]]:
    """Return the first row of points of each block, and the numbers of its points along x, y and z."""
    blocks, row = [], 0
    while row < len(table.values):
        nx, ny, nz = (table.whole(row, column, f"N{'XYZ'[column]}", range(1, 10**7)) for column in range(3))
        last = row + nx * ny * nz
        if last >= len(table.values):
            raise DataError(
                f"'{table.path}', line {table.lines[-1]}: ends after {len(table.values) - row - 1} points of the block"
                f" that begins in line {table.lines[row]}, which has {nx} x {ny} x {nz}; the file is cut short there"
            )
        blocks.append((row + 1, (nx, ny, nz)))
        row = last + 1
    return blocks
