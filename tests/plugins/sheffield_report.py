"""The text of the shipped study's sections, as last read over: `sheffield_report.txt`, beside this file.

`python -m tests.plugins.sheffield_report` renews that file. A load or a diameter that is larger or smaller by 1e-8
of its value gives the same sentences of claims, so rounding does not change them. Tables of fits have three digits
here, far fewer than the minimiser determines.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import wearlaw as wl
from tests.core.cases import case
from tests.plugins.sheffield import FRICTION
from wearlaw.study.study import run
from wearlaw_sheffield import claims, table_4, tables

AGREED = Path(__file__).with_suffix(".txt")

SWEEP: dict[str, Any] = {
    "normal_force_per_width": "741.43 kN/m",
    "creepage": ["0.1 %", "10 %"],
    "friction_coefficient": FRICTION,
}


def study_of(**changes: Any) -> wl.Study:
    """Return a small study under the conditions of the paper, with some of its sweep changed."""
    return run(case(sweeps={"creepage": {**SWEEP, **changes}}, profiles={}))


def report() -> list[str]:
    """Return the lines of the three sections."""
    study = study_of()
    return [line for module in (tables, claims, table_4) for line in lines(module.section(study))]


def lines(section: wl.Section) -> Iterator[str]:
    """Yield the text of a section, its claims, the rows of its tables, and the words in its figures."""
    yield from (f"# {section.title}", *section.text.splitlines())
    for claim in section.claims:
        yield f"- {claim.statement} {claim.where}: {claim.verdict}"
        yield from (f"  Criterion: {claim.criterion}", *(f"  {line}" for line in claim.found.split("\n\n")))
    for name, table in section.tables.items():
        yield f"{name}: {' | '.join(table.columns)}"
        for row in table.itertuples(index=False):
            yield " | ".join(f"{entry:.3g}" if isinstance(entry, float) else entry for entry in row)
    for figure in section.figures:
        yield from (f"{figure.name}: {figure.title}", figure.caption)
        for panel in figure.panels:
            yield f"{panel.title}: {panel.y.label} over {panel.x.label}"
            for curve in panel.curves:
                yield f"{curve.label}: from {curve.x[0]:g} to {curve.x[-1]:g}, style {curve.colour} and {curve.dash}"


if __name__ == "__main__":
    AGREED.write_text("\n".join([*report(), ""]), encoding="utf-8")
