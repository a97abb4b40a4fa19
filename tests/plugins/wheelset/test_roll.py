"""The roll of a wheelset under load: the axle is rigid, so gap plus penetration are equal at both wheels."""

from __future__ import annotations

import warnings
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.full_theory import rows
from tests.plugins.wheelset.wheelsets import R0, wheelset
from wearlaw import Array, Q
from wearlaw_models.rigs.wheelset.stand import BALANCED  # private: the accuracy that a search ends at

FASTSIM = wl.contact_model("fastsim")
STEEL = wl.Material(youngs_modulus=Q(2.56 * 82.0, "GPa"), poisson_ratio=0.28, density="7850 kg/m^3")
"""The steel of CONTACT's examples, with G = 82 GPa."""


def posed(pair: wl.Wheelset, **conditions: Any) -> Any:
    """Return the balanced problem, without warnings of climbing."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)
        return (pair | FASTSIM).posed(conditions)


@pytest.mark.validates(
    "wheelset",
    "Roll under load: the heights at which both wheels carry the axle are equal",
    source="each wheel by itself, at the roll as given",
    held_to="{metres:g} m",
    metres=3e-7,
)
@pytest.mark.parametrize(
    ("displacement", "yaw", "load"),
    [
        (2.0, 0.0, 10.0),
        (3.0, 7.2, 80.0),
        (-4.0, -5.0, 120.0),
        (4.9, 0.0, 60.0),
        (6.6, 12.0, 80.0),
    ],
)
def test_wheels_sink_together(displacement: float, yaw: float, load: float, metres: float) -> None:
    # At 4.9 mm the right wheel has two patches, and at 6.6 mm it stands on its flange.
    pair = wheelset()
    conditions: dict[str, Any] = {
        "lateral_displacement": Q(displacement, "mm"),
        "yaw": Q(yaw, "mrad"),
        "vertical_load": Q(load, "kN"),
        "friction_coefficient": 0.3,
    }
    problem = posed(pair, **conditions)
    found = problem.roll[1, 0]
    given = posed(pair, **conditions, roll=Q(found, "rad"))
    # Elements are as long as the estimated approaches ask for, which are others. They leave 0.4 % of the force: 0.3 %
    # of an approach of 0.1 mm, and a pressure that may lie 20 µm aside, on radii of 13 to 300 mm.
    (left, right) = given.loads.stands[-1].now[0][0]
    assert abs(right - left) < metres
    for name in ("normal_force", "contact_angle", "longitudinal_creepage"):
        assert getattr(given, name) == pytest.approx(
            getattr(problem, name), rel=4e-3, abs=20e-6 / 13e-3, nan_ok=True
        ), name


@pytest.mark.skipif(not find_spec("numba"), reason="needs numba")
def test_compiled_code_rolls_as_numpy_does() -> None:
    rolls = []
    try:
        for on in (True, False):
            wl.accelerate(on)
            problem = posed(
                wheelset(), lateral_displacement=Q(np.linspace(-6.1, 6.1, 9), "mm"), yaw="3 mrad",
                vertical_load="80 kN", friction_coefficient=0.3,
            )  # fmt: skip
            rolls.append(problem.roll[:, 1, 0])
    finally:
        wl.accelerate(None)
    # Both are level to 1e-10 m, and levers are 0.2 m and more.
    assert rolls[0] == pytest.approx(rolls[1], rel=0.0, abs=1e-9)


def service() -> dict[str, Array]:
    """Return the columns of the file for a right wheel, in its units and wearlaw's signs."""
    table = rows("contact_service.csv")
    found = {name: np.array([float(row[name]) for row in table]) for name in table[0]}
    return found | {"xi": -found["xi"], "tgamma": -found["tgamma"]}


def of_service(friction: float, **conditions: Any) -> wl.Prediction:
    """Return the wheelset of the file."""
    pair: Any = wheelset(material=STEEL)
    given: dict[str, Any] = {
        "lateral_displacement": Q(service()["displacement"], "mm"), "yaw": "12 mrad", "vertical_load": "80 kN",
        "friction_coefficient": friction, "angular_speed": Q(2.0 / R0, "rad/s"),
    }  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        result: wl.Prediction = (pair | FASTSIM)(**given | conditions)
    return result


@pytest.mark.validates(
    "wheelset",
    "Roll under 80 kN a wheel, from the tread to the flange",
    source="CONTACT (Vollebregt), half-space theory",
    held_to="{milliradian:g} mrad",
    milliradian=0.02,
)
def test_rolls_under_service_load_are_those_of_contact(milliradian: float) -> None:
    # CONTACT found the roll without friction. The rolls of rigid wheels are off by up to 0.5 mrad.
    problem: Any = of_service(1e-9).problem
    assert 1e3 * problem.roll[:, 1, 0] == pytest.approx(1e3 * service()["roll"], rel=0.0, abs=milliradian)


@pytest.mark.validates(
    "wheelset",
    "Normal force under 80 kN a wheel, on the tread and on the flange",
    source="CONTACT (Vollebregt), half-space theory",
    held_to="{tread:.1%} on the tread, {flange:.0%} on the flange",
    tread=0.005,
    flange=0.02,
)
def test_normal_forces_and_angles_under_service_load_are_those_of_contact(tread: float, flange: float) -> None:
    # The roll is CONTACT's, found without friction, which would change that on the flange by 0.15 mrad. On the tread N
    # follows from equilibrium, N cos δ + Fy sin δ = Q, where 10 mrad of δ are 0.5 % of N at 0.2 rad. On the flange Fy
    # bears a quarter of the load, and FASTSIM's is off by 5 % there, as the direction of slip in full slip is.
    expected = service()
    problem: Any = of_service(0.3, roll=Q(expected["roll"], "rad")).problem
    force = np.nan_to_num(problem.normal_force[:, 1])
    on_flange = np.abs(expected["delta"]) > np.radians(30.0)
    bound = np.where(on_flange, flange, tread)
    total = force.sum(axis=-1)
    assert (np.abs(total / expected["fn"] - 1.0) < bound).all()
    angle = (force * np.nan_to_num(problem.contact_angle[:, 1])).sum(axis=-1) / total
    # Patches are twice as wide as under 10 kN, where tread angles are held to 2 mrad. At 5 mm CONTACT joins two
    # patches, 150 mrad apart, to one with a mean angle, which a tenth of the load on the other patch turns by 15 mrad.
    # Its angle is that of the overlap of the undeformed bodies, which on the flange is not the middle of the pressure.
    joined = expected["displacement"] == 5.0
    assert (np.abs(angle - expected["delta"]) < np.where(joined, 0.015, 0.004))[~on_flange].all()


# ------------------------------------------------------------------------------------------------- what is left over


def test_what_the_balance_leaves_over_is_in_the_result() -> None:
    pair: Any = wheelset()
    result = (pair | FASTSIM)(
        lateral_displacement=Q([0.0, 3.0, 5.5], "mm"), vertical_load="60 kN", friction_coefficient=0.3
    )
    assert result.problem.imbalance.shape == (3, 2, 3)
    assert (result.problem.imbalance[:, :, 0] <= BALANCED).all()
    one = result.sel(side="right", patch=1)
    assert one.problem.imbalance.shape == one.problem.roll.shape == one.problem.penetration.shape == (3,)
    assert one.problem.roll[0] == pytest.approx(0.0, abs=1e-9)
