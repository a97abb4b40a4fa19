"""First yield and shakedown, against integrals of the stresses under point loads and against the literature."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import optimize

import wearlaw as wl
from wearlaw import Array, elastic_limit
from wearlaw.contact.elastic_limit import _stresses  # private: stresses at a point

first_yield, overload, shakedown_limit = (
    elastic_limit.first_yield,
    elastic_limit.overload,
    elastic_limit.shakedown_limit,
)

K = 2.625e9 / 2.8 / math.sqrt(3.0)
"""Yield stress in shear of the default steel, by von Mises [Pa]."""


def under_line_loads(x: Array, z: Array, nu: float, count: int = 4000) -> tuple[Array, Array]:
    """Return σx, σy, σz, τzx under Hertz's pressure of 1 on a line, and under that traction, by Flamant's solution.

    It is superposed by the midpoint rule in the angle, which converges exponentially.
    """
    angle = (np.arange(count) + 0.5) * np.pi / count
    s, weight = np.cos(angle), np.sin(angle) ** 2 * np.pi / count  # √(1-s²) ds
    away, r4 = x[:, None] - s, ((x[:, None] - s) ** 2 + z[:, None] ** 2) ** 2
    pressed = [-2 / np.pi * z * ((away**2 / r4) @ weight), -2 / np.pi * z**3 * ((1 / r4) @ weight)]
    pressed_shear = -2 / np.pi * z**2 * ((away / r4) @ weight)
    sheared = [-2 / np.pi * ((away**3 / r4) @ weight), -2 / np.pi * z**2 * ((away / r4) @ weight)]
    sheared_shear = -2 / np.pi * z * ((away**2 / r4) @ weight)
    return (
        np.stack([pressed[0], nu * (pressed[0] + pressed[1]), pressed[1], pressed_shear]),
        np.stack([sheared[0], nu * (sheared[0] + sheared[1]), sheared[1], sheared_shear]),
    )


def under_point_loads(x: Array, z: Array, nu: float, a: float, b: float) -> tuple[Array, Array]:
    """Return the same under Hertz's pressure on an ellipse, by the solutions of Boussinesq and Cerruti at y = 0.

    J. C. Jaeger, N. G. W. Cook, R. W. Zimmerman, Fundamentals of Rock Mechanics, 2007, after R. Crummett's programs
    Traction_3D_NormalPointLoad.m and Traction_3D_TangentialPointLoad.m.
    """
    nodes, weights = np.polynomial.legendre.leggauss(150)
    theta = (np.arange(800) + 0.5) * 2 * np.pi / 800
    beta = 0.25 * np.pi * (nodes[:, None] + 1.0)  # radius sin β, pressure cos β
    radius = np.sin(beta)
    weight = 0.25 * np.pi * weights[:, None] * np.cos(beta) ** 2 * radius * 2 * np.pi / 800 * a * b
    loads_x, loads_y = a * radius * np.cos(theta), b * radius * np.sin(theta)
    pressed, sheared = [], []
    for at, depth in zip(x, z, strict=True):
        u, v = at - loads_x, -loads_y
        r2, rho = u**2 + v**2, np.sqrt(u**2 + v**2 + depth**2)
        plain = 1 - 2 * nu
        near = plain / r2 * ((1 - depth / rho) * (u**2 - v**2) / r2 + depth * v**2 / rho**3)
        far = plain / r2 * ((1 - depth / rho) * (v**2 - u**2) / r2 + depth * u**2 / rho**3)
        normal = [
            near - 3 * depth * u**2 / rho**5,
            far - 3 * depth * v**2 / rho**5,
            -3 * depth**3 / rho**5,
            -3 * u * depth**2 / rho**5,
        ]
        down = rho + depth
        twist = plain * (
            u / rho**3 - 3 * u / (rho * down**2) + u**3 / (rho**3 * down**2) + 2 * u**3 / (rho**2 * down**3)
        )
        across = plain * (
            u / rho**3 - u / (rho * down**2) + u * v**2 / (rho**3 * down**2) + 2 * u * v**2 / (rho**2 * down**3)
        )
        tangential = [
            twist - 3 * u**3 / rho**5,
            across - 3 * u * v**2 / rho**5,
            -3 * u * depth**2 / rho**5,
            -3 * u**2 * depth / rho**5,
        ]
        pressed.append([float((one * weight).sum() / (2 * np.pi)) for one in normal])
        sheared.append([float((one * weight).sum() / (2 * np.pi)) for one in tangential])
    return np.array(pressed).T, np.array(sheared).T


PLACES = np.array([-1.4, -0.9, -0.3, 0.0, 0.55, 0.85, 1.2])
DEPTHS = np.array([0.3, 0.12, 0.5, 0.75, 0.2, 1.1, 0.6])


@pytest.mark.parametrize("nu", [0.0, 0.28, 0.5])
def test_the_stresses_under_a_line_are_those_of_line_loads(nu: float) -> None:
    for found, expected in zip(_stresses(PLACES, DEPTHS, nu, 0.0), under_line_loads(PLACES, DEPTHS, nu), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-12)  # of p0; both are exact to rounding


@pytest.mark.parametrize(("aspect", "nu"), [(0.2, 0.28), (1.0, 0.0), (1.0, 0.5), (3.0, 0.28)])
def test_the_stresses_under_an_ellipse_are_those_of_point_loads(
    aspect: float, nu: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(elastic_limit, "DIRECTIONS", 3000)
    depths = DEPTHS * min(1.0, 1.0 / aspect)
    found = _stresses(PLACES, depths, nu, aspect)
    expected = under_point_loads(PLACES, depths, nu, 1.0, 1.0 / aspect)
    for one, other in zip(found, expected, strict=True):
        # The midpoint rule with graded steps has an error of about 1/n² of p0, n = 3000.
        np.testing.assert_allclose(one, other, atol=1e-7)


@pytest.mark.validates(
    "hertz",
    "First yield of a line in full slip, von Mises, ν = 0.28, Y = 937.5 MPa: {none:g}, {low:g}, {paper:g}, {high:g} MPa"
    " at T/N = 0, 0.3, 0.46, 0.6",
    source="stresses under line loads (Flamant), on a fine grid",
    held_to="{within:.1%}",
    none=1657.0,
    low=1352.0,
    paper=1005.0,
    high=809.0,
    within=0.001,
)
def test_first_yield_of_a_line_is_that_of_the_stresses_under_line_loads(
    none: float, low: float, paper: float, high: float, within: float
) -> None:
    traction, expected = np.array([0.0, 0.3, 0.46, 0.6]), np.array([none, low, paper, high])
    np.testing.assert_allclose(1e-6 * first_yield(K, traction, poisson_ratio=0.28), expected, rtol=within)
    x, z = (one.ravel() for one in np.meshgrid(np.linspace(-0.98, 0.98, 99), np.linspace(0.1, 1.0, 46)))
    below = np.stack(under_line_loads(x, z, 0.28, 200))  # the error falls like exp(-2 z count)
    # With friction the peak is at the surface, to which stresses at two depths are extrapolated.
    near, deeper = (np.stack(under_line_loads(x[:99], np.full(99, depth), 0.28)) for depth in (0.004, 0.008))
    pressed, sheared = np.concatenate([below, 2.0 * near - deeper], axis=-1)
    peaks = [von_mises(pressed + t * sheared).max() for t in traction]
    np.testing.assert_allclose(1e-6 * math.sqrt(3.0) * K / np.array(peaks), expected, rtol=within)


def von_mises(stresses: Array) -> Array:
    x, y, z, zx = stresses
    stress: Array = np.sqrt(0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) + 3 * zx**2)
    return stress


@pytest.mark.validates(
    "hertz",
    "The shakedown limit of a line is 4k without friction, and k/μ in full slip with μ = 0.46: {paper:g} MPa",
    source="the greatest τzx: p0/4 without friction, else μp0 (as in Johnson's map of shakedown limits)",
    held_to="{within:.1%}",
    paper=1177.0,
    within=0.002,
)
def test_shakedown_of_a_line_is_johnsons(paper: float, within: float) -> None:
    assert 1e-6 * shakedown_limit(K, 0.46) == pytest.approx(paper, rel=within)
    assert shakedown_limit(K, 0.0) == pytest.approx(4 * K, rel=within)
    for friction in (0.4, 0.5, 1.0, 3.0):
        assert shakedown_limit(K, friction) == pytest.approx(K / friction, rel=within)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0, 2.0, 8.0])
def test_shakedown_of_an_ellipse_without_friction_is_lundberg_and_palmgrens(ratio: float) -> None:
    # As in T. A. Harris, Rolling Bearing Analysis: with b the semi-axis in the rolling direction and
    # b/a = √((t²-1)(2t-1)), the greatest orthogonal shear stress is p0 √(2t-1)/(2t(t+1)).
    t = optimize.brentq(lambda t: (t * t - 1) * (2 * t - 1) - ratio**2, 1.0, 100.0)
    peak = math.sqrt(2 * t - 1) / (2 * t * (t + 1))
    # Between points of the grid, and between axis ratios that are half an octave apart.
    assert shakedown_limit(1.0, 0.0, axis_ratio=ratio) == pytest.approx(1.0 / peak, rel=0.02)


def peaks(ratio: float, friction: Array, sticks: Array, nu: float) -> dict[str, Array]:
    """Return the greatest stresses over p0 (frictions, sticks) of each measure on a finer grid, without a table."""
    depth = min(1.0, 1.0 / ratio) if ratio else 1.0
    share = (friction / (1 + friction))[:, None]
    columns: dict[str, list[Array]] = {measure: [] for measure in elastic_limit.MEASURES}
    for stick in sticks:
        x = np.append(np.sin(np.linspace(-0.5, 0.5, 81) * np.pi), 2 * stick - 1)
        x, z = (one.ravel() for one in np.meshgrid(x, np.append(1e-12, np.linspace(0.03, 0.99, 33)) * depth))
        pressed, sheared = _stresses(x, z, nu, ratio)
        if stick:
            sheared = sheared - stick * _stresses((x + 1 - stick) / stick, z / stick, nu, ratio)[1]
        for measure, column in columns.items():
            column.append(elastic_limit.MEASURES[measure](pressed, sheared, share).max(axis=-1) * (1 + friction))
    return {measure: np.stack(column, axis=-1) for measure, column in columns.items()}


@pytest.mark.parametrize(("ratio", "nu"), [(0.0, 0.28), (0.05, 0.28), (0.4, 0.0), (1.2, 0.28), (20.0, 0.45)])
def test_the_tables_are_as_exact_as_the_docstrings_say(
    ratio: float, nu: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At frictions and shares of slip that lie between those of the tables."""
    mu = np.array([0.02, 0.08, 0.17, 0.26, 0.33, 0.46, 0.63, 0.8, 1.0])[:, None]
    share = np.array([1.0, 0.96, 0.7, 0.3, 0.05])
    limits = {
        "von_mises": first_yield(1.0, mu * share, mu, poisson_ratio=nu, axis_ratio=ratio),
        "forward": shakedown_limit(1.0, mu * share, mu, axis_ratio=ratio),
    }
    monkeypatch.setattr(elastic_limit, "DIRECTIONS", 150)
    sticks = (1.0 - share) ** (1.0 / 3.0 if ratio else 0.5)
    found = peaks(ratio, mu[:, 0], sticks, nu)
    for measure, limit in limits.items():
        off = limit * found[measure] - 1.0
        assert -0.035 <= off.min() <= off.max() <= 0.035
        if measure != "forward":
            assert off.max() <= 0.02
        if not ratio:
            assert np.abs(off[:, 0]).max() <= 0.0015


