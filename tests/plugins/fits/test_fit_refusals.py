"""Errors and warnings of fits."""

from __future__ import annotations

import dataclasses
from typing import Annotated, Any, ClassVar

import numpy as np
import pytest
from pydantic import Field

import wearlaw as wl
from tests.plugins.fits.comparisons import scattered
from tests.plugins.fits.fits import (
    ALL,
    CREEPAGE,
    EXACT,
    FRICTION,
    GLOBAL,
    PRESSURE,
    RIG,
    made_up,
    refused,
    sloping,
    traction_tests,
    usfd,
)
from wearlaw import Q
from wearlaw.errors import FitWarning
from wearlaw_apps.fits import WearTests


def test_tests_for_which_the_best_fit_predicts_no_wear_are_refused() -> None:
    predict = GLOBAL | sloping.model_copy(update={"offset": Q(-5.0, "ug/m/mm^2")})
    tests = made_up(GLOBAL | sloping, 0.1, creepage=np.array([0.3, 3.0, 6.0, 9.0]))
    bounds = {"slope": ("1 ug/m/N", "3 ug/m/N")}
    refused("predicts no wear rate in test number 1;", predict, tests, ["slope"], bounds=bounds)


def test_a_pressure_beyond_first_yield_is_warned_of() -> None:
    predict = usfd("global")
    tests = WearTests.from_arrays(
        creepage=Q([1.0, 2.0, 3.0], "%"),
        max_pressure="1.9 GPa",
        friction_coefficient=0.4,
        wear_rate=Q([45.0, 54.0, 56.0], "ug/m/mm^2"),
    )
    with pytest.warns(wl.RangeWarning, match="beyond the shakedown limit") as caught:
        wl.fit(predict, tests, free=["q_s"], bootstrap=0)
    assert caught[0].filename == __file__


class Narrow(wl.WearLaw):
    """A law that allows its parameters little, and fails beyond."""

    name: ClassVar[str] = "narrow"
    k: Annotated[wl.Quantity, wl.Unit("ug/m/N", limit=8.0)]
    power: Annotated[float, Field(ge=1.0, le=2.0)] = 1.0

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        assert np.all((p["power"] >= 1.0) & (p["power"] <= 2.0) & (p["k"] <= 8e-9))
        return p["k"] * 1e6 * (contact.wear_index_density / 1e6) ** p["power"]


@pytest.mark.parametrize(
    ("free", "start", "true", "limit", "beyond"),
    [
        ("k", Q(5.0, "ug/m/N"), Q(6.0, "ug/m/N"), Q(8.0, "ug/m/N"), ("1 ug/m/N", "9 ug/m/N")),
        ("power", 1.5, 1.2, 2.0, (0.5, 1.9)),
        ("power", 1.0, 1.2, 2.0, (1.5, 2.1)),
    ],
)
def test_a_fit_stays_within_the_limits_of_a_field(free: str, start: Any, true: Any, limit: Any, beyond: Any) -> None:
    law = Narrow(k=Q(5.0, "ug/m/N"))
    predict = GLOBAL | law.model_copy(update={free: start})
    creepage = np.linspace(1.0, 5.0, 6)
    tests = made_up(GLOBAL | law.model_copy(update={free: true}), creepage=creepage)
    found = wl.fit(predict, tests, free=[free], bootstrap=0).parameters[free]
    assert found.magnitude == pytest.approx(getattr(true, "magnitude", true), rel=1e-7)
    steeper = made_up(GLOBAL | law.model_copy(update={free: limit}), creepage=creepage)
    steeper = dataclasses.replace(
        steeper, columns={**steeper.columns, "wear_rate": steeper.columns["wear_rate"] * (creepage / 0.5) ** 0.2}
    )
    with pytest.warns(FitWarning, match=f"at a bound of {free}"):
        at_limit = wl.fit(predict, steeper, free=[free], bootstrap=0).parameters[free]
    assert at_limit.magnitude == pytest.approx(getattr(limit, "magnitude", limit), rel=1e-12)
    refused(f"bounds: '{free}'", predict, tests, [free], bounds={free: beyond})


@pytest.mark.parametrize(
    ("predict", "free", "settings", "names"),
    [
        (usfd("global"), ["q_z"], {}, "free: .*q_z.*'q_s'"),
        (usfd("global"), ["fitted_for"], {}, "free: .*fitted_for"),
        (usfd("global"), ["q_s", "q_s"], {}, "free: .*q_s"),
        (usfd("global"), [], {}, "free: "),
        (GLOBAL, ["q_s"], {}, "free: .*friction_coefficient"),
        (RIG, ["q_s"], {}, "predict: "),
        (GLOBAL | wl.wear_law("kth"), ["coefficient"], {}, "free: .*coefficient.low_speed"),
        (usfd("global"), ["q_s"], {"scatter": "log"}, "scatter: "),
        (usfd("global"), ["q_s"], {"bounds": {"m_m": ("1 ug/m/N", "2 ug/m/N")}}, "bounds: .*m_m"),
        (usfd("global"), ["q_s"], {"bounds": {"q_s": ("1 N", "2 N")}}, "bounds: .*q_s"),
        (usfd("global"), ["q_s"], {"bounds": {"q_s": (1.0, 2.0)}}, "bounds: .*q_s"),
        (usfd("global"), ["q_s"], {"bounds": {"q_s": 5}}, "bounds: 'q_s'"),
        (usfd("global"), ["q_s"], {"bounds": {"q_s": ("0 ug/m/mm^2", "2 ug/m/mm^2")}}, "bounds: 'q_s'"),
        (GLOBAL | sloping.model_copy(update={"offset": Q(0.0, "ug/m/mm^2")}), ["offset"], {}, "bounds: .*offset"),
        *[(usfd("global"), ["q_s"], {name: wrong}, f"{name}: ") for name in ("starts", "bootstrap", "seed")
          for wrong in (-1, 1.5)],
        *[(usfd("global"), ["q_s"], {"confidence": wrong}, "confidence: ") for wrong in (95, 0.0, 1.0)],
    ],
)  # fmt: skip
def test_wrong_arguments_are_refused_by_name(predict: Any, free: Any, settings: Any, names: str) -> None:
    refused(f"^{names}", predict, made_up(usfd("global"), 0.1), free, **settings)


