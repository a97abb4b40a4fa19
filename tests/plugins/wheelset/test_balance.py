"""Loads of wheelsets balance the creep forces, at positions from tread to flange."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import borne, wheelset
from wearlaw import Q
from wearlaw.numerics.integrate import integrate_forces  # private: forces of a problem of its own
from wearlaw_models.rigs.wheelset.loads import ROUGH  # private: the accuracy that a search ends at
from wearlaw_models.rigs.wheelset.stand import BALANCED  # private: the accuracy that a search ends at

MODEL = wl.contact_model("fastsim")


def conditions(count: int, seed: int = 0) -> dict[str, Any]:
    draw = np.random.default_rng(seed)
    return {
        "lateral_displacement": Q(draw.uniform(-6.2, 6.2, count), "mm"),
        "vertical_load": Q(draw.uniform(30.0, 100.0, count), "kN"),
        "friction_coefficient": draw.uniform(0.15, 0.5, count),
    }


@pytest.mark.parametrize(("patch", "torque"), [("strips", 800.0), ("ellipse", 0.0)])
def test_loads_and_torque_are_balanced(patch: Any, torque: float) -> None:
    rig, given = wheelset(patch=patch), conditions(100)
    problem: Any = (rig | MODEL).posed(given | {"axle_torque": Q(torque, "N*m")})
    found = integrate_forces(MODEL, problem)
    angle, force = problem.contact_angle, problem.normal_force
    assert angle is not None
    vertical, _ = borne(problem, found.lateral)
    load = given["vertical_load"].to("N").magnitude
    radius = np.asarray(problem.bodies["wheel"].rolling_radius)
    roll = problem.roll
    # Without yaw the creepages change with the speed of rotation by -r/V, 0 and sin(δ - ρ)/V.
    turning = found.spin_moment * np.sin(angle - roll) - found.longitudinal * radius
    grip = np.nansum(problem.friction_coefficient * force * radius, axis=(-2, -1))
    miss = np.abs(np.nansum(turning, axis=(-2, -1)) - torque) / grip
    assert np.abs(vertical / load[:, None] - 1.0).max() < 1.01 * BALANCED
    assert miss.max() < ROUGH  # means of sin(δ - ρ) over rows are not those of mean angles


def test_a_balance_does_not_depend_on_those_before_or_beside_it() -> None:
    pipeline, given = wheelset() | MODEL, conditions(20)
    problem = pipeline.rig.checked_problem(given)
    forces = partial(integrate_forces, MODEL)
    first, second = (pipeline.rig.balanced(problem, forces) for _ in range(2))
    np.testing.assert_array_equal(first.normal_force, second.normal_force)
    alone = pipeline.posed({name: value[7] for name, value in given.items()})
    # The steps are the same but for rounding, which FASTSIM and the normal problem may sum in another order.
    np.testing.assert_allclose(alone.normal_force, first.normal_force[7], rtol=1e-9)


def test_a_flange_that_friction_holds_warns() -> None:
    # For some steps the right wheel carries no load. If its rate were learnt as zero there, the rates were singular.
    rig = wheelset(rail_cant="1:20", rolling_speed=Q(8.72446282923011, "m/s"))
    with pytest.warns(wl.RangeWarning, match="have no result"):
        (rig | wl.contact_model("strip_theory")).posed({
            "lateral_displacement": Q(6.448224844814366, "mm"), "yaw": Q(-17.756389346242024, "mrad"),
            "vertical_load": Q(24.14399725188602, "kN"), "friction_coefficient": 0.4907271308702819,
            "angular_speed": Q(18.806972104059227, "rad/s"),
        })  # fmt: skip
