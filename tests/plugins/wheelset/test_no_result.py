"""Positions whose loads do not balance have no result, and say why; all others balance whatever is asked of them."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.brute_force import worn as worn_by_bells
from tests.plugins.wheelset.wheelsets import borne, through, wheelset
from wearlaw import Array, Q
from wearlaw_models.rigs import wheelset as ws

SHARE = 1e-3
"""Greatest share of the load that a result may leave over."""

COMMON: dict[str, Any] = {"vertical_load": "80 kN", "friction_coefficient": 0.3, "curve_radius": "400 m"}

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")


def worn() -> ws.Profile:
    """Return an S1002 whose flange root has lost up to 0.48 mm, over some 10 mm."""
    new = ws.Profile.s1002()
    s = np.arange(new.curve.s[0], new.curve.s[-1], 0.2e-3)
    y = new.curve.at(s)[0]
    return new.worn(Q(s, "m"), Q(0.48 * np.exp(-(((y + 37e-3) / 5e-3) ** 2)), "mm"))


WHEELS = {"new": ws.Profile.s1002(), "worn": worn()}


def predicted(wheel: str, **conditions: Any) -> wl.Prediction:
    """Return the contact of a new or worn wheel."""
    contact: Any = wheelset(wheel=WHEELS[wheel], rolling_speed="20 m/s")
    found: wl.Prediction = (contact | wl.contact_model("fastsim"))(**COMMON | conditions)
    return found


def missing(found: wl.Prediction) -> Any:
    """Return which positions have no result."""
    return np.asarray(found["status"].magnitude != "balanced").all(axis=(1, 2))


def left_over(found: wl.Prediction, load: float) -> dict[str, Array]:
    """Return what the patches leave over at positions without yaw, in shares of the load of a wheel."""
    problem: Any = found.problem
    angle, normal = np.asarray(problem.contact_angle), found.normal_force.m_as("N")
    along, across = found.longitudinal_force.m_as("N"), found.lateral_force.m_as("N")
    radius, roll = np.asarray(problem.bodies["wheel"].rolling_radius), problem.roll
    # Without yaw the creepages change with the speed of rotation by -r/V, 0 and sin(δ - ρ)/V.
    torque = np.nansum(found.spin_moment.m_as("N*m") * np.sin(angle - roll) - along * radius, axis=(1, 2))
    vertical, lateral = borne(problem, across)
    return {
        "load": np.abs(vertical / load - 1.0).max(axis=1),
        "torque": np.abs(torque) / np.nansum(problem.friction_coefficient * normal * radius, axis=(1, 2)),
        "lateral force": lateral.sum(axis=1) / load,
    }


@pytest.mark.validates(
    "wheelset",
    "Loads and torque of every result balance from the tread to the flange, of a new and a worn wheel",
    source="equilibrium, from rows and patches",
    held_to="{share:g} of the load",
    share=SHARE,
)
@pytest.mark.parametrize(("wheel", "most"), [("new", 6.6), ("worn", 7.2)])
def test_what_does_not_balance_has_no_result(wheel: str, most: float, share: float) -> None:
    place = np.concatenate([np.arange(-6.0, 6.0, 1.0), np.arange(6.0, most, 0.03)])
    found = predicted(wheel, lateral_displacement=Q(place, "mm"))
    none = missing(found)
    assert not none.any()
    for name in ("normal_force", "wear_index", "guiding_force", "wheel_load", "lateral_displacement"):
        assert np.isnan(found[name].magnitude[none]).all(), name
        assert np.isfinite(found[name].magnitude[~none]).any(axis=(1, 2)).all(), name
    left = left_over(found, 80e3)
    for name in ("load", "torque"):
        assert (left[name] <= 1.001 * share).all(), name


@pytest.mark.parametrize(("wheel", "forces"), [("new", [5.0, 60.0, 78.0]), ("worn", [25.0, 40.0])])
def test_each_position_has_the_lateral_force_asked_for_or_none(wheel: str, forces: list[float]) -> None:
    found = predicted(wheel, lateral_force=Q(np.array(forces), "kN"))
    none = missing(found)
    assert not none.all()
    left = left_over(found, 80e3)
    assert (np.abs(left["lateral force"] - np.array(forces) / 80.0) <= SHARE)[~none].all()
    assert np.isnan(found["guiding_force"].magnitude[none]).all()


FORCES: dict[str, Any] = {"lateral_force": Q([10.0, 300.0], "kN"), **COMMON}
"""Lateral forces on a wheelset of 160 kN, of which no flange bears the second."""

CONTACT: Any = wheelset(rolling_speed="20 m/s") | wl.contact_model("fastsim")


def begins(status: Any) -> bool:
    """Return whether the first position is balanced, and the second one states the greatest force."""
    first, second = map(str, np.asarray(status).ravel())
    return first == "balanced" and second.startswith("the greatest lateral force is ")


def test_a_warning_counts_the_positions_without_a_result_and_status_says_why() -> None:
    said = "1 of 2 positions have no result, the first with a lateral force of 300 kN: the greatest lateral force"
    with pytest.warns(wl.RangeWarning, match=said):
        found = CONTACT(**FORCES)
    assert begins(found["status"].magnitude[:, 1, 0])
    assert begins(found.problem.status[:, 0, 2])
    assert begins(found.to_dataset().status[:, 1, 0])
    assert found[0].sel(side="left", patch=1)["status"].magnitude == "balanced"
    assert set(found.to_dataframe(["status"])["status"]) == {"balanced"}  # a table has the patches that exist
    assert found == found[[0, 1]]
    staged = (CONTACT | wl.stage("third_body", reduction=0.5)).predict(found.problem)
    assert begins(staged["status"].magnitude[:, 1, 0])


def test_a_wheel_that_friction_holds_on_its_flank_is_wedged() -> None:
    """At 70 deg and a friction coefficient of 0.35, full slip leaves 0.013 of a normal force to bear a wheel."""
    found = CONTACT(
        lateral_displacement="6.505 mm", yaw=Q([-4.0, -22.0], "mrad"), vertical_load="17 kN", friction_coefficient=0.35
    )
    first, second = map(str, found["status"].magnitude[:, 1, 0])
    assert first == "balanced"
    assert second.startswith("the right wheel is wedged: ")


def test_a_wheelset_that_leaves_both_rails_on_the_way_to_its_balance_has_a_result() -> None:
    wheel = worn_by_bells(wl.Profile.s1002(), (2.76, 10.7, 1.25), (-38.0, 6.0, 0.9))
    found = (wheelset(wheel=wheel, rolling_speed="20 m/s") | wl.contact_model("strip_theory"))(
        lateral_displacement="-6.99 mm", yaw="23 mrad", vertical_load="11.7 kN", friction_coefficient=0.35
    )
    assert (found["status"].magnitude == "balanced").all()


def test_sweeps_keep_the_status(tmp_path: Path) -> None:
    kept = wl.sweep(CONTACT, **FORCES, outputs=["status", "normal_force"], store=tmp_path / "kept")
    assert begins(kept.status[:, 1, 0])
    assert np.isnan(kept.normal_force[1]).all()


# ------------------------------------------------------------------------------------------------- a resampled flank


def resampled(spacing: float) -> ws.Profile:
    """Return an S1002 through points at even arc lengths [m], which meet the ends of its straight flank nowhere."""
    curve = ws.Profile.s1002().curve
    s = np.arange(curve.s[0] + 0.37 * spacing, curve.s[-1], spacing)
    return through(*curve.at(s)[:2], "wheel")


@pytest.mark.parametrize(
    "wheel", [WHEELS["new"], resampled(0.1e-3), resampled(0.5e-3)], ids=["exact", "fine", "coarse"]
)
def test_the_straight_flank_of_resampled_points_does_not_climb(wheel: ws.Profile) -> None:
    contact = wheelset(wheel=wheel, rolling_speed="20 m/s") | wl.contact_model("fastsim")
    given: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        contact.posed({**given, "lateral_displacement": Q(np.arange(6.2, 6.46, 0.05), "mm")})
    assert not [1 for text in caught if "climbs" in str(text.message)]
    with pytest.warns(wl.RangeWarning, match="climbs its rail"):
        contact.posed({**given, "lateral_displacement": "7 mm"})
