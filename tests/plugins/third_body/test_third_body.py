"""The third body: every shipped model with a stiffness that is reduced, against closed forms, CONTACT and tests."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

import wearlaw as wl
from tests.plugins.ellipses import EPS, ellipse, ellipses, limit, line
from tests.plugins.full_theory import rows
from wearlaw import Array, Q
from wearlaw_models.stages.third_body import ThirdBody

ON_ELLIPSE = ("linear", "polach", "shen_hedrick_elkins", "fastsim")
ON_LINE = ("exact", "fastsim", "global")
FALLING = ThirdBody(reduction=0.54, limit_reduction=0.02 * 0.54, reduction_decay=0.62)
"""As in the example tractcurv of CONTACT."""


def never(problem: wl.Problem) -> wl.CreepForces:
    """The stage needs no forces."""
    raise AssertionError(problem)


def forces(name: str, problem: wl.Problem) -> tuple[Array, ...]:
    """Return Fx, Fy and Mz on an ellipse, T on a line."""
    model = wl.contact_model(name)
    if problem.geometry == "line":
        return (model.tangential_force(problem),)
    found: tuple[Array, ...] = dataclasses.astuple(model.creep_forces(problem))[:3]
    return found


def slower(problem: wl.Problem, factor: Array | float) -> wl.Problem:
    return problem.with_creepages(
        factor * problem.longitudinal_creepage, factor * problem.lateral_creepage, factor * problem.spin
    )


def assert_same(found: tuple[Array, ...], due: tuple[Array, ...], problem: wl.Problem, within: float) -> None:
    """Compare forces relative to the larger of μN and the force, a moment relative to that times √(ab)."""
    size = np.maximum(limit(problem), np.hypot(*due[:2]) if len(due) > 1 else np.abs(due[0]))
    for one, other, lever in zip(found, due, (1.0, 1.0, np.sqrt(problem.a * problem.b)), strict=False):
        assert (np.abs(one - other) <= within * size * lever).all()


# With L/k in place of L, each theory is a function of k times the creepages, because stiffness and creepage enter as a
# product alone. So the slopes at zero creepage are k times those without the stage.
@pytest.mark.validates(
    "invariants",
    "`third_body` around `linear`, `polach`, `shen_hedrick_elkins` and `fastsim`: the forces of k times the creepages",
    source="similarity: stiffness and creepage enter as a product",
    held_to="{within:g} of μN",
    within=1e-12,
)
@given(problem=ellipses(), reduction=st.floats(0.05, 1.0))
@pytest.mark.parametrize("name", ON_ELLIPSE)
def test_an_ellipse_has_the_forces_of_k_times_the_creepages(
    name: str, problem: wl.Problem, reduction: float, within: float
) -> None:
    found = forces(name, ThirdBody(reduction=reduction).altered(problem, never))
    assert_same(found, forces(name, slower(problem, reduction)), problem, within)


@given(creepage=st.floats(-6.0, 0.0).map(lambda x: 10.0**x), reduction=st.floats(0.05, 1.0))
@pytest.mark.parametrize("name", ON_LINE)
def test_a_line_has_the_force_of_k_times_the_creepage(name: str, creepage: float, reduction: float) -> None:
    problem = line(creepage)
    found = forces(name, ThirdBody(reduction=reduction).altered(problem, never))
    assert_same(found, forces(name, slower(problem, reduction)), problem, 16 * EPS)


@pytest.mark.validates(
    "limits",
    "`third_body` around every contact model: the initial slope falls by k0",
    source="the slopes of the models in closed form",
    held_to="{within:g}, relative",
    within=1e-5,
)
@pytest.mark.parametrize("stage", [ThirdBody(reduction=0.54), FALLING])
@pytest.mark.parametrize("name", ON_ELLIPSE)
def test_the_initial_slope_of_an_ellipse_falls_by_the_reduction(name: str, stage: ThirdBody, within: float) -> None:
    # G ab C11 ξ with Kalker's C11 = 4.12 at a = b, ν = 1/4 (Table E.3). At ξ = 1e-8, ε is 2e-6, and so the cubic of
    # Shen, Hedrick and Elkins and the factor that falls are lower by up to 2e-6. FASTSIM's sums have an error of their
    # own, which does not depend on the stage.
    problem = ellipse(longitudinal_creepage=1e-8)
    found, bare = (forces(name, one)[0] for one in (stage.altered(problem, never), problem))
    assert found == pytest.approx(0.54 * bare, rel=within)
    if name != "fastsim":
        assert found == pytest.approx(0.54 * 80e9 * 36e-6 * 4.12 * 1e-8, rel=within)


@pytest.mark.validates(
    "creep-forces",
    "`third_body` around `fastsim`: k and the creep curve of a locomotive wheel with falling friction",
    source="CONTACT's modified FASTSIM (after Spiryagin, Polach and Cole 2013), example tractcurv",
    held_to="{of_factor:.1%} of k; at most {high:.3f} of μN below it, its first step on its cells, and {low:g} above",
    of_factor=0.004,
    high=1.1 / 48,
    low=2e-3,
)
def test_the_creep_curve_is_that_of_contacts_modified_fastsim(of_factor: float, high: float, low: float) -> None:
    table = rows("creep_curve_modified_fastsim.csv")
    creepage, factor, force = (np.array([float(row[name]) for row in table]) for name in ("xi", "k", "fx"))
    friction = wl.FallingFriction(static_coefficient=0.36, limit_ratio=0.38, decay=Q(np.log(2.0) / 0.99, "s/m"))
    problem = wl.Problem.ellipse(
        a=Q(6.304, "mm"),
        b=Q(12.61, "mm"),
        normal_force=Q(106.7, "kN"),
        shear_modulus=Q(82, "GPa"),
        poisson_ratio=0.28,
        friction_coefficient=friction.coefficient(10.0 * creepage),
        longitudinal_creepage=Q(creepage, ""),
        lateral_creepage=Q(0, ""),
        spin=Q(0, "1/m"),
    )
    # CONTACT counts the area of its 1376 elements for πab, which is 0.35 % more, and so has an ε as much larger and a k
    # lower by up to as much. Half of the fourth digit adds 0.03 %.
    above = FALLING.factor(problem) / factor - 1.0
    assert (above >= 0.0).all()
    assert (above <= of_factor).all()
    found = wl.contact_model("fastsim").creep_forces(FALLING.altered(problem, never)).longitudinal
    # As for FASTSIM's own curve: the first step of CONTACT's march is a whole one.
    excess = (-force - found) / limit(problem)
    assert (excess <= high).all()
    assert (excess >= -low).all()


def test_the_factor_falls_from_the_reduction_to_its_share() -> None:
    creepage = np.concatenate([[0.0], np.geomspace(1e-6, 1.0, 50)])
    for problem in (line(creepage), ellipse(longitudinal_creepage=creepage)):
        factor = FALLING.factor(problem)
        assert factor[0] == pytest.approx(0.54, rel=2 * EPS)
        assert (np.diff(factor) < 0.0).all()
        assert (factor > 0.54 * 0.02).all()
    huge = ellipse(longitudinal_creepage=1.0, friction_coefficient=1e-6)
    assert FALLING.factor(huge) == pytest.approx(0.54 * 0.02, rel=1e-3)


def test_the_factor_of_a_line_counts_the_force_of_the_linear_theory() -> None:
    # ε = (π/4) k0 F'/(μN), and F' = 2 μN ξ/ξ_sat in Carter's theory
    problem = line(0.003)
    share = 0.003 / (0.46 * problem.a / 11.75e-3)
    due = 0.54 * (0.02 + 0.98 / (1.0 + 0.62 * 0.5 * np.pi * 0.54 * share))
    assert FALLING.factor(problem) == pytest.approx(due, rel=16 * EPS)
    assert FALLING.factor(line(-0.003)) == FALLING.factor(problem)


def test_lateral_creepage_counts_at_the_leading_edge() -> None:
    along = FALLING.factor(ellipse(longitudinal_creepage=2e-3))
    assert FALLING.factor(ellipse(lateral_creepage=-2e-3)) == along
    # a = 6 mm: η + φa = 2e-3
    assert FALLING.factor(ellipse(lateral_creepage=1e-3, spin=1e-3 / 6e-3)) == pytest.approx(along, rel=4 * EPS)
    assert FALLING.factor(ellipse(lateral_creepage=2e-3, spin=-1e-3 / 6e-3)) == along


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "reduction: is missing"),
        ({"reduction": 0.0}, "reduction: input should be greater than 0, got 0.0"),
        ({"reduction": 1.2}, "reduction: input should be less than or equal to 1, got 1.2"),
        ({"reduction": Q(0.8, "mm")}, "reduction: got 0.8000 mm, which is not a ratio"),
        ({"reduction": 0.8, "limit_reduction": 0.5}, "give both for a factor that falls, or none of them"),
        ({"reduction": 0.8, "reduction_decay": 0.5}, "give both for a factor that falls, or none of them"),
        (
            {"reduction": 0.8, "limit_reduction": 0.8, "reduction_decay": 1.0},
            "limit_reduction must lie below reduction = 0.8; got 0.8",
        ),
        (
            {"reduction": 0.8, "limit_reduction": -0.1, "reduction_decay": 1.0},
            "limit_reduction: input should be greater than or equal to 0, got -0.1",
        ),
        (
            {"reduction": 0.8, "limit_reduction": 0.5, "reduction_decay": 0.0},
            "reduction_decay: input should be greater than 0, got 0.0",
        ),
        (
            {"reduction": 0.8, "limit_reduction": 0.5, "reduction_decay": float("inf")},
            "reduction_decay: input should be a finite number",
        ),
        ({"reduktion": 0.8}, "reduktion: unknown field; did you mean 'reduction'"),
    ],
)
def test_wrong_input_is_named(options: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=re.escape(message)):
        ThirdBody(**options)


@pytest.mark.validates(
    "fitting",
    "The `reduction` that fits `exact` best to the eight tractions of the twin-disc study: {reduction} at μ = 0.46",
    source="least squares of ln(predicted/measured), with Carter's T in closed form by hand",
    held_to="{within:g}",
    reduction=0.688,
    within=5e-4,
)
def test_the_measured_tractions_ask_for_a_third_body(reduction: float, within: float) -> None:
    # Frictional heat = T ξ V: Lewis and Dwyer-Joyce (2004), Table 3
    creepage = np.array([0.2, 0.5, 1.0, 3.0, 7.5, 10.0, 15.0, 20.0]) / 100.0
    heat = np.array([1.3, 9.2, 25.7, 102.6, 246.0, 327.8, 492.1, 728.4])
    measured = heat / (creepage * np.pi * 0.047 * 400.0 / 60.0 * 7414.3)

    def by_hand(k: float) -> Any:
        problem = wl.TwinDisc.suros().problem(
            normal_force=Q(7414.3, "N"), creepage=Q(creepage, ""), friction_coefficient=0.46
        )
        share = np.minimum(k * creepage * 11.75e-3 / (0.46 * problem.a), 1.0)
        return 0.46 * share * (2.0 - share)

    assert measured[:3] / by_hand(1.0)[:3] == pytest.approx([0.65, 0.85, 0.79], abs=0.005)
    best = minimize_scalar(lambda k: (np.log(by_hand(k) / measured) ** 2).sum(), bounds=(0.1, 1.0), method="bounded")
    assert best.x == pytest.approx(reduction, abs=within)
