"""Friction that falls with temperature: its temperature against full conduction, and its fixed point."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import minimize_scalar
from scipy.special import k0e

import wearlaw as wl
import wearlaw_models.stages.thermal
from tests.plugins.ellipses import EPS, ellipse, ellipses, limit, line
from wearlaw import Array, Q
from wearlaw_models.stages.thermal import Thermal, ThermalProperties

ON_ELLIPSE = ("linear", "polach", "shen_hedrick_elkins", "fastsim")
STEEL = float(np.sqrt(50.0 * 7850.0 * 450.0))
"""√(λρc) of the default steel, from its three numbers."""


def thermal(**changes: Any) -> Thermal:
    return Thermal(**{"hot_ratio": 0.4, "temperature_range": "400 K", **changes})


def fast(problem: wl.Problem, speed: float = 30.0) -> wl.Problem:
    return problem.replaced(rolling_speed=np.full(problem.batch_shape, speed)[()])


def forces_of(name: str, problem: wl.Problem) -> Callable[[wl.Problem], wl.CreepForces]:
    model = wl.contact_model(name)
    if problem.geometry != "line":
        return model.creep_forces
    return lambda one: wl.CreepForces.of_line(np.asarray(model.tangential_force(one)))


def hot(stage: Thermal, name: str, problem: wl.Problem) -> wl.Problem:
    return stage.altered(problem, forces_of(name, problem))


def heating(point: float) -> float:
    """Return ∫ √(1-s²)/√(t-s) ds from -1 to t, with s = t - u²."""
    found: float = quad(lambda u: 2.0 * np.sqrt(max(1.0 - (point - u * u) ** 2, 0.0)), 0.0, np.sqrt(1.0 + point))[0]
    return found


def test_the_constants_are_integrals_of_hertz_pressure() -> None:
    total = quad(lambda t: heating(np.sin(t)) * np.cos(t) ** 2, -0.5 * np.pi, 0.5 * np.pi)[0]
    assert total == pytest.approx(wearlaw_models.stages.thermal.TOTAL_OF_STRIP, rel=1e-8)  # of quad
    ellipses = quad(lambda t: np.cos(t) ** 4.5, -0.5 * np.pi, 0.5 * np.pi)[0]
    assert ellipses == pytest.approx(wearlaw_models.stages.thermal.TOTAL_OF_ELLIPSE, rel=1e-8)
    hottest = minimize_scalar(lambda t: -heating(t), bounds=(0.0, 0.99), method="bounded")
    assert -hottest.fun == pytest.approx(wearlaw_models.stages.thermal.HOTTEST, rel=1e-8)
    assert hottest.x == pytest.approx(0.652, abs=5e-4)


NODES, WEIGHTS = np.polynomial.legendre.leggauss(200)


def over(low: float, high: float) -> tuple[Array, Array]:
    """Return Gauss nodes and weights over x = u², for integrands like roots of x near zero."""
    ends = np.sqrt(low), np.sqrt(high)
    half = 0.5 * (ends[1] - ends[0])
    u = ends[0] + half * (NODES + 1.0)
    return u * u, 2.0 * u * half * WEIGHTS


def band_by_jaeger(peclet: float) -> float:
    """Return the mean rise of a band under Hertz's pressure, weighted by it, over that of the stage.

    A line source of heat q' on a half-space that moves past it with V gives q'/(πλ) exp(Vx/(2κ)) K0(V|x|/(2κ)) at the
    distance x behind it (Jaeger 1942).
    """
    total = 0.0
    for low, high in ((0.0, 0.1 / peclet), (0.1 / peclet, 2.0)):
        shift, weight = over(low, high)
        s = np.sin(0.5 * np.pi * NODES) * (1.0 - 0.5 * shift[:, None]) - 0.5 * shift[:, None]  # from -1 to 1 - shift
        root = np.sqrt(np.maximum((1.0 - s * s) * (1.0 - (s + shift[:, None]) ** 2), 0.0))
        overlap = (root * np.cos(0.5 * np.pi * NODES)) @ WEIGHTS * 0.5 * np.pi * (1.0 - 0.5 * shift)
        total += float((overlap * k0e(peclet * shift) * (1.0 + np.exp(-2.0 * peclet * shift))) @ weight)
    return float(total * np.sqrt(2.0 * peclet / np.pi) / wearlaw_models.stages.thermal.TOTAL_OF_STRIP)


def ellipse_by_fourier(peclet: float, axis_ratio: float) -> float:
    """Return the same for an ellipse, from the transform of heat conduction: q/(λ √(kx² + ky² + i kx V/κ)).

    Hertz's pressure has the transform 3 (sin K - K cos K)/K³ with K² = (a kx)² + (b ky)², which falls as 1/K².
    """
    wave, of_wave = over(0.0, 60.0)
    angle, of_angle = over(0.0, 0.5 * np.pi)  # from the direction across
    pressure = 3.0 * (np.sin(wave) - wave * np.cos(wave)) / wave**3
    along, across = np.sin(angle)[:, None], np.cos(angle)[:, None]
    carried = 2j * peclet * along * wave
    spread = (along**2 + (axis_ratio * across) ** 2) * wave**2
    full, into_depth = (
        of_angle @ (1.0 / np.sqrt(one)).real @ (pressure**2 * wave * of_wave) for one in (carried + spread, carried)
    )
    return float(full / into_depth)


@pytest.mark.validates(
    "elliptic-contact",
    "`thermal`: mean flash temperature from a Péclet number of 5 max(1, a²/b²) on, a/b from 1/100 to 10",
    source="conduction in all directions: Jaeger's line source on a line, Fourier transform on an ellipse",
    held_to="{within:.0%}",
    within=0.06,
)
def test_the_mean_rise_is_that_of_full_conduction_if_the_contact_is_fast(within: float) -> None:
    for peclet in (5.0, 7.0, 10.0, 20.0, 50.0, 200.0, 1e3, 1e4):
        assert band_by_jaeger(peclet) == pytest.approx(1.0, abs=0.5 * within)
        for axis_ratio in (0.01, 0.1, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0):
            found = ellipse_by_fourier(peclet * max(1.0, axis_ratio**2), axis_ratio)
            assert found == pytest.approx(1.0, abs=within)
    # The two ways agree where the ellipse is nearly a line, but for the share of its ends.
    assert ellipse_by_fourier(5.0, 0.001) == pytest.approx(band_by_jaeger(5.0), abs=0.005)
    # The border is needed: below it the error grows.
    assert ellipse_by_fourier(1.0, 1.0) < 0.82
    assert ellipse_by_fourier(10.0, 5.0) < 0.71


def carter_rise(reduced: float, x: float) -> float:
    """Return ∫ q s/√(x - x') dx' for Carter's fields at ξ/ξ_sat, with a = μp0 = ξ_sat = 1 and x' = x - u²."""
    c = max(1.0 - reduced, 0.0)
    first = 2.0 * c - 1.0  # where slip begins

    def heat(u: float) -> float:
        at = x - u * u
        slip = np.sqrt(max((at + 1.0 - c) ** 2 - c * c, 0.0)) if c else reduced + at
        return float(2.0 * np.sqrt(max(1.0 - at * at, 0.0)) * slip)

    return float(quad(heat, 0.0, np.sqrt(max(x - first, 0.0)), limit=200)[0])


@pytest.mark.validates(
    "line-contact",
    "`thermal`: greatest and mean temperature of a line on `exact`, from {low} to {high} of the creepage of full slip",
    source="Carter's q·s integrated from the leading edge to each point by an adaptive quadrature",
    held_to="{within:.0%}",
    low=0.05,
    high=3.0,
    within=0.01,
)
@given(data=st.data())
def test_the_temperature_of_a_line_is_that_of_carters_heat(
    data: st.DataObject, low: float, high: float, within: float
) -> None:
    reduced = data.draw(st.floats(np.log(low), np.log(high)).map(np.exp))
    speed = data.draw(st.floats(1.0, 60.0))
    problem = line(reduced * 0.46 * float(line().a) / 11.75e-3, rolling_speed=Q(speed, "m/s"))
    contact = wl.contact_model("exact").solve(problem)
    p0, a, stage = float(problem.max_pressure), float(problem.a), thermal()
    # q s = μp0 ξ_sat times that of the function above, ξ_sat = μa/R
    unit = 0.46 * p0 * (0.46 * a / 11.75e-3) * np.sqrt(a * speed / np.pi) / (2.0 * STEEL)
    first = max(1.0 - 2.0 * reduced, -1.0)
    hottest: Any = minimize_scalar(lambda x: -carter_rise(reduced, x), bounds=(first, 1.0), method="bounded")
    assert stage.flash_temperature(contact).to("K").magnitude == pytest.approx(-hottest.fun * unit, rel=within)
    angles = np.arcsin(first), 0.5 * np.pi
    total = quad(lambda t: carter_rise(reduced, np.sin(t)) * np.cos(t) ** 2, *angles, epsrel=1e-5)[0]
    assert stage.mean_rise(contact).to("K").magnitude == pytest.approx(total * unit / (0.5 * np.pi), rel=within)


@pytest.mark.parametrize("reduced", [0.1, 0.3, 0.7, 0.999, 3.0])
def test_conduction_along_the_surface_hardly_changes_the_greatest_temperature(reduced: float) -> None:
    # The numbers of the docstring, with Jaeger's line source as in `band_by_jaeger`
    first = max(1.0 - 2.0 * reduced, -1.0)
    peclet = 5.0 / (0.5 * (1.0 - first))  # of the whole patch

    def heat(x: float) -> float:
        c = max(1.0 - reduced, 0.0)
        slip = np.sqrt(max((x + 1.0 - c) ** 2 - c * c, 0.0)) if c else reduced + x
        return float(np.sqrt(max(1.0 - x * x, 0.0)) * slip)

    def conducted(x: float) -> float:
        before = quad(lambda u: 2.0 * u * heat(x - u * u) * k0e(peclet * u * u), 0.0, np.sqrt(x - first))[0]
        behind = quad(
            lambda u: 2.0 * u * heat(x + u * u) * k0e(peclet * u * u) * np.exp(-2.0 * peclet * u * u),
            0.0,
            np.sqrt(1.0 - x),
        )[0]
        return float((before + behind) * np.sqrt(2.0 * peclet / np.pi))

    places = first + (1.0 - first) * np.linspace(0.6, 0.98, 40)
    change = max(map(conducted, places)) / max(carter_rise(reduced, x) for x in places) - 1.0
    assert -0.012 <= change <= 0.0


def test_a_contact_of_means_has_its_heat_spread_like_the_pressure() -> None:
    problem, stage = line(), thermal()
    contact = wl.contact_model("exact").solve(problem).patch_mean()
    p0, a = float(problem.max_pressure), float(problem.a)
    # In full slip q = μ p s V with the mean slip ξ: θ = q0 √(a/(πV)) I/(β1 + β2), I at its largest 2.188
    scale = 0.46 * p0 * 0.05 * 10.0 * np.sqrt(a / (np.pi * 10.0)) / (2.0 * STEEL)
    assert stage.flash_temperature(contact).to("K").magnitude == pytest.approx(2.188 * scale, rel=3e-4)
    mean = quad(lambda t: heating(np.sin(t)) * np.cos(t) ** 2, -0.5 * np.pi, 0.5 * np.pi)[0] / (0.5 * np.pi)
    assert stage.mean_rise(contact).to("K").magnitude == pytest.approx(mean * scale, rel=1e-8)
    # The shares of the page about stages
    assert (stage.mean_rise(contact) / stage.flash_temperature(contact)).magnitude == pytest.approx(0.718, abs=5e-4)
    rolling = wl.contact_model("polach").solve(fast(ellipse(longitudinal_creepage=0.02)))
    assert (stage.mean_rise(rolling) / stage.flash_temperature(rolling)).magnitude == pytest.approx(0.602, abs=5e-4)


# Lewis, R. and Dwyer-Joyce, R. S., Proc. IMechE Part J 218 (2004) 467-478, Table 3, as transcribed in the repository
# thiernodms/KPFASTSIMUSFD: slip [%], heat [W], mean and maximum flash temperature [K]
LEWIS = [
    (0.2, 1.3, 0.13, 0.19),
    (0.5, 9.2, 0.9, 1.3),
    (1.0, 25.7, 2.5, 3.7),
    (3.0, 102.6, 10.1, 15.1),
    (7.5, 246.0, 24.4, 36.7),
    (10.0, 327.8, 32.8, 49.2),
    (15.0, 492.1, 49.9, 74.8),
    (20.0, 728.4, 75.0, 112.5),
]


@pytest.mark.parametrize(("slip", "heat", "mean", "hottest"), LEWIS)
def test_the_flash_temperature_is_that_of_published_twin_discs(
    slip: float, heat: float, mean: float, hottest: float
) -> None:
    speed, a = 400.0 / 60.0 * np.pi * 0.047, 0.315e-3
    # ρ and c as printed there, and λ from the Péclet number 10.3 there
    steel = {"density": "8000 kg/m^3", "specific_heat": "500 J/kg/K"}
    steel["conductivity"] = f"{0.5 * speed * a / 10.3 * 8000.0 * 500.0} W/m/K"
    problem = line(rolling_speed=Q(speed, "m/s"))
    contact = wl.contact_model("exact").solve(problem).patch_mean().replaced(wear_index=np.float64(heat / speed))
    found = thermal(body_1=steel, body_2=steel).flash_temperature(contact).to("K").magnitude
    # There the heat is spread evenly, ∫ dx'/√(x-x') = 2√(2a), and one disc passes at the speed less the slip.
    evenly = 2.0 * np.sqrt(2.0) / (4.0 / np.pi * wearlaw_models.stages.thermal.HOTTEST)
    slower = 2.0 / (1.0 + np.sqrt(1.0 - 0.01 * slip))
    # Printed digits: half a unit of the last one of the temperature, of the heat, of a and of the Péclet number's root.
    last = 0.005 if hottest < 1.0 else 0.05
    rounding = last / hottest + 0.05 / heat + 0.5 * 0.0005 / 0.315 + 0.5 * 0.05 / 10.3
    assert found * evenly * slower == pytest.approx(hottest, rel=rounding)
    assert mean / hottest == pytest.approx(2.0 / 3.0, abs=0.03)  # evenly spread; weighted by p, it would be 0.72


def test_the_flash_temperature_of_full_slip_is_that_of_contacts_example() -> None:
    # Ertz and Knothe's wheel in the example of CONTACT: 5.88 × 10.54 mm, 100 kN, μ = 0.3, 1 m/s of slip at 30 m/s. On a
    # fine grid its temperature tends to 150.28 K, with the slip the same everywhere.
    problem = wl.Problem.ellipse(
        a="5.88 mm",
        b="10.54 mm",
        normal_force="100 kN",
        shear_modulus="82 GPa",
        poisson_ratio=0.28,
        friction_coefficient=0.3,
        longitudinal_creepage=Q(1.0 / 30.0, ""),
        lateral_creepage=Q(0.0, ""),
        spin=Q(0.0, "1/m"),
        rolling_speed="30 m/s",
    )
    contact = wl.contact_model("strip_theory", strips=40).solve(problem)
    even = contact.replaced(slip_x=np.sign(contact.slip_x) / 30.0)
    # 40 strips: rows beside the middle, cos(π/82)^(3/2), and as many nodes as on a line
    assert thermal().flash_temperature(even).to("K").magnitude == pytest.approx(150.28, rel=0.01)
    # θ grows with 1/(b √a), which have an error of half a printed digit
    digits = 0.005 / 10.54 + 0.5 * 0.005 / 5.88
    assert thermal().flash_temperature(contact.patch_mean()).to("K").magnitude == pytest.approx(150.28, rel=digits)


@pytest.mark.parametrize("creepage", [3e-4, 1e-3, 4e-3])
def test_the_temperature_of_an_ellipse_is_that_of_the_heat_of_its_cells(creepage: float) -> None:
    problem = fast(ellipse(longitudinal_creepage=creepage, lateral_creepage=0.5 * creepage, spin=0.2))
    contact = wl.contact_model("half_space", cells=14).solve(problem)
    # x - x' = u² on each row, by the midpoint rule; a jump of the heat is misplaced by half a step at the most
    steps = 20_000
    step = contact.x[1, 0] - contact.x[0, 0]
    rises = np.zeros(contact.x.shape)
    heat = contact.frictional_power_density
    for (node, row), x in np.ndenumerate(contact.x):
        u = (np.arange(steps) + 0.5) / steps * np.sqrt(x - contact.x[0, row] + 0.5 * step)
        cells = np.floor((x - u * u - contact.x[0, row]) / step + 0.5).astype(int).clip(0)
        rises[node, row] = 2.0 * heat[cells, row].sum() * np.sqrt(x - contact.x[0, row] + 0.5 * step) / steps
    rises /= 2.0 * STEEL * np.sqrt(30.0 * np.pi)
    stage = thermal()
    assert stage.flash_temperature(contact).to("K").magnitude == pytest.approx(rises.max(), rel=14 / steps)
    mean = (rises * contact.pressure * contact.area).sum() / problem.normal_force
    assert stage.mean_rise(contact).to("K").magnitude == pytest.approx(mean, rel=14 / steps)


def drawn(count: int, seed: int, spin: float) -> wl.Problem:
    """Return ellipses with a/b from 1/3 to 3, from a tenth to five times the creepage μN/(Gc²), and spin on request."""
    rng, unit = np.random.default_rng(seed), 0.3 * 30e3 / (80e9 * 9e-6)
    ratio = np.exp(rng.uniform(-np.log(3.0), np.log(3.0), count))
    size, angle = np.exp(rng.uniform(np.log(0.1), np.log(5.0), count)) * unit, rng.uniform(0.0, 2.0 * np.pi, count)
    return wl.Problem.ellipse(
        a=Q(3.0 * np.sqrt(ratio), "mm"),
        b=Q(3.0 / np.sqrt(ratio), "mm"),
        normal_force="30 kN",
        shear_modulus="80 GPa",
        poisson_ratio=0.28,
        friction_coefficient=0.3,
        longitudinal_creepage=Q(size * np.cos(angle), ""),
        lateral_creepage=Q(size * np.sin(angle), ""),
        spin=Q(spin * rng.uniform(-1.0, 1.0, count) * unit / 3e-3, "1/m"),
        rolling_speed="30 m/s",
    )


def ratio_of_flash(problem: wl.Problem, model: wl.ContactModel, reference: wl.ContactModel) -> Array:
    found, due = (thermal().flash_temperature(one.solve(problem)).to("K").magnitude for one in (model, reference))
    ratio: Array = found / due
    return ratio


@pytest.mark.validates(
    "elliptic-contact",
    "`thermal`: greatest temperature on `strip_theory` with 20 strips, a/b from 1/3 to 3, in partial and full slip",
    source="the temperature on the cells of `half_space`",
    held_to="{within:.0%} root mean square, {low:+.0%} to {high:+.0%}",
    within=0.07,
    low=-0.18,
    high=0.20,
)
@pytest.mark.parametrize("spin", [0.0, 0.5])
def test_the_temperature_on_strips_is_near_that_on_half_spaces(
    spin: float, within: float, low: float, high: float
) -> None:
    strips, cells = wl.contact_model("strip_theory", strips=20), wl.contact_model("half_space")
    off = ratio_of_flash(drawn(20, 100, spin), strips, cells) - 1.0
    assert np.sqrt(np.mean(off**2)) <= within
    assert (off >= low).all()
    assert (off <= high).all()


@pytest.mark.parametrize(("strips", "most", "with_spin"), [(10, 0.04, 0.035), (20, 0.013, 0.01)])
def test_few_strips_find_less_than_the_greatest_temperature(strips: int, most: float, with_spin: float) -> None:
    few, many = (wl.contact_model("strip_theory", strips=count) for count in (strips, 60))
    off = ratio_of_flash(drawn(50, 7, 0.0), few, many) - 1.0
    assert off.min() >= -most
    assert off.max() <= 0.0
    turning = ratio_of_flash(drawn(50, 7, 1.0), few, many) - 1.0
    assert np.sqrt(np.mean(turning**2)) <= with_spin


def test_strips_of_an_ellipse_have_the_temperature_of_the_ellipse() -> None:
    whole = fast(ellipse(longitudinal_creepage=0.02))
    edges = np.cos(np.linspace(np.pi, 0.0, 2001))
    share, width = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    root = np.sqrt(1.0 - share**2)
    strips = wl.Strips(
        y=whole.b * share, width=whole.b * width, half_length=whole.a * root, max_pressure=whole.max_pressure * root
    )
    fields = {name: getattr(whole, name) for name in wl.Problem.__slots__ if name not in {
        "geometry", "strips", "normal_force", "max_pressure", "effective_modulus"}}  # fmt: skip
    cut = wl.Problem.of_strips(strips, shear_modulus=whole.shear_modulus, **fields)
    stage = thermal()
    same: list[Any] = []
    for problem in (whole, cut):
        forces = wl.CreepForces(longitudinal=limit(problem), lateral=np.zeros(()), spin_moment=np.zeros(()))
        contact = wl.Contact.of_patch(whole, forces).replaced(problem=problem)
        same.append([one(contact).to("K").magnitude for one in (stage.mean_rise, stage.flash_temperature)])
    # 2000 strips in the midpoint rule, of order 2
    assert same[0] == pytest.approx(same[1], rel=1e-5)


@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # a made-up body
def test_bodies_share_the_heat_by_their_effusivities() -> None:
    contact = wl.contact_model("exact").solve(line())
    rise = thermal().mean_rise(contact)
    # A second body with a hundred times the c has ten times the √(λρc).
    heavy = ThermalProperties(specific_heat="45000 J/kg/K")
    assert thermal(body_2=heavy).mean_rise(contact).magnitude == pytest.approx(2.0 / 11.0 * rise.magnitude, rel=4 * EPS)
    assert thermal(body_1=heavy).mean_rise(contact) == thermal(body_2=heavy).mean_rise(contact)


@pytest.mark.validates(
    "invariants",
    "`thermal`: the friction coefficient in full slip",
    source="the closed form of the fixed point, μ0 (1 + (1-h) θ0/Δθ)/(1 + μ0 (1-h) θ/(μ Δθ)), by hand",
    held_to="{within} ε, relative",
    within=64,
)
@pytest.mark.parametrize("onset", [0.0, 30.0])
def test_the_fixed_point_in_full_slip_has_a_closed_form(onset: float, within: int) -> None:
    problem = line(np.array([0.03, 0.1, 0.2]))
    stage = thermal(hot_ratio=0.2, temperature_range="2000 K", onset=Q(onset, "K"))
    found = hot(stage, "exact", problem).friction_coefficient
    contact = wl.contact_model("exact").solve(problem).patch_mean()
    per_friction = stage.mean_rise(contact).to("K").magnitude / 0.46  # T = μN at any μ
    due = 0.46 * (1.0 + 0.8 * onset / 2000.0) / (1.0 + 0.46 * 0.8 * per_friction / 2000.0)
    assert (per_friction * due > onset).all()
    assert (due > 0.2 * 0.46).all()
    assert found == pytest.approx(due, rel=within * EPS)


def friction_at(stage: Thermal, rise: Array, cold: Array) -> Array:
    """Return the friction of CONTACT's piecewise linear law with L = 6: FREF, DFHEAT, TREF and DTHEAT."""
    share, onset, span = stage.hot_ratio, stage.onset.to("K").magnitude, stage.temperature_range.to("K").magnitude
    found: Array = np.interp(rise, [onset, onset + span], [1.0, share]) * cold
    return found


@given(
    problem=ellipses(),
    hot_ratio=st.floats(0.01, 1.0),
    span=st.floats(0.0, 4.0).map(lambda x: 10.0**x),
    onset=st.sampled_from([0.0, 100.0]),
    speed=st.floats(-3.0, 2.0).map(lambda x: 10.0**x),
)
@pytest.mark.parametrize("name", ON_ELLIPSE)
@pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning")
def test_the_friction_is_that_of_its_own_temperature(
    name: str, problem: wl.Problem, hot_ratio: float, span: float, onset: float, speed: float
) -> None:
    stage = thermal(hot_ratio=hot_ratio, temperature_range=Q(span, "K"), onset=Q(onset, "K"))
    problem = fast(problem, speed)
    cold = problem.friction_coefficient
    found = hot(stage, name, problem).friction_coefficient
    assert hot_ratio * cold <= found <= cold

    def left(friction: Any) -> Any:
        """Return μ minus the friction at its temperature."""
        model = wl.contact_model(name)
        contact = model.solve(problem.replaced(friction_coefficient=np.float64(friction))).patch_mean()
        return friction - friction_at(stage, stage.mean_rise(contact).to("K").magnitude, cold)

    # The root lies within a few roundings of μ: the sign changes there, or μ is an end of the range.
    step = 64 * EPS * cold
    low, high = left(max(found - step, hot_ratio * cold)), left(min(found + step, cold))
    rounding = 64 * EPS * cold * (1.0 + (1.0 - hot_ratio) / hot_ratio)
    assert low <= rounding
    assert high >= -rounding


@pytest.mark.parametrize("name", ["exact", "fastsim", *ON_ELLIPSE])
@pytest.mark.parametrize("friction", [1e-3, 0.03, 0.1, 0.3, 0.6])
def test_energy_grows_with_friction_so_that_there_is_one_solution(name: str, friction: float) -> None:
    creepage = np.geomspace(1e-6, 0.5, 60)
    ways = [line(creepage)] if name in ("exact", "fastsim") else []
    if name != "exact":
        ways += [ellipse(longitudinal_creepage=creepage), ellipse(lateral_creepage=creepage)]
    for problem in ways:
        less, more = (
            problem.power(forces_of(name, one)(one))
            for one in (problem.replaced(friction_coefficient=np.full(60, mu)) for mu in (friction, 1.01 * friction))
        )
        # FASTSIM's sums have an error that depends on its nodes, 0.5/strips at the most.
        rounding = 0.05 if name == "fastsim" and problem.geometry == "ellipse" else 32 * EPS
        assert (more >= less * (1.0 - rounding)).all()


@pytest.mark.parametrize(
    ("shape", "most"),
    [
        (lambda away: np.sin(away) + 0.5 * away, 10),
        (lambda away: np.expm1(50.0 * away), 20),
        (lambda away: np.arctan(1e6 * away), 40),
        (lambda away: np.where(away >= 0.0, 1.0, -1.0), 60),  # a bisection
    ],
)
def test_the_root_is_found_to_rounding(shape: Callable[[Array], Array], most: int) -> None:
    places = np.array([0.1, 0.11, 0.2, 0.37, 0.49, 0.5])
    function = Mock(side_effect=lambda friction: shape(friction - places))
    found = wearlaw_models.stages.thermal._root(function, np.full(6, 0.1), np.full(6, 0.5))
    assert found == pytest.approx(places, rel=8 * EPS)
    assert function.call_count <= most
    assert found[[0, -1]].tolist() == [0.1, 0.5]  # the ends of the bracket to the bit


def test_slow_rolling_leaves_the_friction() -> None:
    stage = thermal()
    speeds = np.array([1e-6, 1e-3, 1.0, 10.0])
    with pytest.warns(wl.RangeWarning, match=r"of at least 5; 2 of 4 contacts have less, down to 1.1e-05"):
        found = hot(stage, "exact", line(0.1, rolling_speed=Q(speeds, "m/s"))).friction_coefficient
    assert (np.diff(found) < 0.0).all()
    assert found[0] == pytest.approx(0.46, abs=1e-3)
    contact = wl.contact_model("exact").solve(line(np.array([0.1, 0.0]), rolling_speed="1 mm/s"))
    for rise in (stage.flash_temperature, stage.mean_rise):
        with pytest.warns(wl.RangeWarning, match=r"1 of 2 contacts have less, down to 0\.011"):
            rise(contact)


def test_a_long_patch_and_a_body_that_conducts_well_count_in_the_warning() -> None:
    long = fast(ellipse(a=Q(8, "mm"), b=Q(2, "mm"), longitudinal_creepage=0.02), 1.0)  # Va/(2κ) = 283, over 4²: 17.7
    stage, copper = thermal(temperature_range="50 K"), ThermalProperties(conductivity="500 W/m/K")
    assert hot(stage, "polach", long).friction_coefficient < 0.29
    for other in ({"body_1": copper}, {"body_2": copper}):
        with pytest.warns(wl.RangeWarning, match=r"1 of 1 contacts have less, down to 1.8\."):
            hot(thermal(temperature_range="50 K", **other), "polach", long)
    with pytest.warns(wl.RangeWarning, match="down to 4.4"):
        hot(stage, "polach", fast(long, 0.25))
    with warnings.catch_warnings(action="error"):  # friction that does not fall needs no temperature
        hot(stage, "polach", fast(ellipse(), 1e-3))


@pytest.mark.validates(
    "limits",
    "`thermal` beside friction that falls at each point: μ of a line in full slip, h from 0.01 to 0.9, any heat",
    source="Abel's integral equation of the temperature, solved from the leading edge on",
    held_to="{low:+.2f} to {high:+.2f} of μ0",
    low=-0.05,
    high=0.02,
)
def test_one_friction_coefficient_stands_for_that_of_all_points(low: float, high: float) -> None:
    for hot_ratio in (0.01, 0.05, 0.2, 0.35, 0.5, 0.65, 0.9):
        for rise in np.geomspace(0.01, 1e3, 16):  # mean rise of the cold contact over Δθ
            lumped = max(hot_ratio, 1.0 / (1.0 + (1.0 - hot_ratio) * rise))
            assert low <= lumped - local_friction(rise, hot_ratio) <= high


def local_friction(rise: float, hot_ratio: float, cells: int = 400) -> float:
    """Return ∫ μ(θ) p dx/N over μ0, where each point has the friction of its own temperature."""
    step = 2.0 / cells
    x = -1.0 + step * (np.arange(cells) + 0.5)
    pressure = np.sqrt(1.0 - x**2)
    ends = np.sqrt((np.arange(cells) + 0.5) * step)
    weights = 2.0 * np.diff(ends, prepend=0.0)  # of the cell itself, the one before it, and so on
    per_heat = rise * 0.5 * np.pi / wearlaw_models.stages.thermal.TOTAL_OF_STRIP
    heat, share = np.zeros(cells), np.ones(cells)
    for i in range(cells):
        before = per_heat * float(heat[:i] @ weights[i:0:-1])
        own = per_heat * pressure[i] * weights[0]
        fallen = min((before + own) / (1.0 + (1.0 - hot_ratio) * own), 1.0)
        share[i] = 1.0 - (1.0 - hot_ratio) * fallen
        heat[i] = share[i] * pressure[i]
    return float((share * pressure).sum() / pressure.sum())


@pytest.mark.parametrize(("of_saturation", "due"), [(0.2, 1.84), (0.5, 1.14), (0.9999, 0.82), (30.0, 0.99)])
def test_the_temperature_of_the_friction_is_near_that_of_the_points_that_slip(of_saturation: float, due: float) -> None:
    # The numbers of the docstring: the mean over the points that slip in Carter's theory, over that of the friction
    problem, reduced = line(of_saturation * 0.46 * float(line().a) / 11.75e-3), of_saturation
    contact = wl.contact_model("exact").solve(problem)
    angles = np.arcsin(max(1.0 - 2.0 * reduced, -1.0)), 0.5 * np.pi
    heated = quad(lambda t: carter_rise(reduced, np.sin(t)) * np.cos(t) ** 2, *angles, epsrel=1e-5)[0]
    slipping = quad(lambda t: np.cos(t) ** 2, *angles)[0]
    p0, a = float(problem.max_pressure), float(problem.a)
    unit = 0.46 * p0 * (0.46 * a / 11.75e-3) * np.sqrt(a * 10.0 / np.pi) / (2.0 * STEEL)
    of_friction = thermal().mean_rise(contact.patch_mean()).to("K").magnitude
    assert heated / slipping * unit / of_friction == pytest.approx(due, abs=0.006)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"hot_ratio": 0.0}, "hot_ratio: "),
        ({"hot_ratio": 1.2}, "hot_ratio: "),
        ({"hot_ratio": "0.5"}, "hot_ratio: "),
        ({"temperature_range": "0 K"}, "temperature_range: "),
        ({"temperature_range": "400 degC"}, "temperature_range: "),
        ({"onset": "-1 K"}, "onset: "),
        ({"body_1": {"conductivity": "0 W/m/K"}}, "body_1.conductivity: "),
    ],
)
def test_wrong_input_is_named(options: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=re.escape(message)):
        thermal(**options)


def test_a_contact_from_arrays_has_no_temperature() -> None:
    contact = wl.Contact.from_arrays(
        pressure=Q([[1.0]], "GPa"),
        traction=Q([[0.3]], "GPa"),
        slip=Q([[0.01]], ""),
        area=Q([[1.0]], "mm^2"),
        rolling_speed=Q([1.0], "m/s"),
    )
    with pytest.raises(wl.InputError, match="temperature: the contact has no problem"):
        thermal().mean_rise(contact)
