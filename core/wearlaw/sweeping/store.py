"""Results of a sweep in a zarr store, written block by block by those who evaluate them."""

from __future__ import annotations

import functools
import json
import shutil
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.errors import InputError, OutputError
from wearlaw.sweeping.evaluation import Job
from wearlaw.sweeping.journal import Journal, check_same, run_of, sync_file
from wearlaw.sweeping.points import Block, Points
from wearlaw.sweeping.space import check_disk
from wearlaw.sweeping.targets import COMPLETE, INCOMPLETE, Target, attributes

if TYPE_CHECKING:
    import xarray


METADATA = "zarr.json"
"""The file of a group or an array that says what it is."""


def write_block(store: str, block: Block, outputs: Mapping[str, Array]) -> None:
    """Write the outputs of a block."""
    group = _group(store)
    for name, values in outputs.items():
        group[name][block.slices] = values


@functools.lru_cache(maxsize=8)
def _group(store: str) -> Any:
    return _zarr().open_group(store, mode="r+")


class Store(Target):
    """Results in a zarr store.

    Beside it, in a file of the same name and ".journal", stands what is done, until all is.
    """

    def __init__(self, job: Job, points: Points, path: Path, resume: bool) -> None:
        super().__init__(job, points)
        self.path, self.store = path, str(path.absolute())
        self._run = run_of(job, points)
        beside = _beside(path)
        if resume and beside.exists():
            journal = Journal.resume(beside, self._run, path, self._sync)
        else:
            check_disk(self.size, path)
            path.parent.mkdir(parents=True, exist_ok=True)
            journal = Journal.begin(beside, self._run, self._sync)
        self._lay_out()
        self._take_over(journal)

    def _lay_out(self) -> None:
        """Write all of the store but the results, also where it is there already and may be damaged."""
        empty = self.points.dataset({}, {}).assign_attrs(status=INCOMPLETE)
        for name in map(str, empty.coords):
            shutil.rmtree(self.path / name, ignore_errors=True)
        for name in ("", *self.job.units):
            (self.path / name / METADATA).unlink(missing_ok=True)
        group = _zarr().open_group(self.store, mode="a", zarr_format=3)
        for name, unit in self.job.units.items():
            group.create_array(
                name,
                shape=self.points.shape,
                chunks=self.points.block_shape,
                dtype="float64",
                compressors=None,
                fill_value=np.nan,
                dimension_names=self.points.dims,
                attributes={"units": unit},
            )
        empty.to_zarr(self.store, mode="a", consolidated=False, zarr_format=3)

    def places(self, block: Block) -> list[Array]:  # noqa: ARG002
        """Return nothing, since nothing is handed back."""
        return []

    def _kept(self, block: Block) -> list[Array]:
        """Return the outputs of a block as they are on disk, or nothing where they cannot be read."""
        try:
            return [_group(self.store)[name][block.slices] for name in self.job.units]
        except (OSError, ValueError):
            return []

    def _sync(self, numbers: list[int]) -> None:
        blocks = self.points.blocks()
        for name in self.job.units:
            array = _group(self.store)[name]
            for number in numbers:
                which = (one.start // size for one, size in zip(blocks[number].slices, array.chunks, strict=True))
                with suppress(FileNotFoundError):  # zarr writes none where all values are NaN
                    sync_file(self.path / name / array.metadata.encode_chunk_key(tuple(which)))

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Mark the store as complete, and return what is in it; values are read when they are used."""
        for cut_off in self.path.rglob("*.partial"):  # of a worker that died as it wrote
            cut_off.unlink()
        _zarr().open_group(self.store, mode="r+").attrs.update(attributes(self._run, notes))
        assert self._journal is not None
        self._journal.remove()
        return _opened(self.path)


def finished(job: Job, points: Points, path: Path, resume: bool) -> xarray.Dataset | None:
    """Return the results that a place holds if they may be resumed, or None if nothing or a part is there.

    Raises
    ------
    OutputError
        If something else is there, or what is there is not to be resumed.
    """
    _zarr()
    if path.exists() and not path.is_dir():
        raise OutputError(f"store: '{path}' is a file, not a folder; choose another name")
    if not path.is_dir() or not any(path.iterdir()):
        return None
    if _beside(path).exists():
        if not resume:
            raise OutputError(f"store: '{path}' holds an unfinished sweep; add resume=True, or remove it")
        return None
    found = _attributes(path)
    if found.get("status") != COMPLETE or "provenance" not in found:
        raise OutputError(f"store: '{path}' is not empty, and holds no sweep of wearlaw; choose another folder")
    if not resume:
        raise OutputError(f"store: '{path}' holds the results of a sweep; choose another folder, or remove it")
    check_same(path, json.loads(found["provenance"]), run_of(job, points))
    return _opened(path)


def _beside(path: Path) -> Path:
    return path.with_name(f"{path.name}.journal")


def _attributes(path: Path) -> dict[str, Any]:
    zarr = _zarr()
    try:
        return dict(zarr.open_group(str(path), mode="r").attrs)
    except (OSError, ValueError, KeyError):
        return {}


def _opened(path: Path) -> xarray.Dataset:
    import xarray

    found: xarray.Dataset = xarray.open_zarr(str(path), chunks=None, consolidated=False)
    return found


def _zarr() -> Any:
    try:
        import zarr
    except ImportError:
        raise InputError('store: zarr is not installed; python -m pip install "wearlaw[dask]"') from None
    return zarr
