"""The base class of wear laws, `WearLaw`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.models.law import WEAR, Law, LocalOutcome, Outcome
from wearlaw.units.quantities import WEAR_RATE, Quantity, from_si


class LocalWear(LocalOutcome):
    """The wear in a contact solved elsewhere; its rates are in kg/m/m²."""

    @property
    def local_wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area at the nodes [kg/m/m²]."""
        return from_si(self.rate, WEAR_RATE)

    @property
    def wear_rate(self) -> Quantity:
        """Mass lost per metre rolled and contact area, mean over the patch [kg/m/m²]."""
        return from_si(self.contact.mean(self.rate), WEAR_RATE)

    @property
    def wear_index(self) -> Quantity:
        """Wear index, Tγ [N], the energy dissipated per metre rolled."""
        return from_si(self.contact.wear_index, "N")

    @property
    def tangential_force(self) -> Quantity:
        """Tangential force, T [N], the sum of the tractions."""
        return from_si(self.contact.tangential_force, "N")

    @property
    def mass_per_distance(self) -> Quantity:
        """Mass lost per metre rolled [kg/m]."""
        return from_si(self.contact.sum_over_nodes(self.rate * self.contact.area), "ug/m")


class WearLaw(Law):
    """A law of wear: from a solved contact to the wear rate at each of its nodes.

    Its `rate` is the mass lost per metre rolled and contact area [kg/m/m²]. It is not negative, and it is zero where
    nothing slips.
    """

    kind: ClassVar[str] = "wear law"
    outcome: ClassVar[Outcome] = Outcome(WEAR, WEAR_RATE, of="area mean")
    zero_in_stick: ClassVar[bool] = True

    def _local(self, contact: Contact, rate: Array) -> LocalWear:
        return LocalWear(contact, rate, self.outcome)

    if TYPE_CHECKING:  # for checkers, these methods of `Law` return wear and wear laws

        def __ror__(self, contact: Contact) -> LocalWear: ...

        def explicit(self) -> WearLaw: ...  # noqa: D102

        def band(self) -> tuple[WearLaw, WearLaw, WearLaw] | None: ...  # noqa: D102