def test_a_body_is_elastic_without_traction_or_friction_and_alike_in_both_directions() -> None:
    assert first_yield(1.0, 0.0, 0.0, poisson_ratio=0.3) == first_yield(1.0, 0.0, poisson_ratio=0.3)
    assert first_yield(1.0, -0.3, poisson_ratio=0.3) == first_yield(1.0, 0.3, poisson_ratio=0.3)
    assert first_yield(1.0, 0.3, 0.2, poisson_ratio=0.3) == first_yield(1.0, 0.3, poisson_ratio=0.3)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"traction_coefficient": math.nan}, "traction_coefficient: must be a finite number, got nan"),
        ({"friction_coefficient": -1.0}, "friction_coefficient: must not be negative, got -1"),
        (
            {"friction_coefficient": [0.3, math.nan]},
            r"friction_coefficient: must be a finite number, got nan at index \[1\]",
        ),
        ({"axis_ratio": -1.0}, "axis_ratio: must not be negative, got -1"),
    ],
)
def test_arguments_that_no_contact_has_are_refused(given: dict[str, Any], message: str) -> None:
    given = {"traction_coefficient": 0.3, **given}
    with pytest.raises(wl.InputError, match=message):
        first_yield(K, **given, poisson_ratio=0.28)
    with pytest.raises(wl.InputError, match=message):
        shakedown_limit(K, **given)