@pytest.mark.filterwarnings("ignore:outliers")  # the rate of zero
def test_rates_of_zero_are_refused_where_scatter_is_by_a_factor() -> None:
    predict, tests = usfd("global"), made_up(usfd("global"))
    rate = tests.wear_rate.magnitude.copy()
    rate[[2, 4]] = 0.0
    conditions: Any = {"creepage": tests.creepage, "max_pressure": PRESSURE, "friction_coefficient": FRICTION}
    zeros = WearTests.from_arrays(
        **conditions, wear_rate=Q(rate, "ug/m/mm^2"), labels=[f"T{number}" for number in range(20)]
    )
    refused('^wear_rate: .* T2, T4.*scatter="absolute"', predict, zeros, ["q_s"])
    wl.fit(predict, zeros, free=["q_s"], scatter="absolute", bootstrap=0)
    still = np.where(np.arange(20) == 5, 0.0, CREEPAGE)
    conditions["creepage"] = Q(still, "%")
    stuck = WearTests.from_arrays(**conditions, wear_rate=tests.wear_rate)
    refused("predicts no wear rate in test number 6", predict, stuck, ["q_s"])
    refused("no traction .* in test number 6", GLOBAL, traction_tests(0.3, still), ["friction_coefficient"])


def test_measurements_that_are_not_there_are_refused() -> None:
    predict = usfd("exact")
    only_traction = traction_tests(np.full(5, 0.4), np.linspace(3.0, 9.0, 5), friction_coefficient=0.4)
    refused("none of the 5 tests has a wear rate", predict, only_traction, ["q_s"])
    refused("fitted to measured traction, and the tests have none", predict, made_up(predict), ["friction_coefficient"])
    with pytest.raises(wl.ConditionsError, match=r"friction_coefficient=0\.46"):
        wl.fit(predict, traction_tests(np.full(5, 0.4), np.arange(1.0, 6.0), wear_rate="5 ug/m/mm^2"), free=["q_s"])
    uncertainty = Q([1.0, np.nan, 1.0, 1.0, 1.0], "ug/m/mm^2")
    gap = WearTests.from_arrays(
        creepage=Q(np.arange(1.0, 6.0), "%"),
        max_pressure=PRESSURE,
        friction_coefficient=0.4,
        wear_rate="5 ug/m/mm^2",
        wear_rate_uncertainty=uncertainty,
    )
    refused("is missing in test number 2", predict, gap, ["q_s"])


ONE_CATASTROPHIC = np.append(np.geomspace(0.1, 12.0, 12), 17.0)


@pytest.mark.parametrize(
    ("predict", "creepage", "free", "open_"),
    [
        *[(usfd(contact), np.geomspace(0.1, 12.0, 15), ALL, "m_c and tr_sc") for contact in ("global", "exact")],
        (usfd("global"), np.geomspace(0.1, 12.0, 15), ["m_m", "m_c"], "m_c"),
        (usfd("global"), ONE_CATASTROPHIC, ALL, "m_c and tr_sc"),
        (GLOBAL | wl.wear_law("kth"), np.linspace(1.0, 15.0, 9), ["coefficient.low_speed", "hardness"],
         "coefficient.low_speed and hardness"),
    ],
)  # fmt: skip
def test_parameters_that_the_tests_leave_open_are_refused(predict: Any, creepage: Any, free: Any, open_: str) -> None:
    """A regime without tests; a slope and a border that one test decides; a quotient k/H."""
    refused(f"do not determine {open_}[,;] ", predict, made_up(predict, 0.1, 0, creepage), free)


@pytest.mark.filterwarnings("ignore::wearlaw.errors.FitWarning")
def test_an_interval_ends_at_the_bounds() -> None:
    # The scatter is that of the largest rates, which hides the mild regime; the interval of its slope has no ends.
    law = wl.wear_law("usfd", fitted_for="exact", m_c="61.9 ug/m/N", tr_sc="77.26 N/mm^2")
    fit = wl.fit(EXACT | law, scattered(), ["m_m", "q_s"], scatter="absolute", bootstrap=40, seed=7)
    for intervals in (fit.intervals, fit.covariance_intervals):
        low, high = (end.to("ug/m/N").magnitude for end in intervals["m_m"])
        assert 5.3 / 100 * (1 - 1e-12) <= low <= high <= 5.3 * 100 * (1 + 1e-12)
