"""The formats in which figures are written, for the command line without what draws them."""

from typing import Literal

FigureFormat = Literal["png", "pdf", "svg"]
