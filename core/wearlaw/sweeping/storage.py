"""Storage of the results of a sweep: in memory, in files, or in a zarr store; and checks that there is room."""

from __future__ import annotations

import errno
import json
import math
import os
import shutil
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pint
import xarray
from pydantic import TypeAdapter

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import is_friction_law
from wearlaw.errors import InputError, OutputError, WearlawError, quoted
from wearlaw.settings.text_files import place_of, reason_of
from wearlaw.sweeping.evaluation import BlockRecord, Job, is_undamaged, load_zarr, zarr_group
from wearlaw.sweeping.journal import Journal, Run, check_same, run_of, sync_file
from wearlaw.sweeping.points import ITEM, Block, Points
from wearlaw.sweeping.store_sums import CHECKSUMS, COMPLETE, INCOMPLETE, METADATA, checksums
from wearlaw.units.quantities import parse
from wearlaw.units.registry import symbol

GIB = 2.0**30

PIECE = 2**20
"""Bytes written at a time."""

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Errors of a full disk: no room, a quota, or a limit on the size of a file."""

JOURNAL = "journal"
"""Name of the journal in a folder of results."""


class Target(ABC):
    """Target of the results of a sweep's blocks.

    Attributes
    ----------
    store : str or None
        Path to which the evaluating processes write outputs themselves; None if they return them.
    done : dict of int to BlockRecord
        Records of the finished blocks, by number.
    listed, damaged : int
        Number of blocks that an interrupted sweep left, and of those among them that are damaged.
    """

    store: str | None = None

    def __init__(self, job: Job, points: Points) -> None:
        self.job = job
        self.points = points
        self.done: dict[int, BlockRecord] = {}
        self.listed = self.damaged = 0
        self._journal: Journal | None = None

    @abstractmethod
    def places(self, block: Block) -> list[Array]:
        """Return arrays for the returned outputs of a block, (points, *axes of the rig), in the order of the job."""

    def add(self, number: int, seen: BlockRecord) -> None:
        """Record a finished block, also in the journal if there is one."""
        self.done[number] = seen
        if self._journal is not None:
            self._journal.add(number, seen)

    def close(self) -> None:
        """Close the journal, if there is one; results stay."""
        if self._journal is not None:
            self._journal.close()

    def _take_over(self, journal: Journal) -> None:
        """Accept the blocks of a journal whose results on disk are undamaged."""
        blocks = {block.number: block for block in self.points.blocks()}
        for number, seen in journal.done.items():
            if number in blocks and is_undamaged(seen, self._kept(blocks[number])):
                self.done[number] = seen
        self.listed = len(journal.done)
        self.damaged = self.listed - len(self.done)

    @abstractmethod
    def _kept(self, block: Block) -> list[Array]:
        """Return the outputs of a block from disk, or nothing if they cannot be read."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of an output with one axis for all operating points: (points, *axes of the rig)."""
        return (self.points.size, *self.job.own_shape)

    @property
    def size(self) -> int:
        """Bytes of the outputs."""
        return math.prod(self.shape) * len(self.job.units) * ITEM


class Arrays(Target):
    """Results in arrays of this process.

    Attributes
    ----------
    arrays : dict of str to ndarray, (points, *axes of the rig)
        The outputs by name.
    """

    arrays: dict[str, Array]

    def places(self, block: Block) -> list[Array]:
        """Return views of the arrays for the outputs of a block."""
        return [array[block.flat] for array in self.arrays.values()]

    _kept = places


