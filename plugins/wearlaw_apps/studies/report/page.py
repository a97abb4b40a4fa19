"""The report of a study: one page that opens offline in any browser.

The page contains plotly.js, nearly all of its 5 MB. It loads nothing, and its security policy forbids requests.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from functools import cache

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from plotly.offline import get_plotlyjs

from wearlaw.version import __version__
from wearlaw_apps.output.curves import FigureData
from wearlaw_apps.output.notes import grouped
from wearlaw_apps.output.styled import html_table
from wearlaw_apps.studies.report.interactive import plotly_figure
from wearlaw_apps.studies.report.tables import main_table, models, of_section, parameters, profiles, summaries
from wearlaw_apps.studies.results import axes_of
from wearlaw_apps.studies.sections import VERDICTS, CheckedClaim
from wearlaw_apps.studies.study import Study, used


def report(study: Study, case_text: str) -> str:
    """Return the page of a study with its case as TOML; the same study gives the same bytes."""
    has_main = bool(axes_of(next(iter(study.sweeps.values()))))
    claims = [claim for section in study.sections for claim in section.claims]
    return _template().render(
        study=study,
        notes=grouped(study.notes),
        case_text=case_text,
        claims=claims,
        counted=counted,
        main_table=main_table(study),
        main_figures=study.figures[:has_main],
        figures=study.figures[has_main:],
        beyond_shakedown=any(map(has_strip, study.figures)),
        summaries=[*summaries(study), *profiles(study)],
        parameters=parameters(study),
        models=models(study),
        used=[(kind, name, origin) for kind, names in used(study.case).items() for name, origin in names.items()],
        version=__version__,
        plotlyjs=get_plotlyjs(),
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
    return f"{len(claims)} claims ({each})"


def has_strip(figure: FigureData) -> bool:
    """Return whether a figure has a strip along the x axis, beyond shakedown."""
    return any(shade.strip for panel in figure.panels for shade in panel.shades)


def paragraphs(text: str) -> list[str]:
    """Split a text into paragraphs at blank lines."""
    return [part for part in re.split(r"\n\s*\n", text.strip()) if part]
