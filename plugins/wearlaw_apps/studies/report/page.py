"""The report of a study: one page that opens offline in any browser.

The page contains plotly.js, nearly all of its 2 MB. It loads nothing, and its security policy forbids requests.
"""

from __future__ import annotations

import gzip
import re
from base64 import b64encode
from collections import Counter
from collections.abc import Sequence
from functools import cache

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from plotly.offline import get_plotlyjs

from wearlaw.version import __version__
from wearlaw_apps.output.curves import FigureData
from wearlaw_apps.output.notes import by_kind
from wearlaw_apps.output.style import DARK, PALETTE
from wearlaw_apps.output.styled import html_table
from wearlaw_apps.studies.report.interactive import plotly_figure
from wearlaw_apps.studies.report.tables import (
    headline,
    main_table,
    models,
    of_section,
    parameters,
    points,
    profiles,
    summaries,
)
from wearlaw_apps.studies.sections import VERDICTS, CheckedClaim
from wearlaw_apps.studies.study import Study, used

LONG, LONGEST = 12, 100
"""Most rows of a table that is not folded, and of one that stands on the page at all."""


def report(study: Study, case_text: str) -> str:
    """Return the page of a study with its case as TOML; the same study gives the same bytes."""
    main, first = study.main, main_table(study)
    claims = [claim for section in study.sections for claim in section.claims]
    leading = sorted(study.sections, key=lambda section: main not in section.figures)
    lines = [section.summary for section in leading]
    lines.insert(1 if main not in study.figures else 0, headline(study))
    return _template().render(
        study=study,
        notes=by_kind(study.notes),
        case_text=_shortened(case_text),
        claims=claims,
        counted=counted,
        key=[line for line in lines if line],
        main_table=first,
        main=main,
        figures=[figure for figure in study.figures if figure is not main],
        beyond_shakedown=any(map(has_strip, study.figures)),
        summaries=[
            table
            for table in (*summaries(study), *profiles(study))
            if (table.title, table.frame.columns[0]) != (first.title, first.frame.columns[0])
        ],
        parameters=parameters(study),
        points=points(study),
        models=models(study),
        used=[(kind, name, origin) for kind, names in used(study.case).items() for name, origin in names.items()],
        version=__version__,
        long=LONG,
        longest=LONGEST,
        on_dark=dict(zip(PALETTE, DARK, strict=True)),
        plotlyjs=packed(get_plotlyjs()),
    )


def packed(text: str) -> str:
    """Return a text compressed and in base 64, always the same bytes."""
    return b64encode(gzip.compress(text.encode(), mtime=0)).decode()


def _shortened(case_text: str) -> str:
    """Return a case without most numbers of long lists, such as the points of a profile."""
    many = re.compile(r"\[\s*((?:-?[\d.e+-]+,\s*){3})((?:-?[\d.e+-]+,\s*){20,})(-?[\d.e+-]+),?\s*\]")
    return many.sub(
        lambda match: f"[{' '.join(match[1].split())} … {match[2].count(',')} more …, {match[3]}]", case_text
    )


@cache
def _template() -> Template:
    """Return the template of the page, compiled once: that takes longer than rendering."""
    environment = Environment(
        autoescape=True,
        loader=PackageLoader("wearlaw_apps.studies.report"),
        lstrip_blocks=True,
        trim_blocks=True,
        undefined=StrictUndefined,
    )
    environment.filters.update(
        packed=packed,
        paragraphs=paragraphs,
        plotly=plotly_figure,
        strip=has_strip,
        styled=html_table,
        tables=of_section,
    )
    return environment.get_template("report.html.j2")


def counted(claims: Sequence[CheckedClaim]) -> str:
    """Return how many claims there are of each verdict, such as "3 claims (holds: 2, does not hold: 1)"."""
    verdicts = Counter(claim.verdict for claim in claims)
    each = ", ".join(f"{verdict}: {verdicts[verdict]}" for verdict in VERDICTS if verdict in verdicts)
    return f"{len(claims)} {'claim' if len(claims) == 1 else 'claims'} ({each})"


def has_strip(figure: FigureData) -> bool:
    """Return whether a figure has a strip along the x axis, beyond shakedown."""
    return any(shade.strip for panel in figure.panels for shade in panel.shades)


def paragraphs(text: str) -> list[str]:
    """Split a text into paragraphs at blank lines."""
    return [part for part in re.split(r"\n\s*\n", text.strip()) if part]
