"""The contacts on which wear laws are tried: enough of them straddle a border, and mix stick and slip."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.testing.wrong_contacts import WrongBatchShape
from tests.testing.wrong_law_nodes import PairOfPoints
from tests.testing.wrong_laws import SLOPE, Linear, Raises
from wearlaw.testing import checks
from wearlaw.testing.examples import _examples
from wearlaw.testing.kit import NotRunError
from wearlaw.testing.law_contacts import (
    Border,
    Contacts,
    borders,
    for_each_contact,
    means_of,
    on_lines,
    on_strips,
    sticks_in_part,
    straddles,
)
from wearlaw.testing.sampling import aimed, at_nodes, of_means, random_contacts

LAWS = [wl.wear_law("usfd"), wl.wear_law("kth")]
MIXED = [on_lines, on_strips]

SHARE = 1.0 / 3.0
"""Least share of the contacts of a kind that have what the kind is for."""


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize("mixed", MIXED, ids=lambda mixed: mixed.__name__)
def test_every_border_has_contacts_with_nodes_on_both_sides(
    law: wl.WearLaw, mixed: Callable[[tuple[Border, ...]], Contacts]
) -> None:
    of_law = borders(law)
    examples = _examples(mixed(of_law))
    for border in of_law:
        assert sum(straddles(contact, border) for contact in examples) >= SHARE * len(examples)


@pytest.mark.parametrize("mixed", MIXED, ids=lambda mixed: mixed.__name__)
def test_enough_mixed_contacts_stick_in_part(mixed: Callable[[tuple[Border, ...]], Contacts]) -> None:
    examples = _examples(mixed(borders(wl.wear_law("usfd"))))
    assert sum(map(sticks_in_part, examples)) >= SHARE * len(examples)


def test_contacts_on_strips_are_of_all_kinds() -> None:
    examples = _examples(on_strips(()))
    cosines = np.concatenate([_cosines(contact) for contact in examples])
    assert (cosines >= 0.049).all()
    assert np.mean(cosines < 0.9) > SHARE
    assert np.mean(cosines > 1.0 - 1e-12) > 0.2
    gaps = [np.diff(contact.y[:, 0, :], axis=-1).max(initial=0.0) for contact in examples]
    assert sum(gap > 1e-2 for gap in gaps) > 0.2 * len(
        examples
    )  # half of those of several strips have a gap in the middle
    assert sum(bool((contact.area == 0.0).any()) for contact in examples) >= SHARE * len(examples)
    assert all((contact.patch_area > 0.0).all() for contact in examples)
    assert any(len(set(contact.strip_width[0])) > 1 for contact in examples)


def _cosines(contact: wl.Contact) -> wl.Array:
    size = contact.traction * contact.slip
    return (contact.wear_index_density / np.where(size > 0.0, size, 1.0))[size > 0.0]


def test_the_energy_of_the_means_is_not_the_product_of_traction_and_slip() -> None:
    examples = _examples(means_of(()))
    ratios = np.concatenate([_cosines(contact).ravel() for contact in examples])
    assert np.ptp(np.log(ratios[ratios > 0.0])) > np.log(10.0)
    spinning = [(contact.traction == 0.0) & (contact.wear_index_density > 0.0) for contact in examples]
    assert any(spin.any() for spin in spinning)


@pytest.mark.parametrize("mixed", [*MIXED, means_of], ids=lambda mixed: mixed.__name__)
@pytest.mark.parametrize(
    ("variable", "value"),
    [("pressure", 1e9), ("slip", 0.01), ("slip_speed", 0.3), ("traction", 1e8), ("wear_index_density", 4e6)],
)
def test_a_variable_is_set_at_all_nodes_where_that_is_possible(
    mixed: Callable[[tuple[Border, ...]], Contacts], variable: str, value: float
) -> None:
    for contact in _examples(mixed(())):
        found = at_nodes(aimed(contact, variable, value), variable)
        reached = contact.wear_index_density > 0.0 if variable == "wear_index_density" else found == found
        np.testing.assert_allclose(found[reached], value, rtol=1e-14)


@pytest.mark.parametrize("mixed", [*MIXED, means_of], ids=lambda mixed: mixed.__name__)
def test_the_wear_index_is_set_by_the_area(mixed: Callable[[tuple[Border, ...]], Contacts]) -> None:
    for contact in _examples(mixed(())):
        found = aimed(contact, "wear_index", 100.0)
        worn = contact.wear_index > 0.0
        assert (found.wear_index[worn] == 100.0).all()
        if not of_means(contact):
            np.testing.assert_allclose(found.cell_wear_index[worn], 100.0, rtol=1e-13)


@pytest.mark.parametrize("variable", ["x", "traction_bound"])
def test_positions_and_bounds_are_set_as_they_are(variable: str) -> None:
    contact = random_contacts(3, nodes=4)
    assert (getattr(aimed(contact, variable, 2.5), variable) == 2.5).all()


class Behind(Linear):
    """Twice the wear far behind the leading edge."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"x": (1e-3,)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * np.where(contact.x < 1e-3, 1.0, 2.0)


