"""Pairs of contact models and wear laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from wearlaw.errors import CompositionError, InputError
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.labels import labelled
from wearlaw.models.wear_law import WearLaw
from wearlaw.pipeline.composition import check_geometry
from wearlaw.pipeline.notes import Notes
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.study.case import Case


@dataclass(frozen=True)
class Pair:
    """A contact model with a wear law."""

    contact_model: str
    wear_law: str
    pipeline: Pipeline[...]

    @property
    def label(self) -> str:
        """Name of the pair in results."""
        return f"{self.wear_law} on {self.contact_model}"


def pairs_of(case: Case, notes: Notes) -> list[Pair]:
    """Compose all pairs of a case with `compose`, for the first operating point of its first sweep."""
    problem = next(iter(case.sweeps.values())).problem(case.rig)
    return compose(case.rig, labelled(case.contact_models), labelled(case.wear_laws), notes, problem)


def compose(
    rig: Rig,
    contact_models: Mapping[str, ContactModel],
    wear_laws: Mapping[str, WearLaw],
    notes: Notes,
    problem: Any = None,
) -> list[Pair]:
    """Compose all possible pairs, and note impossible ones and parameters fitted for other contact models.

    Parameters
    ----------
    rig : Rig
    contact_models, wear_laws : mapping of str to Model
        By their labels in results.
    notes : Notes
        Collects the remarks.
    problem : problem, optional
        A problem that the rig has made; it has a geometry even if the rig declares none.

    Raises
    ------
    InputError
        If there is no pair.
    """
    geometry = None if problem is None else problem.geometry
    pairs = []
    for contact_label, model in contact_models.items():
        for law_label, law in wear_laws.items():
            try:
                with notes.of(f"{law_label} on {contact_label}"):
                    check_geometry(rig, model, geometry or rig.geometry)
                    pipeline = rig | model | law
                    if problem is not None:
                        pipeline.warn_of_problem(problem, stacklevel=1)
                    pairs.append(Pair(contact_label, law_label, pipeline))
            except CompositionError as error:
                notes.add(f"{law_label} on {contact_label} is left out: {error}")
    if not pairs:
        raise InputError("no contact model can be used with any of the wear laws:\n" + "\n".join(notes.texts))
    return pairs
