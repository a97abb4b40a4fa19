from __future__ import annotations

import functools
import math

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from scipy import integrate

import wearlaw as wl
from tests import line
from tests.line import slip_zone
from tests.plugins.excess import DIGITS, Density, Real, copies, crowded, shares
from tests.strategies import EPS, log_uniform, saturation_creepage, with_creepage
from wearlaw import Array, Q
from wearlaw_kit import line_problems
from wearlaw_models.contact_models.exact import kernel  # private: each copy of the formula
from wearlaw_models.contact_models.exact.kernel import excess_dissipation  # private: each copy of the formula

EXACT = wl.contact_model("exact")
PRINTED = wl.contact_model("exact", slip="as_printed")
SUROS = wl.TwinDisc.suros()


def problem_at(percent: float) -> wl.Problem:
    return SUROS.problem(normal_force="7.4143 kN", creepage=Q(percent, "%"), friction_coefficient=0.46)


def fields_at(model: wl.ContactModel, problem: wl.Problem, x: float) -> wl.LineFields:
    return line.fields_at(model, problem, np.array([x]))


def literal(problem: wl.Problem, x: float) -> tuple[float, float]:
    """Return traction and slip as the corrected eqs. (7) and (8) of Tassini et al. write them, to 60 digits."""
    with mpmath.workdps(60):
        a, p0, radius = (
            mpmath.mpf(float(v)) for v in (problem.half_width, problem.max_pressure, problem.relative_radius)
        )
        friction, creepage, x_mp = (mpmath.mpf(float(v)) for v in (problem.friction_coefficient, problem.creepage, x))
        k = friction / radius
        c = a - creepage / k
        carter = friction * p0 * mpmath.sqrt(1 - (x_mp / a) ** 2)
        if c <= 0:
            return float(carter), float(creepage + k * x_mp)
        if x_mp <= -a + 2 * c:
            return float(carter - c / a * friction * p0 * mpmath.sqrt(1 - ((x_mp + a - c) / c) ** 2)), 0.0
        return float(carter), float(k * mpmath.sqrt((x_mp + a - c) ** 2 - c**2))


@pytest.mark.validates(
    "line-contact",
    "Traction and slip of `exact` along the patch, at any load, friction and creepage",
    source="Carter 1926, after Tassini et al. 2010, eqs. 7 and 8 corrected; with 60 digits",
    held_to="{roundings} ε over the root of the distance from the border of slip, in half-widths",
    roundings=16,
)
@given(problem=line_problems(), where=log_uniform(1e-3, 1.0))
def test_the_fields_are_the_corrected_equations_7_and_8(problem: wl.Problem, where: float, roundings: int) -> None:
    x = float(problem.half_width) * (2.0 * where - 1.0) * (1.0 - 1e-6)
    traction, slip = literal(problem, x)
    fields = fields_at(EXACT, problem, x)
    # a - x and the distance from the border are exact to EPS·a; as a share of μp0 and of 2μa/R a square root of
    # them is no worse than √EPS there, and x keeps 1e-6 a away from the edges.
    border = float(problem.half_width) * (1.0 - 2.0 * min(float(problem.creepage) / saturation_creepage(problem), 1.0))
    distance = max(abs(x - border) / float(problem.half_width), 4 * EPS)
    condition = roundings * EPS / math.sqrt(distance)
    assert float(fields.traction[0]) == pytest.approx(
        traction, abs=condition * float(fields.traction_bound.max() + traction)
    )
    assert float(fields.slip[0]) == pytest.approx(slip, abs=2.0 * condition * max(saturation_creepage(problem), slip))


@pytest.mark.validates(
    "line-contact",
    "T = μP [1 - (1 - ξ/ξ_sat)²] is the integral of the traction",
    source="QUADPACK over the corrected eq. 8",
    held_to="{within:g}, relative",
    within=1e-08,
)
@pytest.mark.parametrize("percent", [1e-4, 0.1, 0.5, 1.0, 1.2, 2.0, 25.0])
def test_the_total_is_the_integral_of_the_traction(percent: float, within: float) -> None:
    problem = problem_at(percent)
    a = float(problem.half_width)
    start, end = (float(v) for v in slip_zone(EXACT, problem))

    def over(low: float, high: float) -> float:
        if high <= low:
            return 0.0
        # x = middle + half·sin θ takes the square roots out of both ends
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        total: float = integrate.quad(
            lambda t: literal(problem, middle + half * math.sin(t))[0] * half * math.cos(t),
            -0.5 * math.pi, 0.5 * math.pi, epsrel=1e-9, limit=400,
        )[0]  # fmt: skip
        return total

    total = over(-a, start) + over(start, end)
    contact = EXACT.solve(problem)
    assert float(contact.tangential_force / problem.track_width) == pytest.approx(total, rel=within)


