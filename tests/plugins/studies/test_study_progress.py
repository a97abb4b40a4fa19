"""Running a case: the progress that it tells."""

from __future__ import annotations

from typing import Any

import pytest

from tests.core import cases
from tests.core.cases import case
from tests.plugins.studies.studies import LATTICE, MEASURED
from wearlaw_studies.study import evaluations, run


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        # global: usfd 1, kth 3 for its band, brr 1; exact: usfd 1, kth 3.
        ({}, 5 * 9),
        ({"sweeps": {"a": LATTICE, "b": cases.POINT}}, (48 + 1) * 9),
        ({"sweeps": {"a": LATTICE, "b": MEASURED}}, 48 * 9 + 5 * 5),
        ({"wear_laws": ["usfd"], "contact_models": ["exact"]}, 5),
        ({"sweeps": {"long": {**cases.POINT, "creepage": {"from": "0 %", "to": "9 %", "points": 2500}}}}, 2500 * 9),
    ],
)
def test_progress_sums_to_the_announced_evaluations(changes: dict[str, Any], expected: int) -> None:
    ran = case(**changes)
    blocks: list[int] = []
    run(ran, blocks.append)
    assert sum(blocks) == evaluations(ran) == expected


def test_long_work_reports_progress_in_several_blocks() -> None:
    sweep = {**cases.POINT, "creepage": {"from": "0 %", "to": "9 %", "points": 20000}}
    blocks: list[int] = []
    run(case(contact_models=["exact"], wear_laws=["kth"], sweeps={"long": sweep}, profiles={}), blocks.append)
    assert max(blocks) < 20000 / 2
