"""Checks that finished results are as they were written."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from wearlaw.errors import OutputError, excerpt, quoted
from wearlaw.output.manifest import MANIFEST, read_manifest
from wearlaw.sweeping.checkpoint import RUN
from wearlaw.sweeping.file_sums import Differences, differences
from wearlaw.sweeping.store_sums import METADATA, verify_store

MOST = 10
"""Most files of a kind that a message lists."""


def verify(folder: Path) -> list[str]:
    """Return lines that say what was found unchanged, and which files were added.

    Parameters
    ----------
    folder : Path
        Results of a command, or the store of a sweep.

    Raises
    ------
    OutputError
        If a file is missing or changed, or the folder holds no finished results with checksums.
    """
    if (folder / RUN).is_file():
        raise OutputError(
            f"{quoted(folder)} holds an unfinished run; the same wearlaw run with --resume goes on with it"
        )
    if not folder.is_dir():
        unfinished = folder.with_name(f"{folder.name}.partial")
        there = f"; {quoted(unfinished)} holds an unfinished run" if (unfinished / RUN).is_file() else ""
        raise OutputError(f"{quoted(folder)} is {'not a folder' if folder.exists() else 'not there'}{there}")
    try:
        if (folder / METADATA).exists() and not (folder / MANIFEST).exists():
            (what, found), again = verify_store(folder), "remove it and sweep again"
        else:
            (what, found), again = _verify_files(folder), "run the command again with --overwrite"
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{quoted(error.filename or folder)} cannot be read: {error.strerror or error}") from None
    if found.missing or found.changed:
        raise OutputError(
            "\n".join([f"{quoted(folder)} is not as it was written:", *_lines(found), f"To repair it, {again}"])
        )
    return [f"{excerpt(folder)}: all as written, {what}", *_lines(found)]


def _verify_files(folder: Path) -> tuple[str, Differences]:
    """Return what was compared in a folder of results, in words, and how it differs from what was written."""
    manifest = read_manifest(folder)
    if manifest is None:
        why = "is damaged" if (folder / MANIFEST).exists() else "is missing"
        raise OutputError(f"{quoted(folder)} holds no results of wearlaw that can be verified: its {MANIFEST} {why}")
    sums = {name: one for name, one in manifest.files.items() if one is not None}
    if len(sums) < len(manifest.files):
        missing = [name for name in manifest.files if not (folder / name).exists()]
        there = (
            "\n".join(["some of its files are missing:", *_lines(Differences(missing))])
            if missing
            else "no file is missing"
        )
        raise OutputError(
            f"{quoted(folder)} was written by an earlier wearlaw ({manifest.wearlaw}), whose {MANIFEST} holds no"
            f" checksums, so that changes cannot be found; {there}"
        )
    found = differences(folder, sums)
    found.added.remove(MANIFEST)
    return f"{len(sums)} files of wearlaw {manifest.wearlaw}", found


def _lines(found: Differences) -> Iterator[str]:
    for kind, names in {"missing": found.missing, "changed": found.changed, "added": found.added}.items():
        yield from (f"  {kind}: {excerpt(name)}" for name in names[:MOST])
        if len(names) > MOST:
            yield f"  {kind}: {len(names) - MOST} more"
