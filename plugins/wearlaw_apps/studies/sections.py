"""Sections that a plugin adds to the report of a study: claims that are checked, tables and figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

from wearlaw.errors import InputError, shown
from wearlaw_apps.output.curves import FigureData

if TYPE_CHECKING:
    import pandas as pd


Verdict: TypeAlias = Literal["holds", "holds in part", "does not hold", "cannot be decided"]
"""What putting a claim to the test can give."""

VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
"""The verdicts, from best to worst."""


@dataclass(frozen=True)
class CheckedClaim:
    """A claim of the literature beside computed results: a row of a table.

    Attributes
    ----------
    theirs : str
        What the source claims.
    where : str
        Paper and section.
    ours : str
        The computed result, with numbers and units.
    verdict : {"holds", "holds in part", "does not hold", "cannot be decided"}
        "holds in part": for some variants, or over part of the range. "cannot be decided": it depends on something
        that the source does not state.
    why : str
        What decides, or the cause of a difference, in a sentence.

    Raises
    ------
    InputError
        If the verdict is none of these.
    """

    theirs: str
    where: str
    ours: str
    verdict: Verdict
    why: str

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise InputError(f"verdict: must be one of {', '.join(map(repr, VERDICTS))}, got {shown(self.verdict)}")


@dataclass(frozen=True, eq=False)
class Section:
    """A section of a report.

    Attributes
    ----------
    title, text : str
        Plain text; blank lines separate paragraphs.
    claims : tuple of CheckedClaim
    tables : mapping of str to DataFrame
        By file name, an identifier. The heads of the columns hold the units.
    figures : tuple of FigureData
    summary : str
        A sentence with its main numbers, for the top of the report.
    """

    title: str
    text: str
    claims: tuple[CheckedClaim, ...] = ()
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    figures: tuple[FigureData, ...] = ()
    summary: str = ""
