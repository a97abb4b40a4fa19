"""No prediction moves unseen: see tests/oracle."""

from __future__ import annotations

import json

from tests import oracle
from tests.oracle.record import FILE, differences

SHOWN = 20


def test_no_prediction_has_moved() -> None:
    old = json.loads(FILE.read_text(encoding="utf-8"))
    found = differences(old, json.loads(json.dumps(oracle.rows())))
    more = [f"... and {len(found) - SHOWN} more"] if len(found) > SHOWN else []
    assert not found, "\n".join(["", *found[:SHOWN], *more])
