"""The normal problem by virtual penetration: Hertz on ellipses, CONTACT's own KPEC, and half-spaces elsewhere."""

from __future__ import annotations

import importlib.util
import itertools
from collections.abc import Iterator
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
import scipy

import wearlaw as wl
from tests import normal_patches, wheel_on_rail
from tests.normal_half_space import pressed
from tests.normal_patches import loaded
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_models.rigs.wheelset import normal as normal  # private: the normal problem, against its theory
from wearlaw_models.rigs.wheelset import normal_loops as loops  # private: the normal problem, against its theory
from wearlaw_models.rigs.wheelset.normal import hertz, penetrated  # private: the normal problem, against its theory

A = 1.0 / (2.0 * 0.46)
MODULUS = 82e9 / (1.0 - 0.28)
MM = 1e-3
BOTH = pytest.mark.parametrize(
    "compiled",
    [
        False,
        pytest.param(
            True, marks=pytest.mark.skipif(importlib.util.find_spec("numba") is None, reason="numba is not installed")
        ),
    ],
)
QUADRATURE = 2e-6
"""Error of the displacement that the module states for ellipses; N, p0 and the penetration share it."""


@pytest.fixture(autouse=True)
def as_chosen() -> Iterator[None]:
    """Return to wearlaw's own choice of compiled loops."""
    yield
    wl.accelerate(None)


def sampled(function: Any, width: Array | float, count: int = 201, shift: float = 0.3) -> dict[str, Any]:
    """Return gaps of a function of t, sampled over ±width, for one or several patches."""
    wide = np.atleast_1d(width)
    step = 2.0 * wide / (count - 1)
    t = step[:, None] * (np.arange(count) - (count - 1) / 2 + shift)
    return {"start": t[:, 0], "step": step, "gap": function(t)}


def ellipses(strips_ratio: int = 41) -> tuple[dict[str, Any], Array, Array, Array]:
    """Return gaps B t², with A, B and N."""
    ratio = np.geomspace(1e-2, 1e2, strips_ratio)
    along, across = np.full_like(ratio, A), A * ratio
    force = np.geomspace(1e5, 1e3, strips_ratio)
    b = hertz(along, across, MODULUS, force).b
    return sampled(lambda t: across[:, None] * t**2, 1.5 * b), along, across, force


def two_humps(second: float = 8e-6, place: float = -9e-3, bend: float = 6.0, first: float = 0.4) -> Any:
    """Return a gap with a second hump, such as that of a wheel on the top and the shoulder of a rail."""

    def gap(t: Array) -> Array:
        return np.minimum(first * t**2, second + bend * (t - place) ** 2)

    return gap


def exactly(c: float) -> float:
    """Return 2√(1+c²) (K(m) - E(m)) with m = 1/(1+c²), with more digits than floats have."""
    with mpmath.workdps(40):
        square = 1 + mpmath.mpf(c) ** 2
        return float(2 * mpmath.sqrt(square) * (mpmath.ellipk(1 / square) - mpmath.ellipe(1 / square)))


@pytest.mark.parametrize("c", [0.01, 0.1, 1.0, 10.0, 1e3])
def test_the_closed_form_is_the_integral_over_a_strip(c: float) -> None:
    # x = sin θ; c sinh w = tan θ takes the peak away.
    def integrand(w: float) -> float:
        tangent = c * np.sinh(w)
        cosine = 1.0 / np.sqrt(1.0 + tangent**2)
        return float(2.0 * cosine**4 * np.cosh(w) / np.hypot(tangent * cosine / c, 1.0))

    expected, _ = scipy.integrate.quad(integrand, 0.0, np.arcsinh(1e8 / c), epsabs=0.0, epsrel=1e-12, limit=500)
    assert exactly(c) == pytest.approx(expected, rel=1e-10)
    assert loops.compliance(np.array([4.0]), np.array([2.0 * c]))[0] == pytest.approx(2.0 * exactly(c), rel=64 * EPS)


def test_few_steps_of_the_mean_are_enough() -> None:
    for c, within in ((1e-2, 64 * EPS), (1e-4, 1e-12), (1e-10, 1e-3)):
        assert loops.compliance(1.0, c) == pytest.approx(exactly(c), rel=within)


