"""Uncertain predictions, against distributions and variances in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.uncertainty.specification import UncertainPoint

RIG = wl.TwinDisc.suros()
FULL_SLIP: Any = {"max_pressure": Q(1500, "MPa"), "creepage": Q(3, "%"), "friction_coefficient": 0.4}


@wl.as_wear_law(
    inputs={"wear_index_density": "N/mm^2"},
    returns="ug/m/mm^2",
    breakpoints={},
    parameters={"first": "ug/m/N", "second": "ug/m/N"},
    varies=True,
    source="made up for the tests",
)
def linear(wear_index_density: Any, *, first: float = 4.0, second: float = 2.0) -> Any:
    """Wear in proportion to the sum of two slopes."""
    return (first + second) * wear_index_density


GLOBAL = RIG | wl.contact_model("global")
USFD = GLOBAL | wl.wear_law("usfd")


def plain(quantity: Any) -> Any:
    return quantity.to("ug/m/mm^2").magnitude


def kth_global(k: float) -> float:
    """Return ρ k p ξ / H at 1 % and 1500 MPa; physics of Archard's law, with π/4 of the pressure as its mean."""
    return 7850.0 * k * (np.pi / 4 * 1500e6) * 0.01 / 2.625e9 * 1e3


@pytest.mark.validates(
    "fitting",
    "A uniform parameter of a linear law: median and interval",
    source="the quantiles of a uniform distribution",
    held_to="{parts:g} of the samples' parts of the range",
    parts=2.0,
)
def test_a_uniform_parameter_of_a_linear_law_gives_a_uniform_rate(parts: float) -> None:
    u = (GLOBAL | linear).uncertainty(**FULL_SLIP, law={"first": wl.uniform("2 ug/m/N", "6 ug/m/N")}, samples=1024)
    at = [float(plain((GLOBAL | linear.model_copy(update={"first": Q(f, "ug/m/N")}))(**FULL_SLIP).wear_rate))
          for f in (2.0, 6.0)]  # fmt: skip
    low, high = (plain(end) for end in u.interval(0.9))
    # Each of 1024 equal parts of the range holds one sample, so that a quantile is within two parts of its place.
    part = (at[1] - at[0]) / 1024
    assert low == pytest.approx(at[0] + 0.05 * (at[1] - at[0]), abs=parts * part)
    assert high == pytest.approx(at[0] + 0.95 * (at[1] - at[0]), abs=parts * part)
    assert plain(u.median) == pytest.approx(0.5 * (at[0] + at[1]), abs=parts * part)


def test_each_sample_is_the_prediction_with_its_values() -> None:
    u = USFD.uncertainty(
        normal_force=wl.normal("7 kN", "0.2 kN"), creepage=Q(4, "%"), friction_coefficient=0.4, samples=8
    )
    force = u.inputs[0].values(np.array([0.25]))["normal_force"][0]
    assert force == pytest.approx(stats.norm(7000.0, 200.0).ppf(0.25), rel=8 * EPS)
    rates = np.sort(plain(u.wear_rate))
    probability = np.sort(stats.qmc.Sobol(1, rng=np.random.default_rng(0)).random_base2(3)[:, 0])
    each = USFD(
        normal_force=Q(stats.norm(7000.0, 200.0).ppf(probability), "N"), creepage=Q(4, "%"), friction_coefficient=0.4
    )
    assert rates == pytest.approx(np.sort(plain(each.wear_rate)), rel=64 * EPS)


def test_a_lognormal_value_has_its_median_and_its_factor() -> None:
    u = USFD.uncertainty(**{**FULL_SLIP, "friction_coefficient": wl.lognormal(0.3, 1.1)}, samples=8)
    values = u.inputs[0].values(np.array([0.5, 0.9]))["friction_coefficient"]
    assert values == pytest.approx(stats.lognorm(np.log(1.1), scale=0.3).ppf([0.5, 0.9]), rel=16 * EPS)


@pytest.mark.validates(
    "fitting",
    "Sobol indices of a sum of two normal parameters",
    source="variances add up",
    held_to="{errors:g} standard errors, these below {most:g}",
    errors=8.0,
    most=0.01,
)
def test_variances_of_a_linear_law_add_up(errors: float, most: float) -> None:
    u = (GLOBAL | linear).uncertainty(
        **FULL_SLIP,
        law={"first": wl.normal("4 ug/m/N", "0.3 ug/m/N"), "second": wl.normal("2 ug/m/N", "0.4 ug/m/N")},
        samples=2**12,
    )
    table = u.sobol()
    for order in ("first_order", "total_order"):
        # Variances of 0.3² and 0.4² in a sum. Eight sequences: with 7 degrees of freedom, 8 errors are passed by
        # chance once in 10⁴.
        due = np.array([0.09, 0.16]) / 0.25
        assert np.all(np.abs(table[order] - due) < errors * table[f"{order}_error"])
        assert np.all(table[f"{order}_error"] < most)
    assert list(table.index) == ["first", "second"]


