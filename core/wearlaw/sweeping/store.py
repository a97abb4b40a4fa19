"""Results of a sweep in a zarr store, written block by block by those who evaluate them."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import InputError, OutputError
from wearlaw.sweeping.evaluation import Job, Seen
from wearlaw.sweeping.journal import Journal, check_same, run_of
from wearlaw.sweeping.points import Block, Points
from wearlaw.sweeping.space import check_disk
from wearlaw.sweeping.targets import COMPLETE, INCOMPLETE, Target, attributes

if TYPE_CHECKING:
    import xarray


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
        if resume and beside.exists() and path.is_dir():
            self._journal = Journal.resume(beside, self._run, path)
            self.done = dict(self._journal.done)
            if self.done:
                return
            self._journal.close()  # the store may not have been made
        check_disk(self.size, path)
        self._journal = self._begin(beside)

    def _begin(self, beside: Path) -> Journal:
        """Make a store in which nothing is done yet."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        journal = Journal.begin(beside, self._run)
        empty = self.points.dataset({}, {}).assign_attrs(status=INCOMPLETE)
        empty.to_zarr(str(self.store), mode="w", consolidated=False, zarr_format=3)
        group = _zarr().open_group(self.store, mode="r+")
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
        return journal

    def places(self, block: Block) -> list[Array]:  # noqa: ARG002
        """Return nothing, since nothing is handed back."""
        return []

    def add(self, number: int, seen: Seen) -> None:
        """Take note that a block is done, also on disk."""
        super().add(number, seen)
        self._journal.add(number, seen)

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Mark the store as complete, and return what is in it; values are read when they are used."""
        for cut_off in self.path.rglob("*.partial"):  # of a worker that died as it wrote
            cut_off.unlink()
        _zarr().open_group(self.store, mode="r+").attrs.update(attributes(self._run, notes))
        self._journal.remove()
        return _opened(self.path)

    def close(self) -> None:
        """Leave store and journal as they are."""
        self._journal.close()


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
