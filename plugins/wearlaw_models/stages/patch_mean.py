"""The means of the patch as a stage."""

from __future__ import annotations

from typing import ClassVar

import wearlaw as wl


class PatchMean(wl.Stage):
    """Replaces a resolved contact by its patch means, for laws stated for patch means.

    Pressure and traction are means over the area. The slip is the one with which the mean traction dissipates Tγ.
    """

    name: ClassVar[str] = "patch_mean"
    source: ClassVar[str] = "The global approach of Tassini et al., Wear 268 (2010) 660-667, section 3.1"
    gives_means: ClassVar[bool] = True

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Contact:
        """Return the patch means of the contact."""
        contact = inner(problem)
        return contact if contact.pressure.size == contact.rolling_speed.size else contact.patch_mean()

    def __repr__(self) -> str:
        return "patch_mean()"


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Stage]]:
    """Return the stage of this plugin."""
    return [PatchMean]
