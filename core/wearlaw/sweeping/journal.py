"""The journal of a sweep on disk: a file with a description of the sweep, and a line for each finished block."""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any, Self

import pint
from pydantic import TypeAdapter

from wearlaw.arrays.kernels import WORTHWHILE, accelerated
from wearlaw.errors import PATH, OutputError, excerpt, quoted, with_problems
from wearlaw.models.contact_model import Model
from wearlaw.plugins import loader
from wearlaw.settings.configuration import parts
from wearlaw.sweeping.evaluation import BlockRecord, Job
from wearlaw.sweeping.lock import open_locked
from wearlaw.sweeping.points import BLOCK, Points, Varying
from wearlaw.units.quantities import text_of
from wearlaw.version import __version__

Run = dict[str, Any]
"""Description of a sweep as JSON; sweeps with equal descriptions give the same bytes."""

SYNC_S = 1.0
"""Seconds between two syncs to disk; a crash loses the blocks since the last one."""


def run_of(job: Job, points: Points) -> Run:
    """Return the description of a sweep: all that determines its results, including versions and blocks."""
    found = loader.installed()
    provided = {}
    for part in parts(job.pipeline):
        if isinstance(part, Model):
            provided[f"{part.kind} {part.name}"] = found.of_kind(part.kind).distribution(part.name, type(part))
    varying = {name: _summary(one) for name, one in points.varying.items()}
    run = {
        "wearlaw": __version__,
        "plugins": provided,
        "kernels": "compiled" if accelerated(WORTHWHILE) else "NumPy",
        "predict": job.pipeline.model_dump(mode="json"),
        "conditions": {name: _text(value) for name, value in points.fixed.items()} | varying,
        "outputs": dict(job.units),
        "blocks": list(points.block_shape),
    }
    if points.kept:
        run["kept"] = {name: _summary(one) for name, one in points.kept.items()}
    if job.dims:
        run["axes"] = {name: list(labels) for name, labels in job.dims.items()}
    as_read: Run = json.loads(json.dumps(run))
    return as_read


def _text(value: object) -> str:
    """Return a condition as text with all its digits."""
    return text_of(value) if isinstance(value, pint.Quantity) else str(value)


def _summary(one: Varying) -> str:
    digest = hashlib.sha256()
    for start in range(0, one.values.size, BLOCK):
        digest.update(one.values[start : start + BLOCK].data)
    first, last = (float(one.values[part][0]) for part in (slice(1), slice(-1, None)))
    ends = f"{first:g} to {last:g} {one.unit or ''}".rstrip()
    origin = f", {one.origin}" if one.origin else ""
    return f"{one.values.size} values, {ends}, along {one.dim}{origin}, checksum {digest.hexdigest()[:16]}"


def check_same(where: Path, before: Run, now: Run, journal: Path | None = None) -> None:
    """Raise an error unless an interrupted sweep is the same as this one.

    Parameters
    ----------
    where : Path
        The folder of the interrupted sweep.
    before, now : dict
        The descriptions of both.
    journal : Path, optional
        The journal of the interrupted sweep, if it is not in the folder.

    Raises
    ------
    OutputError
        If they differ; the message lists the changes.
    """
    changes = list(_changes("", before, now))
    if changes:
        head = f"{quoted(where)} holds another run and cannot be resumed, since these have changed:"
        raise OutputError(
            with_problems(head, changes)
            + f"\nChange them back, choose another place, or remove {_both(where, journal)} to start again"
        )


def _both(where: Path, journal: Path | None) -> str:
    return (
        f"{quoted(where)}" if journal is None or where in journal.parents else f"{quoted(journal)} and {quoted(where)}"
    )


def _changes(path: str, before: Any, now: Any) -> Iterator[str]:
    if isinstance(before, list) and isinstance(now, list):
        before, now = ({str(number): one for number, one in enumerate(each)} for each in (before, now))
    if isinstance(before, dict) and isinstance(now, dict):
        for key in dict.fromkeys([*before, *now]):
            yield from _changes(f"{path}.{key}" if path else key, before.get(key, "nothing"), now.get(key, "nothing"))
    elif before != now:
        yield f"{excerpt(path)}: was {_cut(before)}, is {_cut(now)}".replace("**2", "²").replace("**3", "³")


def _cut(value: Any) -> str:
    """Return the text of a value in a journal, cut if it is longer than those of a sweep: the file may be damaged."""
    return str(value) if len(str(value)) <= PATH else excerpt(value)


def write_whole(path: Path, text: str) -> None:
    """Write a file whole or not at all, even if the machine crashes."""
    beside = path.with_name(f"{path.name}.partial")
    beside.write_text(text, encoding="utf-8")
    sync_file(beside)
    beside.replace(path)