def test_the_share_of_hertz_is_that_of_his_ellipse() -> None:
    for largest, within in ((np.log(100.0), 2e-12), (40.0, 4e-11)):
        log_ratio = np.concatenate([[0.0, 1e-12, 1e-8, 1e-4], np.linspace(0.01, largest, 200)])
        one = np.ones_like(log_ratio)
        ellipse = hertz(one, np.exp(log_ratio), 1.0, one)
        assert loops.hertz_share(log_ratio) == pytest.approx(ellipse.a**2 / ellipse.penetration, rel=within)


@BOTH
@pytest.mark.parametrize("strips", [2, 10, 21])
def test_a_parabola_gives_hertz(compiled: bool, strips: int) -> None:
    wl.accelerate(compiled)
    gaps, along, across, force = ellipses()
    exact = hertz(along, across, MODULUS, force)
    found = penetrated(**gaps, curvature_x=along, modulus=MODULUS, penetration=exact.penetration, strips=strips)
    # The trapezoidal rule in the angle for ∫ sin³ = 4/3, in closed form: an error of order 4.
    h = np.pi / (strips + 1)
    rule = 3.0 / 16.0 * h * (3.0 / np.tan(0.5 * h) - 1.0 / np.tan(1.5 * h))
    assert found.max_pressure == pytest.approx(exact.max_pressure, rel=QUADRATURE)
    assert found.normal_force == pytest.approx(rule * force, rel=QUADRATURE)
    assert found.penetration == pytest.approx(exact.penetration, rel=8 * EPS)
    share = 1e-11  # of `hertz_share`
    assert found.a == pytest.approx(exact.a, rel=share)
    assert found.b == pytest.approx(exact.b, rel=share)
    assert found.area == pytest.approx(np.pi * exact.a * exact.b, rel=share)
    assert np.abs(found.centre / exact.b).max() < 1e-10
    assert not found.narrow.any()
    angle = h * np.arange(strips, 0, -1)
    assert found.y == pytest.approx(np.outer(exact.b, np.cos(angle)), rel=1e-9, abs=1e-9 * exact.b.max())
    assert found.half_length == pytest.approx(np.outer(exact.a, np.sin(angle)), rel=1e-9)
    assert found.pressure == pytest.approx(np.outer(exact.max_pressure, np.sin(angle)), rel=QUADRATURE)


def test_more_nodes_leave_less_error(monkeypatch: pytest.MonkeyPatch) -> None:
    wl.accelerate(False)
    gaps, along, across, force = ellipses()
    exact = hertz(along, across, MODULUS, force)
    errors = []
    for nodes in (10, 16, 24):
        monkeypatch.setattr(normal, "NODES", nodes)
        normal._nodes.cache_clear()
        found = penetrated(**gaps, curvature_x=along, modulus=MODULUS, penetration=exact.penetration)
        errors.append(np.abs(found.max_pressure / exact.max_pressure - 1.0).max())
    normal._nodes.cache_clear()
    # s³ ln s has an error of order 8 in the number of nodes, and slender patches converge even faster.
    for (few, many), (error, smaller) in zip(((10, 16), (16, 24)), itertools.pairwise(errors), strict=True):
        assert smaller < error * (few / many) ** 8


def random_gaps(count: int) -> dict[str, Any]:
    """Return gaps with two humps, skew, windows of all kinds."""
    random = np.random.default_rng(27)
    size = 161
    t = 1e-4 * (np.arange(size) - 80.0)
    bend, skew = random.uniform(0.3, 20.0, (count, 1)), random.uniform(-60.0, 60.0, (count, 1))
    place, second = random.uniform(-6e-3, 6e-3, (count, 1)), random.uniform(0.0, 3e-5, (count, 1))
    gap = np.minimum(bend * t**2 * (1.0 + np.tanh(skew * t)), second + random.uniform(0.3, 20.0) * (t - place) ** 2)
    gap[:, :3] = np.where(np.arange(count)[:, None] % 3 == 0, np.inf, gap[:, :3])
    gap[:, -5:] = np.where(np.arange(count)[:, None] % 4 == 0, np.inf, gap[:, -5:])
    one = np.ones(count)
    return {"start": one * t[0], "step": one * 1e-4, "gap": gap, "curvature_x": random.uniform(0.3, 2.0, count)}


