"""The pairs of a case: each contact model, with the stages around it, with each law."""

from __future__ import annotations

from typing import Any

from wearlaw_fits.pairs import Pair, compose
from wearlaw_output.notes import Notes

TAKE_MEANS_IN_A_CASE = 'write stages = ["patch_mean"] in the case, or use the contact model "global"'
"""Remedy in a case for a law of the whole patch on a contact resolved into cells."""


def pairs_of(case: Any, notes: Notes) -> list[Pair]:
    """Compose all pairs of a `Case`, which imports this file, for the first operating point of its first sweep."""
    problem = next(iter(case.sweeps.values())).problem(case.rig)
    models, laws = case.contact_models_by_label, case.laws_by_label
    return compose(case.rig, models, laws, notes, problem, case.stages, TAKE_MEANS_IN_A_CASE)
