"""Text as editors and shells write it into files: UTF-8, with a byte order mark or without, and UTF-16 with one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from wearlaw.errors import InputError

UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""The byte order marks of UTF-16, which `>` writes in Windows PowerShell 5."""


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


def read_text(path: str | os.PathLike[str]) -> str:
    """Return the text of a file.

    Raises
    ------
    OSError
        If the file cannot be read.
    InputError
        If it is not text; the message follows the name of the file.
    """
    try:
        return decoded(Path(path).read_bytes())
    except UnicodeDecodeError:
        raise InputError("it is not text in UTF-8; save it in UTF-8") from None


def decoded(content: bytes, otherwise: str = "utf-8-sig") -> str:
    """Decode UTF-8, or UTF-16 with a byte order mark, and return the text without the mark.

    Parameters
    ----------
    content : bytes
        The content of a file.
    otherwise : str
        The encoding to try if the content is neither.

    Raises
    ------
    UnicodeDecodeError
        If the content is not text in any of these encodings.
    """
    if content.startswith(UTF_16):
        return content.decode("utf-16")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode(otherwise)
