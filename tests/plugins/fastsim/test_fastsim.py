from __future__ import annotations

import math
from typing import Literal

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
from scipy import integrate

import wearlaw as wl
from tests.line import crossings_meet, fields_at, slip_zone
from tests.strategies import EPS, saturation_creepage
from wearlaw import Array, Q

Bound = Literal["parabolic", "elliptic"]
Flexibility = Literal["line", "kalker"]

CONFIGURATIONS: list[tuple[Bound, Flexibility]] = [
    ("parabolic", "line"),
    ("parabolic", "kalker"),
    ("elliptic", "line"),
    ("elliptic", "kalker"),
]
every_configuration = pytest.mark.parametrize(("bound", "flexibility"), CONFIGURATIONS)
PERCENT = [1e-3, 0.1, 0.5, 1.0, 1.8, 1.85, 5.0, 25.0]


def problem_at(percent: float) -> wl.Problem:
    return wl.TwinDisc.suros().problem(normal_force="7.4143 kN", creepage=Q(percent, "%"), friction_coefficient=0.46)


def fastsim(bound: Bound, flexibility: Flexibility) -> wl.LineContactModel:
    model = wl.contact_model("fastsim", bound=bound, flexibility=flexibility)
    assert isinstance(model, wl.LineContactModel)
    return model


def flexibility_of(problem: wl.Problem, flexibility: Flexibility) -> float:
    """Return L [m³/N]: 4a/(πE*), or Kalker's 8a/(3 C11 G) in the limit of a long ellipse, 32a/(3π²E*)."""
    a, modulus = float(problem.half_width), float(problem.effective_modulus)
    return 4.0 * a / (math.pi * modulus) if flexibility == "line" else 32.0 * a / (3.0 * math.pi**2 * modulus)


def bound_at(problem: wl.Problem, bound: Bound, x: Array) -> Array:
    """Return μ p2 with the load P of Hertz's pressure."""
    a, load = float(problem.half_width), float(problem.normal_force_per_width)
    inside = np.maximum(1.0 - (x / a) ** 2, 0.0)
    shape: Array = 0.75 * load / a * inside if bound == "parabolic" else 2.0 * load / (math.pi * a) * np.sqrt(inside)
    return float(problem.friction_coefficient) * shape


def march(problem: wl.Problem, bound: Bound, flexibility: Flexibility, cells: int) -> tuple[Array, Array, Array]:
    """Return positions, traction and slip by the march of Tassini et al. 2010, eqs. (12) and (13), cell by cell.

    From the leading edge each cell adds ξ dx/L to the traction of the one before and is cut off at the bound; the
    slip is what the traction did not follow, ξ - L Δq/dx.
    """
    a, creepage = float(problem.half_width), float(problem.creepage)
    flex = flexibility_of(problem, flexibility)
    step = 2.0 * a / cells
    x: Array = -a + step * np.arange(1.0, cells + 1.0)
    limits = bound_at(problem, bound, x)
    traction, slip = np.zeros(cells), np.zeros(cells)
    before = 0.0
    for cell in range(cells):
        trial = before + creepage / flex * step
        traction[cell] = min(trial, limits[cell])
        if trial > limits[cell]:
            slip[cell] = creepage - flex * (traction[cell] - before) / step
        before = traction[cell]
    return x, traction, slip


