"""Readers that are wrong in one way each, made from that of CONTACT's files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

import wearlaw as wl
from tests.plugins.contact_files.files import FILES
from wearlaw_apps.contact_files import ContactMat


class RightReader(ContactMat):
    """The right one, with a patch on which slip and traction turn."""

    name: ClassVar[str] = "right_reader"
    example: ClassVar[Mapping[str, Any]] = {
        "file": FILES["half_space"].read_text(encoding="ascii"),
        "rolling_speed": "30 m/s",
        "normal_force": "82 kN",
        "slip": "0.7779 %",
    }


def scaled(contact: wl.Contact, factor: float, *names: str) -> wl.Contact:
    return contact.replaced(**{name: factor * getattr(contact, name) for name in names})


def of_problem(contact: wl.Contact, factor: float, name: str) -> wl.Contact:
    assert contact.problem is not None
    return contact.replaced(problem=contact.problem.replaced(**{name: factor * getattr(contact.problem, name)}))


CHANGES: dict[str, tuple[str, Callable[[wl.Contact], wl.Contact]]] = {
    "HalfTheMagnitude": ("vectors_have_their_magnitudes", lambda c: scaled(c, 0.5, "slip")),
    "SwappedSlip": ("elements_dissipate_the_wear_index", lambda c: c.replaced(slip_x=c.slip_y, slip_y=c.slip_x)),
    "HalfTheIndex": ("wear_index_is_forces_times_creepages_of_the_file", lambda c: scaled(c, 0.5, "wear_index")),
    "HalfTheSlip": ("elements_dissipate_the_wear_index", lambda c: scaled(c, 0.5, "slip", "slip_x", "slip_y")),
    "HalfTheTraction": (
        "traction_slips_at_its_bound",
        lambda c: scaled(c, 0.5, "traction", "traction_x", "traction_y", "tangential_force", "force_x", "force_y"),
    ),
    "OtherDensity": (
        "problem_is_that_of_the_file",
        lambda c: scaled(of_problem(c, 1.1, "density"), 1.1, "density"),
    ),
    "OtherLoad": ("problem_is_that_of_the_file", lambda c: of_problem(c, 1.1, "normal_force")),
    "HalfTheFriction": ("problem_is_that_of_the_file", lambda c: of_problem(c, 0.5, "friction_coefficient")),
    "OtherStiffness": ("problem_is_that_of_the_file", lambda c: of_problem(c, 0.5, "effective_modulus")),
    "KilometresPerHour": (
        "contact_is_as_the_example_states",
        lambda c: scaled(of_problem(c, 3.6, "rolling_speed"), 3.6, "rolling_speed"),
    ),
}
"""Contacts that are read wrongly: the check that must catch each, and the change."""


def changed(name: str, change: Callable[[wl.Contact], wl.Contact]) -> Any:
    """Return the class of a reader with a change of its contacts."""

    def read(self: Any, path: Path) -> wl.Contact:
        return change(ContactMat.read(self, path))

    return type(name, (RightReader,), {"read": read, "__module__": __name__, "__doc__": "Wrong."})


class RecognisesNothing(RightReader):
    """Does not recognise its files."""

    @classmethod
    def recognises(cls, head: bytes) -> bool:  # noqa: ARG003
        return False


CAUGHT: dict[Any, str] = {
    **{changed(name, change): check for name, (check, change) in CHANGES.items()},
    RecognisesNothing: "example_is_recognised",
}
"""The check that must catch each."""
