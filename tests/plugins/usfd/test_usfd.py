"""The USFD law, against Tables 3 and 4 of Tassini et al. (2010)."""

from __future__ import annotations

import re
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.laws import contact_of
from tests.strategies import EPS
from wearlaw import Q

# Tassini et al. 2010, Table 4: m_m, q_s, m_c, tr_sc in µg/m/N, µg/m/mm², µg/m/N, N/mm²
TABLE_4 = {
    "global": (5.3, 55.0, 61.9, 77.26),
    "exact": (5.3, 55.0, 83.7, 95.0),
    "fastsim": (5.3, 56.5, 83.7, 107.0),
}
every_set = pytest.mark.parametrize("fitted_for", TABLE_4)


def rate(law: wl.WearLaw, w: float) -> float:
    """Return the rate [µg/m/mm²] of w = Tγ/A [N/mm²]."""
    return float(law.checked_rate(contact_of(traction=w * 1e8, slip=0.01))[0]) * 1e3


@pytest.mark.validates(
    "wear-laws",
    "The three published sets of USFD",
    source="Tassini et al. 2010, Table 4",
    held_to="{roundings} ε (conversion of units)",
    roundings=4,
)
@every_set
def test_the_parameters_are_those_of_table_4(fitted_for: str, roundings: int) -> None:
    law: Any = wl.wear_law("usfd", fitted_for=fitted_for)
    units = ("ug/m/N", "ug/m/mm^2", "ug/m/N", "N/mm^2")
    got = [getattr(law, field).m_as(unit) for field, unit in zip(("m_m", "q_s", "m_c", "tr_sc"), units, strict=True)]
    assert got == pytest.approx(TABLE_4[fitted_for], rel=roundings * EPS)


@pytest.mark.validates(
    "wear-laws",
    "The rate of USFD in its three regimes",
    source="Tassini et al. 2010, Tables 3 and 4",
    held_to="{roundings} ε of the terms",
    roundings=8,
)
@every_set
@given(w=st.floats(0.0, 500.0))
def test_the_rate_is_that_of_tables_3_and_4(fitted_for: str, w: float, roundings: int) -> None:
    m_m, q_s, m_c, tr_sc = TABLE_4[fitted_for]
    expected = m_m * w if w < q_s / m_m else q_s if w < tr_sc else m_c * w - (m_c * tr_sc - q_s)
    # the last branch is a difference of numbers of size m_c·tr_sc
    assert rate(wl.wear_law("usfd", fitted_for=fitted_for), w) == pytest.approx(
        expected, rel=roundings * EPS, abs=roundings * EPS * m_c * (w + tr_sc)
    )


def test_the_severe_regime_may_have_no_width() -> None:
    law = wl.wear_law("usfd", m_m="1 ug/m/N", q_s="50 ug/m/mm^2", m_c="3 ug/m/N", tr_sc="50 N/mm^2")
    assert rate(law, 49.0) == pytest.approx(49.0, rel=8 * EPS)
    assert rate(law, 51.0) == pytest.approx(53.0, rel=1e-12)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"m_m": 5.3}, r"usfd: m_m: .*5\.3"),
        ({"m_m": "5.3 N"}, r"usfd: m_m: got 5\.300 N.*'ug/m/N'"),
        ({"q_s": "-1 ug/m/mm^2"}, r"q_s: must be greater than zero"),
        ({"m_c": "nan ug/m/N"}, r"m_c: "),
        ({"tr_sc": "5 N/mm^2"}, r"tr_sc must not lie below q_s/m_m.*10\.38 N/mm².*got 5\.000 N/mm²"),
        ({"fitted_for": "brr"}, r"fitted_for: .*'global', 'exact' or 'fastsim'"),
        ({"fitted_for": 3}, r"fitted_for: "),
        ({"mm": "5.3 ug/m/N"}, r"mm: unknown field; did you mean 'm_m'\?"),
    ],
)
def test_a_wrong_parameter_is_one_clear_error(options: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=message):
        wl.wear_law("usfd", **options)


def test_the_range_is_that_of_the_tests_up_to_twenty_percent_creepage() -> None:
    # The slip speed of 20 % is the highest if the rig keeps the mean of the surface speeds.
    predict = wl.TwinDisc.suros(speed_of="mean") | wl.contact_model("global") | wl.wear_law("usfd")
    conditions: dict[str, Any] = {"max_pressure": Q(1500, "MPa"), "friction_coefficient": 0.46}
    low, high = wl.wear_law("usfd").valid_range["wear_index_density"]
    assert low == 0.0
    # 20 % · 0.46 · the mean of 1500 MPa, to the four digits that a message shows
    assert high == pytest.approx(0.2 * 0.46 * 1.5e9 * np.pi / 4.0, rel=2e-4)
    predict(creepage=Q(20.0, "%"), **conditions)  # inside: a warning would be an error here
    with pytest.warns(wl.RangeWarning) as caught:
        predict(creepage=Q([20.0, 20.1], "%"), **conditions)
    of_law = [str(one.message) for one in caught if one.category is wl.RangeWarning]
    assert [re.search(r"known range of mean (.*) from", one).group(1) for one in of_law] == [  # type: ignore[union-attr]
        "slip speed", "wear index density",
    ]  # fmt: skip
    assert all("1 of 2 operating points" in one for one in of_law)


@pytest.mark.parametrize(
    ("pressure", "said"),
    [("300 MPa", "235.6 MPa"), ("899 MPa", "706.1 MPa"), ("900 MPa", ""), ("1800 MPa", ""), ("1801 MPa", "1415 MPa")],
)
def test_pressures_without_a_test_are_warned_of(pressure: str, said: str) -> None:
    # Table 1 of Lewis and Dwyer-Joyce (2004): tests at 900, 1200, 1500 and 1800 MPa, of which π/4 is the mean.
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        predict(max_pressure=pressure, creepage="1 %", friction_coefficient=0.46)
    of_law = [str(one.message) for one in caught if one.category is wl.RangeWarning]
    assert len(of_law) == bool(said)
    for message in of_law:
        assert message.startswith("wear law 'usfd' has a known range of mean pressure from 706.8 MPa to 1414 MPa (")
        assert "Lewis and R. S. Dwyer-Joyce" in message
        assert message.endswith(f"1 of 1 operating points lies outside, as far as {said}")


@pytest.mark.parametrize("fitted_for", ["global", "exact", "fastsim"])
def test_every_set_names_its_materials_its_range_and_its_sources(fitted_for: str) -> None:
    calibration = wl.wear_law("usfd", fitted_for=fitted_for).calibration
    assert calibration is not None
    assert calibration.materials == "R8T wheel steel on UIC 60 900A rail steel"
    assert [name for name, _, _ in calibration.stated_range] == ["pressure", "slip_speed", "wear_index_density"]
    assert calibration.range_in_si["slip_speed"][1] == pytest.approx(0.2 * 0.047 * np.pi * 400 / 60, abs=5e-4)
    assert "Table 4" in calibration.source
    assert "secondary transcription" in calibration.source
