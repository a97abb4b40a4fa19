"""Write the oracle's file anew: python -m tests.oracle."""

from __future__ import annotations

from tests.oracle import rows
from tests.oracle.record import FILE, written

FILE.write_text(written(rows()), encoding="utf-8")
