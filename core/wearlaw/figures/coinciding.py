"""Lines that cover each other: drawn once, with a label that names them all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from wearlaw.arrays.array import Array

if TYPE_CHECKING:
    from wearlaw.figures.curves import Curve, Panel, PlotAxis

SAME = 1e-6
"""Largest difference of equal values, relative to the largest one: that of numerical integration."""

COVERED = 0.004
"""Largest distance of lines that cover each other: half a line of 1.6 pt, on a panel some 200 pt high."""


def united(panels: Sequence[Panel]) -> tuple[Panel, ...]:
    """Return panels with one line in place of those that coincide in all of them.

    Its label is "a = b" if the values are equal, and "a ≈ b" if the lines merely cover each other.
    """
    labels = list(dict.fromkeys(curve.label for panel in panels for curve in panel.curves if curve.is_line))
    groups: list[list[str]] = []
    signs: dict[str, str] = {}
    for label in labels:
        for group in groups:
            if sign := _sign(panels, group[0], label):
                group.append(label)
                signs[group[0]] = "≈" if "≈" in (sign, signs.get(group[0])) else "="
                break
        else:
            groups.append([label])
    named = {group[0]: f" {signs[group[0]]} ".join(group) for group in groups if len(group) > 1}
    dropped = {label for group in groups for label in group[1:]}
    return tuple(
        replace(
            panel,
            curves=tuple(
                replace(curve, label=named.get(curve.label, curve.label)) if curve.is_line else curve
                for curve in panel.curves
                if not (curve.is_line and curve.label in dropped)
            ),
        )
        for panel in panels
    )


def _sign(panels: Sequence[Panel], first: str, second: str) -> str:
    """Return "=" or "≈" for lines that coincide in all panels, "" for others."""
    found = []
    for panel in panels:
        one, other = ([c for c in panel.curves if c.is_line and c.label == label] for label in (first, second))
        if len(one) != len(other) or len(one) > 1:
            return ""
        found += [_coincide(panel, one[0], other[0])] if one else []
    return "" if not found or "" in found else "≈" if "≈" in found else "="


def _coincide(panel: Panel, one: Curve, other: Curve) -> str:
    if one.x.shape != other.x.shape or one.x.size < 2 or not _same_flags(one, other):
        return ""
    sign = "="
    for axis, name in ((panel.x, "x"), (panel.y, "y"), (panel.y, "low"), (panel.y, "high")):
        first, second = getattr(one, name), getattr(other, name)
        if first is None and second is None:
            continue
        if first is None or second is None or not np.array_equal(np.isfinite(first), np.isfinite(second)):
            return ""
        there = np.isfinite(first)
        if not there.any():
            return ""
        shown = [values for curve in panel.curves for values in (getattr(curve, name),) if values is not None]
        if (abs(_places(first, axis, shown) - _places(second, axis, shown))[there] > COVERED).any():
            return ""
        if (abs(first - second)[there] > SAME * abs(first[there]).max()).any():
            sign = "≈"
    return sign


def _same_flags(one: Curve, other: Curve) -> bool:
    first, second = (np.zeros(c.x.shape, dtype=bool) if c.outside is None else c.outside for c in (one, other))
    return np.array_equal(first, second)


def _places(values: Array, axis: PlotAxis, shown: list[Array]) -> Array:
    """Return the positions of values along an axis as shares of its length; those it cannot show are at 0."""
    scaled = np.log10 if axis.scale == "log" else np.asarray
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = scaled(np.concatenate([*shown, np.asarray(axis.ends or [])]) if axis.ends is None else axis.ends)
        ends = ends[np.isfinite(ends)]
        low, high = (ends.min(), ends.max()) if ends.size else (0.0, 0.0)
        places: Array = np.nan_to_num((scaled(values) - low) / (high - low or 1.0), nan=0.0, posinf=0.0, neginf=0.0)
    return places
