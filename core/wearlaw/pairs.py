"""Pairs of contact models and wear laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from wearlaw.errors import CompositionError, InputError
from wearlaw.models import WearLaw
from wearlaw.notes import Notes
from wearlaw.pipeline import Pipeline
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.tangential import ContactModel


@dataclass(frozen=True)
class Pair:
    """A contact model with a wear law."""

    contact_model: str
    wear_law: str
    pipeline: Pipeline[...]

    @property
    def label(self) -> str:
        """What the pair is called in results."""
        return f"{self.wear_law} on {self.contact_model}"


def compose(
    rig: TwinDisc, contact_models: Mapping[str, ContactModel], wear_laws: Mapping[str, WearLaw], notes: Notes
) -> list[Pair]:
    """Compose all pairs of models that can be; note those that cannot, and parameters that were fitted for others.

    Raises
    ------
    InputError
        If there is none.
    """
    pairs = []
    for contact_label, model in contact_models.items():
        for law_label, law in wear_laws.items():
            try:
                with notes.of(f"{law_label} on {contact_label}"):
                    pairs.append(Pair(contact_label, law_label, rig | model | law))
            except CompositionError as error:
                notes.add(f"{law_label} on {contact_label} is left out: {error}")
    if not pairs:
        raise InputError("no contact model can be used with any of the wear laws:\n" + "\n".join(notes.texts))
    return pairs
