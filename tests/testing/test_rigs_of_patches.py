"""The checks of rigs with several patches, as ellipses and as strips."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.core.axles import PATCHES, Axle, Cut, Placed, lifted
from wearlaw.testing import checks

RIGS = (Axle(), Cut(), Placed(), Placed(hertzian=False))


@pytest.mark.parametrize("check", [check for rig in RIGS for check in checks(rig)], ids=str)
def test_rigs_with_several_patches_pass(check: Any) -> None:
    check()


class Unlifted(Axle):
    """An axle whose friction has no axes of its own for the patches."""

    name: ClassVar[str] = "unlifted"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with friction along the last axis."""
        found = super().problem(**conditions)
        friction = np.asarray(conditions["friction_coefficient"]) * np.ones(found.batch_shape)
        return found.replaced(friction_coefficient=friction)


class Sticky(Axle):
    """An axle whose flange touches for good once it has touched anywhere."""

    name: ClassVar[str] = "sticky"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with the flange of any of the points."""
        found = super().problem(**conditions)
        near = lifted("mm", conditions["displacement"], "displacement") > 6.8e-3
        exists = np.broadcast_to(np.array([[True, False], [True, bool(near.any())]]), found.batch_shape)
        return found.replaced(dims=PATCHES, exists=exists)


@pytest.mark.parametrize(
    ("rig", "broken"), [(Unlifted, "arrays_equal_single_calls"), (Sticky, "arrays_equal_single_calls")]
)
def test_mistakes_in_the_axes_of_patches_are_found(rig: type[wl.Rig], broken: str) -> None:
    failing = []
    for check in checks(rig()):
        try:
            check()
        except AssertionError:
            failing.append(check.name)
    assert broken in failing
