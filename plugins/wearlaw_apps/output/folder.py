"""A folder of results: written beside its place and moved there file by file, without harm to other files."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

import click

from wearlaw.errors import InputError, OutputError, shown, with_problems
from wearlaw.text_files import MIB, read_text, reason_of

FILES = ".wearlaw-files"
"""List of the files that a command wrote into a folder; another run replaces and removes no others."""

BESIDE = ".wearlaw-new-"
"""Beginning of the name of a folder that is being filled."""


@contextmanager
def results_folder(folder: Path, overwrite: bool, marker: str) -> Iterator[Path]:
    """Yield an empty folder whose files move into `folder` on success.

    Parameters
    ----------
    folder : Path
        A folder that is empty, does not exist, or holds earlier results to replace.
    overwrite : bool
        Whether to replace the files of earlier results. Other files stay, and so does anything that is listed but is no
        file inside the folder, such as a link; a note says so.
    marker : str
        A file that all results of this kind have, to recognise earlier ones.

    Raises
    ------
    OutputError
        If `folder` cannot be written or holds something that must not be overwritten.
    """
    made: list[Path] = []
    try:
        if folder.is_file():
            raise OutputError(f"output: {shown(folder)} is a file, not a folder; choose another with -o")
        _earlier(folder, overwrite, marker)
        made = [path for path in (folder, *folder.parents) if not path.exists()]
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(prefix=BESIDE, dir=folder) as temporary:
            yield Path(temporary)
            _move(Path(temporary), folder, _earlier(folder, overwrite, marker))  # another run may have come first
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(
            f"output: cannot write to {shown(folder)}: {reason_of(error)}; choose another folder with -o"
        ) from None
    finally:
        for path in made:
            with suppress(OSError):  # it holds the results
                path.rmdir()


def _earlier(folder: Path, overwrite: bool, marker: str) -> list[str]:
    """Return the files of the earlier results that are to be replaced."""
    if not folder.is_dir() or all(file.name.startswith(BESIDE) for file in folder.iterdir()):
        return []
    listed = folder / FILES
    try:
        files = read_text(listed, MIB).splitlines() if listed.is_file() else []
    except InputError as error:
        raise OutputError(f"output: cannot read {shown(listed)}: {error}; choose another folder with -o") from None
    if marker not in files:
        what = "holds results of another command" if files else f"does not hold results of wearlaw (no {FILES})"
        raise OutputError(f"output: {shown(folder)} {what}, and will not be overwritten; choose another folder with -o")
    if not overwrite:
        raise OutputError(f"output: {shown(folder)} is not empty; choose another folder with -o, or add --overwrite")
    return files


def _move(new: Path, folder: Path, earlier: list[str]) -> None:
    files = sorted(path.relative_to(new).as_posix() for path in new.rglob("*") if path.is_file())
    there = {name: _what_is(folder, name) for name in [*files, *earlier]}
    for name in files:
        if there[name] == "other" or (there[name] == "file" and name not in earlier):
            raise OutputError(
                f"output: {shown(folder / name)} cannot be written, since something that wearlaw did not write is in"
                " its place; move that, or choose another folder with -o"
            )
    (new / FILES).write_text("".join(f"{name}\n" for name in files), encoding="utf-8")
    for name in {*earlier}.difference(files):
        if there[name] == "file":
            (folder / name).unlink()
    for name in [*files, FILES]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(new / name, folder / name)
    if ignored := [shown(name) for name in earlier if there[name] == "other"]:
        head = f"note: {FILES} in {shown(folder)} listed what is not a file inside the folder; it was left alone:"
        click.echo(with_problems(head, ignored), err=True)


def _what_is(folder: Path, name: str) -> Literal["file", "nothing", "other"]:
    """Return what a name is inside a folder; other are folders, links, and what lies outside or beyond a link."""
    path = Path(name)
    if path.anchor:  # Windows would ask another computer for "//computer/..."
        return "other"
    try:
        if (folder / path).parent.resolve() != folder.resolve() / path.parent:
            return "other"
        return "file" if stat.S_ISREG(os.lstat(folder / path).st_mode) else "other"
    except FileNotFoundError:
        return "nothing"
    except (OSError, ValueError, RuntimeError):  # a file in place of a folder, no possible name, a circle of links
        return "other"
