"""The damage by rolling contact fatigue of the whole life rail model (WLRM)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, model_validator

import wearlaw as wl
from wearlaw import Array

Force = Annotated[wl.Quantity, wl.Unit("N")]

WITHOUT_SPIN = wl.Variable(
    "wear_index_without_spin",
    unit="N",
    meaning="Wear index without the part of the spin, ξFx + ηFy",
    symbol="ξFx + ηFy",
)


class WLRM(wl.Law):
    """Fatigue damage by a passage against Tγ: it rises to a peak, and falls where wear removes cracks.

    zero, Tγ < threshold; a line up to the peak damage at the peak; a line down to zero at the balance; beyond the
    balance the same line goes on below zero, or the damage stays zero. The damages of passages add up.

    Notes
    -----
    Prefer this to rank vehicles, curves and friction on one rail steel. It can't tell how long a crack is. Its points
    hold for one steel: they come from cracks in track and simulations of the vehicles that passed.

    The points have no defaults, because the report was not available to read them. Take them from the report, or from
    tests of your steel.

    With `traction`, passages in the other direction add no damage, and wear still removes what it removes beyond the
    balance. How the sign of traction enters is an interpretation.
    """

    name: ClassVar[str] = "wlrm"
    source: ClassVar[str] = (
        "M. Burstow, Whole life rail model application and development for RSSB: development of an RCF damage"
        " parameter, AEA Technology 2003, RSSB research project T115; the form alone, since the report was not read"
    )
    example_fields: ClassVar[Mapping[str, Any]] = {
        "threshold": "20 N",
        "peak": "65 N",
        "balance": "175 N",
        "peak_damage": 1e-5,
        "beyond": "falls",
        "traction": "either",
    }
    outcome: ClassVar[wl.Outcome] = wl.Outcome(
        "rcf_damage",
        unit="",
        meaning="Damage by rolling contact fatigue, by one passage",
        sign="any",
        of="patch",
    )

    threshold: Force
    """Tγ below which there is no damage [N]."""
    peak: Force
    """Tγ of the largest damage [N]."""
    balance: Force
    """Tγ at which wear removes cracks as fast as they grow [N]."""
    peak_damage: Annotated[float, Field(gt=0.0, strict=True, allow_inf_nan=False)]
    """Damage by a passage at the peak [-]."""
    beyond: Literal["falls", "zero"]
    """The damage beyond the balance: "falls" goes on along the line from the peak, below zero, because wear removes
    cracks faster than they grow; "zero" keeps zero. Sources differ, so you choose."""
    traction: Literal["either", "driving", "braking"] = "either"
    """Longitudinal traction under which cracks grow. "driving" counts passages at which the first body of the rig, the
    wheel or disc 1, drives, "braking" those at which it brakes, "either" all of them, also without traction."""

    spin: Literal["included", "left_out"] = "included"
    """Whether Tγ has the part of the spin: "included" takes ξFx + ηFy + φMz, "left_out" ξFx + ηFy, as many vehicle
    programs do. Choose what the three points were found with."""

    @model_validator(mode="after")
    def _ordered(self) -> WLRM:
        if not self.threshold < self.peak < self.balance:
            raise ValueError(
                f"threshold, peak and balance must rise; got {self.threshold!r}, {self.peak!r} and {self.balance!r}"
            )
        return self

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        """Return the damage of each patch by a passage [-]."""
        index = contact.wear_index if self.spin == "included" else contact.wear_index_without_spin
        rise = np.maximum((index - p["threshold"]) / (p["peak"] - p["threshold"]), 0.0)
        damage: Array = p["peak_damage"] * np.minimum(rise, (p["balance"] - index) / (p["balance"] - p["peak"]))
        if self.beyond == "zero":
            damage = np.maximum(damage, 0.0)
        if self.traction == "either":
            return damage
        # A positive creepage is that of a wheel that brakes, but of a disc 1 that drives.
        driving = -contact.force_x if contact.on_strips else contact.force_x
        if self.traction == "braking":
            driving = -driving
        # Under lateral creepage alone, rounding leaves a longitudinal force of some 1e-16 of the traction.
        grows = driving > 1e-9 * np.hypot(contact.force_x, contact.force_y)
        return np.where(grows, damage, np.minimum(damage, 0.0))

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the three points."""
        variable = "wear_index" if self.spin == "included" else WITHOUT_SPIN.name
        return {variable: (p["threshold"], p["peak"], p["balance"])}

    @property
    def own_variables(self) -> Mapping[wl.Variable, Callable[[wl.Contact], Array]]:
        """Tγ without the part of the spin, if that is left out."""
        return {} if self.spin == "included" else {WITHOUT_SPIN: _without_spin}


def _without_spin(contact: wl.Contact) -> Array:
    """Return Tγ without the part of the spin at the nodes."""
    return np.broadcast_to(contact.per_node(contact.wear_index_without_spin), contact.pressure.shape)


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Law]]:
    """Return the law of this plugin."""
    return [WLRM]
