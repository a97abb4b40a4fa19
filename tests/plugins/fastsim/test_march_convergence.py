"""What Kalker's march converges to: closed forms, a differential equation and CONTACT."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.plugins.fastsim.march import CREEPAGES, sample
from tests.plugins.fastsim.marks import each_bound
from tests.plugins.full_theory import spheres
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.march import (  # private: patches with any flexibilities
    Ellipses,
    forces,
    march,
    strip_centres,
)


def without_spin(ellipses: Ellipses, strips: int) -> tuple[Array, Array]:
    """Return the forces on strips [N] in closed form: without spin q keeps its direction, that of (ξ/L1, η/L2).

    So it is the smaller of growth and bound, as on a line (Kalker 1982; Tassini et al. 2010, section 3.2.2).
    """
    v = strip_centres(strips)
    s = np.sqrt(1.0 - v * v)
    half_length, centre = ellipses.a[:, None] * s, ellipses.bound_centre[:, None] * (s if ellipses.elliptic else s * s)
    growth = (
        ellipses.longitudinal_creepage / ellipses.longitudinal_flexibility,
        ellipses.lateral_creepage / ellipses.lateral_flexibility,
    )
    rate = np.hypot(*growth)
    k = rate[:, None] * half_length / centre
    if ellipses.elliptic:
        force = centre * half_length * (np.arctan(k) + k / (1.0 + k * k))
    else:
        force = 4.0 / 3.0 * centre * half_length * (1.0 - (1.0 - np.minimum(0.5 * k, 1.0)) ** 3)
    total = force.sum(axis=-1) * 2.0 * ellipses.b / strips
    return growth[0] / rate * total, growth[1] / rate * total


def orders(errors: list[Array]) -> Array:
    """Return the orders between errors [N], rms over operating points, with ever twice as many cells."""
    rms = np.array([np.sqrt(np.mean(error * error)) for error in errors])
    between: Array = np.log2(rms[:-1] / rms[1:])
    return between


@pytest.mark.validates(
    "elliptic-contact",
    "Kalker's march without spin converges to the closed form of strips",
    source="Kalker 1982, strip by strip in closed form",
    held_to="orders {parabola:g} (parabolic) and {ellipse:g} (elliptic) ± {off:g}",
    parabola=2.0,
    ellipse=1.5,
    off=0.25,
)
@each_bound
def test_without_spin_forces_converge_to_the_closed_form(
    elliptic: bool, parabola: float, ellipse: float, off: float
) -> None:
    ellipses = sample(400, elliptic, spin=0.0)
    exact = without_spin(ellipses, 3)
    share = np.pi * ellipses.a * ellipses.b * ellipses.bound_centre
    errors = []
    for count in (200, 400, 800, 1600):
        found = forces(ellipses, march(ellipses, count, 3))
        errors.append(np.hypot(found.longitudinal - exact[0], found.lateral - exact[1]) / share)
    # Half way to the next order below and above; the cell where slip begins is met at random.
    assert (np.abs(orders(errors) - (ellipse if elliptic else parabola)) < off).all()
    assert errors[-1].max() < 1600.0 ** -(ellipse if elliptic else parabola)


def by_differential_equation(patch: Ellipses, v: float) -> Any:
    """Return q over the bound's greatest value at x over the half length, on a strip at y = b v of one patch.

    In slip q = g (cos θ, sin θ), and dq/dx = w - s in the direction of q leaves g dθ/dx = w·(-sin θ, cos θ).
    """
    a, b, xi, eta, spin, l1, l2, l3, centre = (float(array[0]) for array in patch.arrays)
    s = np.sqrt(1.0 - v * v)
    unit = a * s / (centre * (s if patch.elliptic else s * s))
    along, across, turn = (xi / l1 - spin * b * v / l3) * unit, eta / l2 * unit, spin / l3 * a * s * unit

    def bound(x: Any) -> Any:
        return np.sqrt(1.0 - x * x) if patch.elliptic else 1.0 - x * x

    def stuck(x: Any) -> Any:
        return (1.0 + x) * along, (1.0 + x) * across + 0.5 * turn * (1.0 - x * x)

    xs = np.linspace(-1.0, 1.0, 200_001)[1:-1]
    first = xs[np.argmax(np.hypot(*stuck(xs)) > bound(xs))]

    def rate(x: float, theta: Array) -> Array:
        turning: Array = (-along * np.sin(theta) + (across - turn * x) * np.cos(theta)) / bound(x)
        return turning

    angle = np.arctan2(*stuck(first)[::-1])
    path = solve_ivp(rate, (first, xs[-1]), [angle], rtol=1e-9, atol=1e-11, dense_output=True, method="LSODA")

    def traction(x: Array) -> tuple[Array, Array]:
        theta = path.sol(np.maximum(x, first))[0]
        slips = x > first
        q = stuck(x)
        return np.where(slips, bound(x) * np.cos(theta), q[0]), np.where(slips, bound(x) * np.sin(theta), q[1])

    return traction


@pytest.mark.validates(
    "elliptic-contact",
    "Kalker's march with spin converges to the differential equation of slip",
    source="LSODA on the angle of the traction",
    held_to="order {order:g} ± {off:g}",
    order=1.0,
    off=0.25,
)
@each_bound
def test_with_spin_tractions_converge_to_the_differential_equation(elliptic: bool, order: float, off: float) -> None:
    patch = sample(
        1, elliptic, a=6e-3, b=4e-3, longitudinal_creepage=1e-3, lateral_creepage=-2e-3, spin=1.0, bound_centre=6e8,
        longitudinal_flexibility=4.6e-14, lateral_flexibility=5.3e-14, spin_flexibility=3.9e-14,
    )  # fmt: skip
    v = strip_centres(2)
    greatest = patch.bound_centre[0] * (np.sqrt(1.0 - v * v) if elliptic else 1.0 - v * v)
    half_length = patch.a[0] * np.sqrt(1.0 - v * v)
    paths = [by_differential_equation(patch, float(share)) for share in v]
    errors = []
    for count in (200, 400, 800, 1600):
        cells = march(patch, count, 2)
        x = cells.x[0] / half_length
        exact = np.stack([path(x[:, strip]) for strip, path in enumerate(paths)], axis=-1)
        found = np.stack([cells.traction_x[0], cells.traction_y[0]]) / greatest
        errors.append(np.abs(found - exact).mean(axis=(1, 2)))
    turned = np.arctan2(exact[1, -1], exact[0, -1]) - np.arctan2(exact[1, 0], exact[0, 0])
    assert (np.abs(turned) > 0.1).all()
    # Halfway to order 1/2 and 3/2.
    assert (np.abs(orders(errors) - order) < off).all()
    assert errors[-1].max() < 1.0 / 1600.0


@pytest.mark.validates(
    "elliptic-contact",
    "Kalker's march over even cells",
    source="CONTACT's FASTSIM on 200 cells across, flexibilities not blended",
    held_to="{within:g} of μN",
    within=0.01,
)
@pytest.mark.parametrize(("method", "elliptic"), [("nb200", True), ("nbpar200", False)])
def test_forces_meet_those_of_contact_with_three_flexibilities(method: str, elliptic: bool, within: float) -> None:
    reference = spheres(method)
    problem = reference.problem
    ellipses = Ellipses(
        **{name: getattr(problem, name) for name in ("a", "b", *CREEPAGES)},
        # The L1, L2 and L3 that CONTACT prints for pure spin, where it does not blend them [m³/N].
        **{
            name: np.full(problem.a.shape, value)
            for name, value in (
                ("longitudinal_flexibility", 4.616916e-14),
                ("lateral_flexibility", 5.266554e-14),
                ("spin_flexibility", 3.861883e-14),
            )
        },
        bound_centre=problem.friction_coefficient * problem.max_pressure * (1.0 if elliptic else 4.0 / 3.0),
        elliptic=elliptic,
    )
    found = forces(ellipses, march(ellipses, 400, 100))
    # The file has five digits, and 200 cells of one length for all strips, of which the first step is a whole one: of
    # first order, so that 1/200 of μN is what they may miss, and 1/400 what is missed here.
    apart = np.hypot(found.longitudinal - reference.force_x, found.lateral - reference.force_y)
    assert (apart < within * reference.bound).all()
    size = sum(np.abs(getattr(problem, name)) * unit for name, unit in zip(CREEPAGES, (1.0, 1.0, 6e-3), strict=True))
    assert (np.abs(problem.power(found) - reference.wear_index) < within * reference.bound * size).all()
