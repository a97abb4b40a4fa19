"""Common properties of the models that give creep forces without resolving the patch."""

from __future__ import annotations

import dataclasses
import re

import pytest
from hypothesis import given

import wearlaw as wl
from tests.plugins.ellipses import ellipses
from wearlaw.errors import CompositionError

NAMES = ("linear", "polach", "shen_hedrick_elkins")
MODELS = [wl.contact_model(name) for name in NAMES]
every_model = pytest.mark.parametrize("model", MODELS, ids=NAMES)


@pytest.mark.validates(
    "invariants",
    "Creep-force models: mirrored and reversed creepages",
    source="symmetry",
    held_to="to the bit",
)
@given(problem=ellipses())
@every_model
def test_mirrored_and_reversed_creepages_mirror_and_reverse_the_forces(
    model: wl.ContactModel, problem: wl.Problem
) -> None:
    along, across, spin = problem.longitudinal_creepage, problem.lateral_creepage, problem.spin
    found = dataclasses.astuple(model.creep_forces(problem))
    mirrored = model.creep_forces(problem.with_creepages(along, -across, -spin))
    braked = model.creep_forces(problem.with_creepages(-along, across, spin))
    assert dataclasses.astuple(mirrored) == (found[0], -found[1], -found[2], None)
    assert dataclasses.astuple(braked) == (-found[0], found[1], found[2], None)


@every_model
def test_a_line_contact_is_refused_with_the_models_that_solve_it(model: wl.ContactModel) -> None:
    message = (
        f"contact model '{model.name}' solves elliptic contacts only, but a TwinDisc makes line contacts; those that"
    )
    with pytest.raises(CompositionError, match=re.escape(message) + r".*exact, fastsim, global, half_space$"):
        wl.TwinDisc.suros() | model