@pytest.mark.validates(
    "fitting",
    "Sobol indices of a product of two uniform factors",
    source="variance of a product, in closed form",
    held_to="{errors:g} standard errors",
    errors=8.0,
)
def test_inputs_of_a_product_share_a_part_of_the_variance(errors: float) -> None:
    # In full slip, in the mild regime, the rate is m_m times something: of two uniform factors on 1 ± h the variance
    # is v1 + v2 + v1 v2 with v = h²/3.
    u = USFD.uncertainty(
        max_pressure=Q(1500, "MPa"),
        creepage=Q(2, "%"),
        friction_coefficient=wl.uniform(0.2, 0.4),
        law={"m_m": wl.uniform("2 ug/m/N", "4 ug/m/N")},
        samples=2**12,
    )
    table = u.sobol()
    v = np.full(2, (1 / 3) ** 2 / 3)
    whole = v.sum() + v.prod()
    assert np.all(np.abs(table["first_order"] - v / whole) < errors * table["first_order_error"])
    assert np.all(np.abs(table["total_order"] - (v + v.prod()) / whole) < errors * table["total_order_error"])


def test_the_published_range_of_kth_spans_its_band() -> None:
    predict = GLOBAL | wl.wear_law("kth")
    u = predict.uncertainty(
        max_pressure=Q(1500, "MPa"),
        creepage=Q(1, "%"),
        friction_coefficient=0.46,
        law={"coefficient": wl.published_range()},
        samples=1024,
    )
    ends = kth_global(1e-4), kth_global(10e-4)
    part = (ends[1] - ends[0]) / 1024
    low, high = (plain(end) for end in u.interval(0.5))
    assert low == pytest.approx(ends[0] + 0.25 * (ends[1] - ends[0]), abs=2 * part)
    assert high == pytest.approx(ends[0] + 0.75 * (ends[1] - ends[0]), abs=2 * part)


