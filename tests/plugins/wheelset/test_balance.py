"""Loads of wheelsets balance the creep forces, at positions from tread to flange."""

from __future__ import annotations

from functools import partial
from itertools import islice
from typing import Annotated, Any, ClassVar, TypedDict

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.brute_force import positions
from tests.plugins.wheelset.wheelsets import borne, wheelset
from wearlaw import Array, Q
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


@pytest.mark.parametrize(
    ("patch", "torque", "model"), [("strips", 800.0, wl.contact_model("strip_theory")), ("ellipse", 0.0, MODEL)]
)
def test_loads_and_torque_are_balanced(patch: Any, torque: float, model: wl.ContactModel) -> None:
    # Forces of FASTSIM on strips jump by up to 0.5 %, and no balance is nearer than that.
    rig, given = wheelset(patch=patch), conditions(100)
    problem: Any = (rig | model).posed(given | {"axle_torque": Q(torque, "N*m")})
    found = integrate_forces(model, problem)
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


@pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning")
@pytest.mark.parametrize(
    ("number", "displacement", "yaw", "load"), [(31, 6.071, -22.31, 33.0), (46, 6.464, -14.06, 64.5)]
)
def test_a_tread_bears_what_friction_takes_from_a_flank(
    number: int, displacement: float, yaw: float, load: float
) -> None:
    pair = next(islice(positions(60, 201), number, None)).pair
    problem: Any = (pair | MODEL).posed({
        "lateral_displacement": Q(displacement, "mm"), "yaw": Q(yaw, "mrad"), "vertical_load": Q(load, "kN"),
        "friction_coefficient": 0.35,
    })  # fmt: skip
    vertical, _ = borne(problem, integrate_forces(MODEL, problem).lateral)
    np.testing.assert_allclose(vertical, 1e3 * load, rtol=1.01 * BALANCED)


@pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning")
def test_a_wheel_that_its_flange_hardly_bears_has_a_result() -> None:
    # For some steps the right wheel carries no load. If its rate were learnt as zero there, the rates were singular.
    rig = wheelset(rail_cant="1:20", rolling_speed=Q(8.72446282923011, "m/s"))
    model, load = wl.contact_model("strip_theory"), 24143.99725189
    problem: Any = (rig | model).posed({
        "lateral_displacement": Q(6.448224844814366, "mm"), "yaw": Q(-17.756389346242024, "mrad"),
        "vertical_load": Q(load, "N"), "friction_coefficient": 0.4907271308702819,
        "angular_speed": Q(18.806972104059227, "rad/s"),
    })  # fmt: skip
    vertical, _ = borne(problem, integrate_forces(model, problem).lateral)
    np.testing.assert_allclose(vertical, [[load, load]], rtol=1.01 * BALANCED)


class Temperature(TypedDict):
    """Temperature of the surfaces."""

    surface_temperature: Annotated[wl.QuantityLike, wl.Unit("K", usual=(250.0, 700.0))]
    """Temperature of the surfaces, T [K]."""


def hot(problem: wl.Problem) -> wl.Problem:
    """Return a problem with friction that falls with the square root of the temperature, from 300 K on."""
    temperature = problem.conditions["surface_temperature"]
    assert temperature.shape == problem.batch_shape
    return problem.replaced(friction_coefficient=problem.friction_coefficient * np.sqrt(300.0 / temperature))


class Hot(wl.Stage):
    """Friction of hot surfaces."""

    name: ClassVar[str] = "hot"
    conditions: ClassVar[Any] = Temperature

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return hot(problem)


class HotModel(wl.ContactModel):
    """FASTSIM with friction of hot surfaces."""

    name: ClassVar[str] = "hot_fastsim"
    conditions: ClassVar[Any] = Temperature

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        return MODEL.solve(hot(problem))

    def solve_strips(self, problem: wl.Problem) -> wl.Contact:
        return MODEL.solve(hot(problem))


class HotLaw(wl.WearLaw):
    """Wear in proportion to temperature and wear-index density."""

    name: ClassVar[str] = "hot_law"
    conditions: ClassVar[Any] = Temperature

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return 1e-12 * contact.per_node(contact.conditions["surface_temperature"]) * contact.wear_index_density

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}


@pytest.mark.parametrize(("patch", "lateral_force"), [("strips", False), ("ellipse", False), ("ellipse", True)])
@pytest.mark.parametrize("parts", [(MODEL, Hot()), (HotModel(),)], ids=["stage", "contact model"])
def test_loads_are_balanced_under_conditions_of_models_that_vary(patch: Any, lateral_force: bool, parts: Any) -> None:
    """As with the friction that follows from the temperature, given to the rig at each position."""
    rig, temperature = wheelset(patch=patch), np.array([[300.0, 450.0, 700.0]])
    given: dict[str, Any] = {"vertical_load": "80 kN", "yaw": Q([2.0], "mrad")}
    if lateral_force:
        given |= {"lateral_force": Q([[8.0], [-15.0]], "kN")}
    else:
        given |= {"lateral_displacement": Q([[2.0], [-6.0]], "mm")}
    pipeline: Any = rig
    for part in parts:
        pipeline = pipeline | part
    problem = pipeline.posed({**given, "friction_coefficient": 0.4, "surface_temperature": Q(temperature, "K")})
    by_hand = (rig | MODEL).posed({**given, "friction_coefficient": 0.4 * np.sqrt(300.0 / temperature)})
    same = (rig | MODEL).posed({**given, "friction_coefficient": np.full_like(temperature, 0.4)})
    same = same.replaced(conditions=problem.conditions)
    np.testing.assert_array_equal(
        problem.conditions["surface_temperature"][problem.resolved],
        np.broadcast_to(temperature[..., None, None], problem.batch_shape)[problem.resolved],
    )
    # Each balance leaves at most this share of the loads and of the torque of full slip with the friction of the rig,
    # and both wheels' forces change with the speed of rotation in the same sense.
    left = 2.0 * (ROUGH if lateral_force else BALANCED) * np.nanmax(problem.normal_force)
    due = integrate_forces(MODEL, by_hand).longitudinal
    np.testing.assert_allclose(problem.normal_force, by_hand.normal_force, rtol=0.0, atol=left)
    np.testing.assert_allclose(integrate_forces(MODEL, hot(problem)).longitudinal, due, rtol=0.0, atol=left)
    assert np.nanmax(np.abs(integrate_forces(MODEL, hot(same)).longitudinal - due)) > 10.0 * left, (
        "its friction does not matter"
    )


def test_a_sweep_of_wheelsets_has_the_temperature_of_laws_and_stages_as_an_axis() -> None:
    pipeline: wl.Pipeline[...] = wheelset() | MODEL | Hot() | HotLaw()
    temperature = np.array([300.0, 600.0])
    given: dict[str, Any] = {"lateral_displacement": Q([0.0, 5.0], "mm"), "vertical_load": "80 kN", "yaw": "2 mrad"}
    swept = wl.sweep(pipeline, **given, friction_coefficient=0.4, surface_temperature=Q(temperature, "K"))
    assert swept.wear_rate.dims[:2] == ("lateral_displacement", "surface_temperature")
    for number, kelvin in enumerate(temperature):
        alone = pipeline(**given, friction_coefficient=0.4, surface_temperature=Q(kelvin, "K"))
        found = swept.wear_rate.isel(surface_temperature=number).values
        # The steps are the same but for rounding, which FASTSIM and the normal problem may sum in another order.
        np.testing.assert_allclose(found, alone.wear_rate.to(swept.wear_rate.attrs["units"]).magnitude, rtol=1e-9)
