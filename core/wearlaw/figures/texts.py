"""The texts of figures, as matplotlib can draw them: of any letters, on few lines, in a font that has them.

A letter that no installed font has is drawn as a box; `warn_of_boxes` says so once for all figures of a report.
"""

from __future__ import annotations

import re
import textwrap
import unicodedata
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cache, partial

import matplotlib as mpl
from matplotlib.font_manager import FontEntry, FontProperties, findfont, fontManager, get_font

from wearlaw.errors import UNWRITABLE, WearlawWarning, printable
from wearlaw.figures.curves import FigureData, Panel, PlotAxis

BOX = "\N{WHITE SQUARE}"
"""The sign in place of a letter without a glyph."""
LABEL, AXIS, NAME, TITLE = 100, 60, 32, 288
"""Most letters of a label in the legend, of that of an axis, of a name on an axis, and of a title.

A longer text is cut in its middle.
"""
CONDITIONS = 1000
"""Most letters of the conditions below a title."""
TOLD = 20
"""Most letters without a glyph that the warning names."""

_BREAK = re.compile("[\t-\r\x1c-\x1f\x85\u2028\u2029]+")
_NO_LETTERS = re.compile("Last ?Resort|Emoji|Color|^cm[a-z]+10$|^STIX(Size|NonUni)")
"""Names of fonts that have boxes, pictures or pieces of formulas in place of letters."""


def texts_of(figure: FigureData) -> Iterator[str]:
    """Yield all texts that are drawn."""
    yield from (figure.title, figure.conditions, figure.bands)
    for panel in figure.panels:
        yield panel.title
        for axis in (panel.x, panel.y):
            yield from (axis.label, *axis.names)
        yield from (curve.label for curve in panel.curves)
        yield from (shade.label for shade in panel.shades)
        if panel.map is not None:
            yield from (panel.map.label, *panel.map.borders)


def drawable(figure: FigureData) -> tuple[FigureData, list[str]]:
    """Return a figure with texts that matplotlib draws, and the families of fonts to draw it with."""
    families, missing = fonts_for(texts_of(figure))
    boxes = {ord(letter): "" if unicodedata.category(letter) in ("Cf", "Mn") else BOX for letter in missing}
    shown = partial(_drawable, boxes)
    made = replace(
        figure,
        title=shown(figure.title, TITLE),
        conditions=shown(figure.conditions, CONDITIONS),
        bands=shown(figure.bands, LABEL),
        panels=tuple(_panel(panel, shown) for panel in figure.panels),
    )
    return made, [*mpl.rcParams["font.family"], *families]


def _panel(panel: Panel, shown: Callable[[str, int], str]) -> Panel:
    drawn = panel.map
    if drawn is not None:
        borders = {shown(name, LABEL): region for name, region in drawn.borders.items()}
        drawn = replace(drawn, label=shown(drawn.label, AXIS), borders=borders)
    return replace(
        panel,
        title=shown(panel.title, TITLE),
        x=_axis(panel.x, shown),
        y=_axis(panel.y, shown),
        curves=tuple(replace(curve, label=shown(curve.label, LABEL)) for curve in panel.curves),
        shades=tuple(replace(shade, label=shown(shade.label, LABEL)) for shade in panel.shades),
        map=drawn,
    )


def _axis(axis: PlotAxis, shown: Callable[[str, int], str]) -> PlotAxis:
    return replace(axis, label=shown(axis.label, AXIS), names=tuple(shown(name, NAME) for name in axis.names))


def _drawable(boxes: dict[int, str], text: str, most: int) -> str:
    """Return a text on one line, printable, cut in its middle, with boxes for letters without a glyph."""
    whole = UNWRITABLE.sub(lambda found: printable(found[0]), _BREAK.sub(" ", text))
    most = _letters(whole, most)
    if len(whole) > most:
        whole = f"{whole[: most // 2]}…{whole[-(most // 2 - 1) :]}"
    return whole.translate(boxes)


def _letters(text: str, width: int) -> int:
    """Return how many letters of a text fit into a width; East Asian ones, and boxes, are twice as wide as others."""
    wide = sum(letter == BOX or unicodedata.east_asian_width(letter) in "WF" for letter in text)
    return max(4, width * len(text) // (len(text) + wide or 1))


def wrapped(text: str, letters: int) -> list[str]:
    """Return the lines of a text, each as long as so many Latin letters."""
    return textwrap.wrap(text, _letters(text, letters))


def fonts_for(texts: Iterable[str]) -> tuple[list[str], set[str]]:
    """Return the families of installed fonts to add for the letters of texts, and the letters that none has."""
    letters = {letter for text in texts for letter in UNWRITABLE.sub("", _BREAK.sub("", text))}
    missing = {letter for letter in letters if ord(letter) not in _letters_of(findfont(FontProperties()))}
    families: list[str] = []
    if missing:
        for entry in _others():
            found = {letter for letter in missing if ord(letter) in _letters_of(entry.fname)}
            if found:
                families.append(entry.name)
                missing -= found
            if not missing:
                break
    return families, missing


def _others() -> list[FontEntry]:
    """Return the upright fonts of normal weight, one of each family, in the order of their names."""
    plain = {
        one.name: one
        for one in fontManager.ttflist
        if one.style == "normal" and one.weight in (400, "normal", "regular") and not _NO_LETTERS.search(one.name)
    }
    return [plain[name] for name in sorted(plain)]


@cache
def _letters_of(path: str) -> frozenset[int]:
    """Return the code points that a font has, none if it cannot be read."""
    try:
        return frozenset(get_font(path).get_charmap())
    except (OSError, RuntimeError, ValueError):
        return frozenset()


def warn_of_boxes(figures: Iterable[FigureData]) -> None:
    """Warn once of the letters in figures that no installed font has."""
    _, missing = fonts_for(text for figure in figures for text in texts_of(figure))
    seen = sorted(letter for letter in missing if unicodedata.category(letter) not in ("Cf", "Mn"))
    if seen:
        more = f" and {len(seen) - TOLD} more" if len(seen) > TOLD else ""
        warnings.warn(
            f"no installed font has {printable(' '.join(seen[:TOLD]))}{more}; pictures show a box in place of each, and"
            " the report shows them if your browser can; install a font of that script",
            WearlawWarning,
            stacklevel=3,
        )
