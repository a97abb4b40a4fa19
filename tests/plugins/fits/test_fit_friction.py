"""Fitting the friction coefficient to tractions, alone and with a law, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.plugins.fits.fits import CREEPAGE, EXACT, GLOBAL, PRESSURE, traction_tests, usfd
from wearlaw import Q

TRACTION = np.array([0.469, 0.449, 0.449, 0.450, 0.499])
FULL_SLIP = traction_tests(TRACTION, [3.0, 7.5, 10.0, 15.0, 20.0])


@pytest.mark.validates(
    "fitting",
    "The friction coefficient fitted to tractions in full slip, with its interval",
    source="mean and Student's t, by hand",
    held_to="{value:g} (value), {interval:g} (interval), relative",
    value=1e-07,
    interval=1e-06,
)
def test_friction_in_full_slip_is_the_mean_of_the_traction(value: float, interval: float) -> None:
    fit = wl.fit(EXACT, FULL_SLIP, free=["friction_coefficient"], scatter="absolute", bootstrap=0)
    assert fit.parameters["friction_coefficient"].magnitude == pytest.approx(TRACTION.mean(), rel=value)
    # By the delta method about the logarithm: μ exp(±t s/(μ √n)).
    reach = stats.t.ppf(0.975, 4) * TRACTION.std(ddof=1) / np.sqrt(5.0) / TRACTION.mean()
    ends = [end.magnitude for end in fit.intervals["friction_coefficient"]]
    assert ends == pytest.approx([TRACTION.mean() * np.exp(-reach), TRACTION.mean() * np.exp(reach)], rel=interval)
    relative = wl.fit(EXACT, FULL_SLIP, free="friction_coefficient", bootstrap=0)
    assert relative.parameters["friction_coefficient"].magnitude == pytest.approx(stats.gmean(TRACTION), rel=value)
    assert relative.law is None
    assert relative.predict == EXACT
    with pytest.raises(wl.FitError, match=r"one law, .* has 0"):
        relative.to_toml("nowhere.toml")


def test_friction_and_law_are_fitted_together_each_by_its_own_scatter() -> None:
    predict = usfd("exact")
    conditions: Any = {"creepage": Q(CREEPAGE, "%"), "max_pressure": PRESSURE, "friction_coefficient": 0.4}
    r = predict(**conditions)
    generator = np.random.default_rng(8)
    tests = traction_tests(
        r.traction_coefficient.magnitude * np.exp(0.002 * generator.standard_normal(20)),
        CREEPAGE,
        wear_rate=r.wear_rate * np.exp(0.2 * generator.standard_normal(20)),
    )
    fit = wl.fit(predict, tests, free=["q_s", "friction_coefficient"], bootstrap=200)
    alone = wl.fit(EXACT, tests, free=["friction_coefficient"], bootstrap=200)
    # The wear scatters a hundred times as much as the traction, and says as good as nothing of the friction.
    both, one = (found.parameters["friction_coefficient"].magnitude for found in (fit, alone))
    error = alone.standard_errors["friction_coefficient"].magnitude
    assert abs(both - one) < 0.2 * error
    assert error < 0.4 * 0.002
    assert fit.intervals["q_s"][0] < Q(55, "ug/m/mm^2") < fit.intervals["q_s"][1]
    assert list(fit.residuals["observable"].unique()) == ["wear_rate [ug/m/mm^2]", "traction_coefficient"]
    drawn = fit.figure_data().panels[0].curves[1].x
    again: Any = fit.predict(**{**conditions, "friction_coefficient": both})
    np.testing.assert_allclose(drawn, again.wear_index_density.magnitude, rtol=1e-9)
    assert [panel.y.label for panel in fit.figure_data().panels] == [
        "wear rate [µg/m/mm²]",
        "traction coefficient T/N [-]",
    ]


def test_a_measured_traction_does_not_stand_in_for_a_friction_that_is_free() -> None:
    traction = np.array([0.2, 0.35, 0.44, 0.45, 0.45])
    tests = traction_tests(traction, [0.5, 1.0, 3.0, 10.0, 20.0])
    of_global, of_exact = (
        wl.fit(contact, tests, free=["friction_coefficient"], bootstrap=0).parameters for contact in (GLOBAL, EXACT)
    )
    # The global model takes its total from the exact one, unless the traction is given.
    assert of_global["friction_coefficient"].magnitude == pytest.approx(
        of_exact["friction_coefficient"].magnitude, rel=1e-9
    )