def _append(file: IO[bytes], text: str) -> None:
    """Write text at the end of a file, and wait until it is on disk."""
    file.write(text.encode())
    file.flush()
    os.fsync(file.fileno())


def sync_file(path: Path) -> None:
    """Wait until a file is on disk."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())


def _spoilt(path: Path, where: Path) -> OutputError:
    return OutputError(
        f"{quoted(path)} is not the journal of a sweep that can be resumed; remove it and {quoted(where)} to"
        " start again"
    )


class Journal:
    """The list of finished blocks, on disk.

    The line of a block is written after its results, in a thread of its own.

    Parameters
    ----------
    path : Path
    file : binary file
        The file there; no other process has it.
    done : dict of int to BlockRecord
        The blocks listed so far.
    sync : callable
        Called with the numbers of some blocks, to wait until their results are on disk.
    """

    def __init__(
        self, path: Path, file: IO[bytes], done: Mapping[int, BlockRecord], sync: Callable[[list[int]], None]
    ) -> None:
        self.path = path
        self._file = file
        self.done = dict(done)
        self._sync = sync
        self._waiting: dict[int, BlockRecord] = {}
        self._thread = ThreadPoolExecutor(1)
        self._writing: Future[None] | None = None
        self._due = time.monotonic() + SYNC_S

    @classmethod
    def begin(cls, path: Path, run: Run, sync: Callable[[list[int]], None]) -> Self:
        """Return a new journal without blocks.

        Raises
        ------
        OutputError
            If another process has the journal.
        """
        file = open_locked(path, create=True)
        try:
            file.truncate(0)
            _append(file, json.dumps(run) + "\n")
        except BaseException:
            file.close()
            raise
        return cls(path, file, {}, sync)

    @classmethod
    def resume(cls, path: Path, run: Run, where: Path, sync: Callable[[list[int]], None]) -> Self:
        """Return the journal of the sweep in `where`, without a last line that was cut off.

        Raises
        ------
        OutputError
            If the journal is damaged or belongs to another run, or another process has it.
        """
        if not path.is_file():
            raise _spoilt(path, where)
        file = open_locked(path)
        try:
            return cls(path, file, cls._read(file, path, run, where), sync)
        except BaseException:
            file.close()
            raise

    @staticmethod
    def _read(file: IO[bytes], path: Path, run: Run, where: Path) -> dict[int, BlockRecord]:
        """Return the records in a journal and cut off a last line that is not whole."""
        text = file.read()
        whole = text[: text.rfind(b"\n") + 1]
        try:
            head, *lines = whole.splitlines()
            before = TypeAdapter(Run).validate_json(head)
            line_type = TypeAdapter(tuple[int, BlockRecord])
            done = dict(line_type.validate_json(line, strict=True) for line in lines)
        except ValueError:
            raise _spoilt(path, where) from None
        check_same(where, before, run, path)
        if len(whole) < len(text):
            file.truncate(len(whole))
        file.seek(len(whole))
        return done

    def add(self, number: int, seen: BlockRecord) -> None:
        """Add a finished block; its line is written a little later."""
        self._waiting[number] = seen
        if time.monotonic() >= self._due and (self._writing is None or self._writing.done()):
            self._wait()
            self._writing = self._thread.submit(self._write, self._waiting)
            self._waiting, self._due = {}, time.monotonic() + SYNC_S

    def _wait(self) -> None:
        """Wait for the lines that are being written; raise their error, if any."""
        if self._writing is not None:
            self._writing.result()

    def _write(self, blocks: Mapping[int, BlockRecord]) -> None:
        """Write the lines of blocks after their results are on disk.

        Raises
        ------
        OutputError
            If lines or results cannot be written.
        """
        try:
            self._sync(list(blocks))
            lines = (json.dumps([number, asdict(seen)]) + "\n" for number, seen in blocks.items())
            _append(self._file, "".join(lines))
        except OSError as error:
            raise OutputError(
                f"{quoted(self.path)}: finished blocks cannot be kept: {error.strerror or error}"
            ) from None

    def close(self) -> None:
        """Write the remaining lines; the file stays."""
        try:
            self.flush()
        finally:
            self._thread.shutdown()
            self._file.close()

    def flush(self) -> None:
        """Write the remaining lines."""
        self._wait()
        waiting, self._waiting = self._waiting, {}
        if waiting:
            self._write(waiting)

    def remove(self) -> None:
        """Remove the file of a finished sweep."""
        if os.name == "nt":  # where a file in use cannot be removed
            self.close()
            self.path.unlink()
        else:  # while it is locked, so that nobody goes on with it
            self.path.unlink()
            self.close()
