"""Catching warnings of one thread."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock, get_ident
from typing import Any

from wearlaw.errors import WearlawWarning

_CATCHING = RLock()


@contextmanager
def caught_warnings(*kinds: type[Warning]) -> Iterator[list[Warning]]:
    """Yield a list of the warnings of some kinds, by default all of wearlaw's, that this thread gives in the context.

    All other warnings are shown as ever. Python's `catch_warnings` changes settings of the process: two threads that
    enter it at once leave the changes behind, and each may get the warnings of the other. So one thread at a time
    enters it here, unless Python keeps the settings for each thread.
    """
    kept = kinds or (WearlawWarning,)
    found: list[Warning] = []
    if getattr(sys.flags, "context_aware_warnings", False):
        with warnings.catch_warnings(record=True) as caught:
            _always(kept)
            yield found
        for one in caught:
            if issubclass(one.category, kept):
                found.append(one.message)  # type: ignore[arg-type]
            else:
                warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
        return
    with _CATCHING, warnings.catch_warnings():
        _always(kept)
        shown, thread = warnings.showwarning, get_ident()

        def show(message: Any, category: type[Warning], *where: Any, **more: Any) -> None:
            if get_ident() == thread and issubclass(category, kept):
                found.append(message)
            else:
                shown(message, category, *where, **more)

        warnings.showwarning = show
        yield found


def _always(kinds: tuple[type[Warning], ...]) -> None:
    for kind in kinds:
        warnings.simplefilter("always", kind)
