"""The manifest of a folder of results: the files that wearlaw wrote, with their sizes and checksums."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from pydantic import TypeAdapter

from wearlaw.sweeping.file_sums import FileSum, file_names, file_sums
from wearlaw.version import __version__

MANIFEST = ".wearlaw.json"
"""Manifest of the files that wearlaw wrote into a folder; it replaces no others."""


@dataclass(frozen=True)
class Manifest:
    """The version that wrote a folder, and the sum of each file by its name; None in a folder of an earlier version."""

    files: Mapping[str, FileSum | None]
    wearlaw: str = "an unknown version"


def write_manifest(folder: Path) -> None:
    """Write the manifest of all files in a folder."""
    sums = file_sums(folder, file_names(folder))
    manifest = {"wearlaw": __version__, "files": {name: asdict(one) for name, one in sums.items()}}
    (folder / MANIFEST).write_text(json.dumps(manifest, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def read_manifest(folder: Path) -> Manifest | None:
    """Return the manifest of a folder, or None if there is none."""
    path = folder / MANIFEST
    if not path.is_file():
        return None
    try:
        found = json.loads(path.read_bytes())
        if isinstance(found["files"], list):  # as earlier versions wrote it
            found["files"] = dict.fromkeys(found["files"])
        return TypeAdapter(Manifest).validate_python(found)
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return None
