"""How results become rows of the oracle, and how two oracles differ."""

from __future__ import annotations

import json
import math
import re
import warnings
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

import wearlaw as wl

FILE = Path(__file__).with_name("oracle.json")

Row = dict[str, Any]
"""What is recorded of a call: {"values": by name with unit, "warns": types}, or {"raises": type, "names": field}."""

TOLERANCE = 1e-12
"""Greatest relative change of a number.

The same code gives the same bits on one machine. Other processors add up in another order and fuse other operations,
which moves a number by some 1e-16 for each of the few hundred operations behind it.
"""

LOOSER = {"fit": 1e-8, "wheelset": 1e-6}
"""Greatest relative change where rounding counts for more, by the first word of a row's name.

A fit ends at steps of 1e-9. A wheel first touches where its gap is least, and rounding by eps moves a minimum by √eps,
or 1.5e-8; shares such as that of stick or of a second patch are differences of numbers up to a hundred times as large.
"""

OF_INTERVALS = 1e-7
"""Greatest relative change of a bound of an interval of a fit: it comes from difference quotients with steps of √eps,
whose rounding is some √eps too."""

CANCELS = 1e-8
"""A change of a force or moment by less is none [N, N m]: those of 10⁵ N that cancel leave the rounding of some hundred
operations of 1e-16 each."""


def recorded(call: Callable[[], Any], field: str | None = None) -> Row:
    """Return the row of a call: its numbers and types of warnings, or its error and the field if that names it."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            values = dict(numbers(call()))
        except wl.WearlawError as error:
            words = re.findall(r"\w+", str(error))
            return {"raises": type(error).__name__, "names": field if field in words else None}
    return {"values": values, "warns": sorted({warning.category.__name__ for warning in caught})}


def numbers(result: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield all numbers of a result, as lists of floats or texts, each under a name that ends with its unit."""
    if isinstance(result, xr.Dataset):
        for column, array in result.variables.items():
            unit = array.attrs.get("units")
            yield from numbers(array.values, f"{name}{column}" + (f" [{unit}]" if unit else ""))
    elif isinstance(result, pd.DataFrame):
        for column in result.columns:
            yield from numbers(result[column].to_numpy(), f"{name}{column}")
    elif isinstance(result, Mapping):
        for key, value in result.items():
            yield from numbers(value, f"{name}.{key}" if name else str(key))
    elif isinstance(result, wl.Quantity):
        yield f"{name} [{result.units:~C}]", _listed(result.magnitude)
    else:
        yield name, _listed(result)


def _listed(values: Any) -> Any:
    array = np.asarray(values)
    return array.tolist() if array.dtype.kind in "fiub" else array.astype(str).tolist()


def written(rows: Mapping[str, Row]) -> str:
    """Return the text of the oracle's file, with a line for each quantity, so that changes show line by line."""
    lines = []
    for key, row in rows.items():
        parts = [f"  {json.dumps(name)}: {_written(value)}" for name, value in row.items()]
        lines.append(f" {json.dumps(key, ensure_ascii=False)}: {{\n" + ",\n".join(parts) + "}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _written(value: Any) -> str:
    if not isinstance(value, dict):
        return json.dumps(value)
    return (
        "{\n" + ",\n".join(f"   {json.dumps(k, ensure_ascii=False)}: {json.dumps(v)}" for k, v in value.items()) + "}"
    )


def differences(old: Mapping[str, Row], new: Mapping[str, Row]) -> list[str]:
    """Return what differs, in words: whatever is not a number first, then the numbers, the greatest change first."""
    others = [f"{key}: is gone" for key in old if key not in new]
    others += [f"{key}: is new" for key in new if key not in old]
    moved: list[tuple[float, str]] = []
    for key in (key for key in old if key in new):
        was, now = dict(_flat(old[key])), dict(_flat(new[key]))
        for name in dict.fromkeys((*was, *now)):
            a, b = was.get(name, "nothing"), now.get(name, "nothing")
            if isinstance(a, float | int) and isinstance(b, float | int):
                change = 0.0 if re.search(r"\[(m\*)?N(\*m)?\]", name) and abs(b - a) < CANCELS else _change(a, b)
                if change > _tolerance(key, name):
                    moved.append((change, f"{key}: {name}: was {a!r}, is {b!r}, a relative change of {change:.1e}"))
            elif a != b:
                others.append(f"{key}: {name}: was {a!r}, is {b!r}")
    return others + [line for _, line in sorted(moved, key=lambda pair: -pair[0])]


def _tolerance(key: str, name: str) -> float:
    kind = key.replace(",", "").split()[0]
    if kind == "fit" and re.search(r"\b(low|high)\b", name):
        return OF_INTERVALS
    return LOOSER.get(kind, TOLERANCE)


def _flat(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the single numbers and texts of a row, with their places in arrays."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _flat(part, key if name in ("", "values") else f"{name} {key}")
    elif isinstance(value, list) and name != "warns":
        yield f"{name} length", str(len(value))
        for place, part in enumerate(value):
            yield from _flat(part, f"{name}[{place}]")
    else:
        yield name, value


def _change(a: float, b: float) -> float:
    """Return the relative change of a number."""
    if a == b or (math.isnan(a) and math.isnan(b)):
        return 0.0
    return math.inf if math.isnan(b - a) else abs(b - a) / max(abs(a), abs(b))
