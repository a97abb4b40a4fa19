"""Kalker's march against closed forms, differential equations and CONTACT, and its compiled copy against NumPy."""

from __future__ import annotations

import dataclasses
import importlib.util
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.plugins.full_theory import spheres
from wearlaw import Array
from wearlaw_fastsim import _march
from wearlaw_fastsim._march import Cells, Ellipses, drop_gains, forces, march, strip_centres
from wearlaw_fastsim._march_loops import WIDTH

EPS = np.finfo(np.float64).eps
CREEPAGES = ("longitudinal_creepage", "lateral_creepage", "spin")
COMPILED = [False, True] if importlib.util.find_spec("numba") else [False]

each_bound = pytest.mark.parametrize("elliptic", [False, True], ids=["parabolic", "elliptic"])
each_way = pytest.mark.parametrize("compiled", COMPILED, ids=["NumPy", "numba"][: len(COMPILED)])


def sample(points: int, elliptic: bool, **given: Any) -> Ellipses:
    """Return slender to wide patches from little to full slip, with creepages of both signs."""
    rng = np.random.default_rng(82)
    a = 10.0 ** rng.uniform(-3.0, -2.0, points)
    values = {
        "a": a,
        "b": 10.0 ** rng.uniform(-3.0, -2.0, points),
        "longitudinal_creepage": 10.0 ** rng.uniform(-4.0, -1.5, points) * rng.choice([-1.0, 1.0], points),
        "lateral_creepage": 10.0 ** rng.uniform(-4.0, -1.5, points) * rng.choice([-1.0, 1.0], points),
        "spin": rng.uniform(-1.0, 1.0, points),
        "longitudinal_flexibility": a * rng.uniform(5e-12, 10e-12, points),
        "lateral_flexibility": a * rng.uniform(5e-12, 10e-12, points),
        "spin_flexibility": a * rng.uniform(5e-12, 10e-12, points),
        "bound_centre": rng.uniform(1e8, 1e9, points),
    }
    changed = {name: np.broadcast_to(np.asarray(value, dtype=np.float64), points) for name, value in given.items()}
    return Ellipses(**{**values, **changed}, elliptic=elliptic)


def marched(ellipses: Ellipses, count: int, strips: int, compiled: bool = False) -> Cells:
    """Return marched cells, none of which may keep what was in the memory before."""
    cells = Cells.empty(ellipses.a.size, count, strips, compiled=compiled)
    for array in cells.arrays:
        array[:] = np.nan
    march(ellipses, cells, compiled=compiled)
    return cells


def power(cells: Cells) -> Array:
    """Return q·s [N/m²]."""
    return cells.traction_x * cells.slip_x + cells.traction_y * cells.slip_y


def summed(value: Array, ellipses: Ellipses) -> Array:
    """Return the sum over the patch of cells, times their areas."""
    _, count, strips = value.shape
    area = ellipses.cell_lengths(count, strips) * (2.0 / strips) * ellipses.b[:, None]
    total: Array = (value.sum(axis=1) * area).sum(axis=-1)
    return total


def rounding(ellipses: Ellipses, cells: Cells) -> tuple[Array, Array]:
    """Return by how much tractions [Pa] and slips [-] may differ between ways to sum up the growth of the traction.

    Each of n steps rounds a traction that is within its bound six times. Slip is the difference of what has grown and
    what is left of it, over the length of a cell and times the flexibility, of which the growth is the rigid slip.
    """
    count, strips = cells.x.shape[1:]
    traction = 6.0 * count * EPS * ellipses.bound_centre[:, None, None]
    size = np.maximum(ellipses.a, ellipses.b)
    growth = (
        np.abs(ellipses.longitudinal_creepage) / ellipses.longitudinal_flexibility
        + np.abs(ellipses.lateral_creepage) / ellipses.lateral_flexibility
        + 2.0 * np.abs(ellipses.spin) / ellipses.spin_flexibility * size
    )
    flexibility = np.maximum(ellipses.longitudinal_flexibility, ellipses.lateral_flexibility)[:, None, None]
    per_length = 2.0 * traction / ellipses.cell_lengths(count, strips)[:, None, :]
    return traction, flexibility * (per_length + 12.0 * EPS * growth[:, None, None])


def assert_same_cells(found: Cells, expected: Cells, ellipses: Ellipses) -> None:
    traction, slip = rounding(ellipses, expected)
    size = np.abs(expected.x).max(axis=(1, 2), keepdims=True)
    allowed = {"x": 6.0 * EPS * size, "bound": traction}
    for name in ("traction_x", "traction_y", "slip_x", "slip_y", *allowed):
        near = allowed.get(name, traction if name.startswith("traction") else slip)
        assert (np.abs(getattr(found, name) - getattr(expected, name)) <= near).all(), name


