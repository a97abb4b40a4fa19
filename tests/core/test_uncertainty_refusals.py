"""Errors and warnings of uncertain predictions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.fits import GLOBAL
from tests.core.uncertain import FULL_SLIP, USFD
from wearlaw import Q
from wearlaw.uncertainties.inputs import check_samples


def test_samples_outside_the_range_of_the_law_are_warned_of() -> None:
    u = wl.uncertainty(
        USFD, max_pressure=Q(1500, "MPa"), creepage=wl.uniform("15 %", "25 %"), friction_coefficient=0.46, samples=64
    )
    with pytest.warns(wl.RangeWarning, match="usfd"):
        u.median  # noqa: B018


WRONG: list[tuple[dict[str, Any], str]] = [
    ({}, "nothing is uncertain"),
    ({"creepage": wl.uniform("2 %", "1 %")}, r"creepage: the upper end of uniform\(2.0 %, 1.0 %\)"),
    ({"creepage": wl.uniform("1 mm", "2 mm")}, "creepage: .*not a ratio"),
    ({"creepage": wl.normal("1 %", "-1 %")}, "creepage: the standard deviation"),
    ({"creepage": wl.normal("1 %", "0 %")}, r"creepage: the standard deviation of normal\(1.0 %, 0.0 %\) must be pos"),
    (
        {"friction_coefficient": wl.normal(0.3, 0.0)},
        r"friction_coefficient: the standard deviation of normal\(0.3, 0\)",
    ),
    ({"friction_coefficient": wl.normal(0.3, np.nan)}, "friction_coefficient: the standard deviation"),
    ({"friction_coefficient": wl.normal(0.0, 0.1)}, "friction_coefficient: must be a positive finite number, got 0"),
    ({"friction_coefficient": wl.uniform(0.3, 0.1)}, r"friction_coefficient: the upper end of uniform\(0.3, 0.1\)"),
    ({"friction_coefficient": wl.normal(0.3, Q(1, "mm"))}, "friction_coefficient: .*not a ratio"),
    ({"creepage": wl.lognormal("0 %", 1.2)}, r"creepage: the median of lognormal\(0.0 %, 1.2\) must be positive"),
    ({"law": {"m_m": wl.lognormal("-1 ug/m/N", 1.2)}}, r"m_m: the median of lognormal\(-1.0 µg/m/N, 1.2\) must be pos"),
    (
        {"creepage": wl.uniform("1 %", "200 %")},
        "creepage: must not exceed 1 in magnitude(.|\n)*samples of its distribution",
    ),
    ({"friction_coefficient": wl.normal(0.3, 0.2)}, "samples of its distribution; choose one without"),
    (
        {"law": {"m_m": wl.uniform("-1 ug/m/N", "3 ug/m/N")}},
        r"m_m: must be greater than zero, got -[0-9.]+ [µn]g/m/N;(.|\n)*samples of its distribution",
    ),
    ({"law": {"m_m": wl.normal("5 ug/m/N", "3 ug/m/N")}}, "samples of its distribution; choose one without"),
    (
        {"law": {"q_s": wl.uniform("50 ug/m/mm^2", "300 ug/m/mm^2"), "tr_sc": wl.uniform("20 N/mm^2", "90 N/mm^2")}},
        "tr_sc must not lie below q_s/m_m(.|\n)*samples of its distribution",
    ),
    ({"creep": wl.normal("1 %", "0.1 %")}, "creep: unknown condition; did you mean 'creepage'"),
    ({"law": {"qs": wl.normal("55 ug/m/mm^2", "1 ug/m/mm^2")}}, "no number 'qs'; did you mean 'q_s'"),
    ({"law": {"q_s": 55.0}}, "q_s: must be a distribution"),
    ({"law": {"q_s": wl.normal("55 mm", "1 mm")}}, "q_s: "),
    ({"law": {"q_s": wl.published_range()}}, "q_s: the source of wear law 'usfd' publishes no ranges"),
    ({"law": {"m_m": wl.normal("5 ug/m/N", "1 ug/m/N")}, "samples": 0}, "samples: must be a whole number"),
    ({"law": {"m_m": wl.normal("5 ug/m/N", "1 ug/m/N")}, "samples": 1e3}, "samples: must be a whole number"),
    ({"creepage": wl.uniform("1 %", "2 %"), "seed": -1}, "seed: must be a whole number, zero or positive; got -1"),
    ({"creepage": wl.uniform("1 %", "2 %"), "seed": "1"}, "seed: must be a whole number, zero or positive; got '1'"),
    (
        {"creepage": wl.uniform("1 %", "2 %"), "max_pressur": Q(1, "GPa")},
        "max_pressur: unknown condition; did you mean 'max_pressure'",
    ),
    ({"creepage": wl.uniform("1 %", "2 %"), "max_pressur": None}, "max_pressur: unknown condition"),
]


@pytest.mark.parametrize(("given", "message"), WRONG)
def test_what_cannot_be_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.WearlawError, match=message):
        wl.uncertainty(USFD, **{**FULL_SLIP, **given}).median  # noqa: B018


def test_samples_may_have_extremes_that_do_not_go_together() -> None:
    law = wl.wear_law("usfd")
    samples = {"q_s": np.array([50e-3, 300e-3]), "tr_sc": np.array([20e6, 90e6])}  # 300/5.3 is 57 N/mm²
    check_samples(law, samples)
    with pytest.raises(wl.InputError, match="tr_sc must not lie below"):
        check_samples(law, {**samples, "tr_sc": samples["tr_sc"][::-1]})


def test_a_range_that_is_not_published_is_named() -> None:
    predict = GLOBAL | wl.wear_law("kth")
    with pytest.raises(wl.InputError, match=r"hardness: .* no published range of it; there are: coefficient"):
        wl.uncertainty(predict, **FULL_SLIP, law={"hardness": wl.published_range()})


@pytest.mark.parametrize("factor", [1.0, 0.5, np.inf, np.nan, "1.2", [1.2, 1.3], Q(1.2, "mm"), None])
def test_a_factor_that_is_none_is_refused(factor: Any) -> None:
    with pytest.raises(wl.InputError, match="geometric_standard_deviation: must be a factor above 1, such as"):
        wl.lognormal(0.3, factor)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (Q([1, 2], "%"), r"must be one value, got an array of shape \(2,\)"),
        ([0.3, 0.4], r"must be one value, got an array of shape \(2,\)"),
        ("1", "'1' is not a number with a unit"),
        (None, "None is not a real number"),
        (True, "True is not a real number"),
    ],
)
def test_what_is_no_value_is_refused_where_a_distribution_is_made(value: Any, message: str) -> None:
    made: list[tuple[str, Callable[[], object]]] = [
        ("low", lambda: wl.uniform(value, "2 %")),
        ("high", lambda: wl.uniform("1 %", value)),
        ("mean", lambda: wl.normal(value, "2 %")),
        ("standard_deviation", lambda: wl.normal("1 %", value)),
        ("median", lambda: wl.lognormal(value, 1.2)),
    ]
    for name, make in made:
        with pytest.raises(wl.InputError, match=f"^{name}: {message}"):
            make()


@pytest.mark.parametrize("confidence", [0.0, 1.0, 95])
def test_a_confidence_that_is_none_is_refused(confidence: float) -> None:
    u = wl.uncertainty(USFD, **{**FULL_SLIP, "friction_coefficient": wl.uniform(0.3, 0.5)}, samples=4)
    with pytest.raises(wl.InputError, match="confidence"):
        u.interval(confidence)


def test_sobol_needs_one_operating_point() -> None:
    u = wl.uncertainty(
        USFD,
        max_pressure=Q(1500, "MPa"),
        creepage=Q([1.0, 2.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=4,
    )
    with pytest.raises(wl.InputError, match="one operating point"):
        u.sobol()


def test_sobol_needs_a_rate_that_varies() -> None:
    u = wl.uncertainty(USFD, **{**FULL_SLIP, "friction_coefficient": wl.uniform(0.3, 0.5)}, samples=4)  # all severe
    with pytest.raises(wl.InputError, match="the same in all samples"):
        u.sobol()


def test_known_conditions_whose_shapes_do_not_fit_are_named_with_the_shapes_they_were_given_in() -> None:
    u = wl.uncertainty(
        USFD,
        max_pressure=Q([1000.0, 1500.0], "MPa"),
        creepage=Q([1.0, 2.0, 3.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=4,
    )
    with pytest.raises(wl.ConditionsError, match=r"do not broadcast: max_pressure \(2,\), creepage \(3,\)$"):
        u.median  # noqa: B018


def test_a_wrong_known_condition_is_not_laid_to_the_samples() -> None:
    uncertain: Any = {"law": {"m_m": wl.uniform("4 ug/m/N", "6 ug/m/N")}}
    with pytest.raises(wl.UnitError, match=r"creepage: must not exceed 1 in magnitude, got 200\.0 %") as refusal:
        wl.uncertainty(USFD, **{**FULL_SLIP, "creepage": "200 %"}, **uncertain).median  # noqa: B018
    assert "samples" not in str(refusal.value)


def test_a_figure_along_two_axes_is_refused_with_their_names() -> None:
    u = wl.uncertainty(
        USFD,
        max_pressure=Q([[1000.0], [1500.0]], "MPa"),
        creepage=Q([1.0, 2.0, 3.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=4,
    )
    with pytest.raises(wl.InputError, match=r"needs one condition with several values, .* are max_pressure, creepage"):
        u.plot()