class ByTheBound(Linear):
    """Wear that rises faster above a traction bound."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"traction_bound": (1e8,)}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        bound = np.minimum(contact.traction_bound, 1e12)  # it may be infinite
        return SLOPE * contact.wear_index_density * (1.0 + np.maximum(bound - 1e8, 0.0) / 1e8)


@pytest.mark.parametrize("law", [Behind(), ByTheBound()], ids=lambda law: type(law).__name__)
def test_a_law_may_branch_by_position_and_by_the_traction_bound(law: wl.WearLaw) -> None:
    for check in checks(law):
        check()


class ByTemperature(Linear):
    """It branches in what a contact does not have, and where nothing is."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"temperature": (500.0,), "pressure": (np.inf,)}


def test_an_unknown_variable_is_found_by_the_check_of_names_alone() -> None:
    assert borders(ByTemperature()) == ()
    found = {check.name: check for check in checks(ByTemperature())}
    found["rate_is_finite"]()
    with pytest.raises(AssertionError, match="`breakpoints` names 'temperature'; the variables are: pressure, "):
        found["declared_names_are_variables"]()


def test_a_law_of_the_patch_gets_one_node() -> None:
    kinds = set()
    for_each_contact(wl.wear_law("brr"), lambda contact: kinds.add(contact.pressure.shape[1:]))
    assert kinds == {(1,), (1, 1)}


def test_a_law_of_the_nodes_gets_lines_strips_and_means() -> None:
    axes = set()
    for_each_contact(wl.wear_law("usfd"), lambda contact: axes.add((contact.pressure.ndim, of_means(contact))))
    assert axes == {(2, False), (3, False), (3, True)}


@pytest.mark.parametrize(
    ("model", "of_shape", "message"),
    [
        (PairOfPoints(), "rate_has_the_right_shape", "rates of shape"),
        (WrongBatchShape(), "contact_has_the_shape_of_the_problem", "on a line: "),
    ],
    ids=["law", "contact_model"],
)
def test_a_wrong_shape_ends_the_run(model: Any, of_shape: str, message: str) -> None:
    outcomes = {}
    for check in checks(model):
        try:
            check()
        except AssertionError as error:
            outcomes[check.name] = error
    assert not isinstance(outcomes.pop(of_shape), NotRunError)
    assert all(isinstance(error, NotRunError) for error in outcomes.values())
    assert len(outcomes) > 15
    reasons = {str(error) for error in outcomes.values()}
    assert len(reasons) == 1
    assert reasons.pop().startswith(f"not run, since the model returns a wrong shape: {message}")


def test_a_model_that_raises_has_no_wrong_shape() -> None:
    found = {check.name: check for check in checks(Raises())}
    with pytest.raises(AssertionError, match="the model raised ZeroDivisionError: no slip"):
        found["rate_has_the_right_shape"]()
    with pytest.raises(AssertionError, match="the model raised ZeroDivisionError: no slip"):
        found["no_slip_no_wear"]()
    found["declared_names_are_variables"]()