# --- Against what is not a march -------------------------------------------------------------------------------


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
@each_way
@each_bound
def test_without_spin_forces_converge_to_the_closed_form(
    elliptic: bool, compiled: bool, parabola: float, ellipse: float, off: float
) -> None:
    ellipses = sample(400, elliptic, spin=0.0)
    exact = without_spin(ellipses, 3)
    share = np.pi * ellipses.a * ellipses.b * ellipses.bound_centre
    errors = []
    for count in (200, 400, 800, 1600):
        found = forces(ellipses, marched(ellipses, count, 3, compiled))
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
@each_way
@each_bound
def test_with_spin_tractions_converge_to_the_differential_equation(
    elliptic: bool, compiled: bool, order: float, off: float
) -> None:
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
        cells = marched(patch, count, 2, compiled)
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
    "Kalker's march over even cells, NumPy and numba, on the same cases",
    source="CONTACT's FASTSIM on 200 cells across, flexibilities not blended",
    held_to="{within:g} of μN",
    within=0.01,
)
@each_way
@pytest.mark.parametrize(("method", "elliptic"), [("nb200", True), ("nbpar200", False)])
def test_forces_meet_those_of_contact_with_three_flexibilities(
    method: str, elliptic: bool, compiled: bool, within: float
) -> None:
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
    found = forces(ellipses, marched(ellipses, 400, 100, compiled))
    # The file has five digits, and 200 cells of one length for all strips, of which the first step is a whole one: of
    # first order, so that 1/200 of μN is what they may miss, and 1/400 what is missed here.
    apart = np.hypot(found.longitudinal - reference.force_x, found.lateral - reference.force_y)
    assert (apart < within * reference.bound).all()
    size = sum(np.abs(getattr(problem, name)) * unit for name, unit in zip(CREEPAGES, (1.0, 1.0, 6e-3), strict=True))
    assert (np.abs(problem.power(found) - reference.wear_index) < within * reference.bound * size).all()


# --- What holds in every cell ----------------------------------------------------------------------------------


@each_way
@each_bound
def test_the_bound_is_kept_and_is_the_mean_of_both_ends(elliptic: bool, compiled: bool) -> None:
    ellipses = sample(200, elliptic)
    cells = marched(ellipses, 30, 7, compiled)
    # q and the bound are sums of two terms each, of which q has another three roundings.
    assert (np.hypot(cells.traction_x, cells.traction_y) <= cells.bound * (1.0 + 8.0 * EPS)).all()
    half = 0.5 * ellipses.cell_lengths(30, 7)[:, None, :]
    share = (strip_centres(7) * np.ones(30)[:, None])[None]
    ends = [1.0 - ((cells.x + side) / ellipses.a[:, None, None]) ** 2 - share**2 for side in (-half, half)]
    ends = [np.sqrt(np.maximum(end, 0.0)) if elliptic else np.maximum(end, 0.0) for end in ends]
    expected = 0.5 * ellipses.bound_centre[:, None, None] * (ends[0] + ends[1])
    # 1 - (x/a)² - (y/b)² loses some ε, of which the root makes more where it is zero.
    near = 1e-7 if elliptic else 16.0 * EPS
    np.testing.assert_allclose(cells.bound, expected, atol=near * ellipses.bound_centre.max(), rtol=16.0 * EPS)


@each_way
@each_bound
def test_slip_is_zero_in_stick_and_only_there(elliptic: bool, compiled: bool) -> None:
    ellipses = sample(200, elliptic, spin=0.0)
    cells = marched(ellipses, 30, 7, compiled)
    growth = np.hypot(
        ellipses.longitudinal_creepage / ellipses.longitudinal_flexibility,
        ellipses.lateral_creepage / ellipses.lateral_flexibility,
    )
    s = np.sqrt(1.0 - strip_centres(7) ** 2)
    end = 2.0 * np.arange(1, 31)[:, None] / 30.0  # from the leading edge, over the half length
    bound = ellipses.bound_centre[:, None, None] * (
        s * np.sqrt(end * (2.0 - end)) if elliptic else s * s * end * (2.0 - end)
    )
    grown = growth[:, None, None] * end * ellipses.a[:, None, None] * s
    slips = np.hypot(cells.slip_x, cells.slip_y) > 0.0
    clear = np.abs(grown - bound) > 100.0 * EPS * grown
    assert (slips == (grown > bound))[clear].all()
    assert 0.2 < slips.mean() < 0.9