@pytest.mark.validates(
    "line-contact",
    "`fastsim` on a line, both bounds and flexibilities, is the limit of the published march over cells",
    source="the march of Tassini et al. 2010, eqs. 12 and 13, on 250 to 8000 cells",
    held_to="dissipation in order {order:g} ± {off:g} of the cell, to {most:g} cells of those that slip",
    order=1.0,
    off=0.25,
    most=3.0,
)
@every_configuration
@pytest.mark.parametrize("percent", [0.1, 0.5, 1.0, 1.7, 3.0])
def test_the_march_converges_to_the_closed_form_in_first_order(
    bound: Bound, flexibility: Flexibility, percent: float, order: float, off: float, most: float
) -> None:
    problem, model = problem_at(percent), fastsim(bound, flexibility)
    force = float(model.solve(problem).tangential_force / problem.track_width)
    energy = force * float(problem.creepage)
    counts = 250 * 2 ** np.arange(6)
    traction_errors, energy_errors = [], []
    for cells in counts:
        _, traction, slip = march(problem, bound, flexibility, int(cells))
        step = 2.0 * float(problem.half_width) / cells
        traction_errors.append(abs(traction.sum() * step - force) / force)
        energy_errors.append(abs((traction * slip).sum() * step - energy) / energy)
    # The march samples the traction at the end of each cell: the trapezoidal rule, since q is zero at both edges,
    # so T converges in a higher order (1.5 at the elliptic edge) than the energy, whose slip is a one-sided difference
    # and which errs by two to three cells of those that slip.
    assert max(np.array(traction_errors) * counts) < 5.0
    assert -np.polyfit(np.log(counts), np.log(energy_errors), 1)[0] == pytest.approx(order, abs=off)
    start, end = slip_zone(model, problem)
    slipping_cells = counts[-1] * float((end - start) / (2.0 * problem.half_width))
    assert energy_errors[-1] < most / slipping_cells