class Memory(Arrays):
    """Results in memory."""

    def __init__(self, job: Job, points: Points) -> None:
        super().__init__(job, points)
        check_memory(self.size, 'give a folder for them, store="..."')
        self.arrays = {name: np.empty(self.shape) for name in job.units}

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Return the results as a labelled dataset."""
        found = dataset(self.points, self.arrays, self.job)
        return found.assign_attrs(attributes(run_of(self.job, self.points), notes))


class Files(Arrays):
    """Results in memory-mapped files, with a journal.

    A file holds nothing but the numbers of one output, so that damage to a part leaves the rest usable.

    Raises
    ------
    OutputError
        If the files cannot be written, or the journal is damaged or belongs to another run.
    """

    def __init__(self, job: Job, points: Points, folder: Path) -> None:
        super().__init__(job, points)
        path, run = folder / JOURNAL, run_of(job, points)
        known = os.path.lexists(path)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            begun = Journal.resume(path, run, folder, self._sync) if known else Journal.begin(path, run, self._sync)
            self._journal = begun
            self._maps = {name: self._mapped(folder / f"{name}.f64") for name in job.units}
            self.arrays = dict(self._maps)
            self._take_over(begun)
        except BaseException as error:
            self.close()
            if isinstance(error, OSError) and not isinstance(error, OutputError):
                if not known:
                    shutil.rmtree(folder, ignore_errors=True)  # so that the disk is not full of files without a result
                where = error.filename or folder
                full = error.errno in FULL
                advice = "make room, and add --resume to go on" if full else f"remove {quoted(folder)} to start again"
                raise OutputError(
                    f"output: finished blocks cannot be kept in {quoted(where)}: {error.strerror or error}; {advice}"
                ) from None
            raise

    def _mapped(self, path: Path) -> np.memmap[Any, Any]:
        """Return the memory map of a file; create or resize the file if needed.

        All its room is taken at once: a memory map that finds the disk full ends the process by a signal.
        """
        path.touch()
        set_size(path, math.prod(self.shape) * ITEM)
        return np.memmap(path, dtype=np.float64, mode="r+", shape=self.shape)

    def _sync(self, _: list[int]) -> None:
        for one in self._maps.values():
            one.flush()


class Store(Target):
    """Results in a zarr store.

    Until the sweep is finished, its journal stands beside the store under the same name with ".journal".
    """

    def __init__(self, job: Job, points: Points, path: Path, resume: bool) -> None:
        super().__init__(job, points)
        self.path, self.store = path, str(path.absolute())
        self._run = run_of(job, points)
        beside = _beside(path)
        try:
            if resume and os.path.lexists(beside):
                self._journal = Journal.resume(beside, self._run, path, self._sync)
            else:
                kept = sum(one.values.size for one in points.coordinates().values() if one.on_disk)
                check_disk(self.size + kept * ITEM, path)
                path.parent.mkdir(parents=True, exist_ok=True)
                self._journal = Journal.begin(beside, self._run, self._sync)
            self._lay_out()
            self._take_over(self._journal)
        except BaseException as error:
            self.close()
            if isinstance(error, OSError) and not isinstance(error, OutputError):
                where, why = error.filename or path, error.strerror or error
                raise OutputError(f"store: cannot write to {quoted(where)}: {why}; choose another folder") from None
            raise

    def _lay_out(self) -> None:
        """Write the layout of the store anew, without results: an existing layout may be damaged."""
        empty = dataset(self.points, {}, self.job).assign_attrs(status=INCOMPLETE)
        large = {name: one for name, one in self.points.coordinates().items() if one.on_disk}
        self._coordinates = [*map(str, empty.coords), *large]
        for name in (METADATA, *self._coordinates):
            _remove(self.path / name)
        for name in self.job.units:
            _remove(self.path / name / METADATA)
        self._clear_chunks()
        group, own = load_zarr().open_group(self.store, mode="a", zarr_format=3), self.job.own_shape
        for name in self.job.units:
            group.create_array(
                name,
                shape=self.points.shape + own,
                chunks=self.points.block_shape + own,
                dtype="float64",
                compressors=None,
                fill_value=np.nan,
                dimension_names=(*self.points.dims, *self.job.dims),
                attributes=self.job.attributes(name),
            )
        empty.to_zarr(self.store, mode="a", consolidated=False, zarr_format=3)
        size = dict(zip(self.points.dims, self.points.block_shape, strict=True))
        for name, one in large.items():
            array = group.create_array(
                name,
                shape=one.values.shape,
                chunks=(size[one.dim],),
                dtype="float64",
                compressors=None,
                fill_value=np.nan,
                dimension_names=(one.dim,),
                attributes={"units": one.unit or ""},
            )
            for start in range(0, one.values.size, size[one.dim]):
                part = slice(start, start + size[one.dim])
                array[part] = one.values[part]
        if large:
            group = load_zarr().open_group(self.store, mode="r+")  # with the attributes that xarray has written
            names = [*group.attrs.get("coordinates", "").split(), *large]
            group.attrs["coordinates"] = " ".join(name for name in names if name not in self.points.dims)

    def _clear_chunks(self) -> None:
        """Remove what stands in the place of a chunk or of a folder of chunks and is none."""
        seen: set[Path] = set()
        for block in self.points.blocks():
            for chunk in self._chunks(block):
                folders = [folder for folder in reversed(chunk.parents) if folder.is_relative_to(self.path)]
                for folder in folders[1:]:
                    if folder not in seen and os.path.lexists(folder) and not folder.is_dir():
                        _remove(folder)
                    seen.add(folder)
                if os.path.lexists(chunk) and not chunk.is_file():
                    _remove(chunk)

    def _chunks(self, block: Block) -> list[Path]:
        """Return the file of each output of a block."""
        shape = self.points.block_shape
        which = [one.start // size for one, size in zip(block.slices, shape, strict=True)]
        key = "/".join(map(str, ["c", *which, *([0] * len(self.job.dims))]))
        return [self.path / name / key for name in self.job.units]

    def places(self, block: Block) -> list[Array]:  # noqa: ARG002
        """Return nothing: the evaluating processes write to the store."""
        return []

    def _kept(self, block: Block) -> list[Array]:
        """Return the outputs of a block from disk, or nothing if they cannot be read."""
        try:
            return [zarr_group(self.store)[name][(*block.slices, ...)] for name in self.job.units]
        except (OSError, ValueError):
            return []

    def _sync(self, numbers: list[int]) -> None:
        blocks = self.points.blocks()
        for number in numbers:
            for chunk in self._chunks(blocks[number]):
                with suppress(FileNotFoundError):  # zarr writes no file if all values are NaN
                    sync_file(chunk)

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Mark the store as complete and open it; values are read when used."""
        assert self._journal is not None
        self._journal.flush()  # results must be on disk before they are said to be complete
        for cut_off in self.path.rglob("*.partial"):  # of a process that died while writing
            _remove(cut_off)
        group = load_zarr().open_group(self.store, mode="r+")
        by_block = [self.done[number].outputs for number in sorted(self.done)]
        by_output = dict(zip(self.job.units, zip(*by_block, strict=True), strict=True))
        group.attrs.update(attributes(self._run, notes))
        group.attrs[CHECKSUMS] = checksums(self.path, self._coordinates, by_output)
        sync_file(self.path / METADATA)
        self._journal.remove()
        return _opened(self.path)


