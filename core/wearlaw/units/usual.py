"""Values outside what people usually have: one warning a call, with the slip of unit that is likely."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar, Token
from typing import TYPE_CHECKING

from wearlaw.errors import UnusualWarning, warn
from wearlaw.units.registry import quantity, symbol, unit_in_si

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

LIKELY = (
    ("mm", "m", "um", "cm", "km"),
    ("MPa", "GPa", "Pa", "kPa", "N/mm^2"),
    ("kN", "N", "MN"),
    ("kN/m", "N/m", "kN/mm"),
    ("kg/m^3", "g/cm^3"),
    ("m/s", "km/h", "mm/s"),
    ("mrad", "rad", "deg"),
    ("1/m", "1/mm"),
    ("%", ""),
    ("ug/m/mm^2", "mg/m/mm^2", "ng/m/mm^2"),
)
"""Units that are taken for each other, the likeliest first."""

POWERS = (3, -3, 6, -6, 9, -9)
"""Powers of ten by which values are off, the likeliest first."""

_SEEN: ContextVar[dict[str, str] | None] = ContextVar("unusual values", default=None)


@contextmanager
def apart() -> Iterator[None]:
    """Let calls inside warn for themselves, whatever call is around."""
    outside = _SEEN.set(None)
    try:
        yield
    finally:
        _SEEN.reset(outside)


class OneWarning:
    """Context of a call: the remarks on unusual values inside it, by subject, become one warning at its end.

    In a context inside another one they are passed on to that. An error drops them.
    """

    __slots__ = ("_outside", "_seen")

    def __enter__(self) -> dict[str, str]:
        """Return the remarks, which the caller may change."""
        seen: dict[str, str] = {}
        self._seen = seen
        self._outside: Token[dict[str, str] | None] = _SEEN.set(seen)
        return seen

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        _SEEN.reset(self._outside)
        if self._seen and kind is None:
            remark(self._seen)


def remark(remarks: Mapping[str, str]) -> None:
    """Warn of unusual values, each with a subject and what is said of it, or leave that to the call around."""
    seen = _SEEN.get()
    if seen is not None:
        seen |= {**remarks, **seen}
    elif remarks:
        warn("\n".join(f"{subject}: {text}" for subject, text in remarks.items()), UnusualWarning)


def likely_slip(name: str, number: float, unit: str, customary: str, usual: tuple[float, float]) -> str:
    """Return the question that explains an unusual number in a unit, or "" if no slip does; `usual` is in SI."""

    def fits(si: float) -> bool:
        return usual[0] <= si <= usual[1]

    si = number * unit_in_si(unit)
    if name.endswith("radius") and fits(0.5 * si):
        return "; is it the diameter?"
    if customary == "":
        return ""
    others = next((every for every in LIKELY if customary in every), (customary,))
    for other in dict.fromkeys((customary, *others)):
        if fits(number * unit_in_si(other)):
            return f"; did you mean {in_words(number, other)}?"
    for power in POWERS:
        if fits(si * 10.0**power):
            return f"; did you mean {in_words(number * 10.0**power, unit)}?"
    return ""


def in_words(number: float, unit: str) -> str:
    """Return a number with the symbol of its unit."""
    return f"{number:.5g} {symbol(quantity(number, unit).units, '~P')}".rstrip()