@pytest.mark.validates(
    "line-contact",
    "The tractions displace two half-planes so that they slip as `exact` says, and not at all in stick",
    source="displacement of half-planes (Johnson 1985), as a principal value by QUADPACK",
    held_to="{within:g} of the creepage",
    within=2e-06,
)
@pytest.mark.parametrize("percent", [0.1, 1.0, 1.2, 2.0])
def test_the_slip_leaves_the_surfaces_together_in_stick(percent: float, within: float) -> None:
    """The displacement gradient of the tractions on two half planes must be the creepage wherever nothing slips.

    s = ξ - (2/πE*) ⨍ q(t)/(x-t) dt·(sign by the leading edge at -a), as in Johnson (1985) with x reversed.
    """
    problem = problem_at(percent)
    a, modulus = float(problem.half_width), float(problem.effective_modulus)
    for position in (-0.9, -0.4, 0.05, 0.6, 0.93):
        x = position * a
        points = [float(v) for v in slip_zone(EXACT, problem)]
        principal, _ = integrate.quad(
            lambda t: float(fields_at(EXACT, problem, t).traction[0]), -a, a, weight="cauchy", wvar=x, limit=2000
        )
        assert points[0] < points[1]
        slip = float(problem.creepage) - 2.0 / (math.pi * modulus) * principal
        assert slip == pytest.approx(float(fields_at(EXACT, problem, x).slip[0]), abs=within * float(problem.creepage))


def test_the_printed_slip_is_creepage_plus_k_x_in_the_whole_slip_zone() -> None:
    problem = problem_at(0.5)
    a, k = float(problem.half_width), 0.46 / 0.01175
    start = float(slip_zone(PRINTED, problem)[0])
    for x in (start + 1e-3 * a, 0.5 * a, 0.99 * a):
        assert float(fields_at(PRINTED, problem, x).slip[0]) == pytest.approx(0.005 + k * x, rel=8 * EPS)
    assert float(fields_at(PRINTED, problem, start - 1e-3 * a).slip[0]) == 0.0
    # the step at the border is ξ_sat - ξ
    assert float(fields_at(PRINTED, problem, start + 1e-9 * a).slip[0]) == pytest.approx(
        saturation_creepage(problem) - 0.005, rel=1e-5
    )


@pytest.mark.validates(
    "line-contact",
    "The share of the patch that sticks is 1 - ξ/ξ_sat",
    source="Carter 1926, after Tassini et al. 2010",
    held_to="{roundings} ε",
    roundings=64,
)
@given(problem=line_problems())
def test_the_stick_ratio_is_one_less_the_reduced_creepage(problem: wl.Problem, roundings: int) -> None:
    contact = EXACT.solve(problem)
    expected = max(1.0 - float(problem.creepage) / saturation_creepage(problem), 0.0)
    assert float(contact.stick_ratio) == pytest.approx(expected, abs=roundings * EPS)


@pytest.mark.validates(
    "line-contact",
    "At a creepage of 1e-7 the force has all its digits",
    source="series of Carter's force in the creepage",
    held_to="{roundings} ε, relative",
    roundings=16,
)
def test_small_creepages_lose_no_digits(roundings: int) -> None:
    problem = with_creepage(problem_at(1.0), 1e-7)
    d = 1e-7 / saturation_creepage(problem)
    expected = 0.46 * 7414.3 * d * (2.0 - d)
    assert float(EXACT.solve(problem).tangential_force) == pytest.approx(expected, rel=roundings * EPS)


def test_a_wrong_slip_is_refused_by_name() -> None:
    with pytest.raises(wl.ConfigurationError, match=r"slip.*'consistent' or 'as_printed'"):
        wl.contact_model("exact", slip="printed")


@pytest.mark.parametrize("model", [EXACT, PRINTED])
@pytest.mark.parametrize("percent", [0.3, 1.0, 1.8, 2.5, 25.0])
def test_where_a_field_crosses_a_value_it_has_that_value(model: wl.LineContactModel, percent: float) -> None:
    line.crossings_meet(model, problem_at(percent))


COPIES = copies(excess_dissipation)
every_copy = pytest.mark.parametrize("copy", COPIES)

ROUNDINGS = 8 * 0.5 * EPS
"""Error as a share of the whole dissipation.

The six terms of the sum come to less than five times the whole together, whatever the threshold, and each carries a
rounding or two. Roots matter only by the square of their error.
"""


