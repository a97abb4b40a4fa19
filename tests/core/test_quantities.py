"""Quantities: how they are made, written, read back and pickled, and what is none."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.core.units import TO_SI
from wearlaw import Q
from wearlaw.units.quantities import from_si, text_of  # private: texts and floats at the rim

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (27.70413, "ug/m/mm^2", "27.70 µg/m/mm²"),
        (7850, "kg/m^3", "7850 kg/m³"),
        (0.314674, "mm", "0.3147 mm"),
        (1234567.0, "N", "1.235e+06 N"),
        (0.01, "", "0.01000"),
        ([1.0, 22.777777], "kN", "[1.000 22.78] kN"),
        (np.float32(2.0), "mm", "2.000 mm"),
        (np.array(2.0), "mm", "2.000 mm"),
    ],
)
def test_repr_shows_four_significant_digits(value: Any, unit: str, text: str) -> None:
    assert repr(Q(value, unit)) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (Q(27.70413, "ug/m/mm^2"), "27.70413 µg/m/mm²"),
        (Q(0.1 + 0.2, "%"), "0.30000000000000004 %"),
        (Q(0.01, ""), "0.01 dimensionless"),
        ("mid", "mid"),
        (0.5, "0.5"),
    ],
)
def test_what_is_shown_to_a_reader_has_all_digits(value: Any, text: str) -> None:
    assert text_of(value) == text


def test_magnitude_keeps_all_digits() -> None:
    assert Q(27.704131234567, "ug").magnitude == 27.704131234567


@pytest.mark.parametrize("value", ["3", True, 1j, None, [[1], [2, 3]], ["a"], np.array([True]), [object()]])
def test_q_refuses_what_is_no_real_number(value: Any) -> None:
    with pytest.raises(wl.UnitError, match=r"is not a real number|is not an array of numbers"):
        Q(value, "mm")


@pytest.mark.parametrize("value", [Q(1, "m"), [Q(1, "m"), Q(2, "m")]])
def test_q_refuses_a_quantity_in_place_of_a_number(value: Any) -> None:
    with pytest.raises(wl.UnitError, match=r"has a unit of its own"):
        Q(value, "mm")


def test_q_refuses_masked_entries() -> None:
    with pytest.raises(wl.UnitError, match="masked"):
        Q(np.ma.masked_array([1.0, 2.0], mask=[False, True]), "mm")


@pytest.mark.parametrize("unit", ["foo", "2 mm", "m**", "mm; import os", "__import__('os')"])
def test_q_refuses_an_unknown_unit_by_its_text(unit: str) -> None:
    with pytest.raises(wl.UnitError) as caught:
        Q(1, unit)
    assert repr(unit) in str(caught.value)


@given(value=finite, unit=st.sampled_from(sorted(TO_SI)))
def test_text_reads_back_to_the_same_quantity(value: float, unit: str) -> None:
    read = wl.parse(text_of(Q(value, unit)))
    assert read.magnitude == value
    assert read.units == Q(value, unit).units


@given(value=finite, unit=st.sampled_from(sorted(set(TO_SI) - {""})), gap=st.sampled_from(["", " ", "   "]))
def test_parse_reads_number_and_unit(value: float, unit: str, gap: str) -> None:
    read = wl.parse(f"{gap}{value!r}{gap}{unit}{gap}")
    assert read.magnitude == value
    assert read.units == Q(1, unit).units


@pytest.mark.parametrize("text", ["0.3 1/m", "0.3 1 / m", "0.3 m^-1"])
def test_a_unit_may_begin_with_one_over(text: str) -> None:
    read = wl.parse(text)
    assert (read.magnitude, read.units) == (0.3, Q(1, "1/m").units)
    assert wl.parse(text_of(read)) == read


@pytest.mark.parametrize(
    "text", ["", "abc", "47", "0.01", "1e3", "3 2 mm", "mm", "--3 mm", "1,5 mm", "5 e3 mm", "31/m", "3 2/m", "3 1m"]
)
def test_parse_refuses_text_that_is_no_quantity(text: str) -> None:
    with pytest.raises(wl.UnitError):
        wl.parse(text)


def test_a_list_of_quantities_takes_the_unit_of_the_first() -> None:
    read = wl.parse(["1 kN", Q(2000.0, "N")])
    assert read.units == Q(1, "kN").units
    assert list(read.magnitude) == [1.0, 2.0]
    with pytest.raises(wl.UnitError, match="from 'millimeter'"):
        wl.parse(["1 kN", "2 mm"])


@pytest.mark.parametrize("quantity", [Q(27.70413, "ug/m/mm^2"), Q([[1.0, 2.5]], "kN"), Q(1, "%")])
def test_quantities_survive_pickling(quantity: wl.Quantity) -> None:
    loaded = pickle.loads(pickle.dumps(quantity))
    np.testing.assert_array_equal(loaded.magnitude, quantity.magnitude)
    assert loaded.units == quantity.units
    assert repr(loaded) == repr(quantity)


@pytest.mark.parametrize("value", [3.5, np.float64(3.5), np.array(3.5), np.array([1.0, 2.0])])
def test_a_result_is_a_quantity_like_any_other(value: Any) -> None:
    made, usual = from_si(value, "ug/m/mm^2"), Q(value * 1e3, "ug/m/mm^2")
    assert type(made) is type(usual)
    assert vars(made).keys() >= vars(usual).keys() - {"_dimensionality"}
    same: Any = made == usual
    assert np.all(same)
    assert made.units == usual.units
    assert repr(made) == repr(usual)
    assert np.all((2 * made).to("kg/m/m^2").m == 2.0 * np.asarray(value))
    assert np.all(pickle.loads(pickle.dumps(made)) == made)
    assert made.check("[mass]/[length]**3")


@pytest.mark.parametrize("unit", ["N/mm^2", "ug/m/mm**2", "m**0.3333", "(m/s)**2", "1/s", "µg·m⁻¹", "m^-1*s^-2", "mm²"])
def test_powers_of_units_are_taken(unit: str) -> None:
    assert Q(1.0, unit).magnitude == 1.0


def test_a_unit_for_values_from_zero_to_a_limit_names_the_value_that_is_out_of_range() -> None:
    unit = wl.Unit("m", positive=False, negative=False, limit=2.0)
    assert unit.si(Q([0.0, 2.0], "m"), "depth").tolist() == [0.0, 2.0]
    with pytest.raises(wl.UnitError, match=r"depth: must not be negative, got -0\.5"):
        unit.si(Q([0.0, -0.5], "m"), "depth")
    with pytest.raises(wl.UnitError, match=r"depth: must not exceed 2 m in magnitude, got 3"):
        unit.si(Q([0.0, 0.5, 3.0], "m"), "depth")


@pytest.mark.parametrize(
    "unit",
    [
        "m**9**9**9",
        "m^9^9^9",
        "m^9 ^9\t^9",
        "m*9**9**9",
        "9**9**9*m",
        "m**(9**9**9)",
        "m**99**9",
        "m**999999999",
        "m^1e9",
        "m⁹⁹⁹⁹⁹⁹⁹⁹⁹",
        "m**(999999999/2)",
        "((m**99)**99)**99",
        "(9**(99))**99*m",
        "9**9999*m",
        "m**--9**9",
        "m*" + "9" * 5000,
        "square m**9**9**9",
        "m**.5.5",
        "m**x",
    ],
)
def test_a_power_that_no_unit_has_is_refused_and_not_computed(unit: str) -> None:
    for read in (
        lambda: wl.Q(1.0, unit),
        lambda: wl.Unit("m").si(f"1 {unit}", "x"),
        lambda: wl.Unit(unit).si("1 m", "x"),
        lambda: wl.Unit("m").si([f"1 {unit}"], "x"),
    ):
        with pytest.raises(
            wl.UnitError, match=r"powers are numbers, as in mm\^2 or MPa\^0\.5|is not a number with a u"
        ):
            read()


@pytest.mark.parametrize("unit", ["km^400", "nm**40", "kg**-200", "Ym^12*Yg^12", "dB^9"])
def test_a_unit_beyond_all_floats_is_refused(unit: str) -> None:
    with pytest.raises(wl.UnitError, match=r"is not a (known )?unit"):
        wl.Q(1.0, unit)


@pytest.mark.parametrize(
    ("unit", "in_si"),
    [
        ("mm**2", 1e-6),
        ("mm^-2", 1e6),
        ("mm²", 1e-6),
        ("MPa^(1/2)", 1e3),
        ("MPa ** 0.5", 1e3),
        ("kPa**( -1 / 2 )", 1e3**-0.5),
        ("square mm", 1e-6),
        ("mm cubed", 1e-9),
        ("m^3*s^2/mm^3/ms^2", 1e15),
    ],
)
def test_ordinary_powers_are_computed(unit: str, in_si: float) -> None:
    assert wl.Unit(unit).si(f"1 {unit}", "x") == pytest.approx(in_si, rel=1e-12)
