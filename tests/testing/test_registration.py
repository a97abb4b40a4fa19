"""The strategies are found by type, in either order of imports, and importing hypothesis imports no wearlaw."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from typing import TypeVar

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wearlaw as wl
from wearlaw import Contact, Material, Problem, TwinDisc, WheelRail
from wearlaw.testing import conditions, elliptic_problems, line_problems, wheel_rails

T = TypeVar("T")


def run(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.mark.parametrize(("order", "imported_before"), [("wearlaw, hypothesis", True), ("hypothesis, wearlaw", False)])
def test_types_are_registered_in_either_order_of_imports_and_hypothesis_does_not_import_wearlaw(
    order: str, imported_before: bool
) -> None:
    first, second = order.split(", ")
    code = (
        f"import {first}, hypothesis, sys; print('wearlaw' in sys.modules, '_wearlaw_hypothesis' in sys.modules)\n"
        f"import {second}; from hypothesis import strategies as st; print(st.from_type(wearlaw.Contact))"
    )
    imported, strategy = run(code).splitlines()
    assert imported == f"{imported_before} True"
    assert "contacts" in strategy


def test_a_missing_hypothesis_is_an_error_that_says_what_to_install() -> None:
    code = (
        "import sys; sys.modules['hypothesis'] = None\n"
        "try:\n    import wearlaw.testing\n"
        "except ModuleNotFoundError as error:\n    print(error)"
    )
    assert 'pip install "wearlaw[check]"' in run(code)


@settings(max_examples=10)
@given(contact=..., problem=..., rig=..., wheel_rail=..., material=...)
def test_typed_arguments_are_drawn(
    contact: Contact,
    problem: Problem,
    rig: TwinDisc,
    wheel_rail: WheelRail,
    material: Material,
) -> None:
    assert contact.pressure.shape[0] == contact.rolling_speed.size
    assert problem.batch_shape == ()
    assert rig.disc_1.material is not None
    assert wheel_rail.bodies
    assert material.density.check("[mass] / [length] ** 3")


@settings(max_examples=10)
@given(drawn=conditions(), problem=line_problems())
def test_conditions_pose_a_problem(drawn: dict[str, object], problem: Problem) -> None:
    posed = wl.TwinDisc.suros().problem(**drawn)  # type: ignore[arg-type]
    assert posed.max_pressure > 0
    # p0 = E* a/(2R) ties the parts of a drawn problem together (Johnson, Contact Mechanics, section 4.2)
    expected = problem.effective_modulus * problem.half_width / (2.0 * problem.relative_radius)
    assert float(problem.max_pressure) == pytest.approx(float(expected), rel=1e-14)


def extent(strategy: st.SearchStrategy[T], *measures: Callable[[T], float]) -> list[tuple[float, float]]:
    """Return the least and the largest of each of the numbers that are measured on 200 drawn examples."""
    found: list[list[float]] = []

    @settings(max_examples=200, derandomize=True, database=None)
    @given(strategy)
    def draw(example: T) -> None:
        found.append([measure(example) for measure in measures])

    draw()
    return [(min(numbers), max(numbers)) for numbers in zip(*found, strict=True)]


def axis_ratio(problem: Problem) -> float:
    return float(problem.a / problem.b)


def test_drawn_ellipses_have_slender_patches_and_spin_of_both_signs() -> None:
    (low, high), signs = extent(elliptic_problems(), axis_ratio, lambda problem: float(np.sign(problem.spin)))
    assert low < 0.1
    assert high > 10.0
    assert signs == (-1.0, 1.0)


def test_no_point_of_a_drawn_ellipse_slips_more_than_it_rolls() -> None:
    def fastest(problem: Problem) -> float:
        creepage = np.hypot(problem.longitudinal_creepage, problem.lateral_creepage)
        return float(creepage + np.abs(problem.spin) * max(problem.a, problem.b))

    ((_, high),) = extent(elliptic_problems(crowded=(1e4,)), fastest)
    assert 0.9 < high <= 1.0 + 1e-15


def test_drawn_wheels_and_rails_touch_in_ellipses_of_all_shapes() -> None:
    def pressed(rig: WheelRail) -> float:
        problem = rig.problem(normal_force="1 N", longitudinal_creepage="1 %", friction_coefficient=0.3)
        return axis_ratio(problem)

    (low, high), (hollow, _) = extent(
        wheel_rails(), pressed, lambda rig: min(rig.wheel_profile_radius.m, rig.rail_head_radius.m)
    )
    assert low < 0.1
    assert high > 10.0
    assert hollow < 0.0
