"""Reading text and TOML from outside, up to a size, in the encodings of editors and shells."""

from __future__ import annotations

import os
import re
from codecs import getincrementaldecoder
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

from wearlaw.errors import InputError, shown

MIB = 2**20

LARGEST = MIB // 4
"""Size of the largest TOML file that is read [bytes]."""

LEVELS = 200
"""Levels of the deepest table in TOML that is read: `tomllib` calls itself for each, and Python ends it at some 300."""

_TOML = re.compile(
    r'''"""(?:\\.|[^\\])*?(?:"{3,5}|\Z)|\'{3}.*?(?:\'{3,5}|\Z)|"(?:\\.|[^"\\\n])*"?|\'[^\'\n]*\'?|#[^\n]*|[.\n,[{}\]]''',
    re.DOTALL,
)
"""What tells the levels of TOML: brackets, the dots of keys, and what ends a key, outside of texts and comments."""

SPREADSHEETS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")
"""First bytes of spreadsheets: .xlsx and .ods, and .xls."""

NOT_A_SPREADSHEET = 'it is a spreadsheet, not text; save its sheet as CSV, in Excel by "Save As" and "CSV UTF-8"'
"""The error for a spreadsheet."""

_READ: ContextVar[Path | None] = ContextVar("folder of the file that is being read", default=None)


@contextmanager
def reading(path: str | os.PathLike[str]) -> Iterator[None]:
    """Let `beside` find files that the file at `path` names, while this context lasts."""
    token = _READ.set(Path(path).parent)
    try:
        yield
    finally:
        _READ.reset(token)


def beside(path: str | os.PathLike[str]) -> Path:
    """Return the path of a file that a case file names: it is relative to the case file.

    Outside of a case file, it is relative to the working folder. A field that takes the path of a file calls this
    function where it reads the file.
    """
    folder = _READ.get()
    return Path(path) if folder is None else folder / path


def reason_of(error: Exception) -> str:
    """Return why a file cannot be opened, read or written, without its name."""
    return getattr(error, "strerror", None) or str(error)


def read_file(path: str | os.PathLike[str], most: int) -> bytes:
    """Return the content of a file of at most so many bytes.

    Parameters
    ----------
    path : str or path-like
        The file.
    most : int
        The size of the largest file that is read [bytes].

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    InputError
        If it is larger, cannot be read or is a spreadsheet; the message follows the name of the file.
    """
    try:
        with open(path, "rb") as file:
            content = file.read(most + 1)
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as error:
        raise InputError(reason_of(error)) from None
    if content.startswith(SPREADSHEETS):
        raise InputError(NOT_A_SPREADSHEET)
    if len(content) > most:
        raise InputError(f"it has more than {_size(most)}, the most that is read; is it the right file?")
    return content


def encoding_of(content: bytes) -> str:
    """Return the encoding of a text by how it begins: UTF-16 with its mark, UTF-8, or else Windows-1252.

    PowerShell 5 writes UTF-16 by `>`, and Excel and older programs write Windows-1252.
    """
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    try:
        getincrementaldecoder("utf-8")().decode(content)  # which may end inside a character
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def read_text(path: str | os.PathLike[str], most: int, *, of_windows: bool = False) -> str:
    """Return the text of a file in UTF-8, or in UTF-16 with its mark; `of_windows` takes others for Windows-1252.

    Raises
    ------
    FileNotFoundError, InputError
        As for `read_file`; also if it is not text.
    """
    content = read_file(path, most)
    encoding = encoding_of(content)
    try:
        return content.decode(encoding if of_windows or encoding == "utf-16" else "utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("it is not text in UTF-8; save it in UTF-8") from None


def _size(size: int) -> str:
    return f"{size // MIB} MiB" if size >= MIB else f"{size // 1024} KiB"


def parse_toml(text: str) -> dict[str, Any]:
    """Return the contents of a text in TOML.

    Raises
    ------
    InputError
        If it is not TOML, or too large or deep; the message follows the name of the file.
    """
    import tomllib  # most scripts read no such file

    if len(text) > LARGEST:
        raise InputError(f"has more than {_size(LARGEST)}, the most that is read")
    if _levels(text) > LEVELS:
        raise InputError(f"has tables or lists inside each other on more than {LEVELS} levels, the most that are read")

    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f'is not valid TOML: {error}; texts stand in quotes, as in "7 kN"') from None


def _levels(text: str) -> int:
    """Return at least the levels of the deepest table or list of a text in TOML, without parsing it."""
    outer, dots, deepest = [0], 0, 0
    for token in _TOML.findall(text):
        if token in ("[", "{"):
            outer.append(outer[-1] + dots + 1)
            dots = 0
        elif token in ("]", "}"):
            outer = outer[:-1] or [0]
        elif token in (",", "\n"):
            dots = 0
        else:
            dots += token == "."
        deepest = max(deepest, outer[-1] + dots)
    return deepest


def read_toml(subject: str, path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the contents of a TOML file; errors name it by its subject.

    Raises
    ------
    InputError
        If the file is missing or is not TOML.
    """
    try:
        text = read_text(path, LARGEST)
    except (FileNotFoundError, InputError) as error:
        raise InputError(f"cannot read {subject} {shown(Path(path))}: {reason_of(error)}") from None
    try:
        return parse_toml(text)
    except InputError as error:
        raise InputError(f"{subject} {shown(Path(path))} {error}") from None
