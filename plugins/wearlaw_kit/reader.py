"""Checks of a reader: the contact of its example file, in itself and against what the file's program says of it."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pint

import wearlaw as wl
from wearlaw.arrays import Array
from wearlaw.contact import hertz
from wearlaw.contact.contact import Contact
from wearlaw.models.reader import Reader
from wearlaw.units.quantities import Quantity, parse, scalar_si
from wearlaw_kit.examples import assert_close
from wearlaw_kit.reduced import parts_of_power
from wearlaw_kit.rules import rule

PRINTED = 1e-3
"""Relative error of numbers that a program prints with four digits."""

STATED = 0.01
"""Relative difference from what the example states."""

COARSE = 0.2
"""Share of the energy that coarse elements miss: in partial slip, 30 along the patch miss 10 % of CONTACT's, and 15 %
in its simplified theory."""

ASIDE = 0.1
"""Share of traction times slip by which they may break dry friction, which a program solves to its tolerance."""

FASTEST = 300.0
"""The highest rolling speed that is tried [m/s]."""


def example_of(reader: Reader) -> Mapping[str, Any]:
    """Return the example of a reader, which may be its file alone."""
    example: Any = reader.example
    return example if isinstance(example, Mapping) else {"file": example}


def contact_of(reader: Reader) -> Contact:
    """Return the contact that a reader reads from its example, checked as in every run."""
    file = example_of(reader)["file"]
    if isinstance(file, Path) or (isinstance(file, str) and "\n" not in file):
        return wl.read_contact(file, reader=reader)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"example{reader.suffixes[0]}")
        path.write_bytes(file if isinstance(file, bytes) else file.encode())
        return wl.read_contact(path, reader=reader)


@rule(Reader, always=True)
def example_is_recognised(reader: Reader) -> None:
    """The reader recognises its example by the first bytes, and its endings are in lower case."""
    file = example_of(reader)["file"]
    if isinstance(file, Path) or (isinstance(file, str) and "\n" not in file):
        file = Path(file).read_bytes()
    head = (file if isinstance(file, bytes) else file.encode())[:4096]
    assert reader.recognises(head), "`recognises` does not recognise the example"
    for suffix in reader.suffixes:
        assert suffix == suffix.lower(), f"the ending {suffix!r} must be in lower case"
        assert suffix.startswith("."), f"the ending {suffix!r} must begin with a dot"


@rule(Reader, always=True)
def vectors_have_their_magnitudes(reader: Reader) -> None:
    """Traction, slip and force are the magnitudes of their components."""
    contact = contact_of(reader)
    printed = PRINTED if reader.digits is None else max(PRINTED, 10.0 ** (1 - reader.digits))
    names = {"traction": ("traction_x", "traction_y"), "tangential_force": ("force_x", "force_y")}
    if not _is_mean(contact):  # the slip of a mean has no direction
        names["slip"] = ("slip_x", "slip_y")
    for name, parts in names.items():
        value, due = np.abs(getattr(contact, name)), np.hypot(*(getattr(contact, part) for part in parts))
        assert_close(value, due, f"the {name} against its components", 0.0, printed * due.max())


@rule(Reader, "stick")
def traction_slips_at_its_bound(reader: Reader) -> None:
    """Where the bodies slip, the traction is at its bound, if that is known."""
    contact = contact_of(reader)
    if np.isfinite(contact.traction_bound).all() and not _is_mean(contact):
        lacking = np.abs(contact.slip) * (contact.traction_bound - np.abs(contact.traction))
        whole = contact.integral(np.abs(contact.slip), contact.traction_bound)
        share = contact.integral(lacking) / whole
        assert (share <= ASIDE).all(), f"where the bodies slip, {share.max():.2g} of the traction bound is missing"


@rule(Reader, always=True)
def wear_index_is_forces_times_creepages_of_the_file(reader: Reader) -> None:
    """The wear index is ξFx + ηFy + φMz with the creepages of the problem."""
    contact = contact_of(reader)
    problem = _problem(contact)
    size = parts_of_power(problem, contact.forces)
    assert_close(contact.wear_index, problem.power(contact.forces), "the wear index", 0.0, STATED * size)


@rule(Reader, "energy_balance")
def elements_dissipate_the_wear_index(reader: Reader) -> None:
    """Traction times slip, summed over the elements, is the wear index, within a fifth for coarse elements."""
    contact = contact_of(reader)
    assert_close(contact.cell_wear_index, contact.wear_index, "q·s summed over the elements, against Tγ", COARSE)


@rule(Reader, always=True)
def problem_is_that_of_the_file(reader: Reader) -> None:
    """The problem has speed, density, load, friction and largest pressure of the contact, and E* of its bodies."""
    contact = contact_of(reader)
    problem = _problem(contact)
    for name in ("rolling_speed", "density", "normal_force"):
        assert_close(getattr(problem, name), getattr(contact, name), f"the {name} of the problem", PRINTED)
    bound = (1.0 + STATED) * problem.friction_coefficient * problem.normal_force
    assert (np.abs(contact.tangential_force) <= bound).all(), "the tangential force is above μN of the problem"
    nodes = tuple(range(contact.rolling_speed.ndim, contact.pressure.ndim))
    if not _is_mean(contact):
        # Of four elements along the patch, those next to the largest pressure are below it by a quarter at the most.
        assert_close(contact.pressure.max(axis=nodes), problem.max_pressure, "the largest pressure", 0.25)
    assert (problem.rolling_speed <= FASTEST).all(), f"the rolling speed is {problem.rolling_speed.max():g} m/s"
    bodies = [*problem.bodies.values()]
    for body in bodies[:1]:
        density = np.asarray(scalar_si(body.material.density, "kg/m^3"))
        assert_close(problem.density, density, "the density of the problem, against its first body", PRINTED)
    if len(bodies) == 2:
        constants = [constant for body in bodies for constant in (body.youngs_modulus, body.material.poisson_ratio)]
        due: Array = np.asarray(hertz.effective_modulus(*constants))
        assert_close(problem.effective_modulus, due, "E* of the problem, against its bodies [Pa]", STATED)


@rule(Reader, applies=lambda reader: len(example_of(reader)) > 1)
def contact_is_as_the_example_states(reader: Reader) -> None:
    """The contact has what the example states of it: totals, creepages, and the largest value of what varies."""
    contact = contact_of(reader)
    problem = _problem(contact)
    for name, stated in example_of(reader).items():
        if name == "file":
            continue
        source = contact if hasattr(contact, name) else problem
        assert hasattr(source, name), f"the example states '{name}', which is no value of a contact or its problem"
        quantity: Quantity | float = parse(stated) if isinstance(stated, str) else stated
        due = quantity.to_base_units().magnitude if isinstance(quantity, pint.Quantity) else quantity
        value = np.asarray(getattr(source, name))
        if value.ndim > contact.rolling_speed.ndim:
            value = np.abs(value).max()
        assert_close(value, np.asarray(due), f"the {name}, against the example", STATED)


def _is_mean(contact: Contact) -> bool:
    """Return whether each contact holds the means of its patch in one node."""
    return contact.pressure.size == contact.rolling_speed.size


def _problem(contact: Contact) -> Any:
    assert contact.problem is not None
    return contact.problem
