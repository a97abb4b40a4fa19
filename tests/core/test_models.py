"""The base classes that a plugin derives from, exercised with models of a few lines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Array, Q

RIG = wl.TwinDisc.suros()


class Ramp(wl.LineContactModel):
    """Sticks in the first half of the patch; behind it, slip rises with x."""

    name = "ramp"
    source = "a test"
    steepness: float = 1.0

    @property
    def exemptions(self) -> Mapping[wl.Claim, str]:
        return {"energy_balance": "slip and traction are not those of one theory"}

    def slip_length(self, problem: wl.Problem) -> Array:
        return problem.half_width

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        assert (problem.creepage >= 0).all()
        x = nodes.x
        slip = self.steepness * problem.creepage * np.maximum(x, 0.0) / problem.half_width
        return wl.LineFields(
            pressure=wl.hertz.pressure(x, problem.half_width, problem.max_pressure),
            traction=np.broadcast_to(problem.creepage * 1e6, x.shape),
            slip=slip,
            traction_bound=np.full_like(x, 1e9),
        )

    def tangential_force_per_width(self, problem: wl.Problem) -> Array:
        return problem.creepage * 1e6 * 2.0 * problem.half_width


class Proportional(wl.WearLaw):
    name = "proportional"
    source = "a test"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return contact.wear_index_density


@pytest.mark.parametrize("base", [wl.ContactModel, wl.LineContactModel, wl.CreepForceModel, wl.WearLaw])
def test_the_bases_are_abstract(base: type[Any]) -> None:
    with pytest.raises(TypeError, match="abstract"):
        base()


@pytest.mark.parametrize("creepage", [[0.02], [-0.02], [0.02, -0.02, 0.0]])
def test_negative_creepage_mirrors_traction_and_slip(creepage: list[float]) -> None:
    problem = RIG.problem(normal_force="7 kN", creepage=Q(creepage, ""), friction_coefficient=0.4)
    forward = problem.replaced(longitudinal_creepage=np.abs(problem.creepage))
    mirrored, straight = Ramp().solve(problem), Ramp().solve(forward)
    sign = np.sign(problem.creepage)
    np.testing.assert_array_equal(mirrored.traction, sign[:, None] * straight.traction)
    np.testing.assert_array_equal(mirrored.slip, sign[:, None] * straight.slip)
    np.testing.assert_array_equal(mirrored.tangential_force, sign * straight.tangential_force)
    np.testing.assert_array_equal(mirrored.pressure, straight.pressure)
    np.testing.assert_array_equal(mirrored.wear_index, straight.wear_index)


def test_solve_puts_nodes_on_the_whole_patch_and_integrates_the_slip_zone() -> None:
    problem = RIG.problem(normal_force="7 kN", creepage=Q([0.02, 0.05], ""), friction_coefficient=0.4)
    contact = Ramp().solve(problem)
    # ∫ of a ramp over half the patch: a quarter of the creepage on average, half the area slipping. Gauss-Legendre
    # of 24 nodes in θ integrates sin θ cos θ to rounding, of which 48 terms leave some eps.
    np.testing.assert_allclose(contact.mean_slip, problem.creepage / 4.0, rtol=1e-14)
    np.testing.assert_allclose(contact.stick_ratio, 0.5, rtol=1e-14)
    np.testing.assert_allclose(contact.patch_area, problem.patch_area, rtol=1e-14)


def test_an_outside_model_and_law_make_a_pipeline() -> None:
    predict = RIG | Ramp() | Proportional()
    result = predict(normal_force="7 kN", creepage=Q([0.02, -0.02], ""), friction_coefficient=0.4)
    # The law is the local q·s; q is uniform and s is a quarter of the creepage on average.
    np.testing.assert_allclose(result.wear_rate.to("kg/m^3").magnitude, 0.02e6 * 0.005, rtol=1e-13)
    np.testing.assert_allclose(result.tangential_force.magnitude[0], -result.tangential_force.magnitude[1])


def test_what_a_model_or_law_does_not_declare_has_a_cautious_default() -> None:
    assert Ramp().scale == "cells"
    assert not Ramp().uses_measured_traction
    assert wl.contact_model("exact").exemptions == {}
    law = Proportional()
    assert (law.scale, law.valid_range, law.numbers) == ("any", {}, {})
    assert (law.breakpoints({}), law.ramps({}), law.jumps({})) == (None, None, {})
    assert law.calibration is None
    assert law.band() is None
    assert law.monotone_in == ()


def calibration(**fields: Any) -> wl.Calibration:
    return wl.Calibration(**{"contact_model": "fastsim", "scale": "cells", "materials": "-", "source": "-", **fields})


FASTSIM, ELLIPTIC = wl.contact_model("fastsim"), wl.contact_model("fastsim", bound="elliptic")


@pytest.mark.parametrize(
    ("fitted_for", "model", "scale", "covered"),
    [
        (calibration(), FASTSIM, "cells", True),
        (calibration(), FASTSIM, "patch", False),
        (calibration(), wl.contact_model("exact"), "cells", False),
        (calibration(), ELLIPTIC, "cells", True),
        (calibration(options=(("bound", "parabolic"),)), FASTSIM, "cells", True),
        (calibration(options=(("bound", "parabolic"),)), ELLIPTIC, "cells", False),
        (calibration(options=(("no_such_field", "x"),)), FASTSIM, "cells", False),
        (calibration(scale="patch"), wl.contact_model("global"), "patch", True),
        (calibration(scale="patch"), wl.contact_model("exact"), "patch", True),
        (calibration(scale="patch"), wl.contact_model("exact"), "cells", False),
        (calibration(contact_model="any"), wl.contact_model("exact"), "cells", True),
        (calibration(contact_model="any"), wl.contact_model("exact"), "patch", False),
        (calibration(contact_model="any", scale="any"), wl.contact_model("exact"), "patch", True),
        (calibration(geometry="ellipse"), FASTSIM, "cells", False),
        (calibration(geometry="any"), FASTSIM, "cells", True),
    ],
)
def test_a_calibration_covers_the_contact_it_was_fitted_for(
    fitted_for: wl.Calibration, model: wl.ContactModel, scale: wl.Scale, covered: bool
) -> None:
    assert fitted_for.covers(model, scale) is covered


def test_a_calibration_says_what_it_was_fitted_for() -> None:
    assert str(calibration(scale="patch")) == "patch means (the global model)"
    assert str(calibration(contact_model="any", scale="any")) == "any contact"
    assert str(calibration(options=(("bound", "parabolic"),))) == (
        "the cells of contact_model('fastsim', bound='parabolic')"
    )


WRONG_RATES: dict[str, Callable[[wl.Contact], Array]] = {
    r"returned values of shape \(\d+,\); it must return one a node": lambda contact: np.atleast_1d(contact.density),
    "returned a value that is not finite": lambda contact: contact.pressure * np.nan,
    "gives a negative wear rate, -": lambda contact: -contact.wear_index_density,
    "gives values where the bodies stick": lambda contact: contact.pressure,
}


@pytest.mark.parametrize("said", WRONG_RATES)
def test_a_law_that_breaks_its_contract_is_named(said: str) -> None:
    class Wrong(Proportional):
        name = "wrong"

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
            return WRONG_RATES[said](contact)

    with pytest.raises(wl.ModelError, match=f"wear law 'wrong' {said}"):
        (RIG | Ramp() | Wrong())(normal_force="7 kN", creepage="1 %", friction_coefficient=0.4)
    rail = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    with pytest.raises(wl.ModelError, match=f"wear law 'wrong' {said}"):
        (rail | wl.contact_model("fastsim") | Wrong())(
            normal_force="80 kN", longitudinal_creepage="0.1 %", friction_coefficient=0.3
        )


def test_what_a_model_knows_of_its_force_without_nodes_is_used() -> None:
    class Knows(wl.ContactModel):
        name = "knows"
        source = "a test"

        def solve_line(self, problem: wl.Problem) -> wl.Contact:
            raise AssertionError("not needed")

        def tangential_force(self, problem: wl.Problem) -> Array:
            return 7e3 * problem.creepage

    contact = (RIG | Knows())(normal_force="7 kN", creepage=Q([1.0, 2.0], "%"), friction_coefficient=0.4)
    assert contact.tangential_force.to("N").magnitude.tolist() == [70.0, 140.0]
