"""Notes of a study, for printing."""

from __future__ import annotations

import re
from collections.abc import Iterable

_SUBJECT = re.compile(r"((?:sweep|profile|section) '[^']*'): (.*)", re.DOTALL)
"""A note about a part of a case."""

_RANGE = re.compile(r"(.*?)( \(.*\))?; (\d+ of \d+ .*, as far as .*)", re.DOTALL)
"""A warning of `RangeWatch`: the remark, the source of a range if any, and the points outside."""


def grouped(texts: Iterable[str]) -> list[str]:
    """Return notes for printing: one for all parts of a case that share a remark or a range, each source once."""
    groups: dict[str, list[tuple[str, str]]] = {}
    sources: dict[str, str] = {}
    lines: dict[str, None] = {}
    for text in texts:
        about = _SUBJECT.fullmatch(text)
        if about is None:
            lines.setdefault(text)
            continue
        subject, remark = about.groups()
        outside = ""
        of_range = _RANGE.fullmatch(remark)
        if of_range:
            remark, outside = of_range[1], of_range[3]
            sources[remark] = of_range[2] or ""
        groups.setdefault(remark, []).append((subject, outside))
    named: set[str] = set()
    for remark, members in groups.items():
        subjects = [subject for subject, _ in members]
        if remark not in sources:
            together = " and ".join(filter(None, (", ".join(subjects[:-1]), subjects[-1])))
            lines.setdefault(f"{together}: {remark}")
            continue
        source = sources[remark]
        known = f"{remark}{' (source above)' if source in named else source}"
        named |= {source} - {""}
        if len(members) == 1:
            lines.setdefault(f"{subjects[0]}: {known}; {members[0][1]}")
        else:
            lines.setdefault(f"{known}; " + "; ".join(f"{subject}: {outside}" for subject, outside in members))
    return list(lines)
