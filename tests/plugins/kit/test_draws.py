"""What the kit draws: the same everywhere, spread over partial slip, and of all kinds that laws may tell apart."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

import wearlaw as wl
from wearlaw import Contact, Material, Problem, TwinDisc, WheelRail
from wearlaw_kit import conditions, elliptic_problems, wheel_rails
from wearlaw_kit.law_contacts import aimed, at_nodes, borders, for_each_contact, means_of, on_line, on_strips
from wearlaw_kit.reduced import random_lines, translation, wide_ellipses

DIGEST = """
import hashlib, numpy as np, wearlaw as wl
from wearlaw_kit.law_contacts import for_each_contact
from wearlaw_kit.shapes import SHAPES
drawn = []
for shape in SHAPES:
    for problem in (shape.problems, shape.similar, shape.batch, shape.draw(8)):
        drawn += [problem.creepage, problem.spin, problem.a, problem.max_pressure, problem.friction_coefficient]
for_each_contact(wl.wear_law("kth"), lambda contact: drawn.extend([contact.traction, contact.slip, contact.area]))
digest = hashlib.sha256(b"".join(np.ascontiguousarray(one).tobytes() for one in drawn)).hexdigest()
"""


def digest(before: str = "") -> str:
    code = f"{before}\n{DIGEST}\nprint(digest)"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()


def test_draws_do_not_depend_on_the_modules_that_are_loaded_or_on_global_seeds() -> None:
    here: dict[str, Any] = {}
    exec(DIGEST, here)
    other = "import random, numpy, hypothesis, pandas, scipy.optimize; random.seed(3); numpy.random.seed(3)"
    assert digest() == digest(other) == here["digest"]


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
    fastest = translation(problem) + np.abs(problem.spin) * np.maximum(problem.a, problem.b)
    assert fastest.max() <= 1.0 + 1e-15
    ratio = problem.a / problem.b
    assert ratio.min() < 0.1 < 10.0 < ratio.max()
    assert {*np.sign(problem.spin)} == {-1.0, 0.0, 1.0}


def test_drawn_lines_are_of_hertz() -> None:
    problem = random_lines(48)
    # p0 = E* a/(2R) ties the parts of a problem together (Johnson, Contact Mechanics, section 4.2)
    expected = problem.effective_modulus * problem.half_width / (2.0 * problem.relative_radius)
    np.testing.assert_allclose(problem.max_pressure, expected, rtol=1e-14)


MIXED: dict[str, Callable[[Any], Contact]] = {
    "line": lambda of_law: on_line(of_law, 0, 24, 8),
    "strips": lambda of_law: on_strips(of_law, 0, 24, (4, 3)),
}


@pytest.mark.parametrize("law", [wl.wear_law("usfd"), wl.wear_law("kth")], ids=lambda law: law.name)
@pytest.mark.parametrize("kind", MIXED)
def test_a_tenth_of_the_contacts_straddle_each_border_and_a_third_stick_in_part(law: wl.WearLaw, kind: str) -> None:
    contact = MIXED[kind](borders(law))
    slips = (contact.slip != 0.0).reshape(24, -1)
    for name, value in borders(law):
        found = at_nodes(contact, name).reshape(24, -1)
        assert np.mean(((found < value) & slips).any(axis=-1) & ((found >= value) & slips).any(axis=-1)) >= 0.1
    wears = (contact.wear_index_density > 0.0).reshape(24, -1)
    assert np.mean((~slips).any(axis=-1) & wears.any(axis=-1)) >= 1.0 / 3.0


def cosines(contact: Contact) -> wl.Array:
    size = contact.traction * contact.slip
    return (contact.wear_index_density / np.where(size > 0.0, size, 1.0))[size > 0.0]


def test_contacts_on_strips_are_of_all_kinds() -> None:
    contact = MIXED["strips"](())
    cosine = cosines(contact)
    assert (cosine >= 0.049).all()
    assert np.mean(cosine < 0.9) > 1.0 / 3.0
    assert np.mean(cosine > 1.0 - 1e-12) > 0.2
    assert np.mean(np.diff(contact.y[:, 0, :], axis=-1).max(axis=-1) > 9e-3) > 0.2  # in two parts
    assert (contact.area == 0.0).any(axis=(-2, -1)).mean() >= 1.0 / 3.0
    assert (contact.patch_area > 0.0).all()


def test_the_energy_of_the_means_is_not_the_product_of_traction_and_slip() -> None:
    contact = means_of((), 0, 24)
    found = cosines(contact)
    assert np.ptp(np.log(found[found > 0.0])) > np.log(10.0)
    assert ((contact.traction == 0.0) & (contact.wear_index_density > 0.0)).any()


@pytest.mark.parametrize("contact", [MIXED["line"](()), MIXED["strips"](()), means_of((), 0, 24)])
@pytest.mark.parametrize(
    ("variable", "value"),
    [("pressure", 1e9), ("slip", 0.01), ("slip_speed", 0.3), ("traction", 1e8), ("wear_index_density", 4e6)],
)
def test_a_variable_is_set_at_all_nodes_where_that_is_possible(contact: Contact, variable: str, value: float) -> None:
    found = at_nodes(aimed(contact, variable, value), variable)
    reached = contact.wear_index_density > 0.0 if variable == "wear_index_density" else found == found
    np.testing.assert_allclose(found[reached], value, rtol=1e-14)
    index = aimed(contact, "wear_index", 100.0).wear_index
    assert (index[contact.wear_index > 0.0] == 100.0).all()


@pytest.mark.parametrize(
    ("law", "axes"), [("brr", {(1,), (1, 1)}), ("usfd", {(1,), (3,), (8,), (3, 1), (4, 3), (5, 4), (1, 1)})]
)
def test_a_law_gets_contacts_of_its_scale(law: str, axes: set[Any]) -> None:
    found = set()
    for_each_contact(wl.wear_law(law), lambda contact: found.add(contact.pressure.shape[1:]))
    assert found == axes


@settings(max_examples=10)
@given(contact=..., problem=..., rig=..., wheel_rail=..., material=...)
def test_typed_arguments_are_drawn_by_hypothesis(
    contact: Contact, problem: Problem, rig: TwinDisc, wheel_rail: WheelRail, material: Material
) -> None:
    assert contact.pressure.shape[0] == contact.rolling_speed.size
    assert problem.batch_shape == ()
    assert rig.disc_1.material is not None
    assert wheel_rail.bodies
    assert material.density.check("[mass] / [length] ** 3")


@settings(max_examples=10)
@given(drawn=conditions(), rig=wheel_rails(), problem=elliptic_problems())
def test_drawn_conditions_and_rigs_pose_problems(drawn: Any, rig: WheelRail, problem: Problem) -> None:
    assert TwinDisc.suros().problem(**drawn).max_pressure > 0
    posed = rig.problem(normal_force="1 N", longitudinal_creepage="1 %", friction_coefficient=0.3)
    assert 0.01 < float(posed.a / posed.b) < 100.0
    assert problem.geometry == "ellipse"


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


def test_a_missing_hypothesis_is_an_error_that_says_what_to_install() -> None:
    code = (
        "import sys; sys.modules['hypothesis'] = None\n"
        "from wearlaw_kit import checks\n"
        "try:\n    from wearlaw_kit import problems\n"
        "except ModuleNotFoundError as error:\n    print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert 'pip install "wearlaw[check]"' in done.stdout
