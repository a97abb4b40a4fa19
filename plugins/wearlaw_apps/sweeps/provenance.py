"""What determines the results of a sweep: recorded with them, and compared before a sweep is resumed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pint

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.errors import OutputError, shown, with_problems
from wearlaw.kernels import WORTHWHILE, accelerated
from wearlaw.models.model import Model
from wearlaw.units.quantities import text_of
from wearlaw.version import __version__
from wearlaw_apps.sweeps.evaluation import Job
from wearlaw_apps.sweeps.points import BLOCK, Points, Varying

Provenance = dict[str, Any]
"""All that determines the results of a sweep, as JSON."""


def provenance_of(job: Job, points: Points) -> Provenance:
    """Return versions, pipeline, conditions and outputs of a sweep; columns of numbers by their digest."""
    installed = loader.discovered()
    provided = {
        f"{part.kind} {part.name}": installed[part.kind].distribution(part.name, type(part))
        for part in parts(job.pipeline)
        if isinstance(part, Model)
    }
    varying = {name: _summary(column) for name, column in points.varying.items()}
    provenance: dict[str, Any] = {
        "wearlaw": __version__,
        "plugins": provided,
        "kernels": "compiled" if accelerated(WORTHWHILE) else "NumPy",
        "predict": job.pipeline.model_dump(mode="json"),
        "conditions": {name: _text(value) for name, value in points.fixed.items()} | varying,
        "outputs": dict(job.units),
    }
    if job.summed:  # in another order a sum is rounded otherwise
        provenance["blocks"] = list(points.block_shape)
    if points.kept:
        provenance["kept"] = {name: _summary(column) for name, column in points.kept.items()}
    provenance |= job.settings
    if job.dims:
        provenance["axes"] = {name: list(labels) for name, labels in job.dims.items()}
    as_read: Provenance = json.loads(json.dumps(provenance))
    return as_read


def _text(value: object) -> str:
    """Return a condition as text with all its digits."""
    return text_of(value) if isinstance(value, pint.Quantity) else str(value)


def _summary(column: Varying) -> str:
    origin = f", {column.origin}" if column.origin else ""
    return digest(column.values, column.unit, f", along {' and '.join(column.dims)}{origin}")


def digest(values: Array, unit: str | None, more: str = "") -> str:
    """Return what tells numbers from others: their count, ends and hash."""
    hashed = hashlib.sha256()
    for start in range(0, values.shape[0], BLOCK):
        hashed.update(values[start : start + BLOCK].data)
    first, last = (float(values[part].flat[place]) for part, place in ((slice(1), 0), (slice(-1, None), -1)))
    ends = f"{first:g} to {last:g} {unit or ''}".rstrip()
    return f"{values.size} values, {ends}{more}, SHA-256 {hashed.hexdigest()[:16]}"


def check_same(path: Path, before: Provenance, now: Provenance, subject: str) -> None:
    """Raise an error unless what a store holds, such as a "sweep", is the same as this one.

    Raises
    ------
    OutputError
        If they differ; the message lists the changes.
    """
    changes = list(_changes("", before, now))
    if changes:
        head = f"{shown(path)} holds another {subject} and cannot be resumed, since these have changed:"
        raise OutputError(
            with_problems(head, changes)
            + f"\nChange them back, choose another place, or remove {shown(path)} to start again"
        )


def _changes(field: str, before: Any, now: Any) -> Iterator[str]:
    if isinstance(before, list) and isinstance(now, list):
        before, now = ({str(number): value for number, value in enumerate(each)} for each in (before, now))
    if isinstance(before, dict) and isinstance(now, dict):
        for key in dict.fromkeys([*before, *now]):
            yield from _changes(f"{field}.{key}" if field else key, before.get(key, "nothing"), now.get(key, "nothing"))
    elif before != now:
        yield f"{field}: was {before}, is {now}".replace("**2", "²").replace("**3", "³")


def parts(value: object) -> Iterator[Configuration]:
    """Yield all configurations in a value: the value itself, and those in its fields at any depth."""
    inner: Iterable[object] = ()
    if isinstance(value, Configuration):
        yield value
        inner = (getattr(value, name) for name in type(value).model_fields)
    elif isinstance(value, (list, tuple)):
        inner = value
    for entry in inner:
        yield from parts(entry)
