"""What a sweep on disk has done so far: a file with a line for each block, headed by what the sweep is."""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any, Self

import pint
from pydantic import TypeAdapter

from wearlaw.arrays.kernels import WORTHWHILE, accelerated
from wearlaw.errors import OutputError
from wearlaw.models.contact_model import Model
from wearlaw.plugins import loader
from wearlaw.settings.configuration import parts
from wearlaw.sweeping.evaluation import BlockRecord, Job
from wearlaw.sweeping.points import Points, Varying
from wearlaw.units.quantities import text_of
from wearlaw.version import __version__

Run = dict[str, Any]
"""What a sweep is, as JSON holds it: two of the same `Run` give the same bytes."""

SYNC_S = 1.0
"""Seconds between two times that results are forced to disk; a crash loses the blocks since the last."""


def run_of(job: Job, points: Points) -> Run:
    """Return what decides about the results of a sweep: versions, pipeline, conditions, outputs and blocks."""
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
    as_read: Run = json.loads(json.dumps(run))
    return as_read


def _text(value: object) -> str:
    """Return a condition as text with all its digits."""
    return text_of(value) if isinstance(value, pint.Quantity) else str(value)


def _summary(one: Varying) -> str:
    digest = hashlib.sha256(one.values.tobytes()).hexdigest()[:16]
    ends = f"{one.values[0]:g} to {one.values[-1]:g} {one.unit or ''}".rstrip()
    return f"{one.values.size} values, {ends}, along {one.dim}, checksum {digest}"


def check_same(where: Path, before: Run, now: Run) -> None:
    """Refuse to go on with a sweep that is another one.

    Raises
    ------
    OutputError
        With all that has changed.
    """
    changes = list(_changes("", before, now))
    if changes:
        raise OutputError(
            f"'{where}' holds another run, which cannot be resumed, since these have changed:"
            + "".join(f"\n  {change}" for change in changes)
            + "\nChange them back, or choose another place"
        )


def _changes(path: str, before: Any, now: Any) -> Iterator[str]:
    if isinstance(before, list) and isinstance(now, list):
        before, now = ({str(number): one for number, one in enumerate(each)} for each in (before, now))
    if isinstance(before, dict) and isinstance(now, dict):
        for key in dict.fromkeys([*before, *now]):
            yield from _changes(f"{path}.{key}" if path else key, before.get(key, "nothing"), now.get(key, "nothing"))
    elif before != now:
        yield f"{path}: was {before}, is {now}".replace("**2", "²").replace("**3", "³")


def write_whole(path: Path, text: str) -> None:
    """Write a file that is there whole or not at all, even after a crash of the machine."""
    beside = path.with_name(f"{path.name}.partial")
    beside.write_text(text, encoding="utf-8")
    sync_file(beside)
    beside.replace(path)


def sync_file(path: Path) -> None:
    """Wait until a file is on disk."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())


class Journal:
    """The record of the blocks that are done, on disk.

    A line follows the results of its block to disk, in a thread that does not hold up the sweep.

    Parameters
    ----------
    path : Path
    done : dict of int to BlockRecord
        The blocks that it lists.
    sync : callable
        Called with the numbers of some blocks; waits until their results are on disk.
    """

    def __init__(self, path: Path, done: Mapping[int, BlockRecord], sync: Callable[[list[int]], None]) -> None:
        self.path = path
        self.done = dict(done)
        self._sync = sync
        self._waiting: dict[int, BlockRecord] = {}
        self._thread = ThreadPoolExecutor(1)
        self._writing: Future[None] | None = None
        self._due = time.monotonic() + SYNC_S

    @classmethod
    def begin(cls, path: Path, run: Run, sync: Callable[[list[int]], None]) -> Self:
        """Return a journal in which nothing is done yet."""
        write_whole(path, json.dumps(run) + "\n")
        return cls(path, {}, sync)

    @classmethod
    def resume(cls, path: Path, run: Run, where: Path, sync: Callable[[list[int]], None]) -> Self:
        """Return the journal of the sweep in `where`, with the last line left out if it was cut off.

        Raises
        ------
        OutputError
            If it is damaged, or that of another run.
        """
        text = path.read_bytes()
        whole = text[: text.rfind(b"\n") + 1]
        try:
            head, *lines = whole.splitlines()
            before = TypeAdapter(Run).validate_json(head)
            line_type = TypeAdapter(tuple[int, BlockRecord])
            done = dict(line_type.validate_json(line, strict=True) for line in lines)
        except ValueError:
            raise OutputError(
                f"'{path}' is no record of a sweep that can be resumed; remove it and '{where}' to begin anew"
            ) from None
        check_same(where, before, run)
        if len(whole) < len(text):
            os.truncate(path, len(whole))
        return cls(path, done, sync)

    def add(self, number: int, seen: BlockRecord) -> None:
        """Take note that a block is done; its line is written a little later."""
        self._waiting[number] = seen
        if time.monotonic() >= self._due and (self._writing is None or self._writing.done()):
            self._wait()
            self._writing = self._thread.submit(self._write, self._waiting)
            self._waiting, self._due = {}, time.monotonic() + SYNC_S

    def _wait(self) -> None:
        """Wait for the lines that are being written, and raise what went wrong."""
        if self._writing is not None:
            self._writing.result()

    def _write(self, blocks: Mapping[int, BlockRecord]) -> None:
        """Write the lines of blocks once their results are on disk.

        Raises
        ------
        OutputError
            If either cannot be written.
        """
        try:
            self._sync(list(blocks))
            with self.path.open("a", encoding="utf-8") as file:
                file.writelines(json.dumps([number, asdict(seen)]) + "\n" for number, seen in blocks.items())
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise OutputError(f"'{self.path}': what is done cannot be kept: {error.strerror or error}") from None

    def close(self) -> None:
        """Write the lines that are left; the file stays."""
        try:
            self._wait()
            if self._waiting:
                self._write(self._waiting)
        finally:
            self._thread.shutdown()

    def remove(self) -> None:
        """Remove the file when all is done."""
        self._thread.shutdown()
        self._waiting = {}
        self.path.unlink()
