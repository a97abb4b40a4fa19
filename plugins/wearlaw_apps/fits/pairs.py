"""Pairs of contact models, with the stages around them, and laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from wearlaw.errors import CompositionError, InputError
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law, Outcome
from wearlaw.pipeline.composition import TAKE_MEANS
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw_apps.output.notes import Notes
from wearlaw_apps.sweeps.several import composed


@dataclass(frozen=True)
class Pair:
    """A contact model with a law, both by their labels in results."""

    contact_model: str
    law: str
    pipeline: Pipeline[...]

    @property
    def label(self) -> str:
        """Name of the pair in results."""
        return f"{self.law} on {self.contact_model}"

    @property
    def outcome(self) -> Outcome:
        """What the law predicts."""
        return self.pipeline.laws[0].outcome


def compose(
    rig: Rig,
    contact_models: Mapping[str, ContactModel],
    laws: Mapping[str, Law],
    notes: Notes,
    problem: Any = None,
    stages: Sequence[Stage] = (),
    remedy: str = TAKE_MEANS,
) -> list[Pair]:
    """Compose all possible pairs, and note impossible ones and parameters fitted for other contact models.

    A `problem` that the rig has made tells the geometry even if the rig declares none; `remedy` says what to do about a
    law of the whole patch on a contact resolved into cells.
    """
    geometry = None if problem is None else problem.geometry
    pairs = []
    for contact_label, model in contact_models.items():
        for law_label, law in laws.items():
            try:
                with notes.of(f"{law_label} on {contact_label}"):
                    pipeline = composed(rig, model, stages, law, geometry, remedy)
                    if problem is not None:
                        pipeline.warn_of_problem(problem)
                    every = (*contact_models.values(), *stages, *laws.values())
                    pairs.append(Pair(contact_label, law_label, pipeline.among(every)))
            except CompositionError as error:
                notes.add(f"{law_label} on {contact_label} is left out: {error}", CompositionError)
    if not pairs:
        kind = "wear laws" if all(law.kind == "wear law" for law in laws.values()) else "laws"
        raise InputError(f"no contact model can be used with any of the {kind}:\n" + "\n".join(notes.texts))
    return pairs
