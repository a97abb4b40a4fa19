"""The pipeline of a pair of a contact model, with the stages of a case around it, and a law."""

from __future__ import annotations

from collections.abc import Sequence

from wearlaw.contact.problem import Geometry
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.law import Law
from wearlaw.models.stage import Stage
from wearlaw.pipeline.composition import check_geometry, check_scale
from wearlaw.pipeline.pipeline import Pipeline, Rig

TAKE_MEANS_IN_A_CASE = 'write stages = ["patch_mean"] in the case, or use the contact model "global"'
"""Remedy in a case for a law of the whole patch on a contact resolved into cells."""


def composed(
    rig: Rig,
    model: ContactModel,
    stages: Sequence[Stage],
    law: Law,
    geometry: Geometry | None = None,
    remedy: str = TAKE_MEANS_IN_A_CASE,
) -> Pipeline[...]:
    """Return the pipeline of a pair.

    Raises
    ------
    CompositionError
        If its parts do not fit each other.
    """
    check_geometry(rig, model, geometry or rig.patch_geometry)
    contact = rig | model
    for stage in stages:
        contact |= stage
    check_scale(contact.scale, model, law, remedy)
    return contact | law
