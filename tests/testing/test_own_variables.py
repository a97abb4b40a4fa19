"""The kit on laws that branch in a variable of their own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from wearlaw.testing import checks

BRANCHES = ("rate_jumps_only_where_declared", "rate_has_kinks_only_where_declared", "declared_jumps_exist")


class PvLimit(wl.WearLaw):
    """Wear in proportion to q·s, ten times as much above a limit of pressure times slip speed."""

    name: ClassVar[str] = "pv_limit"
    source: ClassVar[str] = "test"

    limit: Annotated[wl.Quantity, wl.Unit("W/mm^2")] = wl.Q(12.0, "W/mm^2")

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        severe = contact.pressure * contact.slip_speed >= p["limit"]
        return 5e-9 * np.where(severe, 10.0, 1.0) * contact.wear_index_density

    @property
    def own_variables(self) -> Mapping[str, Callable[[wl.Contact], wl.Array]]:
        return {"pv": lambda contact: contact.pressure * contact.slip_speed}

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"pv": (p["limit"],)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)


class Elsewhere(PvLimit):
    """Declares its jump at twice the limit."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"pv": (2.0 * p["limit"],)}


class Smooth(PvLimit):
    """Declares a jump that it does not have."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 5e-9 * contact.wear_index_density


@pytest.mark.parametrize(
    ("law", "caught"), [(PvLimit(), ()), (Elsewhere(), BRANCHES), (Smooth(), BRANCHES[2:])], ids=str
)
def test_a_branch_in_a_variable_of_its_own_must_be_where_it_is_declared(law: wl.Law, caught: tuple[str, ...]) -> None:
    failed = []
    for check in checks(law):
        if check.name in BRANCHES:
            try:
                check()
            except AssertionError:
                failed.append(check.name)
    assert failed == list(caught)
