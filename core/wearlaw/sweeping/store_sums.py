"""Checksums in a finished zarr store, to tell later whether it is as it was written."""

from __future__ import annotations

import hashlib
import itertools
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from wearlaw.errors import OutputError, quoted
from wearlaw.sweeping.evaluation import checksum, load_zarr
from wearlaw.sweeping.file_sums import Differences, FileSum, change, differences, file_names, file_sums

METADATA = "zarr.json"
"""Name of the file that describes a group or an array in a zarr store."""

COMPLETE, INCOMPLETE = "complete", "incomplete"
"""Values of the attribute "status" of results."""

CHECKSUMS = "checksums"
"""Name of the attribute with the checksums of a store."""


@dataclass(frozen=True)
class StoreSums:
    """The checksums of a store.

    Attributes
    ----------
    outputs : dict of str to list of int
        For each output the CRC-32 of its blocks as they were evaluated, in the order of the blocks.
    files : dict of str to FileSum
        The sums of the other files: coordinates, and what describes the arrays.
    metadata : str
        SHA-256 of what describes the store, without these checksums.
    own : str
        SHA-256 of the sums above.
    """

    outputs: dict[str, list[int]]
    files: dict[str, FileSum]
    metadata: str
    own: str = ""


def checksums(path: Path, coordinates: Iterable[str], outputs: Mapping[str, Sequence[int]]) -> str:
    """Return the attribute with the checksums of a finished store, which does not have it yet.

    Parameters
    ----------
    path : Path
    coordinates : iterable of str
        The names of the coordinates.
    outputs : mapping of str to sequence of int
        The checksums of the blocks of each output.
    """
    files = [f"{name}/{file}" for name in coordinates for file in file_names(path / name)]
    files += [f"{name}/{METADATA}" for name in outputs]
    blocks = {name: list(sums) for name, sums in outputs.items()}
    described = _described(json.loads((path / METADATA).read_bytes()))
    found = StoreSums(blocks, file_sums(path, files), _sum_of(described))
    return json.dumps(asdict(replace(found, own=_sum_of(asdict(found)))), separators=(",", ":"))


def _described(metadata: Mapping[str, Any]) -> dict[str, Any]:
    """Return what describes a store, without its checksums."""
    attributes = {name: value for name, value in metadata["attributes"].items() if name != CHECKSUMS}
    return {**metadata, "attributes": attributes}


def _sum_of(values: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()


def verify_store(path: Path) -> tuple[str, Differences]:
    """Return what was compared in a finished store, in words, and how it differs from what was written.

    Raises
    ------
    OutputError
        If it is not a finished store with checksums.
    """
    try:
        metadata = json.loads((path / METADATA).read_bytes())
        attributes = metadata["attributes"]
        status = attributes.get("status")
    except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise OutputError(
            f"{quoted(path / METADATA)} is damaged ({error}); remove {quoted(path)} and sweep again"
        ) from None
    if status == INCOMPLETE:
        raise OutputError(f"{quoted(path)} holds an unfinished sweep; the same call with resume=True goes on with it")
    if status != COMPLETE:
        raise OutputError(f"{quoted(path)} holds no sweep of wearlaw")
    if CHECKSUMS not in attributes:
        raise OutputError(
            f"{quoted(path)} is complete, but was written by a version of wearlaw that kept no checksums in stores;"
            " remove it and sweep again to have them"
        )
    try:
        sums = TypeAdapter(StoreSums).validate_json(attributes[CHECKSUMS])
    except ValueError:
        sums = StoreSums({}, {}, "")
    if sums.own != _sum_of(asdict(replace(sums, own=""))):
        raise OutputError(
            f"{quoted(path / METADATA)} is damaged (its checksums); remove {quoted(path)} and sweep again"
        )
    found = differences(path, sums.files)
    if _sum_of(_described(metadata)) != sums.metadata:
        found.changed.append(f"{METADATA} (other bytes)")
    added = set(found.added) - {METADATA}
    for output, blocks in sums.outputs.items():
        chunks = {name for name in added if name.startswith(f"{output}/c/")}
        added -= chunks
        described = f"{output}/{METADATA}"
        if change(path / described, sums.files[described]) == "":  # else nobody knows where the blocks are
            added |= chunks - set(_compare(path, output, blocks, found))
    found.added = sorted(added)
    count = max(map(len, sums.outputs.values()))
    of_outputs = f"{_counted(count, 'block')} of {_counted(len(sums.outputs), 'output')}"
    return f"{of_outputs}, and {_counted(len(sums.files) + 1, 'other file')}", found


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def _compare(path: Path, output: str, blocks: Sequence[int], found: Differences) -> list[str]:
    """Compare the blocks of an output with their checksums, and return the names of their files."""
    array = load_zarr().open_array(str(path / output), mode="r")
    along = [range(math.ceil(size / step)) for size, step in zip(array.shape, array.chunks, strict=True)]
    names = []
    for which, before in zip(itertools.product(*along), blocks, strict=True):
        name = f"{output}/{array.metadata.encode_chunk_key(which)}"
        names.append(name)
        part = tuple(slice(n * step, (n + 1) * step) for n, step in zip(which, array.chunks, strict=True))
        there = (path / name).exists()
        try:
            if there and not (path / name).is_file():
                found.changed.append(f"{name} (no longer a file)")
            elif checksum(array[part]) != before:  # zarr writes no file if all values are NaN
                (found.changed if there else found.missing).append(f"{name} (other bytes)" if there else name)
        except (OSError, ValueError) as error:
            found.changed.append(f"{name} (cannot be read: {error})")
    return names
