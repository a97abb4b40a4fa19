"""The KTH map, against Table 2 of Tassini et al. (2010)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.laws import around, contact_of
from tests.strategies import EPS
from wearlaw import Q

# Tassini et al. 2010, Table 2, k: p ≥ 2.1 GPa; slip speed below 0.2 m/s; to 0.7 m/s; above
TABLE_2 = {
    "low": (300e-4, 1e-4, 30e-4, 1e-4),
    "high": (400e-4, 10e-4, 40e-4, 10e-4),
}
TABLE_2["mid"] = tuple(0.5 * (low + high) for low, high in zip(TABLE_2["low"], TABLE_2["high"], strict=True))  # type: ignore[assignment]
OWN = {"high_pressure": 0.05, "low_speed": 2e-4, "mid_speed": 5e-3, "high_speed": 3e-4}
every_coefficient = pytest.mark.parametrize("coefficient", ["low", "mid", "high"])


def kth(coefficient: Any = "mid", **options: Any) -> wl.WearLaw:
    return wl.wear_law("kth", coefficient=coefficient, **options)


def field_of(pressure: float, speed: float) -> int:
    if pressure >= 2.1e9:
        return 0
    return 1 if speed < 0.2 else 2 if speed < 0.7 else 3


@pytest.mark.validates(
    "wear-laws",
    "KTH at a point: ρ k p s/H, in all fields of the map, at the ends and the middle of k",
    source="Tassini et al. 2010, Table 2 (first row corrected) and eq. 15; Jendel 2002",
    held_to="{roundings} ε, relative",
    roundings=16,
)
@every_coefficient
@given(pressure=st.floats(0.0, 4e9), slip=st.floats(0.0, 1.0))
def test_the_rate_is_archards_law_with_the_k_of_the_map(
    coefficient: str, pressure: float, slip: float, roundings: int
) -> None:
    rate = float(kth(coefficient).checked_rate(contact_of(pressure=pressure, slip=slip))[0])
    # ρ k p s / H with H = 2.1 GPa / 0.8
    expected = 7850.0 * TABLE_2[coefficient][field_of(pressure, slip)] * pressure * slip / (2.1e9 / 0.8)
    assert rate == pytest.approx(expected, rel=roundings * EPS, abs=1e-290)  # the least floats have fewer digits


def test_the_band_is_the_published_range_of_this_instance() -> None:
    law = kth("high", hardness="3 GPa")
    band = law.band()
    assert band is not None
    assert band == (kth("low", hardness="3 GPa"), kth("mid", hardness="3 GPa"), law)
    rates = [float(member.checked_rate(contact_of(slip=0.1))[0]) for member in band]
    assert rates == pytest.approx([7850.0 * k * 1e9 * 0.1 / 3e9 for k in (1e-4, 5.5e-4, 10e-4)], rel=16 * EPS)


def test_coefficients_of_your_own_have_no_band() -> None:
    law = kth(OWN)
    assert law.band() == (law, law, law)
    for pressure, slip, name in (
        (3e9, 0.1, "high_pressure"),
        (1e9, 0.1, "low_speed"),
        (1e9, 0.3, "mid_speed"),
        (1e9, 0.9, "high_speed"),
    ):
        got = float(law.checked_rate(contact_of(pressure=pressure, slip=slip))[0])
        assert got == pytest.approx(7850.0 * OWN[name] * pressure * slip / 2.625e9, rel=16 * EPS)


def test_borders_of_your_own_move_the_jumps() -> None:
    law = kth(pressure_threshold="1 GPa", lower_slip_speed="10 cm/s", upper_slip_speed=Q(0.5, "m/s"))
    jumps = law.jumps(law.numbers)
    assert jumps["pressure"] == pytest.approx((1e9,), rel=2 * EPS)
    assert jumps["slip_speed"] == pytest.approx((0.1, 0.5), rel=2 * EPS)
    below, at = law.checked_rate(contact_of(pressure=around(1e9), slip=0.05))
    assert at / below == pytest.approx(350.0 / 5.5, rel=1e-12)


@every_coefficient
def test_the_range_ends_where_the_fields_without_a_printed_end_begin(coefficient: str) -> None:
    law = kth(coefficient)
    assert law.calibration is not None
    assert law.explicit().calibration == law.calibration
    assert law.calibration.materials == "unspecified materials, in twin-disc and pin-on-disc tests"
    assert law.valid_range == {"pressure": (0.0, 2.1e9), "slip_speed": (0.0, 0.7)}
    assert law.monotone_in == ()


@pytest.mark.parametrize(
    "options",
    [
        {"coefficient": OWN},
        {"pressure_threshold": "1 GPa"},
        {"threshold_over_hardness": 0.7},
        {"hardness": "3 GPa"},
        {"hardness": "3 GPa", "pressure_threshold": "2.1 GPa"},
    ],
)
def test_numbers_of_your_own_have_no_range(options: dict[str, Any]) -> None:
    assert kth(**options).calibration is None
    assert kth(**options).valid_range == {}


def test_the_published_map_with_its_border_as_a_number_is_the_published_map() -> None:
    assert kth(pressure_threshold="2.1 GPa").calibration == kth().calibration


@given(hardness=st.floats(1.0, 8.0), share=st.floats(0.1, 2.0), slip=st.floats(1e-3, 1.0))
def test_the_border_in_pressure_follows_the_hardness(hardness: float, share: float, slip: float) -> None:
    for options, border in (
        ({}, 0.8 * hardness),
        ({"threshold_over_hardness": share}, share * hardness),
        ({"pressure_threshold": Q(share, "GPa")}, share),
    ):
        law = kth(hardness=Q(hardness, "GPa"), **options)
        # a border of a hundred roundings on each side, since units are converted
        pressures = 1e9 * border * np.array([1.0 - 100 * EPS, 1.0 + 100 * EPS])
        below, above = law.checked_rate(contact_of(pressure=pressures, slip=slip))
        k_below = TABLE_2["mid"][field_of(0.0, slip)]
        assert [below, above] == pytest.approx(
            7850.0 * slip * pressures * [k_below, TABLE_2["mid"][0]] / (1e9 * hardness), rel=16 * EPS
        )


@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # 3 GPa is beyond H
def test_slip_speeds_and_pressures_in_the_fields_without_an_end_are_warned_of() -> None:
    fast = wl.TwinDisc.suros(rolling_speed="200 m/s") | wl.contact_model("global") | kth()
    conditions: dict[str, Any] = {"max_pressure": "1500 MPa", "friction_coefficient": 0.46}
    fast(creepage="0.35 %", **conditions)  # 0.7 m/s, inside: a warning would be an error here
    no_end = (
        "Table 2, whose outermost fields, at 2.1 GPa and above and at 0.7 m/s and above, have a k but no printed end)"
    )
    with pytest.warns(wl.RangeWarning, match=r"slip speed from 0 m/s to 0\.7000 m/s .* as far as 40\.00 m/s") as said:
        fast(creepage="20 %", **conditions)
    assert no_end in str(said[-1].message)
    with pytest.warns(wl.RangeWarning, match=r"mean pressure from 0 MPa to 2100 MPa .* as far as 2356 MPa"):
        fast(creepage="0.1 %", **conditions | {"max_pressure": "3000 MPa"})  # π/4 of it is the mean


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"coefficient": "middle"}, r"kth: coefficient: must be 'low', 'mid', 'high' or your own .*got 'middle'"),
        ({"coefficient": 1e-3}, r"coefficient: must be 'low', 'mid', 'high' or your own .*got 0\.001"),
        ({"coefficient": {**OWN, "low_speed": -1e-4}}, r"coefficient\.low_speed: .*greater than 0.*-0\.0001"),
        ({"coefficient": {**OWN, "low_speed": "1e-4"}}, r"coefficient\.low_speed: "),
        ({"coefficient": {"low_speed": 1e-4}}, r"coefficient\.high_pressure: is missing"),
        ({"hardness": "0 GPa"}, r"hardness: must be greater than zero"),
        ({"hardness": 2.6}, r"hardness: .*2\.6"),
        ({"pressure_threshold": "2.1 kg"}, r"pressure_threshold: got 2\.100 kg.*'GPa'"),
        ({"threshold_over_hardness": "2.1 GPa"}, r"threshold_over_hardness: got 2\.100 GPa.*plain number"),
        ({"threshold_over_hardness": 0.7, "pressure_threshold": "2 GPa"}, r"pressure_threshold or .*, not both"),
        ({"lower_slip_speed": "inf m/s"}, r"lower_slip_speed: must be finite"),
        ({"upper_slip_speeds": "1 m/s"}, r"unknown field; did you mean 'upper_slip_speed'"),
    ],
)
def test_a_wrong_value_is_one_clear_error(options: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=message):
        wl.wear_law("kth", **options)


def test_borders_of_slip_speed_in_the_wrong_order_are_refused() -> None:
    with pytest.raises(wl.ConfigurationError, match=r"upper_slip_speed must not lie below lower_slip_speed"):
        wl.wear_law("kth", lower_slip_speed="0.8 m/s")


def test_severe_wear_may_have_no_width() -> None:
    law = kth(lower_slip_speed="0.5 m/s", upper_slip_speed="0.5 m/s")
    # the contact rolls at 1 m/s, and low and high speed share their k
    below, at = law.checked_rate(contact_of(slip=around(0.5)))
    assert at == pytest.approx(below, rel=8 * EPS)
