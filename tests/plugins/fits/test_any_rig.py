"""Uncertainty, fits and comparisons of a wheel on a rail and of a rig of one's own."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.core.test_own_rigs import Roller
from tests.plugins.fits.fits import sloping
from tests.strategies import EPS
from wearlaw import Q
from wearlaw_apps.fits import Fit, WearTests

WHEEL = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
KTH = wl.wear_law("kth")
ROLLER = Roller() | wl.contact_model("exact") | KTH
FASTSIM = WHEEL | wl.contact_model("fastsim")
ON_ELLIPSE: Any = {"normal_force": "80 kN", "friction_coefficient": 0.3}


def rate(quantity: Any) -> Any:
    return quantity.to("kg/m^3").magnitude


def sobol_points(inputs: int, samples: int) -> Any:
    """Return the probabilities of the samples, as `uncertainty` takes them with its first seed."""
    return stats.qmc.Sobol(inputs, rng=np.random.default_rng(0)).random_base2(samples.bit_length() - 1).T


def test_samples_on_a_rail_are_single_predictions() -> None:
    predict: Any = FASTSIM | KTH
    u = wl.uncertainty(
        predict,
        normal_force=wl.uniform("60000 N", "90 kN"),
        longitudinal_creepage=Q([0.1, 0.3], "%"),
        lateral_creepage=wl.uniform("-0.1 %", "0.2 %"),
        spin=wl.uniform("-0.5 1/m", "0.5 1/m"),
        friction_coefficient=wl.uniform(0.2, 0.4),
        samples=4,
    )
    p = sobol_points(4, 4)
    each = [
        [
            rate(
                predict(
                    normal_force=Q(60.0 + 30.0 * load, "kN"),
                    longitudinal_creepage=Q(along, "%"),
                    lateral_creepage=Q(-0.1 + 0.3 * across, "%"),
                    spin=Q(-0.5 + turning, "1/m"),
                    friction_coefficient=0.2 + 0.2 * friction,
                ).wear_rate
            )
            for load, across, turning, friction in p.T
        ]
        for along in (0.1, 0.3)
    ]
    # Sampled and rounded twice; FASTSIM's strips add up some hundred terms.
    assert rate(u.wear_rate) == pytest.approx(np.array(each), rel=1e4 * EPS)
    assert np.ptp(rate(u.wear_rate)) > 0.0


bending = sloping.model_copy(update={"offset": Q(0.0, "ug/m/mm^2"), "bend": Q(1.0, "ug*mm^2/m/N^2")})
LAW = bending.model_copy(update={"slope": Q(5.0, "ug/m/N"), "bend": Q(3.0, "ug*mm^2/m/N^2")})
TWICE = bending.model_copy(update={"slope": Q(10.0, "ug/m/N"), "bend": Q(6.0, "ug*mm^2/m/N^2")})
MASSES: Any = {"mass": Q([20.0, 20.0, 40.0, 40.0, 30.0], "kg")}
CREEPAGES: Any = {"creepage": Q([0.2, 1.0, 2.0, 0.5, -0.7], "%")}
LOADS: Any = {"normal_force": Q([60.0, 80.0, 80.0, 100.0, 90.0], "kN")}
ON_RAIL: Any = {
    "longitudinal_creepage": Q([0.05, 0.2, -0.1, 0.0, 0.4], "%"),
    "lateral_creepage": Q([0.1, 0.0, 0.2, 0.3, 0.1], "%"),
    "spin": Q([0.0, 0.5, -0.5, 0.2, 0.3], "1/m"),
}


def on_roller(**changes: Any) -> WearTests:
    """Return tests of a roller that follow a law, and their tractions."""
    found = (Roller() | wl.contact_model("exact") | LAW)(**MASSES, **CREEPAGES, friction_coefficient=0.35)
    measured: Any = {"traction_coefficient": abs(found.traction_coefficient.magnitude), "wear_rate": found.wear_rate}
    return WearTests.from_arrays(**{**CREEPAGES, **measured, "other_conditions": MASSES, **changes})


def on_rail(model: str, **changes: Any) -> WearTests:
    """Return tests of a wheel on a rail that follow a law, and their tractions."""
    found = (WHEEL | wl.contact_model(model) | LAW)(**LOADS, **ON_RAIL, friction_coefficient=0.35)
    measured: Any = {"traction_coefficient": found.traction_coefficient.magnitude, "wear_rate": found.wear_rate}
    return WearTests.from_arrays(**{**LOADS, **measured, "other_conditions": ON_RAIL, **changes})


def fitted(predict: Any, tests: WearTests, **more: Any) -> Fit:
    free = ["bend", "slope", "friction_coefficient"]
    return wl.fit(predict, tests, free=free, starts=4, bootstrap=0, **{"friction_coefficient": 0.3, **more})


@pytest.mark.parametrize("model", ["exact", "fastsim"])
def test_a_fit_finds_the_law_that_made_the_tests(model: str) -> None:
    tests = on_roller() if model == "exact" else on_rail(model)
    rig = Roller() if model == "exact" else WHEEL
    fit = fitted(rig | wl.contact_model(model) | bending, tests)
    found = {name: value.magnitude for name, value in fit.parameters.items()}
    # Without scatter the sum of squares is zero at these values and nowhere else; near it each step of Gauss and Newton
    # squares the error, so that the last one leaves a millionth or less.
    assert found == pytest.approx({"bend": 3.0, "slope": 5.0, "friction_coefficient": 0.35}, rel=1e-6)
    along = CREEPAGES["creepage"] if model == "exact" else ON_RAIL["longitudinal_creepage"]
    assert fit.residuals["creepage [%]"][:5].to_numpy() == pytest.approx(along.magnitude, rel=4 * EPS)
    assert all(panel.curves[-1].hollow for panel in fit.figure_data().panels)  # the tests differ in load


def test_a_law_fitted_on_a_rail_belongs_to_ellipses() -> None:
    usfd = wl.wear_law("usfd", fitted_for="fastsim")
    given: Any = {"friction_coefficient": 0.35, "starts": 4, "bootstrap": 0}
    with pytest.warns(wl.CalibrationWarning, match="were fitted for line contacts, but are used with elliptic"):
        fit = wl.fit(FASTSIM.with_law(usfd), on_rail("fastsim"), ["m_m"], **given)
    assert fit.law is not None
    FASTSIM | fit.law  # warnings are errors
    with pytest.warns(wl.CalibrationWarning, match="were fitted for elliptic contacts, but are used with line"):
        wl.TwinDisc.suros() | wl.contact_model("fastsim") | fit.law


@pytest.mark.parametrize(
    ("along", "x"),
    [
        ([0.4, 0.05, 0.1, 0.2], "wear index over area Tγ/A [N/mm²]"),
        ([0.4, 0.05, -0.1, 0.2], "longitudinal creepage [%]"),  # Tγ/A is the same at two of them
    ],
)
def test_tests_on_a_rail_that_differ_in_creepage_alone_are_drawn_as_a_curve(along: list[float], x: str) -> None:
    given: Any = {**ON_ELLIPSE, "longitudinal_creepage": Q(along, "%"), "lateral_creepage": "0.1 %", "spin": "0.3 1/m"}
    predict: Any = FASTSIM | LAW
    tests = WearTests.from_arrays(
        normal_force="80 kN",
        friction_coefficient=0.3,
        wear_rate=predict(**given).wear_rate,
        other_conditions={name: given[name] for name in ON_RAIL},
    )
    fit = wl.fit(FASTSIM | bending, tests, free=["bend", "slope"], starts=4, bootstrap=0)
    (panel,) = fit.figure_data().panels
    curve, measured = panel.curves
    assert panel.x.label == x
    assert not curve.points
    assert curve.x.size == 3 * 8 + 1
    assert curve.x[[0, -1]] == pytest.approx([min(measured.x), max(measured.x)], rel=1e-12)
    assert np.interp(measured.x, curve.x, curve.y) == pytest.approx(measured.y, rel=1e-6)


def test_the_law_that_made_the_tests_agrees_best() -> None:
    tests = on_rail("fastsim", traction_coefficient=None, friction_coefficient=0.35)
    ranking = wl.compare({"twice": FASTSIM | TWICE, "true": FASTSIM | LAW}, tests)
    best, second = ranking.compared
    assert (best.names.label, second.names.label) == ("true", "twice")
    assert best.agreement.rms_factor == pytest.approx(1.0, abs=1e4 * EPS)
    assert second.agreement.rms_factor == pytest.approx(2.0, rel=1e4 * EPS)
    assert "spin [1/m]" in ranking.predictions().columns


def test_conditions_that_a_rig_does_not_take_or_misses_are_named() -> None:
    predict, tests = ROLLER.without_law() | LAW, on_roller(other_conditions={"mas": Q(20.0, "kg")})
    for call in (
        lambda: wl.fit(predict, tests, free=["slope"], bootstrap=0),
        lambda: wl.compare([predict], tests),
    ):
        with pytest.raises(wl.InputError, match="mas: unknown condition; did you mean 'mass'"):
            call()
    with pytest.raises(wl.ConditionsError, match="friction_coefficient: is missing"):
        wl.compare([FASTSIM | LAW], on_rail("polach"))


class Greased(wl.Rig):
    """Discs of one friction coefficient."""

    name: ClassVar[str] = "greased"

    def problem(self, *, normal_force: wl.QuantityLike, creepage: wl.QuantityLike) -> wl.Problem:
        """Return the problem of the discs."""
        discs = wl.TwinDisc.suros()
        return discs.problem(normal_force=normal_force, creepage=creepage, friction_coefficient=0.05)


def test_a_rig_is_not_given_the_friction_and_the_traction_that_it_does_not_take() -> None:
    predict: Any = Greased() | wl.contact_model("global") | LAW
    given: Any = {"normal_force": Q([5.0, 6.0], "kN"), "creepage": "1 %"}
    tests = WearTests.from_arrays(**given, traction_coefficient=0.04, wear_rate=predict(**given).wear_rate)
    found = wl.compare([predict], tests)
    assert found.compared[0].agreement.rms_factor == pytest.approx(1.0, abs=64 * EPS)
    assert not found.notes
