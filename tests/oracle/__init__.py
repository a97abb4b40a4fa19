"""The oracle: what wearlaw predicts, in one file, so that no number moves unseen.

`python -m tests.oracle` writes the file, and `tests/test_oracle.py` compares with it. Only public names are used.
"""

from __future__ import annotations

import wearlaw as wl
from tests.oracle.applications import applications
from tests.oracle.cases import predictions
from tests.oracle.mistakes import mistakes
from tests.oracle.record import Row, recorded


def rows() -> dict[str, Row]:
    """Return all rows of the oracle by name.

    Arrays go through NumPy, as they do without numba; that compiled loops agree with it is for other tests.
    """
    wl.accelerate(False)
    try:
        found = {name: recorded(call) for name, call in (*predictions(), *applications())}
        return found | {name: recorded(call, field) for name, call, field in mistakes()}
    finally:
        wl.accelerate(None)