def test_known_conditions_keep_their_shape() -> None:
    u = USFD.uncertainty(
        max_pressure=Q([[1000.0], [1500.0]], "MPa"),
        creepage=Q([1.0, 2.0, 3.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=16,
    )
    assert u.wear_rate.shape == (2, 3, 16)
    assert u.median.shape == (2, 3)
    one = USFD.uncertainty(
        max_pressure=Q(1500, "MPa"), creepage=Q(2, "%"), friction_coefficient=wl.uniform(0.3, 0.5), samples=16
    )
    assert plain(u.wear_rate)[1, 1] == pytest.approx(plain(one.wear_rate), rel=64 * EPS)


@pytest.mark.validates(
    "reproducibility",
    "An uncertain prediction, made again with the same seed",
    source="the first one",
    held_to="to the bit",
)
def test_the_same_seed_gives_the_same_samples() -> None:
    def rates(seed: int) -> Any:
        uncertain = {**FULL_SLIP, "creepage": wl.uniform("1 %", "1.5 %")}
        return plain(USFD.uncertainty(**uncertain, samples=64, seed=seed).wear_rate)

    assert np.array_equal(rates(1), rates(1))
    assert not np.array_equal(rates(1), rates(2))


@pytest.mark.parametrize(("asked", "taken"), [(2, 2), (3, 4), (1000, 1024), (1024, 1024)])
def test_samples_are_rounded_up_to_a_power_of_two(asked: int, taken: int) -> None:
    u = USFD.uncertainty(**{**FULL_SLIP, "friction_coefficient": wl.uniform(0.3, 0.5)}, samples=asked)
    assert u.samples == u.wear_rate.size == taken
    assert f"{taken} samples" in repr(u)


def test_samples_outside_the_range_of_the_law_are_warned_of() -> None:
    u = USFD.uncertainty(
        max_pressure=Q(1500, "MPa"), creepage=wl.uniform("15 %", "25 %"), friction_coefficient=0.46, samples=64
    )
    with pytest.warns(wl.RangeWarning, match="usfd"):
        u.median  # noqa: B018


def test_the_figure_shows_median_and_interval() -> None:
    u = USFD.uncertainty(**{**FULL_SLIP, "friction_coefficient": wl.uniform(0.3, 0.5)}, samples=64)
    (panel,) = u.figure_data().panels
    distribution, marks = panel.curves
    assert np.all(np.diff(distribution.x) >= 0)
    assert marks.x == pytest.approx([plain(u.interval()[0]), plain(u.median), plain(u.interval()[1])])
    assert panel.x.label == "wear rate [µg/m/mm²]"
    assert u.plot().axes[0].get_xlabel() == panel.x.label


def test_the_figure_of_several_points_is_a_band_in_their_order() -> None:
    u = USFD.uncertainty(
        max_pressure=Q(1500, "MPa"),
        creepage=Q([1.5, 0.5, 1.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=64,
    )
    ((band,),) = (panel.curves for panel in u.figure_data().panels)
    assert band.x == pytest.approx([0.5, 1.0, 1.5])
    assert band.low is not None
    assert np.all(band.low < band.y)


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
        r"m_m: must be greater than zero, got -0\.[0-9]+ µg/m/N;(.|\n)*samples of its distribution",
    ),
    ({"law": {"m_m": wl.normal("5 ug/m/N", "3 ug/m/N")}}, "samples of its distribution; choose one without"),
    ({"creep": wl.normal("1 %", "0.1 %")}, "creep: unknown condition; did you mean 'creepage'"),
    ({"law": {"qs": wl.normal("55 ug/m/mm^2", "1 ug/m/mm^2")}}, "no number 'qs'; did you mean 'q_s'"),
    ({"law": {"q_s": 55.0}}, "q_s: must be a distribution"),
    ({"law": {"q_s": wl.normal("55 mm", "1 mm")}}, "q_s: "),
    ({"law": {"q_s": wl.published_range()}}, "q_s: the source of wear law 'usfd' publishes no ranges"),
    ({"law": {"m_m": wl.normal("5 ug/m/N", "1 ug/m/N")}, "samples": 0}, "samples: must be a whole number"),
    ({"law": {"m_m": wl.normal("5 ug/m/N", "1 ug/m/N")}, "samples": 1e3}, "samples: must be a whole number"),
]


@pytest.mark.parametrize(("given", "message"), WRONG)
def test_what_cannot_be_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.WearlawError, match=message):
        USFD.uncertainty(**{**FULL_SLIP, **given}).median  # noqa: B018


def test_a_range_that_is_not_published_is_named() -> None:
    predict = GLOBAL | wl.wear_law("kth")
    with pytest.raises(wl.InputError, match=r"hardness: .* no published range of it; there are: coefficient"):
        predict.uncertainty(**FULL_SLIP, law={"hardness": wl.published_range()})


@pytest.mark.parametrize("factor", [1.0, 0.5, np.inf, np.nan])
def test_a_factor_that_is_none_is_refused(factor: float) -> None:
    with pytest.raises(wl.InputError, match="geometric_standard_deviation"):
        wl.lognormal(0.3, factor)


@pytest.mark.parametrize("confidence", [0.0, 1.0, 95])
def test_a_confidence_that_is_none_is_refused(confidence: float) -> None:
    u = USFD.uncertainty(**{**FULL_SLIP, "friction_coefficient": wl.uniform(0.3, 0.5)}, samples=4)
    with pytest.raises(wl.InputError, match="confidence"):
        u.interval(confidence)


def test_sobol_needs_one_operating_point() -> None:
    u = USFD.uncertainty(
        max_pressure=Q(1500, "MPa"), creepage=Q([1.0, 2.0], "%"), friction_coefficient=wl.uniform(0.3, 0.5), samples=4
    )
    with pytest.raises(wl.InputError, match="one operating point"):
        u.sobol()


def test_sobol_needs_a_rate_that_varies() -> None:
    u = USFD.uncertainty(**{**FULL_SLIP, "friction_coefficient": wl.uniform(0.3, 0.5)}, samples=4)  # all severe
    with pytest.raises(wl.InputError, match="the same in all samples"):
        u.sobol()


def test_the_only_input_explains_all_of_the_variance() -> None:
    u = USFD.uncertainty(
        **{**FULL_SLIP, "creepage": Q(0.5, "%"), "friction_coefficient": wl.uniform(0.3, 0.4)}, samples=64
    )
    assert u.sobol().loc["friction_coefficient"].to_dict() == {
        "first_order": 1.0,
        "first_order_error": 0.0,
        "total_order": 1.0,
        "total_order_error": 0.0,
    }


def test_known_conditions_whose_shapes_do_not_fit_are_named_with_the_shapes_they_were_given_in() -> None:
    u = USFD.uncertainty(
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
        USFD.uncertainty(**{**FULL_SLIP, "creepage": "200 %"}, **uncertain).median  # noqa: B018
    assert "samples" not in str(refusal.value)


def test_a_figure_along_two_axes_is_refused_with_their_names() -> None:
    u = USFD.uncertainty(
        max_pressure=Q([[1000.0], [1500.0]], "MPa"),
        creepage=Q([1.0, 2.0, 3.0], "%"),
        friction_coefficient=wl.uniform(0.3, 0.5),
        samples=4,
    )
    with pytest.raises(wl.InputError, match=r"needs one condition with several values, .* are max_pressure, creepage"):
        u.plot()


def test_every_distribution_of_a_case_is_the_one_of_python() -> None:
    table: Any = {
        "normal_force": {"normal": ["5 kN", "0.2 kN"]},
        "creepage": {"uniform": ["1 %", "2 %"]},
        "friction_coefficient": {"lognormal": [0.4, 1.2]},
    }
    assert {name: str(given) for name, given in UncertainPoint(**table).conditions().items()} == {
        "normal_force": "normal(5.0 kN, 0.2 kN)",
        "creepage": "uniform(1.0 %, 2.0 %)",
        "friction_coefficient": "lognormal(0.4, 1.2)",
    }