@contextmanager
def kept_in(store: str | os.PathLike[str] | None) -> Iterator[None]:
    """Raise an OutputError if the system keeps a sweep from writing to its store."""
    if store is None:
        yield
        return
    try:
        place_of(Path(store))
        yield
    except (WearlawError, ConnectionError):
        raise
    except (OSError, ValueError) as error:
        code = getattr(error, "errno", None)
        if code is None and "null" not in str(error):  # no error of a file, but a timeout of a cluster
            raise
        advice = "make room, and add resume=True to go on" if code in FULL else "choose another folder"
        raise OutputError(f"store: cannot write to '{store}': {reason_of(error)}; {advice}") from None


def finished(job: Job, points: Points, path: Path, resume: bool) -> xarray.Dataset | None:
    """Return the finished results in a folder, or None if it is empty or holds an unfinished part to resume.

    Raises
    ------
    OutputError
        If the folder holds something else, or results without `resume`.
    """
    load_zarr()
    if path.is_symlink() and not path.exists():
        raise OutputError(
            f"store: {quoted(path)} is a link to {quoted(os.readlink(path))}, which does not exist; create that folder"
        )
    if path.exists() and not path.is_dir():
        raise OutputError(f"store: {quoted(path)} is a file, not a folder; choose another name, or remove it")
    if not path.is_dir() or not any(path.iterdir()):
        return None
    if os.path.lexists(_beside(path)):
        if not resume:
            raise OutputError(f"store: {quoted(path)} holds an unfinished sweep; add resume=True, or remove it")
        return None
    found = _attributes(path)
    if found.get("status") == INCOMPLETE:
        raise OutputError(
            f"store: {quoted(path)} holds an unfinished sweep whose journal {quoted(_beside(path))} is missing; remove"
            f" {quoted(path)} to start again"
        )
    if found.get("status") != COMPLETE or "provenance" not in found:
        raise OutputError(f"store: {quoted(path)} is not empty, and holds no sweep of wearlaw; choose another folder")
    if not resume:
        raise OutputError(f"store: {quoted(path)} holds the results of a sweep; choose another folder, or remove it")
    try:
        before = TypeAdapter(Run).validate_json(found["provenance"])
    except ValueError:
        raise OutputError(f"store: {_damaged(path)}") from None
    check_same(path, before, run_of(job, points))
    try:
        opened = _opened(path)
    except Exception:  # zarr and xarray raise many kinds
        raise OutputError(f"store: {_damaged(path)}") from None
    if not set(job.units) <= set(opened):
        raise OutputError(f"store: {_damaged(path)}")
    return opened


