"""The conditions of the paper's simulations, and predictions for them."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array, Q

WEAR_RATE = "ug/m/mm^2"

PAPER = tuple(wl.TwinDisc.suros(speed_of=kept) for kept in ("disc_1", "mean"))
"""The rig of the paper, which does not say whether it keeps the speed of disc 1 or the mean of both."""

LOAD = Q(741.43, "kN/m")
"""The load of the paper's simulations with varying creepage, a maximum pressure of 1500 MPa."""

HIGHEST = 25.0
"""The highest creepage of the paper's simulations [%]."""

TESTED = (0.2, 20.0)
"""The creepages of the public tests [%]."""

PARTIAL = np.array([0.1, 0.5, 1.0])
"""Creepages in partial slip for which the claims list numbers [%]."""

WINDOW = 350.0 / 6.2934
"""Upper end of the severe wear window in the paper's Figure 6c: 350 N on its patch of 6.2934 mm² [N/mm²]."""


def borders(law: str, variable: str) -> tuple[float, ...]:
    """Return the values of a variable, in SI, at which a law branches."""
    of = wl.wear_law(law)
    return (of.breakpoints(of.numbers) or {})[variable]


@dataclass(frozen=True)
class Bench:
    """A rig at the load, friction coefficient and creepages, 0.001 to 25 %, of the paper's section 5.2."""

    rig: wl.TwinDisc
    normal_force_per_width: wl.Quantity = LOAD
    friction_coefficient: float = 0.46

    @classmethod
    def of(cls, study: wl.Study) -> Bench:
        """Return the rig of a study, or raise an `InputError` if it is not the paper's."""
        rig = study.case.rig
        if not isinstance(rig, wl.TwinDisc) or rig not in PAPER:
            raise wl.InputError("rig: this section judges the paper's rig, SUROS with its own fields, and no other")
        return cls(rig)

    @cached_property
    def creepage(self) -> Array:
        """Creepages [%], at most 0.02 % apart, including those where the patch means have kinks in full slip."""
        regular = np.append(np.geomspace(1e-3, 1.0, 401), np.linspace(1.0, HIGHEST, 1201))
        kinks = np.array([self.full_slip, *(100.0 * border / self.full_force for border in self.usfd_borders)])
        return np.union1d(regular, [TESTED[0], *kinks[kinks < HIGHEST]])

    def predict(self, model: wl.ContactModel | str, law: wl.WearLaw, creepage: Array | float) -> wl.Prediction:
        """Return the prediction at creepages [%]; the law's parameters may have been fitted for another contact."""
        contact = wl.contact_model(model) if isinstance(model, str) else model
        # The claims report what the warnings would say.
        with warnings.catch_warnings(action="ignore", category=wl.WearlawWarning):
            return (self.rig | contact | law)(
                normal_force_per_width=self.normal_force_per_width,
                creepage=Q(creepage, "%"),
                friction_coefficient=self.friction_coefficient,
            )

    def rate(self, model: wl.ContactModel | str, law: wl.WearLaw, creepage: Array | None = None) -> Array:
        """Return the wear rate [µg/m/mm²] at creepages [%], by default the bench's own."""
        prediction = self.predict(model, law, self.creepage if creepage is None else creepage)
        return np.asarray(prediction.wear_rate.to(WEAR_RATE).magnitude)

    def force(self, model: wl.ContactModel | str, creepage: Array | None = None) -> Array:
        """Return the tangential force relative to full slip, T/(μN), at creepages [%]."""
        contact = self.predict(model, wl.wear_law("usfd"), self.creepage if creepage is None else creepage)
        return np.asarray(contact.traction_coefficient.to("").magnitude) / self.friction_coefficient

    @cached_property
    def usfd(self) -> Array:
        """USFD on the patch means [µg/m/mm²]."""
        return self.rate("global", wl.wear_law("usfd"))

    @cached_property
    def gaps(self) -> dict[str, Array]:
        """USFD on the cells of each theory less USFD on the patch means [µg/m/mm²]."""
        return {theory: self.rate(theory, wl.wear_law("usfd")) - self.usfd for theory in ("exact", "fastsim")}

    @cached_property
    def wear_index(self) -> Array:
        """Tγ [N] at the creepages of the bench, with the traction of the exact theory."""
        contact = self.predict("global", wl.wear_law("usfd"), self.creepage)
        return np.asarray(contact.wear_index.to("N").magnitude)

    @cached_property
    def patch_area(self) -> float:
        """Area of the patch [mm²]."""
        return float(1e6 * self.problem.patch_area)

    def creepage_at(self, slip_speed: float) -> float:
        """Return the creepage [%] at which the surface speeds differ by a slip speed, ξV = v1 - v2 [m/s].

        It is infinite if v1 is kept and at most half the slip speed, since a mean V is above zero.
        """
        kept = wl.scalar_si(self.rig.rolling_speed, "m/s")
        mean = kept - (0.5 * slip_speed if self.rig.speed_of == "disc_1" else 0.0)
        return 100.0 * slip_speed / mean if mean > 0.0 else np.inf

    def usfd_at_measured(self, tests: tuple[Array, Array]) -> Array:
        """Return USFD on the patch means [µg/m/mm²] at the measured Tγ of tests, creepages [%] and T/N [-].

        USFD is linear in Tγ between its kinks, which are among the creepages of the bench.
        """
        creepage, traction = tests
        measured = traction * float(self.problem.normal_force) * creepage / 100.0
        return np.interp(measured, self.wear_index, self.usfd)

    @cached_property
    def slow(self) -> NDArray[np.bool_]:
        """The tests' creepages at which no cell reaches the lower slip speed of KTH."""
        lower, _ = borders("kth", "slip_speed")
        fastest = [
            self.predict(model, wl.wear_law("kth"), self.creepage).contact.slip_speed.max(axis=-1)
            for model in ("exact", "fastsim")
        ]
        return np.asarray(self.tested & (np.max(fastest, axis=0) < lower))

    @cached_property
    def tested(self) -> NDArray[np.bool_]:
        """Which creepages are within the range of the tests."""
        return (self.creepage >= TESTED[0]) & (self.creepage <= TESTED[1])

    @cached_property
    def problem(self) -> wl.Problem:
        """The contact problem at the load of the bench and 1 % creepage."""
        return self.rig.problem(
            normal_force_per_width=self.normal_force_per_width,
            creepage=Q(1, "%"),
            friction_coefficient=self.friction_coefficient,
        )

    @cached_property
    def full_slip(self) -> float:
        """The creepage of full slip in the exact theory, ξ_sat = μa/R [%]."""
        return float(100.0 * self.friction_coefficient * self.problem.half_width / self.problem.relative_radius)

    @cached_property
    def partial_slip(self) -> NDArray[np.bool_]:
        """Which creepages are below that of full slip."""
        return self.creepage < self.full_slip

    @cached_property
    def full_force(self) -> float:
        """The tangential force in full slip, μN [N]."""
        return float(self.friction_coefficient * self.problem.normal_force)

    @cached_property
    def usfd_borders(self) -> tuple[float, float]:
        """The wear indices Tγ [N] where severe and catastrophic wear begin in the global USFD law."""
        mild, severe = borders("usfd", "wear_index_density")
        return mild * 1e-6 * self.patch_area, severe * 1e-6 * self.patch_area

    @cached_property
    def regimes(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
        """Which creepages are in mild, severe and catastrophic wear of the global USFD law; borders are in both."""
        begin, end = self.usfd_borders
        return self.between(-np.inf, begin), self.between(begin, end), self.between(end, np.inf)

    @cached_property
    def window(self) -> float:
        """The wear index [N] at the upper end of the paper's severe wear window: 350 N on the paper's patch."""
        return WINDOW * self.patch_area

    @cached_property
    def severe_window(self) -> NDArray[np.bool_]:
        """Which creepages are in the paper's severe wear window."""
        return self.between(self.usfd_borders[0], self.window)

    def between(self, lowest: float, highest: float) -> NDArray[np.bool_]:
        """Return which creepages have a wear index [N] within a closed range."""
        rounding = 1e-9
        return (self.wear_index >= lowest * (1.0 - rounding)) & (self.wear_index <= highest * (1.0 + rounding))
