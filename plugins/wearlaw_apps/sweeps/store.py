"""The store of a sweep: one group of zarr, with a chunk for each block and output."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray
import zarr
from pydantic import TypeAdapter

from wearlaw.arrays import Array
from wearlaw.errors import OutputError, shown
from wearlaw.units.variables import is_text
from wearlaw_apps.sweeps.evaluation import BlockRecord, Job, Outputs
from wearlaw_apps.sweeps.folder import CHECKED, Folder, write_dataset
from wearlaw_apps.sweeps.points import ITEM, Block, Points, Varying
from wearlaw_apps.sweeps.provenance import provenance_of
from wearlaw_apps.sweeps.results import COMPLETE, INCOMPLETE, Target, attributes, bytes_of, dataset, described
from wearlaw_apps.sweeps.workers import RECORDS


class Store(Target):
    """Results in a folder, of which one process at a time is the writer.

    An output is an array in which each block is a chunk. A block counts as finished if its record and all its chunks
    are there and decode, whatever ended the process that wrote them.

    Parameters
    ----------
    job : Job
    points : Points
    path : Path
    resume : bool
        Whether to go on with what the folder holds.

    Raises
    ------
    OutputError
        As for `Folder`, or if the description of an array is damaged.
    """

    def __init__(self, job: Job, points: Points, path: Path, resume: bool) -> None:
        super().__init__(job, points)
        large = sum(condition.values.size for condition in points.coordinates().values() if condition.on_disk)
        size = bytes_of(job, points) + large * ITEM
        self._folder = Folder(path, provenance_of(job, points), resume, size=size)
        self.path, self.store, self.resumed = path, str(path.absolute()), self._folder.resumed
        try:
            self._lay_out()
            if self.resumed:
                self.done = dict(self._kept())
        except BaseException as error:
            self.close()
            if self.resumed and isinstance(error, ValueError | KeyError | TypeError):  # what describes an array
                raise OutputError(f"store: {shown(path)} is damaged ({error}); remove it to start again") from None
            raise

    def _lay_out(self) -> None:
        """Write the coordinates, and the arrays of outputs that are missing."""
        points, job = self.points, self.job
        group: Any = zarr.open_group(self.store, mode="r+", zarr_format=3)
        there = set(group) if self.resumed else set()
        for name in there & {*job.units}:  # blocks stay as they were, however long points take now
            divided = group[name].chunks[: len(points.dims)]
            self.points = points = replace(points.divided_by(1), divided=divided)
        for name in job.units:
            if name not in there:
                shape, chunks = points.shape + job.own_shape(name), points.block_shape + job.own_shape(name)
                dims, text = (*points.dims, *job.labels(name)), is_text(name)
                _add_array(group, name, shape, chunks, dims, job.attributes(name), text)
        if not self.resumed or RECORDS not in group:
            group.create_array(RECORDS, shape=(len(points.blocks()),), chunks=(1,), dtype=str, compressors=CHECKED)
        small = dataset(points, {}, job, attributes(INCOMPLETE, self._folder.provenance))
        small = small.drop_vars(job.units, errors="ignore")  # a case keeps some of its conditions as outputs
        large = {name: column for name, column in points.coordinates().items() if column.on_disk}
        for name in (*small.coords, *large):  # those of an interrupted sweep may be damaged
            shutil.rmtree(self.path / str(name), ignore_errors=True)
        write_dataset(small, self.path)
        for name, column in large.items():
            self._write_large(name, column)

    def _write_large(self, name: str, column: Varying) -> None:
        """Write a coordinate that is too large for memory, piece by piece."""
        step = dict(zip(self.points.dims, self.points.block_shape, strict=True))[column.dim]
        group = zarr.open_group(self.store, mode="r+", zarr_format=3)
        shape = column.values.shape
        array = _add_array(group, name, shape, (step, *shape[1:]), column.dims, described(name, column.unit))
        for start in range(0, shape[0], step):
            array[start : start + step] = column.values[start : start + step]
        if name != column.dim:  # as xarray tells coordinates from variables
            group.attrs["coordinates"] = f"{group.attrs.get('coordinates', '')} {name}".strip()

    def _kept(self) -> Iterator[tuple[int, BlockRecord]]:
        """Give the numbers and records of the blocks whose records and chunks are there and decode."""
        group: Any = zarr.open_group(self.store, mode="r")
        arrays = [group[name] for name in self.job.units]
        for block in self.points.blocks():
            with suppress(OSError, ValueError):
                record = TypeAdapter(BlockRecord).validate_json(str(group[RECORDS][block.number]))
                if all(self._chunk(array, block).is_file() for array in arrays):  # zarr would read it as NaN
                    for array in arrays:
                        array[(*block.slices, ...)]
                    yield block.number, record

    def _chunk(self, array: Any, block: Block) -> Path:
        """Return the file of a block in the array of an output."""
        which = [span.start // size for span, size in zip(block.slices, self.points.block_shape, strict=True)]
        key = array.metadata.encode_chunk_key((*which, *(0 for _ in array.shape[len(which) :])))
        return self.path / str(array.path) / str(key)

    def add(self, block: Block, outputs: Outputs, record: BlockRecord) -> None:  # noqa: ARG002
        """Note that a block is finished; the process that evaluated it has written it."""
        self.done[block.number] = record

    def arrays(self) -> dict[str, Array]:
        """Return the outputs in the shape of the points."""
        return {name: np.asarray(zarr.open_array(self.store, path=name, mode="r")[...]) for name in self.job.units}

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Mark the store as complete and open it; values are read when used."""
        group = zarr.open_group(self.store, mode="r+", zarr_format=3)
        group.attrs.update(attributes(COMPLETE, self._folder.provenance, notes))
        dataset: xarray.Dataset = xarray.open_zarr(self.store, chunks=None, consolidated=False, zarr_format=3)
        return dataset

    def close(self) -> None:
        """Let other processes write the folder."""
        self._folder.close()


def _add_array(
    group: zarr.Group,
    name: str,
    shape: tuple[int, ...],
    chunks: tuple[int, ...],
    dims: tuple[str, ...],
    attrs: Mapping[str, str],
    text: bool = False,
) -> Any:
    """Return a new array of a group, of numbers or texts, which xarray reads as one of these dimensions."""
    return group.create_array(
        name,
        shape=shape,
        chunks=chunks,
        dtype=str if text else "float64",
        compressors=CHECKED,
        fill_value="" if text else np.nan,
        dimension_names=dims,
        attributes={**attrs},
    )
