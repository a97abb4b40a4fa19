"""The strategies are found by type, in either order of imports, and importing hypothesis imports no wearlaw."""

from __future__ import annotations

import subprocess
import sys

import pytest
from hypothesis import given, settings

import wearlaw as wl
from wearlaw import Contact, LineProblem, Material, TwinDisc
from wearlaw.testing import conditions


def run(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_importing_hypothesis_does_not_import_wearlaw() -> None:
    assert run("import hypothesis, sys; print('wearlaw' in sys.modules, '_wearlaw_hypothesis' in sys.modules)") == (
        "False True"
    )


def test_importing_wearlaw_does_not_import_hypothesis_or_pytest() -> None:
    code = "import wearlaw, sys; print([name in sys.modules for name in ('hypothesis', 'pytest', 'wearlaw.testing')])"
    assert run(code) == "[False, False, False]"


@pytest.mark.parametrize("order", ["wearlaw, hypothesis", "hypothesis, wearlaw"])
def test_types_are_registered_in_either_order_of_imports(order: str) -> None:
    code = f"import {order}; from hypothesis import strategies as st; print(st.from_type(wearlaw.Contact))"
    assert "contacts" in run(code)


def test_a_missing_hypothesis_is_an_error_that_says_what_to_install() -> None:
    code = (
        "import sys; sys.modules['hypothesis'] = None\n"
        "try:\n    import wearlaw.testing\n"
        "except ModuleNotFoundError as error:\n    print(error)"
    )
    assert 'pip install "wearlaw[test]"' in run(code)


@settings(max_examples=10)
@given(contact=..., problem=..., rig=..., material=...)
def test_typed_arguments_are_drawn(contact: Contact, problem: LineProblem, rig: TwinDisc, material: Material) -> None:
    assert contact.pressure.shape[0] == contact.rolling_speed.size
    assert problem.batch_shape == ()
    assert rig.disc_1.material is not None
    assert material.density.check("[mass] / [length] ** 3")


@settings(max_examples=10)
@given(drawn=conditions(), problem=...)
def test_conditions_pose_a_problem(drawn: dict[str, object], problem: LineProblem) -> None:
    posed = wl.TwinDisc.suros().problem(**drawn)  # type: ignore[arg-type]
    assert posed.max_pressure > 0
    # p0 = E* a/(2R) ties the parts of a drawn problem together (Johnson, Contact Mechanics, eqs. 4.43 and 4.44)
    expected = problem.effective_modulus * problem.half_width / (2.0 * problem.relative_radius)
    assert float(problem.max_pressure) == pytest.approx(float(expected), rel=1e-14)
