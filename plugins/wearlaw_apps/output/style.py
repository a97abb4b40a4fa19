"""The looks of figures, in print and on pages: colours, markers, line styles and sizes.

`wearlaw.mplstyle` beside this file has what matplotlib reads, the palette among it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl

STYLE: Any = mpl.rc_params_from_file(Path(__file__).with_name("wearlaw.mplstyle"), use_default_template=False)
"""The settings of the style file."""
PALETTE: tuple[str, ...] = tuple(STYLE["axes.prop_cycle"].by_key()["color"])
DARK: tuple[str, ...] = ("#58B0E8", "#FF8B4D", "#2CC899", "#E59CC6", "#F0B63C", "#A5DAF8", "#FFFFFF")
"""The palette on a dark ground."""
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
LINES: tuple[Any, ...] = ("-", "--", ":", "-.", (0, (9, 3)), (0, (6, 1.5, 1, 1.5, 1, 1.5)), (0, (3, 3, 1, 3, 1, 3)))
"""Line styles, as many as colours: names of matplotlib, or an offset with lengths of dashes and gaps in line widths."""
OUTSIDE_LINE: Any = (0, (3.0, 1.6))
"""Line style of a law outside its range."""
LIMIT_LINE: Any = (0, (1.0, 1.6))
"""Line style of a limit, which is thin and grey."""
COLUMN, PAGE = 3.54, 7.48
"""Width of one column and of a page of a journal, in inches (90 and 190 mm)."""
SHADE, STRIP_GREY, LIMIT_GREY = "#ececec", "#8c8c8c", "#505050"
"""Greys of a shade as high as a panel, of a strip along its x axis, and of a limit."""
BAND, EDGE = 0.1, 0.4
"""Opacity of a band and of its edges."""
THIN = 0.8
"""Width of a limit, in points."""
COLOURS: str = STYLE["image.cmap"]
"""Colour map of maps."""