def _damaged(path: Path) -> str:
    return f"{quoted(path)} holds a complete sweep, but is damaged; remove it to start again"


def _remove(path: Path) -> None:
    """Remove a file or a folder, if there is one."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        with suppress(FileNotFoundError, NotADirectoryError):
            path.unlink()


def _beside(path: Path) -> Path:
    return path.with_name(f"{path.name}.journal")


def _attributes(path: Path) -> dict[str, Any]:
    zarr = load_zarr()
    try:
        return dict(zarr.open_group(str(path), mode="r").attrs)
    except (OSError, ValueError, KeyError):
        return {}


def _opened(path: Path) -> xarray.Dataset:
    found: xarray.Dataset = xarray.open_zarr(str(path), chunks=None, consolidated=False)
    found.attrs.pop(CHECKSUMS, None)
    return found


def dataset(points: Points, variables: Mapping[str, Array], job: Job) -> xarray.Dataset:
    """Return results, (points, *axes of the rig) each, as a dataset with the conditions as coordinates."""
    coordinates: dict[str, Any] = {**points.rows, **_labels(job)}
    for name, one in points.coordinates().items():
        if not one.on_disk:
            coordinates[name] = (one.dim, one.values, {"units": one.unit or ""})
    numbers = {name: _number(value) for name, value in points.fixed.items()}
    coordinates |= {name: number for name, number in numbers.items() if number is not None}
    data = {
        name: ((*points.dims, *job.dims), values.reshape(points.shape + job.own_shape), job.attributes(name))
        for name, values in variables.items()
    }
    others = {name: str(points.fixed[name]) for name, number in numbers.items() if number is None}
    return xarray.Dataset(data, coordinates, others)


def _labels(job: Job) -> dict[str, Any]:
    """Return the labels of the rig's own axes; zarr has a stable format only for texts of any length."""
    found = {}
    for name, labels in job.dims.items():
        integers = all(isinstance(label, int) for label in labels)
        found[name] = (name, np.array(labels, dtype=np.int64 if integers else object))
    return found


def _number(value: Any) -> Any:
    """Return a condition as a scalar coordinate, or None for a law of friction."""
    if is_friction_law(value):
        return None
    quantity = parse(value) if isinstance(value, str) else value
    if isinstance(quantity, pint.Quantity):
        return (), float(quantity.magnitude), {"units": symbol(quantity.units, "~C")}
    return (), float(quantity), {"units": ""}


def damage(damaged: int, listed: int, where: Path) -> str:
    """Return the message about damaged blocks on disk."""
    return f"{damaged} of the {listed} blocks kept in {quoted(where)} were damaged, and are computed again"


def attributes(run: Run, notes: Sequence[str]) -> dict[str, str]:
    """Return the attributes of finished results: status, provenance, and remarks for the reader."""
    return {"status": COMPLETE, "provenance": json.dumps(run), "notes": "\n".join(notes)}


def check_memory(size: int, advice: str) -> None:
    """Raise an error if results do not fit into memory, if its size is known.

    Raises
    ------
    InputError
        If they do not; the message says how much they need.
    """
    there = available_memory()
    if there is not None and size > there:
        raise InputError(
            f"the results need {size / GIB:.3g} GiB of memory, but {there / GIB:.3g} GiB are free; {advice}"
        )


def check_disk(size: int, path: Path) -> None:
    """Raise an error if the results do not fit on the disk.

    Raises
    ------
    InputError
        If they do not; the message says how much they need.
    """
    nearest = next(parent for parent in (path.absolute(), *path.absolute().parents) if parent.exists())
    there = shutil.disk_usage(nearest).free
    if size > there:
        raise InputError(
            f"the results need {size / GIB:.3g} GiB on disk, but {quoted(nearest)} has {there / GIB:.3g} GiB free;"
            " choose another disk, fewer outputs or fewer points"
        )


def set_size(path: Path, size: int) -> None:
    """Cut a file to a size, or extend it by zeros that have their room on the disk.

    Raises
    ------
    OSError
        If the disk is full.
    """
    with path.open("rb+") as file:
        file.truncate(min(size, file.seek(0, os.SEEK_END)))
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size)
        else:
            for start in range(file.tell(), size, PIECE):
                file.write(bytes(min(PIECE, size - start)))


def available_memory() -> int | None:
    """Return the available memory in bytes, or None if the system does not say."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration):
        pass
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return None