@pytest.mark.parametrize("shape", ["line", "ellipse"])
def test_an_overload_is_the_same_of_one_point_and_of_many(shape: str) -> None:
    random = np.random.default_rng(3)
    p0, mu = random.uniform(5e8, 2.5e9, 50), random.uniform(0.05, 0.6, 50)
    t = mu * random.uniform(0.0, 1.0, 50)
    ratio = None if shape == "line" else np.append(2.0 ** random.uniform(-2.0, 2.0, 48), [0.01, 40.0])
    bodies = [(K, 0.28), (0.9 * K, 0.4)]
    alone = [overload(bodies, p0[i], t[i], mu[i], None if ratio is None else ratio[i]) for i in range(50)]
    worst = max(one for one in alone if one is not None)
    assert overload(bodies, p0, t, mu, ratio) == pytest.approx(worst, rel=1e-14)
    ratios = np.zeros(50) if ratio is None else ratio
    for one, at_p0, at_t, at_mu, of in zip(alone, p0, t, mu, ratios, strict=True):
        yields = min(float(first_yield(k, at_t, at_mu, poisson_ratio=nu, axis_ratio=of)) for k, nu in bodies)
        shakes = min(float(shakedown_limit(k, at_t, at_mu, axis_ratio=of)) for k, _ in bodies)
        assert (one is None) == (at_p0 <= yields)
        if one is not None:
            assert one.beyond_shakedown == (at_p0 > shakes)
            assert one.max_pressure / one.ratio == pytest.approx(shakes if one.beyond_shakedown else yields, rel=1e-12)


