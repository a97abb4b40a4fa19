"""What a sweep on disk has done so far: a file with a line for each block, headed by what the sweep is."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Self

import pint

from wearlaw import plugins
from wearlaw.configuration import parts
from wearlaw.errors import OutputError
from wearlaw.kernels import WORTHWHILE, accelerated
from wearlaw.models import WearLaw
from wearlaw.shelf import Shelf
from wearlaw.sweeping.evaluation import Job, Seen
from wearlaw.sweeping.points import Points, Varying
from wearlaw.tangential import Model
from wearlaw.units import text_of
from wearlaw.version import __version__

Run = dict[str, Any]
"""What a sweep is, as JSON holds it: two of the same `Run` give the same bytes."""


def run_of(job: Job, points: Points) -> Run:
    """Return what decides about the results of a sweep: versions, pipeline, conditions, outputs and blocks."""
    found = plugins.installed()
    provided = {}
    for part in parts(job.pipeline):
        if isinstance(part, Model):
            shelf: Shelf[Any] = found.wear_laws if isinstance(part, WearLaw) else found.contact_models
            provided[f"{shelf.kind} {part.name}"] = shelf.distribution(part.name, type(part))
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
    if isinstance(before, dict) and isinstance(now, dict):
        for key in dict.fromkeys([*before, *now]):
            yield from _changes(f"{path}.{key}" if path else key, before.get(key, "nothing"), now.get(key, "nothing"))
    elif before != now:
        yield f"{path}: was {before}, is {now}".replace("**2", "²").replace("**3", "³")


def write_whole(path: Path, text: str) -> None:
    """Write a file that is there whole or not at all, also if the process is killed."""
    beside = path.with_name(f"{path.name}.partial")
    beside.write_text(text, encoding="utf-8")
    beside.replace(path)


class Journal:
    """The record of the blocks that are done, on disk.

    Attributes
    ----------
    path : Path
    done : dict of int to Seen
        What was seen of each block that was done when it was opened.
    """

    def __init__(self, path: Path, done: Mapping[int, Seen]) -> None:
        self.path = path
        self.done = dict(done)
        self._file = path.open("a", encoding="utf-8")

    @classmethod
    def begin(cls, path: Path, run: Run) -> Self:
        """Return a journal in which nothing is done yet."""
        write_whole(path, json.dumps(run) + "\n")
        return cls(path, {})

    @classmethod
    def resume(cls, path: Path, run: Run, where: Path) -> Self:
        """Return a journal that goes on, with the last line left out if it was cut off.

        Raises
        ------
        OutputError
            If it is that of another run.
        """
        text = path.read_bytes()
        whole = text[: text.rfind(b"\n") + 1]
        try:
            before, *lines = map(json.loads, whole.splitlines())
            done = {line.pop("block"): Seen(**line) for line in lines}
        except (ValueError, TypeError, KeyError):
            raise OutputError(f"'{path}' is no record of a sweep; remove it, and what it belongs to") from None
        check_same(where, before, run)
        if len(whole) < len(text):
            os.truncate(path, len(whole))
        return cls(path, done)

    def add(self, number: int, seen: Seen) -> None:
        """Take note that a block is done."""
        self._file.write(json.dumps({"block": number, **asdict(seen)}) + "\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file, which stays."""
        self._file.close()

    def remove(self) -> None:
        """Remove the file when all is done."""
        self._file.close()
        self.path.unlink()