@each_way
@each_bound
def test_without_spin_the_cells_dissipate_what_the_forces_do(elliptic: bool, compiled: bool) -> None:
    ellipses = sample(200, elliptic, spin=0.0)
    cells = marched(ellipses, 30, 7, compiled)
    found = forces(ellipses, cells)
    expected = ellipses.longitudinal_creepage * found.longitudinal + ellipses.lateral_creepage * found.lateral
    traction, slip = rounding(ellipses, cells)
    reach = np.hypot(ellipses.longitudinal_creepage, ellipses.lateral_creepage)[:, None, None]
    allowed = summed(cells.bound * slip + traction * reach, ellipses)
    assert (power(cells) >= 0.0).all()
    assert (np.abs(summed(power(cells), ellipses) - expected) <= allowed).all()


@each_way
@each_bound
def test_a_mirrored_problem_has_the_mirrored_solution(elliptic: bool, compiled: bool) -> None:
    ellipses = sample(100, elliptic)
    mirrored = dataclasses.replace(ellipses, lateral_creepage=-ellipses.lateral_creepage, spin=-ellipses.spin)
    cells, image = marched(ellipses, 30, 8, compiled), marched(mirrored, 30, 8, compiled)
    signs = {"traction_y": -1.0, "slip_y": -1.0}
    back = {
        field.name: signs.get(field.name, 1.0) * getattr(image, field.name)[..., ::-1]
        for field in dataclasses.fields(Cells)
    }
    assert_same_cells(Cells(**back), cells, ellipses)
    found, other = forces(ellipses, cells), forces(mirrored, image)
    limit = 8 * 30 * EPS * np.pi * ellipses.a * ellipses.b * ellipses.bound_centre
    assert (np.abs(found.longitudinal - other.longitudinal) < limit).all()
    assert (np.abs(found.lateral + other.lateral) < limit).all()
    assert (np.abs(found.spin_moment + other.spin_moment) < limit * np.maximum(ellipses.a, ellipses.b)).all()


@each_way
@each_bound
def test_without_creepage_or_friction_nothing_is_transmitted(elliptic: bool, compiled: bool) -> None:
    at_rest = marched(sample(3, elliptic, **dict.fromkeys(CREEPAGES, 0.0)), 10, 5, compiled)
    for name in ("traction_x", "traction_y", "slip_x", "slip_y"):
        assert (getattr(at_rest, name) == 0.0).all()
    smooth = sample(3, elliptic, bound_centre=0.0, spin=0.0)
    cells = marched(smooth, 10, 5, compiled)
    assert (cells.traction_x == 0.0).all()
    assert (cells.traction_y == 0.0).all()
    # The growth over the length of a cell, and back.
    creepage = smooth.longitudinal_creepage[:, None, None]
    np.testing.assert_allclose(cells.slip_x, np.broadcast_to(creepage, cells.x.shape), rtol=8.0 * EPS)


@each_bound
def test_no_cell_gains_energy_once_gains_are_dropped(elliptic: bool) -> None:
    cells = marched(sample(400, elliptic, spin=3.0), 20, 20)
    before, slip_x, slip_y = power(cells), cells.slip_x.copy(), cells.slip_y.copy()
    assert 0 < (before < 0.0).sum() < 1e-3 * before.size
    drop_gains(cells)
    np.testing.assert_array_equal(power(cells), np.maximum(before, 0.0))
    np.testing.assert_array_equal(cells.slip_x, np.where(before < 0.0, 0.0, slip_x))
    np.testing.assert_array_equal(cells.slip_y, np.where(before < 0.0, 0.0, slip_y))


# --- Blocks and copies -----------------------------------------------------------------------------------------


@each_bound
def test_blocks_and_the_order_in_memory_do_not_matter(elliptic: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    ellipses = sample(11, elliptic)
    whole = marched(ellipses, 12, 6)
    monkeypatch.setattr(_march, "BLOCK", 4 * 6)
    other = Cells.empty(11, 12, 6, compiled=True)
    march(ellipses, other, compiled=False)
    for found, expected in zip(other.arrays, whole.arrays, strict=True):
        np.testing.assert_array_equal(found, expected)


@pytest.mark.skipif(True not in COMPILED, reason="numba is not installed")
@each_bound
@pytest.mark.parametrize("strips", [1, 50, WIDTH, WIDTH + 1, 2 * WIDTH + 3])
def test_the_compiled_march_is_the_march(elliptic: bool, strips: int) -> None:
    ellipses = sample(40, elliptic)
    assert_same_cells(marched(ellipses, 50, strips, True), marched(ellipses, 50, strips, False), ellipses)
