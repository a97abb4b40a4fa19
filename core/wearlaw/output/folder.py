"""A folder of results: written whole or not at all, with a list of its files, without harm to other files."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from wearlaw.errors import OutputError, quoted
from wearlaw.output.manifest import MANIFEST, read_manifest, write_manifest
from wearlaw.output.temporary import Temporary, tidy_up
from wearlaw.settings.text_files import place_of, reason_of
from wearlaw.sweeping.file_sums import file_names


class ElsewhereError(OutputError):
    """The results are complete, but in another folder than the one asked for."""


@dataclass(frozen=True)
class _Earlier:
    """Earlier results, to be replaced.

    Attributes
    ----------
    files : frozenset of str
        The files that wearlaw wrote, relative to the folder.
    identity : tuple of int
        Inode and time of the manifest, to recognise the folder.
    """

    files: frozenset[str]
    identity: tuple[int, ...]


@contextmanager
def fresh_folder(folder: Path, overwrite: bool = False, marker: str | None = None) -> Iterator[Path]:
    """Yield a temporary folder that replaces `folder` on success.

    Parameters
    ----------
    folder : Path
        A folder that is empty, does not exist, or holds earlier results to replace.
    overwrite : bool
        Whether to replace the files listed in the manifest of earlier results. Other files stay.
    marker : str, optional
        A file that all results of this kind have, to recognise earlier ones. Without it no manifest is written.

    Raises
    ------
    OutputError
        At once, if `folder` cannot be written or holds something that must not be overwritten.
    ElsewhereError
        At the end, if something else has taken `folder` meanwhile, or one of the user's files in it has the name of a
        new one. The results are then in a folder beside it, which the message names.
    """
    with _os_errors_of(folder):
        target = place_of(folder)
        tidy_up(folder, target)
        earlier = _earlier(folder, target, overwrite, marker)
    temporary = Temporary(target)
    try:
        with _os_errors_of(folder):
            temporary.make()
        inside = temporary.fresh
        yield inside
        try:
            with _os_errors_of(folder):
                if marker is not None:
                    write_manifest(inside)
                if earlier is None:
                    _uninterrupted(lambda: _put(inside, folder, target))
                else:
                    _uninterrupted(lambda: _replace(inside, folder, target, temporary.replaced, earlier))
        except OutputError as error:
            beside = _put_beside(inside, target)
            if beside is None:
                raise
            raise ElsewhereError(f"{error}. The results are in {quoted(beside)}") from None
    finally:
        temporary.remove()


def _uninterrupted(step: Callable[[], None]) -> None:
    """Take a step to its end in a thread of its own: Ctrl-C interrupts the main thread only."""
    with ThreadPoolExecutor(1) as thread:
        thread.submit(step).result()


@contextmanager
def _os_errors_of(folder: Path) -> Iterator[None]:
    try:
        yield
    except OutputError:
        raise
    except (OSError, ValueError) as error:  # a ValueError is a null character in a name
        reason = reason_of(error)
        raise OutputError(
            f"output: cannot write to {quoted(folder)}: {reason}; choose another folder with -o"
        ) from None


def _earlier(folder: Path, target: Path, overwrite: bool, marker: str | None) -> _Earlier | None:
    """Return the earlier results to replace, or None if the place is free."""
    if not target.exists():
        return None
    if not target.is_dir():
        raise OutputError(f"output: {quoted(folder)} is a file, not a folder; choose another with -o")
    if Path.cwd().is_relative_to(target):
        raise OutputError(f"output: {quoted(folder)} is the working folder or above it; choose another folder with -o")
    if os.path.ismount(target):
        raise OutputError(f"output: {quoted(folder)} is the top of a disk; choose a folder in it with -o")
    if not any(target.iterdir()):
        return None
    files = _listed(target)
    if marker not in files:
        what = "holds results of another command" if files else f"does not hold results of wearlaw (no {MANIFEST})"
        raise OutputError(
            f"output: {quoted(folder)} {what}, and will not be overwritten; choose another folder with -o"
        )
    if not overwrite:
        raise OutputError(f"output: {quoted(folder)} is not empty; choose another folder with -o, or add --overwrite")
    known = identity(target)
    return None if known is None else _Earlier(files, known)


def _listed(folder: Path) -> frozenset[str]:
    """Return the files in a folder's manifest and the manifest itself, or none without one."""
    found = read_manifest(folder)
    return frozenset() if found is None else frozenset([MANIFEST, *found.files])