@pytest.mark.skipif(importlib.util.find_spec("numba") is None, reason="numba is not installed")
def test_numba_and_numpy_agree() -> None:
    count = 600
    results = []
    for compiled in (False, True):
        wl.accelerate(compiled)
        penetration = np.geomspace(1e-6, 1e-4, count)
        results.append([penetrated(**random_gaps(count), modulus=MODULUS, penetration=penetration)])
    for one, other in zip(*results, strict=True):
        assert 0 < np.count_nonzero(one.narrow) < count
        np.testing.assert_array_equal(one.narrow, other.narrow)
        for name in ("penetration", "normal_force", "max_pressure", "a", "b", "area"):
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=2e-9), name
        for name in ("y", "width", "half_length", "pressure", "centre"):
            value = getattr(one, name)
            assert value == pytest.approx(getattr(other, name), abs=2e-9 * np.abs(value).max()), name


def one_patch(function: Any, width: float = 2e-2, count: int = 401) -> dict[str, Any]:
    return {**sampled(function, width, count), "curvature_x": [A], "modulus": MODULUS}


@BOTH
def test_strips_between_humps_carry_next_to_nothing(compiled: bool) -> None:
    wl.accelerate(compiled)
    found = penetrated(**one_patch(two_humps(bend=6.0)), penetration=[18e-6])
    idle = found.half_length[0] < 2.0 * loops.FLOOR * found.half_length.max()
    assert 3 <= np.count_nonzero(idle) < 18
    assert np.flatnonzero(idle)[0] > 0
    assert np.flatnonzero(idle)[-1] < 20
    assert found.strips.normal_force[0, idle].sum() < 1e-7 * found.normal_force[0]
    elastic: Any = {"shear_modulus": np.array([82e9]), "poisson_ratio": np.array([0.28])}
    slip = {
        name: np.array([value])
        for name, value in {
            "friction_coefficient": 0.3,
            "longitudinal_creepage": 1e-3,
            "lateral_creepage": 5e-4,
            "spin": 0.4,
            "rolling_speed": 20.0,
            "density": 7850.0,
        }.items()
    }
    problem = wl.Problem.of_strips(found.strips, a=found.a, b=found.b, **elastic, **slip)
    contact = wl.contact_model("fastsim").solve(problem)
    assert np.isfinite(contact.traction_x).all()
    assert 0.0 < contact.force_x[0] < 0.3 * found.normal_force[0]


@BOTH
def test_the_ellipse_of_kalkers_coefficients_has_the_area_and_ratio_of_the_patch(compiled: bool) -> None:
    wl.accelerate(compiled)
    gaps = one_patch(lambda t: t**2 * (2.0 + 0.2 * np.tanh(300.0 * t)))
    found = penetrated(**gaps, penetration=[5e-5], strips=401)
    assert np.pi * found.a * found.b == pytest.approx(found.area, rel=1e-12)
    width = found.width.sum()  # 1/24 h² of it is missing
    assert found.a / found.b == pytest.approx(2.0 * found.half_length.max() / width, rel=1e-4)
    assert found.max_pressure == pytest.approx(found.pressure.max(), rel=1e-4)
    assert found.centre == pytest.approx((found.strips.normal_force * found.y).sum() / found.normal_force, rel=1e-12)


