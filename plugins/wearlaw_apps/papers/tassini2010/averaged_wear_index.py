"""The averaged wear index of Tassini et al. (2010)."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

import wearlaw as wl
from wearlaw import Array


class AveragedWearIndex(wl.Law):
    """The mean slip of the slip zone times the tangential force.

    It exceeds the dissipated energy wherever part of the patch sticks; `wear_index` is consistent with that energy.
    """

    name: ClassVar[str] = "averaged_wear_index"
    source: ClassVar[str] = "N. Tassini et al., Wear 268 (2010) 660-667, section 3.2.3"
    outcome: ClassVar[wl.Outcome] = wl.Outcome(
        "averaged_wear_index",
        unit="N",
        meaning="The averaged wear index of Tassini et al. 2010, section 3.2.3",
        of="patch",
    )

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:  # noqa: ARG002
        """Return the averaged wear index [N]; zero where nothing slips."""
        slid, area = contact.mean_slip * contact.patch_area, contact.slip_area
        slip = np.divide(slid, area, out=np.zeros(np.shape(area)), where=area > 0.0)
        index: Array = slip * np.abs(contact.tangential_force)
        return index

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:  # noqa: ARG002
        """Return none: the index is smooth in its variables."""
        return {}
