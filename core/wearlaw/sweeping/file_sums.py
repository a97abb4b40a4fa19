"""Sizes and checksums of files, to tell later whether they are as they were written."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class FileSum:
    """Size of a file and the SHA-256 of its bytes."""

    bytes: int
    sha256: str


@dataclass
class Differences:
    """Names of the files that are missing, changed or added since a folder was written.

    Names are relative to the folder. Those of changed files are followed by what is seen of the change.
    """

    missing: list[str] = field(default_factory=list)
    changed: list[str] = field(default_factory=list)
    added: list[str] = field(default_factory=list)


def file_names(folder: Path) -> list[str]:
    """Return the names of all files below a folder."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir())


def file_sums(folder: Path, names: Iterable[str]) -> dict[str, FileSum]:
    """Return the sums of files in a folder by their names."""
    return {name: _file_sum(folder / name) for name in names}


def _file_sum(path: Path) -> FileSum:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256")
        return FileSum(file.tell(), digest.hexdigest())


def differences(folder: Path, sums: Mapping[str, FileSum]) -> Differences:
    """Compare the files in a folder with their sums."""
    found = Differences()
    for name, before in sums.items():
        seen = change(folder / name, before)
        if seen is None:
            found.missing.append(name)
        elif seen:
            found.changed.append(f"{name} ({seen})")
    found.added += [name for name in file_names(folder) if name not in sums]
    return found


def change(path: Path, before: FileSum) -> str | None:
    """Return what is seen of the change of a file, "" if there is none, or None if the file is missing."""
    if not path.exists():
        return None
    if not path.is_file():
        return "no longer a file"
    try:
        now = _file_sum(path)
    except OSError as error:
        return f"cannot be read: {error.strerror or error}"
    if now.bytes != before.bytes:
        return f"was {before.bytes} bytes, is {now.bytes}"
    return "other bytes" if now != before else ""
