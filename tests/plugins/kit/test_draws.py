"""What the kit and its strategies draw: spread over partial slip, and typed arguments of hypothesis."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings

import wearlaw as wl
from wearlaw import Contact, Problem
from wearlaw_kit import elliptic_problems
from wearlaw_kit.reduced import random_lines, wide_ellipses  # private: the batches that the checks try


@pytest.mark.parametrize(
    ("model", "problem"), [("exact", random_lines(48)), ("fastsim", random_lines(48)), ("fastsim", wide_ellipses(32))]
)
def test_problems_spread_over_stick_partial_and_full_slip(model: str, problem: Problem) -> None:
    contact = wl.contact_model(model).solve(problem)
    share = contact.tangential_force / (problem.friction_coefficient * problem.normal_force)
    assert np.mean((contact.stick_ratio > 0.0) & (share < 0.9999)) > 0.5
    for low, high in ((0.0, 0.03), (0.03, 0.2), (0.2, 0.7), (0.7, 1.0), (1.0 - 1e-9, 2.0)):
        assert np.mean((share >= low) & (share <= high)) > 0.05, (low, high)


def test_no_point_of_a_drawn_ellipse_slips_more_than_it_rolls() -> None:
    problem = wide_ellipses(1000)
    translation = np.hypot(problem.longitudinal_creepage, problem.lateral_creepage)
    assert (translation + np.abs(problem.spin) * np.maximum(problem.a, problem.b)).max() <= 1.0 + 1e-15
    ratio = problem.a / problem.b
    assert ratio.min() < 0.1 < 10.0 < ratio.max()
    assert {*np.sign(problem.spin)} == {-1.0, 0.0, 1.0}


@settings(max_examples=10)
@given(contact=..., problem=..., ellipse=elliptic_problems())
def test_typed_arguments_are_drawn_by_hypothesis(contact: Contact, problem: Problem, ellipse: Problem) -> None:
    assert contact.pressure.shape[0] == contact.rolling_speed.size
    assert problem.batch_shape == ()
    assert ellipse.geometry == "ellipse"


@pytest.mark.parametrize(("first", "second"), [("wearlaw", "hypothesis"), ("hypothesis", "wearlaw")])
def test_types_are_registered_in_either_order_and_hypothesis_does_not_import_wearlaw(first: str, second: str) -> None:
    code = (
        f"import {first}, hypothesis, sys; print('wearlaw' in sys.modules)\n"
        f"import {second}; from hypothesis import strategies as st; print(st.from_type(wearlaw.Contact))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    imported, strategy = done.stdout.splitlines()
    assert imported == str(first == "wearlaw")
    assert "on_line" in strategy
