"""Shared parts of the checks for line contacts and elliptic contacts."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Callable, Mapping
from typing import TypeAlias

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import Claim, ContactModel
from wearlaw.testing.examples import SAME, SUM, assert_close

Claims: TypeAlias = Mapping[Claim, tuple[Callable[..., None], ...]]
"""Checks by the claim from which a contact model may be exempt."""


Solved: TypeAlias = Callable[[Array], Contact]
"""From the creepages of some problems, in SI or reduced, to the contacts."""


def friction_limit(problem: Problem) -> Array:
    """Return μN."""
    return problem.friction_coefficient * problem.normal_force


def arrays_of(contact: Contact) -> dict[str, Array]:
    """Return the fields and totals of a contact by name."""
    fields = {field.name: getattr(contact, field.name) for field in dataclasses.fields(contact)}
    return {name: value for name, value in fields.items() if value is not None and name != "problem"}


def assert_finite(contact: Contact) -> None:
    """Assert that every field and total is a finite number; the traction bound may be infinite."""
    for name, value in arrays_of(contact).items():
        bad = np.isnan(value).any() or (name != "traction_bound" and np.isinf(value).any())
        assert not bad, f"{name} is not finite: {value!r}"


def assert_double(contact: Contact) -> None:
    """Assert that every field and total is a float64."""
    for name, value in arrays_of(contact).items():
        assert value.dtype == np.float64, f"{name} is of type {value.dtype}, not float64"


def assert_carries(contact: Contact, problem: Problem) -> None:
    """Assert that rolling speed, density and normal force are those of the problem, and that it knows the problem."""
    for name in ("rolling_speed", "density", "normal_force"):
        assert_close(getattr(contact, name), getattr(problem, name), f"the {name} of the contact")
    known = contact.problem
    for field in dataclasses.fields(problem) if known is not None else ():
        same = np.array_equal(getattr(known, field.name), getattr(problem, field.name))
        assert same, f"the contact's problem has another {field.name}"


def assert_unchanged(problem: Problem, before: Problem) -> None:
    """Assert that the arrays of a problem are those of the copy from before."""
    for field in dataclasses.fields(problem):
        same = np.array_equal(getattr(problem, field.name), getattr(before, field.name))
        assert same, f"the model changed the problem's {field.name}"


def assert_solved_alike(model: ContactModel, problem: Problem, other: Problem) -> None:
    """Assert that a problem has the same contact to the bit before and after another one is solved."""
    first = model.solve(problem)
    kept = copy.deepcopy(first)
    model.solve(other)
    second = model.solve(problem)
    for name, value in arrays_of(kept).items():
        for contact in (first, second):
            same = np.array_equal(getattr(contact, name), value)
            assert same, f"two solutions of one problem differ in {name}"


def full_slip(solved: Solved, high: Array) -> Array:
    """Return the least creepages, to rounding, with the same force as at `high` and no stick."""
    low = np.zeros_like(high)
    limit = solved(high).tangential_force * (1.0 - SAME)
    for _ in range(60):
        middle = 0.5 * (low + high)
        contact = solved(middle)
        reached = (contact.tangential_force >= limit) & (contact.stick_ratio <= SUM)
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    return high


def steps_into_full_slip(solved: Solved, full: Array, gap: float) -> dict[str, Array]:
    """Return the relative differences of force and of mean slip over creepage a `gap` below and above full slip."""
    below, above = (solved(full * (1.0 + side * gap)) for side in (-1.0, 1.0))
    slip = below.mean_slip / above.mean_slip * (1.0 + gap) / (1.0 - gap)
    return {
        "force": np.abs(1.0 - below.tangential_force / above.tangential_force),
        "mean slip": np.abs(1.0 - slip),
    }
