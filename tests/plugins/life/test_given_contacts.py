"""Contacts that a program has computed accumulate on a profile: those of a wheelset give its own sum."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Q
from wearlaw.errors import DataError
from wearlaw_apps.life.removal import swept  # private: an independent mass

AT = Q(np.arange(-60.0, 50.0, 0.25), "mm")
SHARE = np.array([0.2, 0.3, 0.5])
COLUMNS = {
    "contact_position": "y{contact} [mm]",
    "normal_force": "N{contact} [kN]",
    "longitudinal_creepage": "xi{contact} [%]",
    "lateral_creepage": "eta{contact} [%]",
    "spin": "phi{contact} [1/m]",
    "semi_axis_a": "a{contact} [mm]",
    "semi_axis_b": "b{contact} [mm]",
}

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")


def predict(wheel: Any = None) -> wl.Pipeline[...]:
    fields: dict[str, Any] = {"rail": wl.Profile.uic60(), "material": wl.steel(), "nominal_radius": "460 mm"}
    rig = wl.ProfileContact(wheel=wheel or wl.Profile.s1002(), rail_cant="1:40", rolling_speed="20 m/s", **fields)
    return rig | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")


@pytest.fixture(scope="module")
def of_wheelset() -> wl.Prediction:
    """The right wheel touches once, once and twice."""
    pair = wheelset(patch="ellipse") | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")
    return pair(lateral_displacement=Q([-2.0, 3.0, 5.0], "mm"), vertical_load="60 kN", friction_coefficient=0.3)


@pytest.fixture(scope="module")
def run(of_wheelset: wl.Prediction) -> pd.DataFrame:
    """The contacts of the right wheel of each row, as a vehicle program writes them; absent ones have N = 0."""
    p: Any = of_wheelset.problem
    wheel = wl.Profile.s1002().curve
    there = np.broadcast_to(p.exists, p.batch_shape)[:, 1, :2]
    arcs = np.where(there, np.broadcast_to(p.body("wheel").profile_position, p.batch_shape)[:, 1, :2], 0.0)
    table: dict[str, Any] = {"share": SHARE}
    for contact in range(2):
        values = {
            "y{} [mm]": 1e3 * wheel.at(arcs[:, contact])[0],
            "N{} [kN]": 1e-3 * p.normal_force[:, 1, contact],
            "xi{} [%]": 1e2 * p.longitudinal_creepage[:, 1, contact],
            "eta{} [%]": 1e2 * p.lateral_creepage[:, 1, contact],
            "phi{} [1/m]": p.spin[:, 1, contact],
            "a{} [mm]": 1e3 * p.a[:, 1, contact],
            "b{} [mm]": 1e3 * p.b[:, 1, contact],
        }
        rest = {"y{} [mm]": 0.0, "N{} [kN]": 0.0, "a{} [mm]": 1.0, "b{} [mm]": 1.0}
        table |= {
            head.format(contact + 1): np.where(there[:, contact], value, rest.get(head, 0.0))
            for head, value in values.items()
        }
    assert there.sum(axis=1).tolist() == [1, 1, 2]
    return pd.DataFrame(table)


@pytest.mark.parametrize("from_file", [False, True])
def test_contacts_of_a_wheelset_wear_as_the_wheelset(
    of_wheelset: wl.Prediction, run: pd.DataFrame, from_file: bool, tmp_path: Path
) -> None:
    table: Any = run
    if from_file:
        table = tmp_path / "run.csv"
        run.to_csv(table, index=False)
    across = of_wheelset.wear_profile("wheel", at=AT)["depth"].sel(side="right").values
    found = wl.wear_profiles(predict(), table, at=AT, share="share", columns=COLUMNS, friction_coefficient=0.3)
    # The same strips at the same places: what differs is the rounding of y to arc length and back, of 1e-9 m.
    expected = SHARE @ across
    assert found["depth"].values == pytest.approx(expected, abs=1e-5 * expected.max())


def test_a_life_of_contacts_removes_their_mass(of_wheelset: wl.Prediction, run: pd.DataFrame) -> None:
    found = wl.wear_out(predict(), run, over="200 km", columns=COLUMNS, friction_coefficient=0.3)
    mass = np.nansum(of_wheelset.mass_lost("200 km", "wheel").m_as("kg")[:, 1], axis=-1) @ SHARE
    # The contacts stay, but their rolling radii fall by up to the depth of wear, a share of 1e-4 of the radius.
    assert found.table["mass [kg]"].iloc[-1] == pytest.approx(mass, rel=1e-3)
    volume = swept(found.worn_profiles[0][0], found.profile, 0.46)
    assert 7850.0 * volume == pytest.approx(found.table["mass [kg]"].iloc[-1], rel=1e-9)


def test_cone_under_uniform_slip_wears_by_archard_in_closed_form() -> None:
    """Patches in full slip ξ every Δ = 0.25 mm: a wheel of radius r loses the depth k N ξ L/(H 2π r n Δ)."""
    y = np.arange(-30.0, 30.1, 0.25)
    cone = wl.Profile.from_points(y=Q(np.linspace(-60.0, 60.0, 61), "mm"),
                                  z=Q(np.linspace(3.0, -3.0, 61), "mm"), kind="wheel")  # fmt: skip
    rig = wl.ProfileContact(wheel=cone, rail=wl.Profile.uic60(), nominal_radius="460 mm", rail_cant="1:40",
                            material=wl.steel(), rolling_speed="20 m/s")  # fmt: skip
    law = wl.wear_law("archard", coefficient=1e-4, hardness="2.6 GPa")
    states = pd.DataFrame({"contact_position [mm]": y})
    given: dict[str, Any] = {"normal_force": "60 kN", "longitudinal_creepage": "3 %", "spin": "0 1/m",
                             "semi_axis_a": "6 mm", "semi_axis_b": "5 mm", "friction_coefficient": 0.3}  # fmt: skip
    found = wl.wear_out(rig | wl.contact_model("fastsim") | law, states, over="400 km", share="equal", **given)
    across = found.profiles["depth"].isel(distance=-1)
    at = across["place"].values
    middle = np.abs(at) < 20.0
    slope = np.arctan(0.05)
    radius = 0.46 - 1e-3 * at[middle] * np.sin(slope)
    width = y.size * 0.25e-3 / np.cos(slope)
    expected = 1e-4 / 2.6e9 * 60e3 * 0.03 * 400e3 / (2.0 * np.pi * radius * width)
    # The depth of a patch is a parabola, which sums every Δ to 1 ± Δ²/(4 b²) = 1 ± 6e-4. The radius changes by 1e-4.
    assert 1e-3 * across.values[0, middle] == pytest.approx(expected, rel=1e-3)


def test_patch_of_constant_curvatures_is_that_of_hertz() -> None:
    """A cone on a rail of one radius: the ellipse of `WheelRail`."""
    y = np.linspace(-40.0, 40.0, 400)
    cone = wl.Profile.from_points(y=Q(y, "mm"), z=Q(-0.05 * y, "mm"), kind="wheel")
    angle = np.linspace(-0.1, 0.1, 2001)
    head = wl.Profile.from_points(
        y=Q(300.0 * np.sin(angle), "mm"), z=Q(300.0 * (1.0 - np.cos(angle)), "mm"), kind="rail"
    )
    fields: dict[str, Any] = {"material": wl.steel(), "rolling_speed": "20 m/s"}
    rig = wl.ProfileContact(wheel=cone, rail=head, nominal_radius="460 mm", **fields)
    one: dict[str, Any] = {"normal_force": "60 kN", "longitudinal_creepage": "0.1 %", "friction_coefficient": 0.3}
    p = rig.problem(contact_position="10 mm", **one)
    same = wl.WheelRail(wheel_radius="459.5 mm", rail_head_radius="300 mm", **fields).problem(
        contact_angle=Q(-np.arctan(0.05), "rad"), **one
    )
    # `WheelRail` has the rail's radius in an upright plane, which the angle of 0.05 shortens by its square.
    for name in ("a", "b", "spin", "max_pressure"):
        assert float(getattr(p, name)) == pytest.approx(float(getattr(same, name)), rel=2e-3), name


def test_patch_is_near_that_of_half_spaces(of_wheelset: wl.Prediction, run: pd.DataFrame) -> None:
    """Where both profiles curve within the patch: within what the docstring of the rig states of random draws."""
    p = of_wheelset.problem
    for row, contact in ((0, 0), (1, 0), (2, 0), (2, 1)):
        here = {name: run[head.format(contact=contact + 1)][row] for name, head in COLUMNS.items()}
        found = predict().rig.problem(
            contact_position=Q(here["contact_position"], "mm"), normal_force=Q(here["normal_force"], "kN"),
            longitudinal_creepage="0.1 %", friction_coefficient=0.3,
        )  # fmt: skip
        assert float(found.a) == pytest.approx(p.a[row, 1, contact], rel=0.11)  # the bounds that the rig states
        assert -0.3 < float(found.b) / p.b[row, 1, contact] - 1.0 < 0.2


def row(**changed: Any) -> pd.DataFrame:
    values = {
        "contact_position [mm]": [0.0, 10.0, 20.0], "normal_force [kN]": 60.0, "longitudinal_creepage [%]": 0.1,
        "friction_coefficient": 0.3, "share": 1.0 / 3.0,
    }  # fmt: skip
    return pd.DataFrame({**values, **changed})


@pytest.mark.parametrize(
    ("states", "options", "error", "named"),
    [
        (row(**{"contact_position [mm]": [0.0, 61.0, 5.0]}), {}, DataError, r"row 1 .*61 mm is beyond .* -70 to 60 mm"),
        (row(**{"normal_force [kN]": [60.0, 60.0, 1e6]}), {}, DataError, r"row 2 .*20 mm .*as hollow as the rail is"),
        (row(**{"semi_axis_a [mm]": 6.0}), {}, DataError, "both semi_axis_a and semi_axis_b"),
        (row(), {"sides": "each"}, wl.InputError, "sides"),
        (
            row(**{"W1 N [kN]": 1.0, "W2 N [kN]": 1.0}).drop(columns="normal_force [kN]"),
            {"columns": {"normal_force": "W{wheel} N", "contact_position": "contact_position",
                         "longitudinal_creepage": "longitudinal_creepage"}},
            DataError,
            r"over \{contact\} alone, not over \{wheel\}",
        ),
    ],
)  # fmt: skip
def test_mistakes_name_the_row(states: pd.DataFrame, options: Any, error: type[Exception], named: str) -> None:
    with pytest.raises(error, match=named):
        wl.wear_out(predict(), states, over="10 km", **options)
