"""Models that change what other models read, and errors at run time: which plugin they name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.distributions import Install
from tests.core.stages import CONDITIONS, EXACT, FASTSIM, KTH, ON_RAILS, RAILS, RIG, silently
from wearlaw import Q
from wearlaw.errors import ModelError
from wearlaw.numerics.integrate import integrate_laws  # private: integrals at the size of blocks

PLUGIN = """
    from typing import Annotated, Any

    import numpy as np
    from pydantic import Field

    import wearlaw as wl
    from wearlaw_models.contact_models.exact import Exact
    from wearlaw_models.contact_models.fastsim import Fastsim

    def writing(*arrays):
        for array in arrays:
            array *= 2.0

    class Law(wl.WearLaw):
        source = "the tests"
        factor: Annotated[wl.Quantity, wl.Unit("ug/m/N")] = Field(default="1 ug/m/N", validate_default=True)
        def rate(self, contact, p):
            return p["factor"] * contact.wear_index_density

    class LawOnPressure(Law):
        name = "law_on_pressure"
        def rate(self, contact, p):
            writing(contact.pressure)
            return super().rate(contact, p)

    class LawOnNumbers(Law):
        name = "law_on_numbers"
        def rate(self, contact, p):
            slope = p["factor"]
            slope *= 2.0
            return slope * contact.wear_index_density

    class ModelOnProblem(Fastsim):
        name = "model_on_problem"
        def solve_ellipse(self, problem):
            writing(problem.normal_force)
            return super().solve_ellipse(problem)

    class FieldsOnNodes(Exact):
        name = "fields_on_nodes"
        def fields(self, problem, nodes):
            writing(nodes.from_trailing)
            return super().fields(problem, nodes)

    class RigOnCondition(wl.WheelRail):
        name = "rig_on_condition"
        def problem(self, *, normal_force, **others):
            normal_force *= 2.0
            return super().problem(normal_force=normal_force, **others)

    class RigWithoutFriction(wl.TwinDisc):
        name = "rig_without_friction"
        def problem(self, **conditions):
            return super().problem(**conditions).replaced(friction_coefficient=np.float64(np.nan))

    class StageWithoutFriction(wl.Stage):
        name = "stage_without_friction"
        source = "the tests"
        def altered(self, problem, forces):
            return problem.replaced(friction_coefficient=problem.friction_coefficient - 1.0)

    class SolvingWithoutFriction(StageWithoutFriction):
        name = "solving_without_friction"
        def solve(self, problem, inner):
            return inner(self.altered(problem, None))

    class FloatBreakpoint(Law):
        name = "float_breakpoint"
        def breakpoints(self, p):
            return {"pressure": 2.1e9}

    class FloatRamp(Law):
        name = "float_ramp"
        def breakpoints(self, p):
            return {}
        def ramps(self, p):
            return (1e6,)

    class OwnVariable(Law):
        name = "own_variable"
        @property
        def own_variables(self):
            return {wl.Variable("heat", unit="W"): lambda contact: contact.heat}
        def breakpoints(self, p):
            return {"heat": (1.0,)}

    class NoSuchBody(Law):
        name = "no_such_body"
        def rate(self, contact, p):
            return contact.body("wheel_9").rolling_radius * contact.pressure

    @wl.hookimpl
    def wearlaw_models():
        laws = [LawOnPressure, LawOnNumbers, FloatBreakpoint, FloatRamp, OwnVariable, NoSuchBody]
        stages = [StageWithoutFriction, SolvingWithoutFriction]
        return [*laws, *stages, ModelOnProblem, FieldsOnNodes, RigOnCondition, RigWithoutFriction]
