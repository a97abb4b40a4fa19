"""FASTSIM on strips whose pressure is given: as on the ellipse that they cut up, and in closed form on each strip."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Array, Q
from wearlaw.errors import CompositionError

POINTS, STRIPS = 7, 10
BOUNDS = pytest.mark.parametrize("bound", ["parabolic", "elliptic"])
SHEAR, NU = 80.6e9, 0.28


def common(points: int, **changes: Any) -> dict[str, Any]:
    """Return what problems have besides their patch, with creepages up to full slip."""
    random = np.random.default_rng(4)
    given = {
        "friction_coefficient": random.uniform(0.1, 0.6, points),
        "longitudinal_creepage": random.uniform(-6e-3, 6e-3, points),
        "lateral_creepage": random.uniform(-6e-3, 6e-3, points),
        "spin": random.uniform(-2.0, 2.0, points),
        "rolling_speed": np.full(points, 20.0),
        "density": np.full(points, 7850.0),
    }
    return given | {name: np.full(points, value) for name, value in changes.items()}


def cut(a: Array, b: Array, p0: Array, count: int = STRIPS) -> wl.Strips:
    """Return ellipses under Hertz's pressure as strips, with Gauss's quadrature over the angle of y = b cos β."""
    angle = np.pi / (count + 1) * np.arange(count, 0, -1)
    root = np.sin(angle)
    return wl.Strips(
        y=np.outer(b, np.cos(angle)),
        width=np.outer(b, np.pi / (count + 1) * root),
        half_length=np.outer(a, root),
        max_pressure=np.outer(p0, root),
    )


def patches(points: int = POINTS, **changes: Any) -> tuple[wl.Problem, wl.Problem]:
    """Return elliptic problems, and the same as strips."""
    random = np.random.default_rng(5)
    a, b = random.uniform(2e-3, 8e-3, points), random.uniform(2e-3, 8e-3, points)
    elastic: Any = {"shear_modulus": np.full(points, SHEAR), "poisson_ratio": np.full(points, NU)}
    of_all = common(points, **changes)
    force = random.uniform(3e4, 9e4, points)
    ellipse = wl.Problem.ellipse_from_si(a=a, b=b, normal_force=force, **elastic, **of_all)
    return ellipse, wl.Problem.of_strips(cut(a, b, ellipse.max_pressure), a=a, b=b, **elastic, **of_all)


@BOUNDS
def test_strips_of_an_ellipse_are_solved_as_the_ellipse(bound: Any) -> None:
    ellipse, strips = patches()
    if bound == "parabolic":  # scaled to the load that the strips have
        ellipse = ellipse.replaced(normal_force=strips.normal_force)
    model = wl.contact_model("fastsim", bound=bound)
    found, expected = model.solve(strips), model.solve(ellipse)
    for name in ("traction_x", "traction_y", "traction_bound", "slip_x", "slip_y", "x", "y", "area"):
        one, other = getattr(found, name), getattr(expected, name)
        # Slips are differences of creepage and growth, and a node's place moves with where its strip begins to slip.
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e4 * EPS * np.abs(other).max(), err_msg=name)
    rim = 4.0 * np.sqrt(EPS) * ellipse.max_pressure.max()  # where the root in Hertz's pressure magnifies rounding
    np.testing.assert_allclose(found.pressure, expected.pressure, rtol=0.0, atol=rim)
    for name in ("force_x", "force_y", "moment_z", "wear_index"):
        one, other = getattr(found, name), getattr(expected, name)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e3 * EPS * np.abs(other).max(), err_msg=name)
    np.testing.assert_allclose(strips.patch_area, ellipse.patch_area, rtol=16 * EPS)
    # Gauss's quadrature is exact for √(1-η²) times a polynomial, as the integrals of x² and y² are.
    np.testing.assert_allclose(strips.rigid_slip, ellipse.rigid_slip, rtol=32 * EPS)


def two_humps(creepage: float, friction: float = 0.3) -> wl.Problem:
    """Return a patch with two humps of pressure, such as a worn wheel's, without spin."""
    y = np.linspace(-9e-3, 9e-3, 19)
    hump = 0.4 + 0.6 * np.sin(np.pi * (y / 9e-3 + 1.0)) ** 2
    strips = wl.Strips(
        y=y[None], width=np.full((1, 19), 1e-3), half_length=6e-3 * hump[None], max_pressure=1.2e9 * hump[None]
    )
    given = common(1, friction_coefficient=friction, longitudinal_creepage=creepage, lateral_creepage=0.0, spin=0.0)
    elastic: Any = {"shear_modulus": np.array([SHEAR]), "poisson_ratio": np.array([NU])}
    return wl.Problem.of_strips(strips, a=np.array([5e-3]), b=np.array([9.5e-3]), **elastic, **given)


