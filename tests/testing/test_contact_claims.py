"""Claims and exemptions of contact models, and contacts of a wrong shape."""

from __future__ import annotations

import time
import tracemalloc
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.testing.cells import Cells
from tests.testing.strips import Strips
from tests.testing.wrong_contacts import Wrapped
from wearlaw.models.contact_model import Claim
from wearlaw.testing import checks
from wearlaw.testing.kit import CLAIMS


class Batched(Wrapped):
    """Repeats the batch: its arrays have the shape (batch, batch, nodes)."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.mapped(lambda array: np.broadcast_to(array, problem.batch_shape + array.shape).copy())


class NoContact(Wrapped):
    """Returns nothing."""

    def solve_line(self, problem: wl.Problem) -> Any:
        return None


class ShapedByCreepage(Wrapped):
    """Gives the force an axis too many at small creepages."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        if problem.creepage.max() > 1e-4:
            return contact
        return contact.replaced(tangential_force=contact.tangential_force[..., None])


def messages(model: wl.ContactModel) -> dict[str, str]:
    """Return the messages of the checks that fail."""
    found = {}
    for check in checks(model):
        try:
            check()
        except AssertionError as error:
            found[check.name] = str(error)
    return found


OF_SHAPE = "contact_has_the_shape_of_the_problem"


@pytest.mark.parametrize("model", [Batched, NoContact, ShapedByCreepage])
def test_after_a_wrong_shape_no_other_check_is_run(model: Any) -> None:
    found = messages(model())
    assert {*found, "exemptions_are_claims"} == {check.name for check in checks(model())}
    first = found.pop(OF_SHAPE)
    assert set(found.values()) == {f"not run, since the model returns a wrong shape: {first}"}


def test_a_wrong_shape_takes_neither_time_nor_memory() -> None:
    tracemalloc.start()
    before = time.process_time()
    found = messages(Batched())
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found[OF_SHAPE] == "on a line: rolling_speed has the shape (1, 1) for a batch of shape (1,)"
    # A single check without this would solve 512 lines on 48 nodes: 512² · 48 numbers of 8 bytes are 100 MB an array.
    assert peak < 10e6
    assert time.process_time() - before < 10.0


def exempt(base: Any, claim: Claim) -> Any:
    """Return a model that does not claim something."""
    return type("Exempt", (base,), {"exemptions": property(lambda _: {claim: "for the tests"}), "__doc__": "Exempt."})()


@pytest.mark.parametrize("claim", CLAIMS)
def test_an_exemption_leaves_out_the_checks_of_a_claim(claim: Claim) -> None:
    for base in (Cells, Strips):
        kept, left = ([check.name for check in checks(model)] for model in (base(), exempt(base, claim)))
        assert len(set(kept)) == len(kept)
        if (base, claim) != (Cells, "spin"):
            assert set(left) < set(kept)
        assert "no_node_gains_energy" in left


def test_checks_without_a_claim_are_those_that_wearlaw_relies_on() -> None:
    kept = {check.name for check in checks(Strips())}
    for claim in CLAIMS:
        kept &= {check.name for check in checks(exempt(Strips, claim))}
    assert kept == {
        "contact_has_the_shape_of_the_problem",
        "contact_is_finite",
        "contact_carries_the_conditions",
        "nodes_cover_the_patch",
        "nodes_lie_where_their_areas_do",
        "strips_have_their_widths",
        "pressure_sums_to_the_load",
        "tractions_sum_to_the_forces",
        "magnitudes_are_those_of_the_vectors",
        "no_node_gains_energy",
        "batch_equals_loop",
        "solution_is_in_double_precision",
        "wear_index_is_forces_times_creepages",
        "forces_alone_are_those_of_the_contact",
        "refined_strips_improve_the_forces",
        "other_strips_have_the_same_sums",
        "units_of_parameters_do_not_matter",
        "acceleration_does_not_matter",
        "exemptions_are_claims",
    }