"""

LOADS = Q(np.array([60.0, 80.0]), "kN")
ON_LOADS = ON_RAILS | {"normal_force": LOADS}


def with_numbers(law: wl.Law) -> object:
    return integrate_laws(EXACT, (law,), RIG.problem(**CONDITIONS)[None], numbers=[{"factor": np.array([[1e-9]])}])


WRITING: dict[str, Any] = {
    "LawOnPressure": lambda: silently(RAILS, FASTSIM, wl.wear_law("law_on_pressure"))(**ON_RAILS),
    "LawOnNumbers": lambda: with_numbers(wl.wear_law("law_on_numbers")),
    "ModelOnProblem": lambda: silently(RAILS, wl.contact_model("model_on_problem"), KTH)(**ON_LOADS),
    "FieldsOnNodes": lambda: silently(RIG, wl.contact_model("fields_on_nodes"), KTH)(**CONDITIONS),
    "RigOnCondition": lambda: (wl.rig("rig_on_condition", **dict(RAILS)) | FASTSIM)(**ON_LOADS),
}
"""Pipelines of models that write into arrays which they were given, by the class at fault."""


@pytest.mark.parametrize("at_fault", WRITING)
def test_a_model_that_writes_into_an_array_it_was_given_is_named(install: Install, at_fault: str) -> None:
    install("lab", PLUGIN, version="1.2.3")
    with pytest.raises(ModelError, match=r"failed: ValueError: output array is read-only\n.*Make a new") as error:
        WRITING[at_fault]()
    assert str(error.value).endswith(f" is class {at_fault} of lab 1.2.3 (plugin 'lab')")
    assert LOADS.m_as("kN").tolist() == [60.0, 80.0]


def test_arrays_of_the_user_are_neither_changed_nor_frozen() -> None:
    given = np.array([0.3, 0.4])
    loads = Q(np.array([6e3, 7e3]), "N")
    RIG.checked_problem(CONDITIONS | {"friction_coefficient": given, "normal_force": loads})
    contact = EXACT.solve(RIG.problem(**CONDITIONS | {"friction_coefficient": given}))
    area = contact.area.copy()
    assert contact.replaced(area=area).area.base is area
    assert all(array.flags.writeable for array in (given, loads.magnitude, area))


WRONG: dict[str, tuple[Any, str]] = {
    "RigWithoutFriction": (
        lambda: silently(wl.rig("rig_without_friction", **dict(RIG)), EXACT, KTH)(**CONDITIONS),
        "rig 'rig_without_friction' posed a problem with a friction coefficient of nan",
    ),
    "StageWithoutFriction": (
        lambda: silently(RIG, EXACT, wl.stage("stage_without_friction"), KTH)(**CONDITIONS),
        "stage 'stage_without_friction' posed a problem with a friction coefficient of -0.54 in SI units; it must be",
    ),
    "SolvingWithoutFriction": (
        lambda: silently(RIG, EXACT, wl.stage("solving_without_friction"), KTH)(**CONDITIONS),
        "stage 'solving_without_friction' posed a problem with a friction coefficient of -0.54 in SI units; it must be",
    ),
    "FloatBreakpoint": (
        lambda: silently(RIG, EXACT, wl.wear_law("float_breakpoint")),
        "wear law 'float_breakpoint' gives {'pressure': 2100000000.0} as `breakpoints`; it must be like {",
    ),
    "FloatRamp": (
        lambda: silently(RIG, EXACT, wl.wear_law("float_ramp"))(**CONDITIONS),
        "wear law 'float_ramp' failed: TypeError: cannot unpack non-iterable float",
    ),
    "OwnVariable": (
        lambda: silently(RIG, EXACT, wl.wear_law("own_variable"))(**CONDITIONS),
        "wear law 'own_variable' failed: AttributeError: 'Contact' object has no attribute 'heat'",
    ),
}
"""Pipelines of wrong models by the class at fault, and what their errors say."""


@pytest.mark.parametrize("at_fault", WRONG)
def test_an_error_at_run_time_names_the_model_at_fault_and_its_distribution(install: Install, at_fault: str) -> None:
    install("lab", PLUGIN, version="1.2.3")
    work, said = WRONG[at_fault]
    with pytest.raises(ModelError) as error:
        work()
    assert str(error.value).startswith(said)
    assert str(error.value).endswith(f" is class {at_fault} of lab 1.2.3 (plugin 'lab')")


def test_an_input_error_in_a_law_has_a_note_with_the_law(install: Install) -> None:
    install("lab", PLUGIN, version="1.2.3")
    with pytest.raises(wl.InputError, match="body: this rig has no 'wheel_9'") as error:
        silently(RIG, EXACT, wl.wear_law("no_such_body"))(**CONDITIONS)
    assert error.value.__notes__ == ["raised in wear law 'no_such_body', class NoSuchBody of lab 1.2.3 (plugin 'lab')"]