@pytest.mark.parametrize("shape", ["line", "ellipse"])
@pytest.mark.parametrize("nu", [0.0, 0.28, 0.5])
def test_no_point_beyond_a_limit_is_passed_over(shape: str, nu: float) -> None:
    """The quick bound is conservative: a point just beyond a limit is found, alone and among points of less load."""
    mu, share = np.array([1e-3, 0.05, 0.15, 0.3, 0.37, 0.5, 1.0, 5.0])[:, None], np.linspace(0.0, 1.0, 40)
    t, mu = (array.ravel() for array in np.broadcast_arrays(mu * share, mu))
    for aspect in [0.0] if shape == "line" else [0.03, 0.3, 1.0, 1.9, 30.0]:
        ratio = np.full(t.shape, aspect)
        limit = first_yield(K, t, mu, poisson_ratio=nu, axis_ratio=ratio)
        if shape == "ellipse" and nu == 0.28:
            limit = np.maximum(limit, shakedown_limit(K, t, mu, axis_ratio=ratio))
        for i in range(t.size):
            p0 = np.minimum(limit, 0.999 * limit[i])
            p0[i] = 1.0001 * limit[i]
            alone = overload([(K, nu)], p0[i], t[i], mu[i], ratio[i] if aspect else None)
            assert alone is not None
            among = overload([(K, nu)], p0, t, mu, ratio if aspect else None)
            assert among is not None
            assert among >= alone