@BOUNDS
@pytest.mark.parametrize("creepage", [1e-5, 1e-3, 4e-3, 3e-2])
def test_without_spin_each_strip_has_the_force_of_a_line(bound: Any, creepage: float) -> None:
    problem = two_humps(creepage)
    strips = problem.strips
    assert strips is not None
    c11 = wl.kalker.coefficients(problem.a / problem.b, problem.poisson_ratio).c11
    slope = creepage / (8.0 / 3.0 * problem.a / (c11 * SHEAR))[:, None]  # dq/dx in stick
    a, load = strips.half_length, strips.normal_force
    if bound == "elliptic":
        ratio = slope * a / (0.3 * strips.max_pressure)
        force = 0.3 * load * 2.0 / np.pi * (np.arctan(ratio) + ratio / (1.0 + ratio**2))
    else:
        share = a * strips.max_pressure**2 * strips.width
        load = problem.normal_force[:, None] * share / share.sum()
        ratio = np.minimum(slope * a / (2.0 * 0.3 * load / (4.0 / 3.0 * a * strips.width)), 1.0)
        force = 0.3 * load * (1.0 - (1.0 - ratio) ** 3)
    model = wl.contact_model("fastsim", bound=bound, strips=40)  # nodes along a strip in proportion
    contact = model.solve(problem)
    along = contact.over_strip(contact.traction_x) * contact.strip_width
    # Gauss's nodes: the stick zone is linear, the slip zone in its angle an entire function.
    np.testing.assert_allclose(along, force, rtol=1e-9)
    np.testing.assert_allclose(contact.force_x, force.sum(axis=-1), rtol=1e-9)
    np.testing.assert_allclose(contact.cell_wear_index, contact.wear_index, rtol=1e-6)


class Humps(wl.Rig):
    """A worn wheel, whose pressure is known."""

    name: ClassVar[str] = "humps"
    creepage: ClassVar[str] = "creepage"
    patch_geometry: ClassVar[wl.Geometry | None] = "strips"

    @property
    def bodies(self) -> dict[str, wl.Body]:
        """The wheel and the rail."""
        return {"wheel": wl.Body(wl.steel(), 0.46), "rail": wl.Body(wl.steel(), np.inf)}

    def problem(self, *, creepage: wl.QuantityLike, friction_coefficient: float) -> wl.Problem:
        """Return the problem at creepages."""
        ratio = wl.Unit("", positive=False, limit=1.0).si(creepage, "creepage")
        one = two_humps(0.0, friction_coefficient)[0].broadcast_to(ratio.shape)
        return one.replaced(longitudinal_creepage=ratio)


def test_a_rig_of_strips_wears() -> None:
    predict: Any = Humps() | wl.contact_model("fastsim") | wl.wear_law("kth")
    given: Any = {"creepage": Q([[0.1], [0.5]], "%"), "friction_coefficient": 0.3}
    found = predict(**given)
    assert found.wear_rate.shape == (2, 1)
    assert "patch_area" in repr(found)
    profile = found.wear_profile("wheel")
    assert profile.depth.shape == (2, 1, 19)
    contact = found.contact
    lost = (found.wear_profile("rail").depth.values * 1e-9 * contact.strip_width).sum(axis=-1) * 7850.0
    np.testing.assert_allclose(lost, found.mass_per_distance.to("kg/m").magnitude, rtol=64 * EPS)
    swept = wl.sweep(predict, creepage=Q([0.1, 0.5], "%"), friction_coefficient=0.3)
    np.testing.assert_allclose(swept.wear_rate.values, found.wear_rate.to(swept.wear_rate.units).magnitude[:, 0])
    force = wl.creepage_for(Humps() | wl.contact_model("fastsim"), traction_coefficient=0.1, friction_coefficient=0.3)
    traction = predict(creepage=force, friction_coefficient=0.3).traction_coefficient
    assert float(traction.magnitude) == pytest.approx(0.1, rel=1e-9)


def test_what_strips_cannot_do_is_said() -> None:
    with pytest.raises(CompositionError, match="the pressure of strips is given"):
        two_humps(1e-3).with_normal_force(np.array([1e4]))
    for model in (wl.contact_model("fastsim"), wl.contact_model("strip_theory")):
        assert model.on_strips(two_humps(1e-3), np.array([0.0])) is None
    found: Any = (Humps() | wl.contact_model("fastsim"))(creepage="1 %", friction_coefficient=0.3)
    with pytest.raises(CompositionError, match="semi_axis_a: belongs to elliptic contacts, not to patches of strips"):
        _ = found.semi_axis_a
