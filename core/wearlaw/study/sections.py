"""Sections that a plugin adds to the report of a study: claims that are checked, tables and figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from wearlaw.figures.curves import FigureData

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class CheckedClaim:
    """A claim of the literature, tested against computed numbers.

    Attributes
    ----------
    statement : str
        The claim.
    where : str
        Paper and section.
    found : str
        The computed result, with numbers and units.
    holds : bool
        Whether the result supports the claim.
    """

    statement: str
    where: str
    found: str
    holds: bool


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
