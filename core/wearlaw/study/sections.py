"""Sections that a plugin adds to the report of a study: claims that are checked, tables and figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

from wearlaw.errors import InputError, shortened
from wearlaw.figures.curves import FigureData

if TYPE_CHECKING:
    import pandas as pd


Verdict: TypeAlias = Literal["holds", "holds in part", "does not hold", "cannot be decided"]
"""What putting a claim to the test can give."""

VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
"""The verdicts, from best to worst."""


@dataclass(frozen=True)
class CheckedClaim:
    """A claim of the literature, tested against computed numbers.

    Attributes
    ----------
    statement : str
        The claim.
    where : str
        Paper and section.
    criterion : str
        Which numbers decide, and how near they must be.
    found : str
        The computed result, with numbers and units; blank lines separate paragraphs, such as one for each variant.
    verdict : {"holds", "holds in part", "does not hold", "cannot be decided"}
        "holds in part": for some variants, or over part of the range. "cannot be decided": it depends on something
        that the source does not state.

    Raises
    ------
    InputError
        If the verdict is none of these.
    """

    statement: str
    where: str
    criterion: str
    found: str
    verdict: Verdict

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise InputError(f"verdict: must be one of {', '.join(map(repr, VERDICTS))}, got {shortened(self.verdict)}")


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
    """

    title: str
    text: str
    claims: tuple[CheckedClaim, ...] = ()
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    figures: tuple[FigureData, ...] = ()
