"""Stages around the contact model: those that change the problem or the contact, and wrong ones."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

import numpy as np
import pytest
from pydantic import Field

import wearlaw as wl
from tests.core.axles import EXISTS, GIVEN, Axle
from tests.core.stages import CONDITIONS, EXACT, FASTSIM, KTH, RIG, predicted, silently
from wearlaw import Q
from wearlaw.errors import ModelError

EPS = float(np.finfo(np.float64).eps)
RAILS = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="2 m/s")
ON_RAILS: dict[str, Any] = {
    "normal_force": "50 kN",
    "longitudinal_creepage": Q([0.1, 0.3], "%"),
    "lateral_creepage": "0.1 %",
    "spin": "0.3 1/m",
    "friction_coefficient": 0.4,
}


class Lubricated(wl.Stage):
    """Friction that falls to a share."""

    name: ClassVar[str] = "lubricated"

    share: Annotated[float, Field(gt=0.0, le=1.0)] = 0.5

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return problem.replaced(friction_coefficient=self.share * problem.friction_coefficient)


class LubricatedBySolving(Lubricated):
    """The same, as a stage that overrides `solve`."""

    name: ClassVar[str] = "lubricated_by_solving"

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Contact:
        return inner(problem.replaced(friction_coefficient=self.share * problem.friction_coefficient))


class Softening(wl.Stage):
    """Friction that falls with the traction coefficient, one step of a fixed point."""

    name: ClassVar[str] = "softening"

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        used = forces(problem).tangential / (problem.friction_coefficient * problem.normal_force)
        return problem.replaced(friction_coefficient=problem.friction_coefficient * (1.0 - 0.5 * used))


USFD = wl.wear_law("usfd", fitted_for="exact")
HALF = {**CONDITIONS, "friction_coefficient": 0.5 * CONDITIONS["friction_coefficient"]}


@pytest.mark.parametrize(
    ("rig", "model", "law", "conditions"),
    [
        *((RIG, model, law, CONDITIONS) for model in ("exact", "fastsim", "global") for law in (KTH, USFD)),
        *((RAILS, model, wl.wear_law("usfd"), ON_RAILS) for model in ("fastsim", "polach")),
    ],
)
def test_a_stage_that_changes_the_problem_gives_the_result_of_that_problem(
    rig: Any, model: str, law: wl.WearLaw, conditions: dict[str, Any]
) -> None:
    half = {**conditions, "friction_coefficient": 0.5 * conditions["friction_coefficient"]}
    staged = predicted(silently(rig, wl.contact_model(model), Lubricated(), law), **conditions)
    plain = predicted(silently(rig, wl.contact_model(model), law), **half)
    for name in ("wear_rate", "wear_rate_error", "tangential_force", "spin_moment", "wear_index", "stick_ratio"):
        assert np.array_equal(getattr(staged, name).magnitude, getattr(plain, name).magnitude), name
    assert np.array_equal(staged.contact.traction, plain.contact.traction)


def test_a_stage_that_overrides_solve_gives_the_same_within_its_error() -> None:
    alters, solves = (
        predicted(silently(RIG, EXACT, stage, USFD), **CONDITIONS) for stage in (Lubricated(), LubricatedBySolving())
    )
    assert solves.tangential_force.magnitude == pytest.approx(alters.tangential_force.magnitude, rel=64 * EPS)
    gap = abs(solves.wear_rate - alters.wear_rate)
    assert gap <= solves.wear_rate_error + alters.wear_rate_error
    assert solves.wear_rate_error > 1e3 * alters.wear_rate_error, "its nodes do not know the law's borders"


def test_the_error_and_the_strips_of_a_stage_that_overrides_solve_are_those_of_the_altered_problem() -> None:
    law = wl.wear_law("usfd")
    solves, alters = (
        predicted(silently(RAILS, FASTSIM, stage, law), **ON_RAILS) for stage in (LubricatedBySolving(), Lubricated())
    )
    assert np.array_equal(solves.wear_rate_error.magnitude, alters.wear_rate_error.magnitude)
    for strips in (None, 31):
        one, other = (result.wear_profile("wheel", strips=strips) for result in (solves, alters))
        assert one.identical(other)
    assert one.depth.shape == (2, 31)


class Balancing(wl.WheelRail):
    """Presses the wheel down by the longitudinal force."""

    def balanced(self, problem: wl.Problem, forces: Any) -> wl.Problem:
        return problem.with_normal_force(problem.normal_force + np.abs(forces(problem).longitudinal))


def test_a_rig_balances_its_loads_with_the_forces_behind_the_stages() -> None:
    rig = Balancing(**dict(RAILS))
    load = predicted(rig | FASTSIM | Lubricated(), **ON_RAILS).normal_force.m_as("N")
    force = predicted(RAILS | FASTSIM | Lubricated(), **ON_RAILS).longitudinal_force.m_as("N")
    assert load == pytest.approx(50e3 + np.abs(force), rel=16 * EPS)


def test_a_stage_sees_the_forces_of_the_model_inside() -> None:
    plain = predicted(RIG | EXACT, **CONDITIONS)
    used = plain.traction_coefficient.magnitude / CONDITIONS["friction_coefficient"]
    staged = predicted(RIG | EXACT | Softening(), **CONDITIONS)
    expected = CONDITIONS["friction_coefficient"] * (1.0 - 0.5 * used)
    assert staged.friction_coefficient.magnitude == pytest.approx(expected, rel=16 * EPS)


def test_the_first_stage_stands_next_to_the_model() -> None:
    inner_first = predicted(RIG | EXACT | Softening() | Lubricated(), **CONDITIONS)
    by_hand = predicted(RIG | EXACT | Softening(), **HALF)
    assert np.array_equal(inner_first.tangential_force.magnitude, by_hand.tangential_force.magnitude)
    other = predicted(RIG | EXACT | Lubricated() | Softening(), **CONDITIONS)
    assert not np.allclose(other.tangential_force.magnitude, by_hand.tangential_force.magnitude, rtol=1e-3)


def test_patch_means_can_follow_and_precede_other_stages() -> None:
    law = wl.wear_law("brr")
    plain = predicted(silently(RIG, FASTSIM, wl.patch_mean(), law), **HALF)
    for stages in ([Lubricated(), wl.patch_mean()], [wl.patch_mean(), Lubricated()]):
        staged = predicted(silently(RIG, FASTSIM, *stages, law), **CONDITIONS)
        assert staged.wear_rate.magnitude == pytest.approx(plain.wear_rate.magnitude, rel=16 * EPS)
    assert silently(RIG, FASTSIM, wl.patch_mean(), LubricatedBySolving()).scale == "patch"


def test_applications_see_the_stages() -> None:
    """Sweeps, creepage_for and uncertainties all solve the contact with its stages."""
    predict, plain = silently(RIG, EXACT, Lubricated(), USFD), silently(RIG, EXACT, USFD)
    axis = Q(np.linspace(0.1, 2.0, 5), "%")
    swept = wl.sweep(predict, **{**CONDITIONS, "creepage": axis})
    assert np.array_equal(swept.wear_rate, wl.sweep(plain, **{**HALF, "creepage": axis}).wear_rate)
    given = {name: value for name, value in CONDITIONS.items() if name != "creepage"}
    half = {**given, "friction_coefficient": HALF["friction_coefficient"]}
    found = wl.creepage_for(predict, traction_coefficient=0.1, **given)
    assert found == wl.creepage_for(plain, traction_coefficient=0.1, **half)
    spread = wl.normal(Q(1.0, "%"), Q(0.01, "%"))
    uncertain = wl.uncertainty(predict, samples=16, **{**given, "creepage": spread})
    assert uncertain.median == wl.uncertainty(plain, samples=16, **{**half, "creepage": spread}).median


class Wrong(wl.Stage):
    """Returns what is not a problem, or another one."""

    name: ClassVar[str] = "wrong"
    fault: str

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> Any:
        match self.fault:
            case "nothing":
                return None
            case "shape":
                return problem[:1]
            case "raises":
                return 1 / 0
        return problem.replaced(friction_coefficient=WRONG_FRICTION[self.fault](problem.friction_coefficient))


WRONG_FRICTION: dict[str, Any] = {
    "column": lambda friction: friction[..., None],
    "one number": lambda friction: np.float64(0.3),  # noqa: ARG005
    "seven": lambda friction: np.full(7, 0.3),  # noqa: ARG005
    "no array": lambda friction: 0.3,  # noqa: ARG005
    "none": lambda friction: None,  # noqa: ARG005
}
"""Frictions that are not of the shape of the problem, or no arrays."""


class WrongContact(Wrong):
    """Returns what is not a contact, or a wrong one."""

    name: ClassVar[str] = "wrong_contact"

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> Any:
        if self.fault == "raises":
            return 1 / 0
        contact = inner(problem)
        return contact.replaced(traction=2.0 * contact.traction)


@pytest.mark.parametrize(
    ("stage", "said"),
    [
        (Wrong(fault="nothing"), "stage 'wrong' returned NoneType from `altered`"),
        (
            Wrong(fault="shape"),
            r"stage 'wrong' returned \('line', \(1,\)\) from `altered`; it must return .* \('line', \(2,\)\)",
        ),
        (Wrong(fault="raises"), "stage 'wrong' failed: ZeroDivisionError"),
        (WrongContact(fault="raises"), "stage 'wrong_contact' failed: ZeroDivisionError"),
        (WrongContact(fault="traction"), "stage 'wrong_contact' gave a traction of .* where its own bound is"),
    ],
    ids=lambda value: value.fault + type(value).__name__ if isinstance(value, Wrong) else "",
)
def test_a_wrong_stage_is_named(stage: wl.Stage, said: str) -> None:
    predict = silently(RIG, EXACT, stage, KTH)
    with pytest.raises(ModelError, match=said):
        predict(**{**CONDITIONS, "creepage": Q([0.3, 1.0], "%")})


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("column", r"of shape \(2, 1\); it must be \(2,\)"),
        ("one number", r"of shape \(\); it must be \(2,\)"),
        ("seven", r"of shape \(7,\); it must be \(2,\)"),
        ("no array", "of type float; it must be an array"),
        ("none", "of type NoneType; it must be an array"),
    ],
)
@pytest.mark.parametrize("model", [EXACT, FASTSIM])
def test_a_stage_with_the_wrong_shape_of_friction_is_named(model: wl.ContactModel, fault: str, said: str) -> None:
    predict = silently(RIG, model, Wrong(fault=fault), KTH)
    with pytest.raises(ModelError, match=f"stage 'wrong' posed a problem with a friction coefficient {said}"):
        predict(**{**CONDITIONS, "creepage": Q([0.3, 1.0], "%")})
    if fault != "one number":
        with pytest.raises(ModelError, match="stage 'wrong' posed a problem with a friction coefficient of"):
            predict(**{**CONDITIONS, "creepage": Q(0.3, "%")})


def test_a_stage_that_changes_nothing_is_refused() -> None:
    with pytest.raises(TypeError, match="Idle changes nothing: it implements neither altered nor solve"):

        class Idle(wl.Stage):
            name: ClassVar[str] = "idle"


class SeesOnlyNumbers(Lubricated):
    """Fails where there is no patch."""

    name: ClassVar[str] = "sees_only_numbers"

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        assert np.isfinite(forces(problem).longitudinal).all()
        return super().altered(problem, forces)


def test_a_stage_sees_existing_patches_only() -> None:
    staged = predicted(silently(Axle(), FASTSIM, SeesOnlyNumbers(), KTH), **GIVEN)
    plain = predicted(silently(Axle(), FASTSIM, KTH), **{**GIVEN, "friction_coefficient": 0.15})
    rates = staged.wear_rate.magnitude
    assert np.array_equal(rates, plain.wear_rate.magnitude, equal_nan=True)
    assert (np.isnan(rates) == ~EXISTS).all()
