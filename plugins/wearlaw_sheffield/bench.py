"""The conditions of the paper's simulations, and predictions under them."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np

import wearlaw as wl
from wearlaw import Array, Q

WEAR_RATE = "ug/m/mm^2"


@dataclass(frozen=True)
class Bench:
    """A rig under one load and with one friction coefficient, at creepages from nearly none to the largest of a sweep.

    Attributes
    ----------
    rig : TwinDisc
    normal_force_per_width : Quantity
        P [N/m].
    friction_coefficient : float
    highest_creepage : float
        [%].
    """

    rig: wl.TwinDisc
    normal_force_per_width: wl.Quantity
    friction_coefficient: float
    highest_creepage: float

    @classmethod
    def of(cls, study: wl.Study) -> Bench:
        """Return the conditions of a study's sweep "creepage".

        Raises
        ------
        InputError
            If the study has no such sweep, or there is more to it than a range of positive creepages.
        """
        sweep = study.sweep("creepage")
        if sweep["normal_force_per_width"].size > 1 or sweep["friction_coefficient"].size > 1:
            raise wl.InputError("sweeps.creepage: must have one load and one friction_coefficient; put others elsewhere")
        highest = float(sweep["creepage"].max())
        if highest <= 0.0:
            raise wl.InputError("sweeps.creepage: must reach a positive creepage")
        load = Q(float(sweep["normal_force_per_width"].item()), sweep["normal_force_per_width"].attrs["units"])
        return cls(study.case.rig, load, float(sweep["friction_coefficient"].item()), highest)

    @cached_property
    def creepage(self) -> Array:
        """Creepages [%]: as many in each decade up to 1 %, then as many in each percent; 0.01 % apart or less."""
        return np.append(np.geomspace(1e-3, 1.0, 600, endpoint=False), np.arange(1.0, self.highest_creepage, 0.01))

    def predict(self, model: wl.ContactModel | str, law: wl.WearLaw, creepage: Array | float) -> wl.Prediction:
        """Return the prediction at creepages [%], also with parameters that were fitted for another contact."""
        contact = wl.contact_model(model) if isinstance(model, str) else model
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wl.WearlawWarning)  # that is what the claims are about
            return (self.rig | contact | law)(
                normal_force_per_width=self.normal_force_per_width,
                creepage=Q(creepage, "%"),
                friction_coefficient=self.friction_coefficient,
            )

    def rate(self, model: wl.ContactModel | str, law: wl.WearLaw, creepage: Array | None = None) -> Array:
        """Return the wear rate [µg/m/mm²] at creepages [%], by default those of the bench."""
        prediction = self.predict(model, law, self.creepage if creepage is None else creepage)
        return np.asarray(prediction.wear_rate.to(WEAR_RATE).magnitude)

    def force(self, model: wl.ContactModel | str, creepage: Array | None = None) -> Array:
        """Return the tangential force over that of full slip, T/(μN), at creepages [%]."""
        contact = self.predict(model, wl.wear_law("usfd"), self.creepage if creepage is None else creepage)
        return np.asarray(contact.traction_coefficient.to("").magnitude) / self.friction_coefficient

    @cached_property
    def wear_index(self) -> Array:
        """Tγ [N] at the creepages of the bench, with the traction of the exact theory."""
        contact = self.predict("global", wl.wear_law("usfd"), self.creepage)
        return np.asarray(contact.wear_index.to("N").magnitude)

    @cached_property
    def patch_area(self) -> float:
        """[mm²]."""
        return float(self.predict("global", wl.wear_law("usfd"), 1.0).patch_area.to("mm^2").magnitude)

    @cached_property
    def rolling_speed(self) -> float:
        """[m/s]."""
        return wl.scalar_si(self.rig.rolling_speed, "m/s")

    @cached_property
    def full_slip(self) -> float:
        """The creepage of full slip in the exact theory, ξ_sat = μa/R [%]."""
        problem = self.rig.problem(
            normal_force_per_width=self.normal_force_per_width,
            creepage=Q(1, "%"),
            friction_coefficient=self.friction_coefficient,
        )
        return float(100.0 * self.friction_coefficient * problem.half_width / problem.relative_radius)

    @cached_property
    def usfd_borders(self) -> tuple[float, float]:
        """The wear indices Tγ [N] where severe and where catastrophic wear begins, for the global USFD law."""
        mild, severe = (wl.wear_law("usfd").breakpoints or {})["wear_index_density"]
        return mild * 1e-6 * self.patch_area, severe * 1e-6 * self.patch_area


def first_crossing(x: Array, above: Array, below: Array) -> float | None:
    """Return the first x at which `above - below` changes its sign, by linear interpolation; None if nowhere."""
    difference = above - below
    changes = np.flatnonzero(np.sign(difference[:-1]) * np.sign(difference[1:]) < 0)
    if changes.size == 0:
        return None
    i = int(changes[0])
    share = difference[i] / (difference[i] - difference[i + 1])
    return float(x[i] + share * (x[i + 1] - x[i]))


def largest(relative: Array, x: Array) -> tuple[float, float]:
    """Return the entry of largest magnitude and where it is."""
    i = int(np.abs(relative).argmax())
    return float(relative[i]), float(x[i])