def identity(folder: Path) -> tuple[int, ...] | None:
    """Return inode and time of a folder's manifest, or None without one."""
    try:
        found = (folder / MANIFEST).stat()
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def _taken(folder: Path) -> OutputError:
    return OutputError(f"output: {quoted(folder)} was meanwhile taken by another run or program, and is left unchanged")


def _put(inside: Path, folder: Path, target: Path) -> None:
    """Move new results to a place that was free, unless something else is there now."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        with suppress(FileNotFoundError):
            target.rmdir()  # an empty folder, which Windows does not replace
        inside.rename(target)
    except OSError:
        if os.path.lexists(target):
            raise _taken(folder) from None
        raise


def _replace(inside: Path, folder: Path, target: Path, replaced: Path, earlier: _Earlier) -> None:
    """Replace earlier results by new ones; the earlier ones stay if that fails."""
    if identity(target) != earlier.identity:
        raise _taken(folder)
    try:
        target.rename(replaced)
    except FileNotFoundError:
        raise _taken(folder) from None
    try:
        if identity(replaced) != earlier.identity:  # another run was faster since the lines above
            raise _taken(folder)
        new = frozenset(file_names(inside))
        others = list(_others(replaced, earlier.files, new))
        _check_names(folder, others, new)
        inside.rename(target)
    except BaseException:
        _restore(replaced, folder, target)
        raise
    _carry_over(others, replaced, folder, target)
    _remove(replaced, earlier.files)


def _others(folder: Path, ours: frozenset[str], new: frozenset[str], within: str = "") -> Iterator[str]:
    """Yield the other contents of a folder: files, and whole folders without a file of wearlaw."""
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        name, is_folder = f"{within}{entry.name}", entry.is_dir(follow_symlinks=False)
        if is_folder and any(one.startswith(f"{name}/") for one in ours | new):
            yield from _others(Path(entry), ours, new, f"{name}/")
        elif is_folder or name not in ours:
            yield name


def _check_names(folder: Path, others: list[str], new: frozenset[str]) -> None:
    """Raise an error if a new file has the name of a file that wearlaw did not write."""
    for name in others:
        if name in new or any(one.startswith(f"{name}/") for one in new):
            raise OutputError(
                f"output: {quoted(folder / name)} was not written by wearlaw, and a new file has its name; move it"
                " elsewhere, or choose another folder with -o"
            )


def _restore(replaced: Path, folder: Path, target: Path) -> None:
    try:
        replaced.rename(target)
    except OSError as error:
        raise OutputError(
            f"output: the earlier contents of {quoted(folder)} are now in {quoted(replaced)}, and could not be"
            f" moved back: {error.strerror or error}"
        ) from None


def _carry_over(names: list[str], replaced: Path, folder: Path, target: Path) -> None:
    """Move the other files from the earlier folder to the new one."""
    try:
        for name in names:
            for parent in reversed(Path(name).parents[:-1]):
                (target / parent).mkdir(exist_ok=True)
            (replaced / name).rename(target / name)
    except (OSError, KeyboardInterrupt) as error:
        raise OutputError(
            f"output: the results are in {quoted(folder)}, but other files that were there are still in"
            f" {quoted(replaced)}: {str(error) or 'interrupted'}"
        ) from None


def _remove(folder: Path, files: frozenset[str]) -> None:
    """Remove some files of a folder, then the folder if it is empty."""
    for path in (*sorted(folder.rglob("*"), reverse=True), folder):  # the contents of a folder come before it
        with suppress(OSError):
            if path.is_dir() and not path.is_symlink():
                path.rmdir()
            elif path.relative_to(folder).as_posix() in files:
                path.unlink()


def _put_beside(inside: Path, target: Path) -> Path | None:
    """Move results to the first free folder of that name with a number; return None if that fails."""
    numbered = (target.with_name(f"{target.name}-{number}") for number in itertools.count(2))
    beside = next(path for path in numbered if not os.path.lexists(path))
    try:
        inside.rename(beside)
    except OSError:
        taken_meanwhile = os.path.lexists(beside)
        return _put_beside(inside, target) if taken_meanwhile else None
    return beside
