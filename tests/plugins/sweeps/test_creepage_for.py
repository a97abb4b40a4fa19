"""The creepage that transmits a given force, of a wheel on a rail and of a rig of one's own."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.core.test_own_rigs import OnRail
from tests.plugins.fits.test_any_rig import FASTSIM, ON_ELLIPSE, ROLLER, WHEEL
from tests.strategies import EPS
from wearlaw import Q


@pytest.mark.parametrize("model", ["fastsim", "polach", "shen_hedrick_elkins"])
def test_the_creepage_on_a_rail_transmits_the_longitudinal_force(model: str) -> None:
    contact = WHEEL | wl.contact_model(model)
    given: Any = {**ON_ELLIPSE, "lateral_creepage": Q([[0.0], [0.1]], "%"), "spin": Q([[0.0], [-0.6]], "1/m")}
    force = Q([-20.0, -1e-6, 0.0, 1.0, 23.0], "kN")
    creepage = wl.creepage_for(contact, tangential_force=force, **given)
    assert creepage.shape == (2, 5)
    assert np.array_equal(np.sign(creepage.magnitude), np.sign(np.broadcast_to(force.magnitude, (2, 5))))
    back = contact(longitudinal_creepage=creepage, **given).longitudinal_force.to("kN").magnitude
    # The logarithm of the creepage, -20 at the least, is found to some roundings, and the force to those of a sum of
    # hundreds of terms of the size of the friction force, 24 kN.
    assert back == pytest.approx(np.broadcast_to(force.magnitude, (2, 5)), rel=1e-12, abs=1e3 * EPS * 24.0)


def test_the_creepage_of_a_rig_of_ones_own_on_a_rail_is_found() -> None:
    contact: Any = OnRail() | wl.contact_model("fastsim")
    creepage = wl.creepage_for(contact, traction_coefficient=[0.1, -0.2], mass="8 t")
    back = contact(mass="8 t", longitudinal_creepage=creepage)
    assert back.longitudinal_force / Q(8e3 * 9.81, "N") == pytest.approx(np.array([0.1, -0.2]), rel=1e-12)


class Odd(wl.CreepForceModel):
    """A contact whose traction is a function of the longitudinal creepage, and not one that rises from zero."""

    name: ClassVar[str] = "odd"
    source: ClassVar[str] = "a test"
    falls: bool = False

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return a force that peaks at 1 %, or one of 0.1 N at rest."""
        along = problem.longitudinal_creepage
        share = 0.02 * along / (along**2 + 1e-4) if self.falls else 0.5 + 0.5 * along
        force = problem.friction_coefficient * problem.normal_force * share
        return wl.CreepForces(longitudinal=force, lateral=0.0 * force, spin_moment=0.0 * force)


@pytest.mark.parametrize(
    ("falls", "traction", "said"),
    [
        (False, 0.1, "of 0.1: without longitudinal creepage the contact transmits more already"),
        (False, [[0.2, 0.1]], r"of 0.1 at index \[0, 1\]: without longitudinal creepage the contact transmits more"),
        (False, -0.1, "no creepage transmits a traction coefficient of 0.1"),
        (True, 0.2, "of 0.2: several creepages do, because the traction falls again as"),
        (True, -0.2, "of -0.2: several creepages"),
        (True, 0.31, "of 0.31: with contact model 'odd' it stays below 0.3 "),
    ],
)
def test_a_traction_of_no_single_creepage_is_refused(falls: bool, traction: Any, said: str) -> None:
    with pytest.raises(wl.ConditionsError, match=said):
        wl.creepage_for(WHEEL | Odd(falls=falls), traction_coefficient=traction, **ON_ELLIPSE)


def test_a_traction_of_one_creepage_is_found_even_if_that_of_others_is_not() -> None:
    found = wl.creepage_for(WHEEL | Odd(), traction_coefficient=0.2, **ON_ELLIPSE)
    assert found.to("").magnitude == pytest.approx(1 / 3, rel=1e-12)
    # 2 x/(x² + 1) is 0.01 at 0.005 only, below 1: at 200 it is outside.
    found = wl.creepage_for(WHEEL | Odd(falls=True), traction_coefficient=0.3 * 0.01, **ON_ELLIPSE)
    assert found.to("%").magnitude == pytest.approx(100.0 - np.sqrt(1e4 - 1.0), rel=1e-10)


def test_full_slip_on_a_rail_has_no_single_creepage() -> None:
    for traction in (0.3, -0.3, 0.4):
        with pytest.raises(wl.ConditionsError, match=r"no creepage transmits .* stays below 0\.3 \(full slip\)"):
            wl.creepage_for(FASTSIM, traction_coefficient=traction, **ON_ELLIPSE)
    # What friction leaves for the longitudinal direction where the lateral creepage is as large as can be.
    with pytest.raises(wl.ConditionsError, match=r"stays below 0\.2"):
        wl.creepage_for(FASTSIM, traction_coefficient=0.25, lateral_creepage="100 %", **ON_ELLIPSE)


def test_the_creepage_that_is_found_is_not_given() -> None:
    with pytest.raises(wl.ConditionsError, match="creepage: creepage_for returns it; leave it out"):
        wl.creepage_for(ROLLER, traction_coefficient=0.1, mass="20 kg", creepage="1 %")
