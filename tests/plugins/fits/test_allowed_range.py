"""The range in which a parameter may lie is that of its field."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw import Q
from wearlaw_apps.fits.free_parameters import allowed_range  # private: bounds of fits, each kind of annotation alone


class Bounded(wl.Configuration):
    """Numbers with every kind of bound."""

    plain: float = 1.0
    above: Annotated[float, Field(gt=0.5)] = 1.0
    above_zero: Annotated[float, Field(gt=0.0)] = 1.0
    above_less: Annotated[float, Field(gt=-0.5)] = 1.0
    below_zero: Annotated[float, Field(gt=-2.0, lt=0.0)] = -1.0
    share: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0
    length: wl.Length = Q(1.0, "mm")
    offset: Annotated[wl.Quantity, wl.Unit("mm", positive=False, limit=20.0)] = Q(1.0, "mm")
    ratio: Annotated[wl.Quantity, wl.Unit("", limit=1.0)] = Q(50.0, "%")
    power: Annotated[float, Field(ge=1.0, le=2.0)] | None = 1.5
    stress: Annotated[wl.Quantity, wl.Unit("GPa")] | None = Q(1.0, "GPa")


class Outer(wl.Configuration):
    """A record within a record."""

    inner: Bounded = Bounded()


def test_the_range_that_a_field_allows_is_that_of_its_annotation() -> None:
    inf = np.inf
    due = {
        "plain": (-inf, inf, False),
        "above": (0.5, inf, True),
        "above_zero": (0.0, inf, True),
        "above_less": (-0.5, inf, False),
        "below_zero": (-2.0, 0.0, False),
        "share": (0.0, 1.0, False),
        "length": (0.0, inf, True),
        "offset": (-0.02, 0.02, False),
        "ratio": (0.0, 1.0, True),
        "power": (1.0, 2.0, False),
        "stress": (0.0, inf, True),
    }
    assert {name: allowed_range(Bounded(), name) for name in due} == due
    assert allowed_range(Outer(), "inner.share") == (0.0, 1.0, False)
