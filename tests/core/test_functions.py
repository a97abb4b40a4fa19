"""Wear laws made of one function."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import wearlaw as wl
from tests.line import fields_at
from wearlaw import Q

Array = NDArray[np.float64]
RIG = wl.TwinDisc.suros()
POINT: Any = {"max_pressure": "1500 MPa", "creepage": "1 %", "friction_coefficient": 0.46}


@wl.as_wear_law(
    inputs={"wear_index_density": "N/mm^2"},
    returns="ug/m/mm^2",
    breakpoints={"wear_index_density": [4.0]},
    jumps=[4.0],
    parameters={"mild": "ug/m/N", "severe": "ug/m/N", "limit": "N/mm^2"},
    monotone_in=["wear_index_density"],
    source="made up for these tests",
)
def two_slopes(wear_index_density: Array, *, mild: float = 5.0, severe: float = 15.0, limit: float = 4.0) -> Array:
    """Two slopes with a jump."""
    return np.where(wear_index_density < limit, mild, severe) * wear_index_density


@wl.as_wear_law(
    inputs={"wear_index_density": "N/mm^2"},
    returns="ug/m/mm^2",
    breakpoints={"wear_index_density": [10.377358490566039, 77.26]},
    source="Tassini et al., Wear 268 (2010) 660-667, Table 3",
)
def usfd_again(w: Array) -> Array:
    return np.minimum(5.3 * w, 55.0) + 61.9 * np.maximum(w - 77.26, 0.0)


@wl.as_wear_law(
    inputs={"pressure": "GPa", "slip_speed": "mm/s", "wear_index": "kN"},
    returns="kg/m/m^2",
    source="made up for these tests",
)
def of_all_inputs(pressure: Array, slip_speed: Array, wear_index: Array) -> Array:
    return pressure + slip_speed + wear_index


def decorate(function: Any = lambda w: w, **changes: Any) -> Any:
    declared: Any = {"inputs": {"wear_index_density": "N/mm^2"}, "returns": "ug/m/mm^2", "source": "none", **changes}
    return wl.as_wear_law(**declared)(function)


def test_a_function_law_predicts_what_the_same_law_as_a_class_predicts() -> None:
    creepage = Q(np.geomspace(1e-4, 0.2, 40), "")
    solve = RIG | wl.contact_model("global")
    conditions: Any = {**POINT, "creepage": creepage}
    expected = (solve | wl.wear_law("usfd"))(**conditions).wear_rate.magnitude
    found = (solve | usfd_again)(**conditions).wear_rate.magnitude
    # Conversions to N/mm² and back cost a few roundings each.
    np.testing.assert_allclose(found, expected, rtol=20 * np.finfo(float).eps)


def test_inputs_come_in_the_units_declared_and_the_result_is_taken_in_its_unit() -> None:
    contact = (RIG | wl.contact_model("global"))(**POINT).contact
    expected = contact.pressure / 1e9 + contact.slip_speed * 1e3 + contact.wear_index[..., None] / 1e3
    np.testing.assert_allclose(of_all_inputs.checked_rate(contact), expected, rtol=8 * np.finfo(float).eps)


def test_breakpoints_and_jumps_are_declared_in_si() -> None:
    assert two_slopes.breakpoints(two_slopes.numbers) == {"wear_index_density": (4e6,)}
    assert two_slopes.jumps(two_slopes.numbers) == {"wear_index_density": (4e6,)}
    assert of_all_inputs.breakpoints(of_all_inputs.numbers) is None
    assert of_all_inputs.jumps(of_all_inputs.numbers) == {}


def test_parameters_are_fields_with_units_and_defaults() -> None:
    steeper = two_slopes.model_copy(update={"mild": Q(10, "ug/m/N")})
    rate = (RIG | wl.contact_model("global") | two_slopes)(**{**POINT, "creepage": "0.5 %"}).wear_rate
    twice = (RIG | wl.contact_model("global") | steeper)(**{**POINT, "creepage": "0.5 %"}).wear_rate
    assert twice.magnitude == pytest.approx(2 * rate.magnitude, rel=8 * np.finfo(float).eps)
    with pytest.raises(wl.ConfigurationError, match="two_slopes: mild: got the bare number 10"):
        two_slopes.model_copy(update={"mild": 10})


def test_the_jump_is_integrated_to_rounding() -> None:
    prediction = (RIG | wl.contact_model("exact") | two_slopes)(**POINT)
    contact = wl.contact_model("exact")
    # An independent midpoint sum over 2e6 cells. Each of the two crossings costs it at most one cell of the jump,
    # (15 - 5) µg/m/N at 4 N/mm²; the square roots at the ends of the zone cost cells^-1.5 = 4e-10.
    problem = RIG.problem(**POINT)
    cells = 2_000_000
    x = problem.half_width * ((2 * np.arange(cells) + 1.0) / cells - 1)
    fields = fields_at(contact, problem, x)
    w = fields.traction * fields.slip / 1e6
    mean = np.where(w < 4.0, 5.0, 15.0) * w
    assert prediction.wear_rate.magnitude == pytest.approx(mean.mean(), abs=2 * 10 * 4 / cells + 4e-10 * mean.mean())


def test_a_function_law_compares_hashes_and_pickles() -> None:
    again = pickle.loads(pickle.dumps(two_slopes))
    assert again == two_slopes
    assert hash(again) == hash(two_slopes)
    changed = two_slopes.model_copy(update={"limit": Q(3, "N/mm^2")})
    assert pickle.loads(pickle.dumps(changed)) == changed != two_slopes
    assert type(two_slopes).model_validate_json(changed.model_dump_json()) == changed


def test_the_docstring_and_the_source_are_kept() -> None:
    assert type(two_slopes).__doc__ == "Two slopes with a jump."
    assert two_slopes.source == "made up for these tests"
    assert type(usfd_again).__doc__ == "The function usfd_again as a wear law."


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"inputs": {"wear_index_densty": "N/mm^2"}}, "unknown variable; did you mean 'wear_index_density'?"),
        ({"inputs": {"wear_index_density": "mm"}}, "inputs.wear_index_density: .* not have the dimension"),
        ({"inputs": {"wear_index_density": "foo"}}, "'foo' is not a known unit"),
        ({"returns": "kg"}, "returns: .* not have the dimension of 'ug/m/mm"),
        ({"inputs": {}}, "0 are declared; the function takes 1"),
        ({"function": lambda w, *, k=1.0: k * w}, "parameters: declare a unit for each of k"),
        ({"parameters": {"k": "mm"}}, "parameters: declare a unit for each of none"),
        ({"function": lambda w, *, k: k * w, "parameters": {"k": ""}}, "parameters.k: needs a default value"),
        ({"breakpoints": {"pressure": [1.0]}}, "breakpoints.pressure: is not one of the inputs: wear_index_density"),
        ({"jumps": [1.0]}, "jumps: name their variable"),
        (
            {"breakpoints": {"wear_index_density": [1.0, 2.0]}, "jumps": [2.0, 3.0]},
            "jumps.wear_index_density: 3.0 is not one of the breakpoints: 1.0, 2.0",
        ),
        ({"jumps": {"wear_index_density": [1.0]}}, "1.0 is not one of the breakpoints: none"),
        ({"monotone_in": ["slip"]}, "monotone_in.slip: is not one of the inputs: wear_index_density"),
        (
            {"function": lambda w, *, k=1.0: k * w, "parameters": {"k": "foo"}},
            "parameters.k: 'foo' is not a known unit",
        ),
        ({"function": lambda w, *, k="1": k * w, "parameters": {"k": "mm"}}, "parameters.k: '1' is not a real number"),
    ],
)
def test_a_declaration_that_does_not_fit_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=message):
        decorate(**changes)


@pytest.mark.parametrize(
    "name",
    ["rate", "units", "inputs", "returns", "declared", "function", "calibration", "name", "source", "copy", "_k"],
)
def test_a_parameter_that_would_hide_what_every_law_has_is_refused(name: str) -> None:
    function = eval(f"lambda w, *, {name}=1.0: {name} * w")
    with pytest.raises(wl.ConfigurationError, match=f"parameters.{name}: is a name that wear laws use themselves"):
        decorate(function, parameters={name: ""})


def test_a_law_shows_its_parameters_as_other_results_are_shown() -> None:
    assert repr(two_slopes) == "two_slopes(mild=5.0 µg/m/N, severe=15.0 µg/m/N, limit=4.0 N/mm²)"


def test_jumps_of_several_variables_are_declared_by_their_names() -> None:
    law = decorate(
        lambda p, s: p * s,
        inputs={"pressure": "GPa", "slip": "%"},
        breakpoints={"pressure": [1.0, 2.0], "slip": [0.5, 1.0]},
        jumps={"pressure": [2.0], "slip": [0.5]},
    )
    assert law.jumps(law.numbers) == {"pressure": pytest.approx((2e9,)), "slip": pytest.approx((5e-3,))}


def test_a_function_that_returns_what_is_no_rate_is_refused_where_it_is_used() -> None:
    with pytest.raises(wl.ModelError, match="not finite"):
        (RIG | wl.contact_model("global") | decorate(lambda w: w * np.nan))(**POINT)