@BOTH
def test_samples_may_be_shifted_mirrored_and_cut_off(compiled: bool) -> None:
    wl.accelerate(compiled)

    def skewed(t: Array) -> Array:
        return 2.0 * t**2 * (1.0 + 0.5 * np.tanh(300.0 * t))

    gaps = one_patch(skewed, 5e-3, 301)
    plain = penetrated(**gaps, penetration=[3e-5])
    moved = penetrated(**{**gaps, "start": gaps["start"] + 0.1}, penetration=[3e-5])
    assert moved.y - 0.1 == pytest.approx(plain.y, abs=1e-15)
    assert moved.centre - 0.1 == pytest.approx(plain.centre, abs=1e-15)
    mirrored: dict[str, Any] = {**gaps, "gap": gaps["gap"][:, ::-1], "start": -(gaps["start"] + 300.0 * gaps["step"])}
    other = penetrated(**mirrored, penetration=[3e-5])
    assert -other.y[:, ::-1] == pytest.approx(plain.y, abs=1e-12)
    assert other.pressure[:, ::-1] == pytest.approx(plain.pressure, rel=1e-9)
    cut = gaps["gap"].copy()
    cut[:, :20], cut[:, -10:], cut[:, 3] = np.inf, np.inf, 1e-7  # beyond the window another patch may be deeper
    same = penetrated(**{**gaps, "gap": cut}, penetration=[3e-5])
    assert same.pressure == pytest.approx(plain.pressure, rel=1e-12)
    assert not same.narrow[0]


@BOTH
def test_a_narrow_window_is_reported(compiled: bool) -> None:
    wl.accelerate(compiled)
    gaps = one_patch(lambda t: 2.0 * t**2, 5e-3, 301)
    wide = penetrated(**gaps, penetration=[3e-5])
    assert not wide.narrow[0]
    reach = np.abs(np.arange(301) - 150) * gaps["step"] <= 0.98 * wide.b
    left = np.where(reach | (np.arange(301) > 150), gaps["gap"], np.inf)
    for gap in (left, left[:, ::-1], np.where(np.arange(301) < 150, np.inf, gaps["gap"])):
        assert penetrated(**{**gaps, "gap": gap}, penetration=[3e-5]).narrow[0]


@BOTH
def test_the_error_of_samples_is_of_fourth_order(compiled: bool) -> None:
    wl.accelerate(compiled)

    def wavy(t: Array) -> Array:
        return 2.0 * t**2 + 4e-6 * (1.0 - np.cos(900.0 * t))

    force = [
        penetrated(**one_patch(wavy, 6e-3, count), penetration=[3e-5]).normal_force[0] for count in (25, 49, 97, 1537)
    ]
    coarse, middle, fine = (abs(one / force[-1] - 1.0) for one in force[:3])
    assert coarse < 1e-2
    assert middle < coarse / 8.0
    assert fine < middle / 8.0


@BOTH
def test_the_deepest_point_always_touches(compiled: bool) -> None:
    wl.accelerate(compiled)
    # Steep on one side and flat on the other, so that the middle of a long ellipse is far from the deepest point.
    gaps = one_patch(lambda t: np.where(t > 0.0, 1e4, 10.0) * t**2, 5e-3, 2001)
    penetration = np.geomspace(5e-6, 9e-5, 30)
    many: dict[str, Any] = {
        name: np.repeat(value, penetration.size, axis=0) for name, value in gaps.items() if name != "modulus"
    }
    found = penetrated(**many, modulus=MODULUS, penetration=penetration)
    middle, half = 0.5 * (found.y[:, -1] + found.y[:, 0]), 0.5 * (found.y[:, -1] - found.y[:, 0]) / np.cos(np.pi / 22)
    assert (middle + half > 1e-5).all()
    assert (middle - half < -1e-4).all()
    assert (np.diff(found.normal_force) > 0.0).all()
    assert (found.half_length > 1e-3 * found.half_length.max(axis=1)[:, None]).all()


@pytest.mark.parametrize("ratio", [0.1, 1.0, 8.0])
def test_the_half_spaces_of_the_reference_meet_hertz(ratio: float) -> None:
    exact = hertz(np.array([A]), np.array([A * ratio]), MODULUS, np.array([8e4]))
    errors = []
    for elements in (24, 48, 96):
        x, t = (np.linspace(-1.3, 1.3, elements) * axis[0] for axis in (exact.a, exact.b))
        gap = A * x[:, None] ** 2 + A * ratio * t**2
        found = pressed(gap, x[1] - x[0], t[1] - t[0], MODULUS, 8e4)
        assert found.pressure.sum() * (x[1] - x[0]) * (t[1] - t[0]) == pytest.approx(8e4, rel=1e-12)
        assert found.pressure.max() == pytest.approx(exact.max_pressure[0], rel=0.3 / elements)
        assert found.penetration == pytest.approx(exact.penetration[0], rel=0.3 / elements)
        errors.append(abs(found.area / (np.pi * exact.a[0] * exact.b[0]) - 1.0))
    assert errors[-1] < 0.01  # steps of the rim


