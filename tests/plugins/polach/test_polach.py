"""Polach's forces, against his equations, Kalker's slopes, FASTSIM and the full theory."""

from __future__ import annotations

from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.ellipses import EPS, TABLE_E3, ellipse, ellipses, initial_slopes, limit, of_ratio
from tests.plugins.full_theory import assert_energy_misses_by, assert_forces_miss_by, spheres

POLACH = wl.contact_model("polach")
WET = wl.contact_model("polach", adhesion_reduction=0.3, slip_reduction=0.1)


def published(problem: wl.Problem, k_a: float, k_s: float) -> tuple[float, float, float]:
    """Return Fx, Fy and the sum of what they are made of, in the form of Polach (1999, 2005), from 60 digits.

    They are in the signs of the creepages.
    """
    with mpmath.workdps(60):
        a, b, load, modulus, friction, x, y, spin = (
            mpmath.mpf(float(getattr(problem, name)))
            for name in (
                "a", "b", "normal_force", "shear_modulus", "friction_coefficient",
                "longitudinal_creepage", "lateral_creepage", "spin",
            )
        )  # fmt: skip
        c = wl.kalker.coefficients(problem.a / problem.b, problem.poisson_ratio)
        c11, c22, c23 = (mpmath.mpf(float(value)) for value in (c.c11, c.c22, c.c23))
        s = mpmath.hypot(x, y)
        c_jj = mpmath.hypot(c11 * x / s, c22 * y / s) if s else mpmath.mpf(0)
        y_c = y + spin * a if abs(y + spin * a) > abs(y) else y
        s_c = mpmath.hypot(x, y_c)
        if not s_c:
            return 0.0, 0.0, 0.0
        gradient = mpmath.pi / 4 * modulus * a * b * c_jj / (load * friction) * s_c
        force = 2 * load * friction / mpmath.pi
        force *= k_a * gradient / (1 + (k_a * gradient) ** 2) + mpmath.atan(k_s * gradient)
        shape = 1 + mpmath.mpf("6.3") * (1 - mpmath.exp(-a / b))
        turning = mpmath.mpf(8) / 3 * modulus * b * mpmath.sqrt(a * b) / (load * friction) * c23 * abs(y_c) / shape
        delta = (turning**2 - 1) / (turning**2 + 1)
        k_m = turning * (delta**3 / 3 - delta**2 / 2 + mpmath.mpf(1) / 6) - mpmath.sqrt((1 - delta**2) ** 3) / 3
        by_spin = -mpmath.mpf(9) / 16 * a * load * friction * k_m * shape * spin / s_c
        return float(force * x / s_c), float(force * y / s_c + by_spin), float(force + abs(by_spin))


@pytest.mark.validates(
    "creep-forces",
    "`polach`: Fx and Fy with any reduction factors",
    source="Polach 1999 and 2005, with 60 digits",
    held_to="{roundings} ε of the terms",
    roundings=32,
)
@given(problem=ellipses(), k_a=st.floats(0.05, 1.0), share=st.floats(0.05, 1.0))
def test_the_forces_are_those_of_the_published_equations(
    problem: wl.Problem, k_a: float, share: float, roundings: int
) -> None:
    k_s = k_a * share
    found = wl.contact_model("polach", adhesion_reduction=k_a, slip_reduction=k_s).creep_forces(problem)
    force_x, force_y, size = published(problem, k_a, k_s)
    # The two parts of Fy may cancel.
    assert float(found.longitudinal) == pytest.approx(force_x, abs=roundings * EPS * size)
    assert float(found.lateral) == pytest.approx(force_y, abs=roundings * EPS * size)


@pytest.mark.validates(
    "creep-forces",
    "`polach` at vanishing creepage: Kalker's slopes, times (k_A + k_S)/2",
    source="Kalker 1990, Table E.3; the derivative of Polach 2005, eq. 11, without creepage",
    held_to="{within:g}, relative",
    within=1e-11,
)
@pytest.mark.parametrize(("axis_ratio", "poisson_ratio"), TABLE_E3)
@pytest.mark.parametrize("model", [POLACH, WET], ids=["1, 1", "0.3, 0.1"])
def test_the_slopes_at_vanishing_creepage_are_kalkers(
    model: wl.ContactModel, axis_ratio: float, poisson_ratio: float, within: float
) -> None:
    c11, c22, c23, c33 = TABLE_E3[axis_ratio, poisson_ratio]
    k = 1.0 if model is POLACH else 0.2  # (k_A + k_S)/2, the derivative of Polach (2005), eq. (11)
    expected = np.array([[k * c11, 0.0, 0.0], [0.0, k * c22, -c23], [0.0, c23, k * c33]])
    # ε and ε_S are below 1e-6 here, and what is neglected is their square.
    assert initial_slopes(model, axis_ratio, poisson_ratio) == pytest.approx(expected, rel=within, abs=0.0)


