"""Lack of fit: its tests against other statistics, and what `fit` says of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.core.fits import FRICTION, GLOBAL, PRESSURE, made_up, sloping, usfd
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.fitting.lack_of_fit import SAME, f_test, repeats

CREEPAGE = [0.2, 0.4, 0.6, 0.8]
"""All within the mild regime of USFD, where wear is m_m times the wear-index density."""


def repeated(effect: Any = (0.0, 0.0, 0.0, 0.0), each: int = 3, scatter: float = 0.05) -> wl.WearTests:
    """Return repeated tests in the mild regime, off a law by the logarithms `effect` at each creepage."""
    creepage = np.repeat(CREEPAGE, each)
    conditions: Any = {"creepage": Q(creepage, "%"), "max_pressure": PRESSURE, "friction_coefficient": FRICTION}
    scattered = scatter * np.random.default_rng(5).standard_normal(creepage.size)
    factor = np.exp(np.repeat(effect, each) + scattered)
    return wl.WearTests.from_arrays(**conditions, wear_rate=usfd("exact")(**conditions).wear_rate * factor)


def of_mild(tests: wl.WearTests, **options: Any) -> wl.Fit:
    return wl.fit(usfd("exact"), tests, ["m_m"], bootstrap=0, **options)


@pytest.mark.validates(
    "fitting",
    "F of the lack of fit of a line to repeated tests",
    source="the F test of nested linear models: a line in one mean for each point",
    held_to="rounding",
)
def test_f_is_that_of_nested_linear_models() -> None:
    generator = np.random.default_rng(1)
    points = np.array([0, 0, 1, 2, 2, 2, 3, 4, 4])
    x = np.array([1.0, 2.0, 3.5, 5.0, 8.0])[points]
    y = 2.0 + 0.3 * x**2 + generator.standard_normal(x.size)

    def rest(design: Any) -> Any:
        return y - design @ np.linalg.lstsq(design, y)[0]

    line, means = rest(np.stack([np.ones_like(x), x], axis=-1)), rest(np.eye(5)[points])
    expected = ((line @ line - means @ means) / (5 - 2)) / (means @ means / (9 - 5))
    f, degrees, p, scatter = f_test(line, points, 2.0)
    # The sums hold nine terms, each rounded, and their difference is more than a tenth of them.
    assert f == pytest.approx(expected, rel=1e3 * EPS)
    assert degrees == (3.0, 4.0)
    assert p == pytest.approx(stats.f.sf(expected, 3, 4), rel=1e4 * EPS)
    assert scatter == pytest.approx(np.sqrt(means @ means / 4), rel=1e3 * EPS)


@pytest.mark.parametrize(
    ("points", "spent", "degrees"),
    [([0, 0, 1, 1, 2], 2.0, (1.0, 2.0)), ([0, 0, 1, 2], 1.0, (2.0, 1.0)), ([0, 0, 1, 1], 2.0 - 1e-9, None)],
)
def test_one_degree_of_freedom_is_enough_and_none_is_no_test(points: Any, spent: float, degrees: Any) -> None:
    residuals = np.array([0.1, -0.2, 0.3, 0.2, -0.1])[: len(points)]
    f, found, p, scatter = f_test(residuals, np.array(points), spent)
    if degrees is None:
        assert p is scatter is None
    else:
        assert found == degrees
        assert p == pytest.approx(stats.f.sf(f, *degrees), rel=1e4 * EPS)


@pytest.mark.parametrize(("scatter", "tested"), [(0.9 * SAME, False), (1.1 * SAME, True)])
def test_repeats_are_copies_by_their_standard_deviation(scatter: float, tested: bool) -> None:
    """Two tests off their mean by ±d have a standard deviation of √2 d."""
    off = scatter / np.sqrt(2.0)
    mean = np.arange(8.0)
    residuals = np.concatenate([np.repeat(mean[:4], 2) + off * np.tile([1.0, -1.0], 4), mean[4:]])
    points = np.concatenate([np.repeat([0, 1, 2, 3], 2), [4, 5, 6, 7]])
    found = f_test(residuals, points, 1.0)[3]
    assert found == (pytest.approx(scatter, rel=1e-9) if tested else None)


def test_tests_repeat_each_other_if_every_condition_agrees_to_its_thousandth() -> None:
    force = [7000.0, 7006.9, 7007.1, 7000.0, 7000.0, 7006.9]  # [N]
    creepage, lateral = [0.01, 0.01, 0.01, 0.01002, 0.01, 0.00999], [0.0, 0.0, 0.0, 0.0, 1e-9, 0.0]
    conditions = {"normal_force": Q(force, "N"), "creepage": np.array(creepage), "lateral_creepage": np.array(lateral)}
    assert repeats({**conditions, "friction_coefficient": 0.46}, 6).tolist() == [0, 0, 1, 2, 3, 0]


def test_p_is_uniform_if_the_model_is_right() -> None:
    generator = np.random.default_rng(2)
    points = np.repeat(np.arange(6), 3)
    design = np.stack([np.ones(18), points.astype(float)], axis=-1)
    hat = design @ np.linalg.pinv(design)
    residuals = generator.standard_normal((2000, 18)) @ (np.eye(18) - hat)
    found = [f_test(row, points, 2.0)[2] for row in residuals]
    assert stats.kstest(found, "uniform").pvalue > 0.001


@pytest.mark.parametrize("effect", [(0.0, 0.0, 0.0, 0.0), (0.3, -0.3, 0.2, -0.2)])
def test_with_one_factor_free_it_is_the_one_way_analysis_of_variance(effect: Any) -> None:
    tests = repeated(effect)
    logs = np.log(tests.wear_rate.magnitude / usfd("exact")(
        creepage=tests.creepage, max_pressure=PRESSURE, friction_coefficient=FRICTION
    ).wear_rate.magnitude).reshape(4, 3)  # fmt: skip
    expected = stats.f_oneway(*logs)
    poor = bool(expected.pvalue < 0.05)
    assert poor == any(effect)
    if poor:
        with pytest.warns(wl.FitWarning, match=r"lack of fit: the fitted wear rate is further from repeated tests"):
            fit = of_mild(tests)
    else:
        fit = of_mild(tests)
    (check,) = fit.lack_of_fit
    # The search ends within about 1e-8 of the best m_m, where the sum of squares is flat.
    assert check.method == "repeats"
    assert list(check.degrees) == pytest.approx([3.0, 8.0], rel=1e-6)
    assert check.value == pytest.approx(expected.statistic, rel=1e-6)
    assert check.p_value == pytest.approx(expected.pvalue, rel=1e-5)
    assert check.poor == poor
    assert f"  lack of fit           {'yes' if poor else 'none'}: F = {check.value:.3g} with 3 and 8 degrees" in repr(
        fit
    )


def test_the_confidence_decides() -> None:
    tests = repeated((0.1, 0.0, -0.05, 0.0), each=2)
    with pytest.warns(wl.FitWarning, match="lack of fit"):
        p = of_mild(tests, confidence=0.05).lack_of_fit[0].p_value
    assert p is not None
    assert 0.0 < p < 0.9
    assert not of_mild(tests, confidence=1.0 - 0.9 * p).lack_of_fit[0].poor


def test_stated_uncertainties_are_held_against_the_residuals() -> None:
    tests = repeated((0.0, 0.1, 0.1, 0.0), each=1, scatter=0.0)
    conditions: Any = {"creepage": tests.creepage, "max_pressure": PRESSURE, "friction_coefficient": FRICTION}

    def with_uncertainty(share: float) -> wl.Fit:
        rate = tests.wear_rate
        return of_mild(wl.WearTests.from_arrays(**conditions, wear_rate=rate, wear_rate_uncertainty=share * rate))

    (check,) = with_uncertainty(0.1).lack_of_fit
    assert check.method == "uncertainty"
    assert list(check.degrees) == pytest.approx([3.0], rel=1e-6)
    # The weighted mean of the ratios 1/(measured/law), by hand.
    ratio = np.exp([0.0, 0.1, 0.1, 0.0])
    best = np.sum(1.0 / ratio) / np.sum(1.0 / ratio**2)
    expected = np.sum(((best / ratio - 1.0) / 0.1) ** 2)
    assert check.value * 3.0 == pytest.approx(expected, rel=1e-6)
    assert check.p_value == pytest.approx(stats.chi2.sf(expected, 3), rel=1e-6)
    assert not check.poor
    with pytest.warns(
        wl.FitWarning, match=r"lack of fit: the residuals of the wear rate are .* the stated uncertainty"
    ):
        assert with_uncertainty(0.01).lack_of_fit[0].poor


@pytest.mark.parametrize(("scale", "poor"), [(0.65, False), (0.75, True)])
def test_without_repeats_a_typical_factor_of_two_is_poor(scale: float, poor: bool) -> None:
    """Logarithms of +scale and -scale leave m_m as it is: the typical factor is exp(scale), and exp(0.693) is 2."""
    tests = repeated(scale * np.array([1.0, -1.0, -1.0, 1.0]), each=1, scatter=0.0)
    if poor:
        with pytest.warns(wl.FitWarning, match=r"typically wrong by a factor of 2\.12, more than 2;"):
            fit = of_mild(tests)
    else:
        fit = of_mild(tests)
    (check,) = fit.lack_of_fit
    assert (check.method, check.poor) == ("factor", poor)
    assert check.value == pytest.approx(np.exp(scale), rel=1e-6)
    assert fit.residuals["predicted/measured"].to_numpy() == pytest.approx(
        np.exp(scale * np.array([-1.0, 1.0, 1.0, -1.0])), rel=1e-6
    )
    assert f", a factor of {np.exp(scale):.4g}\n" in repr(fit)
    assert str(check) == f"typical factor {np.exp(scale):.3g}, limit 2"


def test_copies_of_a_test_do_not_count_as_repeats() -> None:
    assert of_mild(repeated((0.1, 0.0, 0.1, 0.0), each=2, scatter=0.0)).lack_of_fit[0].method == "factor"


def test_absolute_scatter_without_repeats_is_held_against_half_the_measurements() -> None:
    predict = GLOBAL | sloping
    creepage = np.linspace(1.0, 10.0, 8)
    good = made_up(predict, creepage=creepage)
    assert not wl.fit(predict, good, ["slope"], scatter="absolute", bootstrap=0).lack_of_fit[0].poor
    conditions: Any = {"creepage": Q(creepage, "%"), "max_pressure": PRESSURE, "friction_coefficient": FRICTION}
    spikes = wl.WearTests.from_arrays(**conditions, wear_rate=Q([9, 100, 9, 9, 9, 100, 9, 9], "ug/m/mm^2"))
    with pytest.warns(
        wl.FitWarning, match=r"rms residual of the wear rate is \d+% of the rms measurement, more than 50%"
    ):
        (check,) = wl.fit(predict, spikes, ["slope"], scatter="absolute", bootstrap=0).lack_of_fit
    assert check.method == "share"
    assert str(check) == f"rms residual {check.value:.0%} of the rms measurement, limit 50%"


def test_each_kind_of_measurement_is_checked() -> None:
    """The degrees of freedom of both kinds add up to the points less the parameters."""
    predict = usfd("exact")
    creepage = np.repeat([0.1, 0.3, 0.5, 0.8, 1.5], 3)
    given: Any = {"creepage": Q(creepage, "%"), "max_pressure": PRESSURE}
    found = predict(**given, friction_coefficient=FRICTION)
    generator = np.random.default_rng(3)
    one, two = np.exp(0.05 * generator.standard_normal((2, creepage.size)))
    tests = wl.WearTests.from_arrays(
        **given, wear_rate=found.wear_rate * one, traction_coefficient=found.traction_coefficient * two
    )
    fit = wl.fit(predict, tests, ["m_m", "friction_coefficient"], bootstrap=0)
    assert [one.observable for one in fit.lack_of_fit] == ["wear_rate", "traction_coefficient"]
    assert sum(one.degrees[0] for one in fit.lack_of_fit) == pytest.approx(10 - 2, rel=1e-9)
    assert not any(one.poor for one in fit.lack_of_fit)
    assert "lack of fit           none of wear rate: F" in repr(fit)
