"""The base class of contact models that give the creep forces of an ellipse without resolving the patch."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel, Scale


class CreepForceModel(ContactModel):
    """A contact model that gives Fx, Fy and Mz from the creepages and the spin; its contact is one node of means."""

    scale: ClassVar[Scale] = "patch"

    @abstractmethod
    def creep_forces(self, problem: Problem) -> CreepForces:
        """Return the forces and the moment, of the batch shape."""

    def solve_ellipse(self, problem: Problem) -> Contact:
        """Return the patch means as a contact of one node, of shape (batch, 1, 1)."""
        return Contact.of_patch(problem, self.creep_forces(problem))