@pytest.mark.validates(
    "creep-forces",
    "`polach` in pure creepage is FASTSIM with the elliptic bound",
    source="CONTACT's FASTSIM on 40 and 200 cells across, extrapolated",
    held_to="{share:g} of the step that is extrapolated",
    share=0.5,
)
def test_pure_creepage_is_what_fastsim_converges_to(share: float) -> None:
    # With the elliptic bound and without spin FASTSIM has this closed form. The error of the reference is of first
    # order in the size of its elements: 40 and 200 across extrapolate to none, closer than by the step from 200.
    coarse, fine = spheres("nb40"), spheres("nb200")
    pure = [i for i, name in enumerate(coarse.names) if name.startswith(("long", "lat"))]
    force_40, force_200 = (np.hypot(one.force_x, one.force_y)[pure] for one in (coarse, fine))
    step = (force_40 - force_200) / 4.0
    found = POLACH.creep_forces(fine.problem).tangential[pure]
    assert len(pure) == 8
    assert (np.abs(found - (force_200 - step)) < share * np.abs(step)).all()


@pytest.mark.validates(
    "creep-forces",
    "`polach` never gives back energy, with any creepages, spin and factors",
    source="the second law",
    held_to="{roundings} ε of the terms",
    roundings=8,
)
@given(problem=ellipses())
@pytest.mark.parametrize("model", [POLACH, WET], ids=["1, 1", "0.3, 0.1"])
def test_no_creepage_and_spin_give_back_energy(model: wl.ContactModel, problem: wl.Problem, roundings: int) -> None:
    found = model.creep_forces(problem)
    terms = [
        problem.longitudinal_creepage * found.longitudinal,
        problem.lateral_creepage * found.lateral,
        problem.spin * found.spin_moment,
    ]
    assert problem.power(found) >= -roundings * EPS * float(np.abs(terms).sum())
    moving = bool(problem.longitudinal_creepage or problem.lateral_creepage or problem.spin)
    assert (problem.power(found) > 0.0) == moving


@pytest.mark.parametrize("spin", [-3.0, 0.5, 30.0])
def test_the_moment_goes_smoothly_to_that_of_spin_alone(spin: float) -> None:
    # C is not defined without creepage; nothing may hang on its direction there.
    alone, along, across = (
        float(POLACH.creep_forces(ellipse(longitudinal_creepage=x, lateral_creepage=y, spin=spin)).spin_moment)
        for x, y in ((0.0, 0.0), (1e-12, 0.0), (0.0, 1e-12))
    )
    assert along == pytest.approx(alone, rel=1e-8)
    assert across == pytest.approx(alone, rel=1e-8)


@pytest.mark.validates(
    "limits",
    ("`polach` with factors for wet rails can pass μN, by more than a tenth at a/b = 10 with spin; declared"),
    source="the published equations",
    held_to="more than {times:g} μN",
    times=1.1,
)
def test_reduced_it_can_pass_friction_on_a_long_patch_and_declares_it(times: float) -> None:
    assert set(POLACH.exemptions) == {"stick", "saturation"}
    assert set(WET.exemptions) == {"stick", "saturation", "initial_slope", "traction_bound"}
    # Spin against the lateral creepage, so that η_C is no larger than η: |F_S φ/s_C| is then the larger part.
    problem = of_ratio(10.0, 0.25, lateral_creepage=-0.0018, spin=0.0036 / (6e-3 * 10.0**0.5))
    assert WET.creep_forces(problem).tangential > times * limit(problem)
    assert POLACH.creep_forces(problem).tangential < limit(problem)


@pytest.mark.validates(
    "limits",
    (
        "`polach` misses forces by {curve_most:.1%} of μN on a creep curve (a/b = 1/2), and by {circle:.1%} in 16 "
        "cases on a circle, with lateral creepage and spin of the same sign; there Tγ by {low:+.0%} to {high:+.0%}"
    ),
    source="CONTACT (Vollebregt), half-space theory",
    held_to="the digits shown",
    curve_most=0.061,
    circle=0.054,
    low=-0.13,
    high=0.1,
)
def test_contact_leaves_it_by_the_digits_shown(curve_most: float, circle: float, low: float, high: float) -> None:
    assert_forces_miss_by(POLACH, curve_most, at=0.98, circle=circle)
    assert_energy_misses_by(POLACH, low, high, highest="spin_0.001")


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"slip_reduction": 0.5, "adhesion_reduction": 0.4}, "slip_reduction must not lie above adhesion_reduction = 0.4"),
    ({"adhesion_reduction": 0.5}, "slip_reduction must not lie above adhesion_reduction = 0.5; got 1.0"),
    ({"slip_reduction": 0.0}, "polach: slip_reduction: .*greater than 0"),
    ({"adhesion_reduction": 1.2}, "polach: adhesion_reduction: .*less than or equal to 1"),
    ({"slip_reduction": "0.4"}, "polach: slip_reduction: .*number"),
    ({"slip_reduction": float("nan")}, "polach: slip_reduction: "),
    ({"slip_reducton": 0.4}, "polach: slip_reducton: unknown field; did you mean 'slip_reduction'?"),
]


@pytest.mark.parametrize(("options", "message"), WRONG)
def test_factors_that_are_none_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=message):
        wl.contact_model("polach", **options)