CONTACT: dict[str, tuple[tuple[float, ...], float, float, float, float]] = {
    "centred": ((0.0, 0.1999, 0.0, 0.0, -0.0298, 751.6369), 9996.0, 381.9, 1033, 17.79),
    "0.5 mm": ((0.5, 0.1945, -2.304e-5, 1.2e-3, -0.0562, 744.6479), 9889.0, 569.8, 939, 20.17),
    "5 mm": ((5.0, 0.0043, -3.554e-4, 1.2e-2, -0.2823, 727.5827), 9624.0, 1625.0, 225, 29.93),
    "6 mm": ((6.0, -0.1960, -6.272e-4, 1.44e-2, -0.4176, 725.1370), 9709.7, 1123.1, 319, 27.34),
}
"""Positions as in `normal_patches.MANCHESTER`, and CONTACT's results with B = 5: N, p0 [MPa], elements of 0.04 mm² and
δ [µm]. The first three are printed in its examples/mbench_a22_kpec.ref_out."""


def samples_of(position: tuple[float, ...], wide: float = 12.0) -> dict[str, Any]:
    """Return the gap of a wheel on a rail."""
    y, z, roll, yaw, angle, at = position
    gap = wheel_on_rail.gap(y, z, roll, yaw, angle=angle, at=at, half_width=wide, half_length=3.0)
    start, step = [MM * gap.t[0]], [MM * (gap.t[1] - gap.t[0])]
    return {"start": start, "step": step, "gap": MM * gap.across[None], "curvature_x": [1e3 * gap.curvature]}


@pytest.mark.parametrize("name", CONTACT)
def test_the_method_is_that_of_contact(name: str) -> None:
    position, force, pressure, elements, approach = CONTACT[name]
    gaps = samples_of(position)
    if name == "centred":  # several penetrations carry this force, and CONTACT finds the largest
        found = penetrated(**gaps, modulus=MODULUS, penetration=[1e-6 * approach])
    else:
        found = loaded(**gaps, modulus=MODULUS, force=[force])
    # CONTACT's grid of 0.2 mm; at 0.5 mm two humps touch, and the force rises with the sixth power of the penetration.
    within = 0.025 if name == "0.5 mm" else 0.01
    assert found.normal_force[0] == pytest.approx(force, rel=within)
    assert found.max_pressure[0] == pytest.approx(1e6 * pressure, rel=within)
    assert found.penetration[0] == pytest.approx(1e-6 * approach, rel=within)
    assert found.area[0] == pytest.approx(0.04e-6 * elements, rel=0.02)


FULL = {
    "S1002 on 60E1, tread, 3 mm": (10030.0, 498.8, 0.01, 0.01),
    "S1002 on 60E1, centred": (9997.0, 338.3, 0.01, 0.12),
    "S1002 on 60E1, flange root, 8.5 mm": (12310.0, 2638.0, 0.02, 0.025),
}
"""CONTACT's normal force and maximum pressure [MPa] with its full theory, from examples/mbench_a22_*.ref_out, and how
close half-spaces and virtual penetration come. Its grid is 0.2 mm, four elements across the patch at the flange.

`test_wheelset_normal_positions.py` has the other positions."""


@pytest.mark.parametrize("name", FULL)
def test_pressures_are_near_those_of_contacts_full_theory(name: str) -> None:
    assert_near_full_theory(name, *FULL[name])


def assert_near_full_theory(name: str, force: float, pressure: float, reference: float, within: float) -> None:
    patch = normal_patches.wheel(normal_patches.MANCHESTER[name], force)
    assert patch.full.pressure.max() == pytest.approx(1e6 * pressure, rel=reference)
    assert patch.strips.max_pressure[0] == pytest.approx(1e6 * pressure, rel=within)