def density(reduced: Real) -> Density:
    """Return q·s/(μp0 μa/R) by its factors (Carter 1926), with d = ξR/(μa).

    s/(μa/R) is √((x+a-c)² - c²)/a = √((2d-v)(2-v)) in partial slip, and d + x/a = d + 1 - v in full slip.
    """
    with mpmath.workdps(DIGITS):
        d = mpmath.mpf(reduced)
        if d < 1:
            top = (2 + 3 * d - mpmath.sqrt((2 + 3 * d) ** 2 - 16 * d)) / 4
            return Density(lambda v: mpmath.sqrt(abs(v * (2 * d - v))) * (2 - v), top, 2 * d)
        top = 1 - (mpmath.sqrt(d * d + 8) - d) / 4
        return Density(lambda v: mpmath.sqrt(abs(v * (2 - v))) * (d + 1 - v), top, mpmath.mpf(2))


def whole(reduced: Array) -> Array:
    """Return the whole dissipation T ξ over μp0 a μa/R: (π/2) d² (2-d), and (π/2) d in full slip."""
    return 0.5 * math.pi * reduced * np.where(reduced < 1.0, reduced * (2.0 - reduced), 1.0)


def apply(copy: str, reduced: Array, level: Array) -> Array:
    """Return the results of a copy of the kernel in units where μ, p0, a and R are one, and E* = 2 p0 R/a is two."""
    one = np.ones_like(reduced)
    return COPIES[copy](reduced, one, one, one, 2.0 * one, level)


@functools.cache
def integrals() -> tuple[Array, Array, Array]:
    """Return reduced creepages, thresholds, and the energy above these."""
    random = np.random.default_rng(41)
    reduced = crowded(random, 40)
    densities = [density(d) for d in reduced]
    level = shares(random, reduced.size) * [each.peak for each in densities]
    return reduced, level, np.array([each.excess(at) for each, at in zip(densities, level, strict=True)])


@pytest.mark.validates(
    "integration",
    "The closed form of the energy that `exact` dissipates above a threshold",
    source="mpmath quadrature in 50 digits (Carter 1926, after Tassini et al. 2010)",
    held_to="{share:.1e} of the whole dissipation",
    share=ROUNDINGS,
)
@every_copy
def test_the_energy_above_a_threshold_is_its_integral(copy: str, share: float) -> None:
    reduced, level, expected = integrals()
    error = np.abs(apply(copy, reduced, level) - expected).astype(float)
    assert (error <= share * whole(reduced)).all()
    assert np.ptp(expected.astype(float) / whole(reduced)) > 0.99  # thresholds leave all of it, and nearly nothing


@every_copy
def test_just_below_the_maximum_nothing_is_negative_and_above_it_all_is_zero(copy: str) -> None:
    random = np.random.default_rng(47)
    reduced = crowded(random, 500)
    peaks = np.array([density(d).peak for d in reduced])
    assert (apply(copy, reduced, peaks * (1.0 - 10.0 ** random.uniform(-14.0, -8.0, reduced.size))) >= 0.0).all()
    # squares of the level and of the maximum, of four factors, are compared
    gap = 10.0 ** random.uniform(math.log10(8.0 * EPS), 3.0, reduced.size)
    assert (apply(copy, reduced, peaks * (1.0 + gap)) == 0.0).all()


@every_copy
def test_a_threshold_next_to_nothing_leaves_the_whole_dissipation(copy: str) -> None:
    reduced = np.append(crowded(np.random.default_rng(43), 1_000), 1.0)
    for level in (0.0, 1e-40, 1e-300):
        error = np.abs(apply(copy, reduced, np.full_like(reduced, level)) - whole(reduced))
        assert (error <= (ROUNDINGS + 2 * EPS) * whole(reduced)).all()  # that of the test has four roundings


def test_two_steps_find_the_roots_at_any_creepage_and_level(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(46)
    reduced = crowded(random, 100_000)
    level = shares(random, reduced.size) * np.where(reduced < 1.0, 2.0 * reduced, 1.0 + reduced)  # near the maximum
    limit = 2.0 * ROUNDINGS * whole(reduced)
    found = {}
    for steps in (1, 2, 8):
        monkeypatch.setattr(kernel, "STEPS", steps)
        found[steps] = apply("arrays", reduced, level)
    assert (np.abs(found[2] - found[8]) <= limit).all()
    assert not (np.abs(found[1] - found[8]) <= limit).all()
