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

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import is_friction_law
from wearlaw.errors import InputError, OutputError, WearlawError
from wearlaw.settings.text_files import reason_of
from wearlaw.sweeping.evaluation import BlockRecord, Job, checksum, load_zarr, zarr_group
from wearlaw.sweeping.journal import Journal, Run, check_same, run_of, sync_file
from wearlaw.sweeping.points import ITEM, Block, Points
from wearlaw.units.quantities import parse
from wearlaw.units.registry import symbol

GIB = 2.0**30

PIECE = 2**20
"""Bytes written at a time."""

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Errors of a full disk: no room, a quota, or a limit on the size of a file."""

JOURNAL = "journal"
"""Name of the journal in a folder of results."""

METADATA = "zarr.json"
"""Name of the file that describes a group or an array in a zarr store."""

COMPLETE, INCOMPLETE = "complete", "incomplete"
"""Values of the attribute "status" of results."""


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
        """Use a journal, and accept its blocks whose results on disk are undamaged."""
        self._journal = journal
        blocks = {block.number: block for block in self.points.blocks()}
        for number, seen in journal.done.items():
            if number in blocks and checksum(seen, self._kept(blocks[number])) == seen.checksum:
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
        known = path.exists()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            journal = Journal.resume(path, run, folder, self._sync) if known else Journal.begin(path, run, self._sync)
            self._maps = {name: self._mapped(folder / f"{name}.f64") for name in job.units}
        except OutputError:
            raise
        except OSError as error:
            if not known:
                shutil.rmtree(folder, ignore_errors=True)  # so that the disk is not full of files without a result
            where = error.filename or folder
            full = error.errno in FULL
            advice = "make room, and add --resume to go on" if full else f"remove '{folder}' to start again"
            raise OutputError(
                f"output: finished blocks cannot be kept in '{where}': {error.strerror or error}; {advice}"
            ) from None
        self.arrays = dict(self._maps)
        self._take_over(journal)

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
        if resume and beside.exists():
            journal = Journal.resume(beside, self._run, path, self._sync)
        else:
            kept = sum(one.values.size for one in points.coordinates().values() if one.on_disk)
            check_disk(self.size + kept * ITEM, path)
            path.parent.mkdir(parents=True, exist_ok=True)
            journal = Journal.begin(beside, self._run, self._sync)
        self._lay_out()
        self._take_over(journal)

    def _lay_out(self) -> None:
        """Write the layout of the store anew, without results: an existing layout may be damaged."""
        empty = dataset(self.points, {}, self.job).assign_attrs(status=INCOMPLETE)
        large = {name: one for name, one in self.points.coordinates().items() if one.on_disk}
        for name in (*map(str, empty.coords), *large):
            shutil.rmtree(self.path / name, ignore_errors=True)
        for name in ("", *self.job.units):
            (self.path / name / METADATA).unlink(missing_ok=True)
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
        for name in self.job.units:
            array = zarr_group(self.store)[name]
            for number in numbers:
                shape = self.points.block_shape
                which = [one.start // size for one, size in zip(blocks[number].slices, shape, strict=True)]
                which += [0] * len(self.job.dims)
                with suppress(FileNotFoundError):  # zarr writes no file if all values are NaN
                    sync_file(self.path / name / array.metadata.encode_chunk_key(tuple(which)))

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Mark the store as complete and open it; values are read when used."""
        for cut_off in self.path.rglob("*.partial"):  # of a worker that died while writing
            cut_off.unlink()
        load_zarr().open_group(self.store, mode="r+").attrs.update(attributes(self._run, notes))
        assert self._journal is not None
        self._journal.remove()
        return _opened(self.path)


def place_of(folder: Path) -> Path:
    """Return the path of a folder without links in it, after checks of whether it can be made.

    Raises
    ------
    OSError
        If it cannot, since a name is too long, links lead in a circle, or something above it is no folder.
    ValueError
        If a name has a null character.
    """
    try:
        target = folder.resolve()
    except RuntimeError:  # before Python 3.13
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP)) from None
    there = next(parent for parent in (target, *target.parents) if os.path.lexists(parent))
    for path in (target, *(there / name for name in target.relative_to(there).parts)):
        with suppress(FileNotFoundError):
            os.stat(path)
    return target


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
            f"store: '{path}' is a link to '{os.readlink(path)}', which does not exist; create that folder"
        )
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
    zarr = load_zarr()
    try:
        return dict(zarr.open_group(str(path), mode="r").attrs)
    except (OSError, ValueError, KeyError):
        return {}


def _opened(path: Path) -> xarray.Dataset:
    found: xarray.Dataset = xarray.open_zarr(str(path), chunks=None, consolidated=False)
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
    return f"{damaged} of the {listed} blocks kept in '{where}' were damaged, and are computed again"


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
            f"the results need {size / GIB:.3g} GiB on disk, but '{nearest}' has {there / GIB:.3g} GiB free;"
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
