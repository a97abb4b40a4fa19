"""The normal problem on half-spaces: Hertz, a solver and surfaces in space of other make, and CONTACT."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests import normal_half_space, wheel_on_rail
from tests.plugins.wheelset.test_roll import STEEL, service
from tests.plugins.wheelset.wheelsets import R0, wheelset
from wearlaw import Q
from wearlaw_models.rigs.wheelset import half_space  # private: the finest of its grids
from wearlaw_models.rigs.wheelset.half_space import pressed  # private: the normal problem, against its theory
from wearlaw_models.rigs.wheelset.motion import placed  # private: one step of the contact, against another way to it
from wearlaw_models.rigs.wheelset.normal import hertz  # private: the normal problem, against its theory

A, MODULUS = 1.0 / (2.0 * R0), 82e9 / (1.0 - 0.28)
FASTSIM = wl.contact_model("fastsim")


def posed(pressure: Any, strips: int = 20, **conditions: Any) -> Any:
    """Return the balanced problem of the benchmark's wheelset."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)
        return (wheelset(pressure=pressure, strips=strips, material=STEEL) | FASTSIM).posed(
            conditions | {"friction_coefficient": 0.3}
        )


@pytest.mark.validates(
    "wheelset",
    "Pressure on half-spaces: maximum pressure and force at an approach, on ellipses with curvatures 1:10 to 8:1",
    source="Hertz, closed form",
    held_to="the inverse square of the number of elements over the overlap of the undeformed bodies",
)
@pytest.mark.parametrize("ratio", [0.1, 1.0, 8.0])
def test_ellipses_are_those_of_hertz_to_second_order(ratio: float) -> None:
    exact = hertz(np.array([A]), np.array([A * ratio]), MODULUS, np.array([8e4]))
    depth = exact.penetration[0]
    for n in (20, 40, 80):
        dx, dy = 2.0 * np.sqrt(depth / A) / n, 2.0 * np.sqrt(depth / (A * ratio)) / n
        x, y = (step * np.arange(-(n // 2), n // 2 + 1) for step in (dx, dy))
        pressure = pressed(A * x[:, None] ** 2 + A * ratio * y**2, dx, dy, MODULUS, depth)
        assert pressure.max() == pytest.approx(exact.max_pressure[0], rel=1.0 / n**2)
        assert pressure.sum() * dx * dy == pytest.approx(8e4, rel=1.0 / n**2)
        # Rows are half ellipses: their length follows from force and maximum, as that of columns.
        for axis, step, semi_axis in ((0, dx, exact.a[0]), (1, dy, exact.b[0])):
            length = 2.0 / np.pi * pressure.sum(axis=axis).max() * step / pressure.max()
            assert length == pytest.approx(semi_axis, rel=0.2 / n)


def test_a_ball_with_a_hump_is_carried_by_both_areas() -> None:
    # A ball on a plane with a hump beside it, against the tests' solver, which is given the force and finds δ.
    step, depth = 0.15e-3, 60e-6
    x = step * np.arange(-60, 61)
    gap = np.minimum(A * (x[:, None] ** 2 + x**2), 15e-6 + 3.0 * (x[:, None] ** 2 + (x - 6e-3) ** 2))
    pressure = pressed(gap, step, step, MODULUS, depth)
    rows = pressure.max(axis=0) > 0.0
    assert np.count_nonzero(np.diff(rows.astype(int)) == 1) == 2  # two areas
    other = normal_half_space.pressed(gap, step, step, MODULUS, float(pressure.sum() * step**2), 1e-11)
    assert other.penetration == pytest.approx(depth, rel=1e-7)
    assert pressure == pytest.approx(other.pressure, rel=0.0, abs=1e-6 * pressure.max())
    for guess in (np.roll(pressure, 5, axis=1), 100.0 * pressure, 1e-6 * pressure):
        again = pressed(gap, step, step, MODULUS, depth, guess)
        assert again == pytest.approx(pressure, rel=0.0, abs=1e-6 * pressure.max())
    # Bodies that touch later.
    later = pressed(gap + 2.0 * depth, step, step, MODULUS, 3.0 * depth)
    assert later == pytest.approx(pressure, rel=0.0, abs=1e-6 * pressure.max())
    # All of a guess that is far too high vanishes in the first step.
    little = pressed(gap, step, step, MODULUS, 0.02 * depth)
    again = pressed(gap, step, step, MODULUS, 0.02 * depth, pressure)
    assert again == pytest.approx(little, rel=0.0, abs=1e-6 * little.max())


def pressed_in_space(
    problem: Any, displacement: float, yaw: float, half_width: float, half_length: float
) -> tuple[Any, Any, Any]:
    """Return the first place of the right wheel, and t [mm] and the pressure [Pa] of half-spaces there under its force.

    The gap is that between the surfaces in space, on elements of 0.3 mm by 0.05 mm.
    """
    balance = problem.balance
    part = balance.found.part(np.flatnonzero((balance.found.side == 1) & (balance.found.number == 0)))
    place = placed(balance.section, part.position, part.arc)
    gap = wheel_on_rail.gap(
        displacement, 1e3 * (balance.height[0, 1] + R0 + balance.penetration[1]), problem.roll[1, 0], 1e-3 * yaw,
        angle=float(place.angle[0]), at=float(1e3 * place.y[0] + displacement),
        half_width=half_width, half_length=half_length, step=0.05, border=wheel_on_rail.UIC_60,
    )  # fmt: skip
    found = normal_half_space.pressed(1e-3 * gap.height[::6], 3e-4, 5e-5, MODULUS, problem.normal_force[1, 0])
    return place, gap.t, found.pressure


@pytest.mark.validates(
    "wheelset",
    "Maximum pressure on strongly yawed flanges, 24 and 36 mrad, under 20 kN a wheel, at wearlaw's force",
    source="half-spaces between the surfaces in space, on a grid of 0.3 mm by 0.05 mm",
    held_to="{strips:.0%} by strips and by ellipses, {half_spaces:.1%} on half-spaces",
    strips=0.03,
    half_spaces=0.015,
)
@pytest.mark.parametrize(("displacement", "yaw"), [(7.0, 24.0), (6.8, 36.0)])
def test_yawed_flanges_are_pressed_as_in_space(
    displacement: float, yaw: float, strips: float, half_spaces: float
) -> None:
    # The grid has 18 rows across the patch.
    where: dict[str, Any] = {"lateral_displacement": Q(displacement, "mm"), "yaw": Q(yaw, "mrad")}
    problem = posed("half_space", **where, vertical_load="20 kN")
    place, t, in_space = pressed_in_space(problem, displacement, yaw, 2.0, 13.0)
    full = in_space.max()
    assert problem.max_pressure[1, 0] == pytest.approx(full, rel=half_spaces)
    moved = 1e3 * (problem.bodies["rail"].profile_position[1, 0] - place.rail_arc[0])
    assert moved == pytest.approx(t @ in_space.sum(axis=0) / in_space.sum(), abs=0.05 / 4)  # a quarter of a row
    for pressure in ("kpec", "hertz"):
        other = posed(pressure, **where, vertical_load="20 kN")
        assert other.normal_force[1, 0] == pytest.approx(
            problem.normal_force[1, 0], rel=0.005
        )  # 0.17 % of the pressure
        assert other.max_pressure[1, 0] == pytest.approx(full, rel=strips), pressure


@pytest.mark.validates(
    "wheelset",
    "Maximum pressure on half-spaces with 12 mrad of yaw: where a second hump begins to touch (4.6 and 4.8 mm), from"
    " the root to the flange (6.2 and 6.3 mm), and where the curvature of the flange steps (6.4 mm)",
    source="half-spaces between the surfaces in space, on a grid of 0.3 mm by 0.05 mm",
    held_to="{within:.0%}, on the default number of strips, on half and on twice as many",
    within=0.03,
)
@pytest.mark.parametrize(
    ("displacement", "load", "half_width", "half_length"),
    [(4.8, 10, 12.5, 6.0), (4.6, 80, 12.5, 11.0), (6.2, 80, 10.5, 26.0), (6.3, 80, 12.0, 26.0), (6.4, 10, 2.0, 10.0)],
)
def test_humps_are_pressed_as_in_space(
    displacement: float, load: float, half_width: float, half_length: float, within: float
) -> None:
    where: dict[str, Any] = {"lateral_displacement": Q(displacement, "mm"), "yaw": "12 mrad"}
    where["vertical_load"] = Q(load, "kN")
    found = {strips: posed("half_space", strips, **where) for strips in (10, 20, 40)}
    _, _, pressure = pressed_in_space(found[20], displacement, 12.0, half_width, half_length)
    for strips, problem in found.items():
        assert problem.max_pressure[1, 0] == pytest.approx(pressure.max(), rel=within), strips
        rows = problem.strips
        assert rows.y.shape[-1] == 2 * strips
        assert rows.normal_force.sum(axis=-1)[1, 0] == pytest.approx(problem.normal_force[1, 0], rel=1e-12)


@pytest.mark.validates(
    "wheelset",
    "Maximum pressure on flanges with 12 to 36 mrad of yaw, where one ellipse fits, 6.6 to 7.1 mm, 20 to 80 kN a wheel",
    source='`pressure="half_space"`, which is held to surfaces in space',
    held_to="{strips:.1%} by strips, {ellipses:.1%} by ellipses",
    strips=0.032,
    ellipses=0.005,
)
def test_yawed_flanges_have_the_pressure_of_half_spaces(strips: float, ellipses: float) -> None:
    displacement, yaw, load = (one.ravel() for one in np.meshgrid([6.6, 6.8, 7.1], [12.0, 36.0], [20.0, 80.0]))
    at: dict[str, Any] = {
        "lateral_displacement": Q(displacement, "mm"),
        "yaw": Q(yaw, "mrad"),
        "vertical_load": Q(load, "kN"),
    }
    half_spaces, kpec, hertz = (posed(one, **at).max_pressure[:, 1, 0] for one in ("half_space", "kpec", "hertz"))
    assert kpec == pytest.approx(half_spaces, rel=strips)
    assert hertz == pytest.approx(half_spaces, rel=ellipses)


@pytest.mark.validates(
    "wheelset",
    "Half-spaces under 80 kN a wheel, from the tread over two humps to the flange: maximum pressure, N and angle on"
    " the tread, power",
    source="CONTACT (Vollebregt), half-space theory on elements of 0.4 mm, whose own error is 2 %",
    held_to="{pressure:.0%}, {force:.2%}, {milliradian:g} mrad, {power:.0%}",
    pressure=0.01,
    force=0.0005,
    milliradian=0.7,
    power=0.02,
)
def test_wheels_under_service_load_are_pressed_as_in_contact(
    pressure: float, force: float, milliradian: float, power: float
) -> None:
    expected = service()
    pair: Any = wheelset(pressure="half_space", material=STEEL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        result = (pair | FASTSIM)(
            lateral_displacement=Q(expected["displacement"], "mm"), yaw="12 mrad", vertical_load="80 kN",
            friction_coefficient=0.3, angular_speed=Q(2.0 / R0, "rad/s"), roll=Q(expected["roll"], "rad"),
        )  # fmt: skip
    problem: Any = result.problem
    assert problem.exists[:, 1].sum(axis=-1).tolist() == [1] * 8
    assert 1e-6 * problem.max_pressure[:, 1, 0] == pytest.approx(expected["pmax"], rel=pressure)
    # At 5 mm the humps are 0.15 rad apart, and CONTACT's angle is that of their overlap; at 7 mm Fy bears a quarter.
    tread = expected["displacement"] < 4.0
    assert problem.normal_force[tread, 1, 0] == pytest.approx(expected["fn"][tread], rel=force)
    angle = problem.contact_angle[tread, 1, 0]
    assert 1e3 * angle == pytest.approx(1e3 * expected["delta"][tread], rel=0.0, abs=milliradian)
    found = result.wear_index.to("N").magnitude[:, 1, 0]
    joined = expected["displacement"] == 5.0
    assert (np.abs(found / expected["tgamma"] - 1.0) < np.where(joined, 2.0 * power, power)).all()
    strips = problem.strips
    assert strips.normal_force.sum(axis=-1)[:, 1, 0] == pytest.approx(problem.normal_force[:, 1, 0], rel=1e-12)


def test_the_loads_of_joined_patches_are_balanced_and_mirrored() -> None:
    given: dict[str, Any] = {"vertical_load": "80 kN"}
    one, other = (
        posed("half_space", lateral_displacement=Q(sign * 0.8, "mm"), yaw=Q(sign * 6.0, "mrad"), **given)
        for sign in (1.0, -1.0)
    )
    force = FASTSIM.creep_forces(one)
    angle = one.contact_angle[:, 0]
    carried = one.normal_force[:, 0] * np.cos(angle) + force.lateral[:, 0] * np.sin(angle)
    assert carried == pytest.approx(np.full(2, 8e4), rel=1e-6)
    assert one.imbalance.ravel()[0] < 1e-5
    assert other.normal_force[::-1, 0] == pytest.approx(one.normal_force[:, 0], rel=1e-6)
    assert -other.contact_angle[::-1, 0] == pytest.approx(one.contact_angle[:, 0], rel=1e-5)
    assert -other.strips.y[::-1, 0, ::-1] == pytest.approx(one.strips.y[:, 0], rel=1e-4, abs=1e-7)


def test_a_position_from_root_to_flange_is_no_error() -> None:
    # On the way to a balance the contact point lies beyond the surfaces that are known.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        problem = posed("half_space", lateral_displacement="6.5 mm", vertical_load="80 kN")
    assert problem.normal_force.shape == (2, 3)


def test_strips_on_two_humps_warn_and_half_spaces_do_not() -> None:
    where: dict[str, Any] = {"vertical_load": "80 kN", "friction_coefficient": 0.3}
    with pytest.warns(wl.RangeWarning, match=r"two humps.*right wheel.* 1 mm.*half_space"):
        (wheelset() | FASTSIM).posed(where | {"lateral_displacement": "1 mm"})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (wheelset() | FASTSIM).posed(where | {"lateral_displacement": "3 mm"})
        (wheelset(pressure="half_space") | FASTSIM).posed(where | {"lateral_displacement": "1 mm"})


def test_a_hump_that_is_too_narrow_for_its_rows_warns(monkeypatch: pytest.MonkeyPatch) -> None:
    where: dict[str, Any] = {
        "lateral_displacement": Q([3.0, 4.8], "mm"), "yaw": "12 mrad", "vertical_load": "10 kN",
        "friction_coefficient": 0.3,
    }  # fmt: skip
    pipeline = wheelset(pressure="half_space") | FASTSIM
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pipeline.posed(where)
    monkeypatch.setattr(half_space, "FINEST", 1)
    told = r"1 of 4 patches .*right wheel .* 4\.8 mm, .* off by (5|6|7|8|9|1[0-5]) %.* 20 strips"
    with pytest.warns(wl.RangeWarning, match=told):
        pipeline.posed(where)