@every_configuration
@pytest.mark.parametrize("percent", [0.1, 1.0, 3.0])
def test_the_fields_of_the_march_are_those_of_the_closed_form(
    bound: Bound, flexibility: Flexibility, percent: float
) -> None:
    problem, model = problem_at(percent), fastsim(bound, flexibility)
    cells = 4000
    x, traction, slip = march(problem, bound, flexibility, cells)
    inside = slice(cells // 50, -cells // 50)  # the slope of the ellipse grows without bound at the edges
    fields = fields_at(model, problem, x)
    assert traction[inside] == pytest.approx(fields.traction[inside], rel=1e-9)  # the march only adds up, in 4000 sums
    start, _ = slip_zone(model, problem)
    away = np.abs(x - float(start)) > 2.0 * float(problem.half_width) / cells
    keep = away & (np.abs(x) < 0.96 * float(problem.half_width))
    # a one-sided difference is off by L q'' dx/2
    assert slip[keep] == pytest.approx(fields.slip[keep], abs=0.02 * float(problem.creepage) + 2e-4)


@pytest.mark.validates(
    "line-contact",
    "The closed forms of T of `fastsim`, both bounds and flexibilities",
    source="QUADPACK over min(ξ(x+a)/L, μp2)",
    held_to="{within:g}, relative",
    within=1e-09,
)
@every_configuration
@pytest.mark.parametrize("percent", PERCENT)
def test_the_total_is_the_integral_of_the_clipped_line(
    bound: Bound, flexibility: Flexibility, percent: float, within: float
) -> None:
    problem, model = problem_at(percent), fastsim(bound, flexibility)
    a, slope = float(problem.half_width), float(problem.creepage) / flexibility_of(problem, flexibility)
    start = float(slip_zone(model, problem)[0])
    total = sum(
        integrate.quad(
            lambda x: min(slope * (x + a), float(bound_at(problem, bound, np.array(x)))), low, high, epsrel=1e-11
        )[0]
        for low, high in ((-a, start), (start, a))
        if low < high
    )
    assert float(model.solve(problem).tangential_force / problem.track_width) == pytest.approx(total, rel=within)


@pytest.mark.validates(
    "line-contact",
    "The slip of `fastsim` is ξ - L dq/dx",
    source="Kalker 1982; numerical derivative of the bound with 40 digits",
    held_to="{roundings} ε of the two terms",
    roundings=16,
)
@every_configuration
@pytest.mark.parametrize("percent", PERCENT)
def test_the_slip_is_the_creepage_less_the_slope_of_the_bound(
    bound: Bound, flexibility: Flexibility, percent: float, roundings: int
) -> None:
    problem, model = problem_at(percent), fastsim(bound, flexibility)
    a, flex = float(problem.half_width), flexibility_of(problem, flexibility)
    start = float(slip_zone(model, problem)[0])
    x = start + (a - start) * np.linspace(0.05, 0.9, 12)
    with mpmath.workdps(40):
        top = mpmath.mpf(float(bound_at(problem, bound, np.array(0.0))))
        power = 1 if bound == "parabolic" else 0.5
        gradient = [float(mpmath.diff(lambda y: top * (1 - (y / mpmath.mpf(a)) ** 2) ** power, v)) for v in x]
    expected = float(problem.creepage) - flex * np.array(gradient)
    # the creepage and the slope may cancel where slip begins
    scale = float(problem.creepage) + flex * max(np.abs(gradient))
    assert fields_at(model, problem, x).slip == pytest.approx(expected, abs=roundings * EPS * scale)


@every_configuration
@pytest.mark.parametrize("percent", [0.5, 5.0, 25.0])
def test_where_a_field_crosses_a_value_it_has_that_value(
    bound: Bound, flexibility: Flexibility, percent: float
) -> None:
    crossings_meet(fastsim(bound, flexibility), problem_at(percent))


@every_configuration
@pytest.mark.parametrize("percent", PERCENT)
def test_a_threshold_next_to_nothing_leaves_what_the_force_dissipates(
    bound: Bound, flexibility: Flexibility, percent: float
) -> None:
    problem, model = problem_at(percent), fastsim(bound, flexibility)
    whole = float(model.tangential_force_per_width(problem) * problem.creepage)
    # the roundings of the kernel, of its arguments, and of the closed form of the force
    assert model.excess_dissipation(problem, 1e-300) == pytest.approx(whole, rel=64 * EPS)


@pytest.mark.validates(
    "line-contact",
    "With the parabolic bound, `fastsim` saturates at 1.5 times Carter's creepage",
    source="ξ_f = 3μa/(2R) (Kalker 1982)",
    held_to="{within:g}, relative",
    within=1e-09,
)
def test_the_parabola_saturates_at_one_and_a_half_times_the_creepage_of_carter(within: float) -> None:
    problem = problem_at(1.0)
    for shift, sticks in ((-within, True), (within, False)):
        percent = 150.0 * saturation_creepage(problem) * (1.0 + shift)
        start = float(slip_zone(fastsim("parabolic", "line"), problem_at(percent))[0])
        assert (start > -float(problem.half_width)) is sticks


@pytest.mark.validates(
    "limits",
    (
        "At 1 % creepage T of FASTSIM is below the exact one by {line:.1%}, or {kalker:.1%} with "
        "Kalker's flexibility; the paper finds both the same"
    ),
    source="Carter 1926",
    held_to="the digits shown",
    line=0.063,
    kalker=0.013,
)
def test_the_two_flexibilities_differ_by_the_known_factor(line: float, kalker: float) -> None:
    problem = problem_at(1.0)
    force = {f: float(fastsim("parabolic", f).solve(problem).tangential_force) for _, f in CONFIGURATIONS[:2]}
    exact = float(wl.contact_model("exact").solve(problem).tangential_force)
    # Tassini et al. find about the same T with both theories; at 1 % creepage it is 6 % and 1.3 % less.
    assert 1.0 - force["line"] / exact == pytest.approx(line, abs=5e-4)
    assert 1.0 - force["kalker"] / exact == pytest.approx(kalker, abs=5e-4)


@pytest.mark.parametrize("edge", [-1.0, 1.0])
def test_the_elliptic_bound_is_finite_at_the_very_edge(edge: float) -> None:
    problem = problem_at(1.0)
    a = float(problem.half_width)
    fields = fields_at(fastsim("elliptic", "line"), problem, np.array([edge * a]))
    density = fields.traction * fields.slip
    # towards the trailing edge q·s tends to L (μp0)²/a
    grip = 0.46 * float(problem.max_pressure)
    limit = flexibility_of(problem, "line") * grip**2 / a if edge > 0 else 0.0
    # q and s are of order √EPS and 1/√EPS there
    assert density == pytest.approx(limit, rel=1e-6)


@pytest.mark.parametrize("field", ["bound", "flexibility"])
def test_a_wrong_option_is_refused_by_name(field: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=f"{field}.*got 'spherical'"):
        wl.contact_model("fastsim", **{field: "spherical"})
