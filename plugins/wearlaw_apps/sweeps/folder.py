"""A folder in zarr format that keeps finished parts of a calculation, and goes on with the same one alone."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import filelock
import numpy as np
import xarray
import zarr
from zarr.codecs import Crc32cCodec

from wearlaw.arrays import Array
from wearlaw.errors import OutputError, shown
from wearlaw_apps.sweeps.provenance import Provenance, check_same
from wearlaw_apps.sweeps.results import COMPLETE, INCOMPLETE, attributes
from wearlaw_apps.sweeps.room import check_disk

CHECKED = Crc32cCodec()
"""Every chunk ends with its CRC-32C, so that a damaged one does not decode."""


class Folder:
    """A group of zarr with the provenance of a calculation, of which one process at a time is the writer.

    Parameters
    ----------
    path : path
        The folder; it may be there and empty.
    provenance : dict
        What determines the results.
    resume : bool
        Whether to go on with what the folder holds.
    subject : str
        What it holds, such as "sweep".
    size : int
        Bytes that the results need on the disk.

    Attributes
    ----------
    resumed : bool
        Whether the folder held the same calculation before.

    Raises
    ------
    OutputError
        If the folder holds anything else, or holds it and `resume` is false, or another process writes it.
    """

    def __init__(
        self, path: str | os.PathLike[str], provenance: Provenance, resume: bool, subject: str = "sweep", size: int = 0
    ) -> None:
        self.path, self._subject, self.provenance = Path(path), subject, provenance
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._lock = filelock.FileLock(f"{self.path.absolute()}.lock", blocking=False)
        try:
            self._lock.acquire()
        except filelock.Timeout:
            raise OutputError(f"store: {shown(path)} is being written by another process; wait for its end") from None
        try:
            self.resumed = self._begun(resume)
            if not self.resumed:
                check_disk(size, self.path)
                new = attributes(INCOMPLETE, provenance)
                zarr.create_group(str(self.path.absolute()), zarr_format=3, attributes={**new})
        except BaseException:
            self.close()
            raise

    def _begun(self, resume: bool) -> bool:
        """Return whether the folder holds a part of this calculation, or is empty."""
        if not self.path.exists() or all(
            file.suffix == ".partial" for file in self.path.iterdir()
        ):  # zarr's, of a crash
            return False
        try:
            attrs = zarr.open_group(str(self.path), mode="r").attrs
            before, status = json.loads(str(attrs["provenance"])), attrs["status"]
        except (OSError, ValueError, KeyError, TypeError):
            raise OutputError(
                f"store: {shown(self.path)} is not empty, and holds no {self._subject} of wearlaw; choose another"
                " folder"
            ) from None
        if not resume:
            what = f"the results of a {self._subject}" if status == COMPLETE else f"an unfinished {self._subject}"
            raise OutputError(
                f"store: {shown(self.path)} holds {what}; add resume=True, choose another folder, or remove it"
            )
        check_same(self.path, before, self.provenance, self._subject)
        return True

    def close(self) -> None:
        """Let other processes write the folder."""
        with suppress(OSError):  # Windows keeps a file in use, and removes it afterwards
            Path(self._lock.lock_file).unlink()
        self._lock.release()


class Part(NamedTuple):
    """Arrays by name, and what JSON holds besides."""

    arrays: dict[str, Array]
    record: dict[str, Any]


class Parts(Folder):
    """A folder whose parts are groups of small arrays, numbered from zero."""

    def __getitem__(self, number: int) -> Part | None:
        """Return a part, None if it is missing or damaged."""
        try:
            group: Any = zarr.open_group(str(self.path), path=_name(number), mode="r")
            record = json.loads(str(group.attrs["record"]))
            return Part({name: np.asarray(group[name][...]) for name in record.pop("arrays")}, record)
        except (OSError, ValueError, KeyError):
            return None

    def add(self, number: int, arrays: Mapping[str, Array], record: Mapping[str, Any]) -> None:
        """Write a part, or write it anew; its record comes last, since it says that the part is finished."""
        group = zarr.open_group(str(self.path), mode="r+").create_group(_name(number), overwrite=True)
        for name, values in arrays.items():
            array = group.create_array(name, shape=values.shape, dtype=values.dtype, compressors=CHECKED)
            array[...] = values
        group.attrs["record"] = json.dumps({**record, "arrays": list(arrays)})

    def finish(self, results: xarray.Dataset) -> None:
        """Write results beside the parts, with attributes that mark the folder as complete."""
        for name in results.variables:  # those of an earlier call
            shutil.rmtree(self.path / str(name), ignore_errors=True)
        write_dataset(results, self.path)


def write_dataset(results: xarray.Dataset, path: Path) -> None:
    """Write the variables and the attributes of a dataset into a group of zarr."""
    encoding = {name: {"compressors": (CHECKED,)} for name in results.variables}
    results.to_zarr(str(path), mode="a", consolidated=False, zarr_format=3, encoding=encoding)


def _name(number: int) -> str:
    return f"part_{number:06d}"
