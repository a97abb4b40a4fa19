"""Fitting the numbers of stages, alone and with friction and laws, to made-up tests of known numbers."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
import pytest
from pydantic import Field
from scipy import stats

import wearlaw as wl
from tests.plugins.fits.fits import EXACT, PRESSURE, RIG, refused, traction_tests
from wearlaw import Array, Q
from wearlaw.errors import CompositionError
from wearlaw_apps.fits import WearTests

CREEPAGE = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0, 2.0, 3.0])


class Softer(wl.Stage):
    """Bodies with a layer between them: the modulus falls to a share, and with it the initial slope of the traction."""

    name: ClassVar[str] = "softer"

    reduction: Annotated[float, Field(gt=0.0, le=1.0)] = 1.0

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return problem.replaced(effective_modulus=self.reduction * problem.effective_modulus)


class Rubbed(wl.Stage):
    """Friction that falls by a share of its own, as a stage that overrides `solve`; its number has a unit."""

    name: ClassVar[str] = "rubbed"

    share: Annotated[wl.Quantity, wl.Unit("", limit=1.0)] = Q(80.0, "%")
    reduction: Annotated[float, Field(gt=0.0)] = 1.0
    layers: int = 1

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Contact:
        factor = self.share.m_as("") * self.reduction
        return inner(problem.replaced(friction_coefficient=factor * problem.friction_coefficient))


SOFT = EXACT | Softer(reduction=0.9)


def traction(reduction: float) -> Array:
    conditions: Any = {"creepage": Q(CREEPAGE, "%"), "max_pressure": PRESSURE, "friction_coefficient": 0.4}
    values: Array = (EXACT | Softer(reduction=reduction))(**conditions).traction_coefficient.magnitude
    return values


def made_up(reduction: float = 0.6, scatter: float = 0.0, seed: int = 0, **more: Any) -> WearTests:
    factor = np.exp(scatter * np.random.default_rng(seed).standard_normal(CREEPAGE.size))
    return traction_tests(traction(reduction) * factor, CREEPAGE, **{"friction_coefficient": 0.4, **more})


@pytest.mark.parametrize("free", [["reduction"], ["softer.reduction"], ["reduction", "friction_coefficient"]])
@pytest.mark.parametrize("scatter", ["relative", "absolute"])
def test_the_known_number_of_a_stage_comes_back(free: list[str], scatter: Any) -> None:
    fit = wl.fit(SOFT, made_up(), free=free, scatter=scatter, bootstrap=0)
    found = {name: value.magnitude for name, value in fit.parameters.items()}
    # The tests have no scatter, so the fit ends at the truth but for its tolerance on the parameters, 1e-8.
    assert found == pytest.approx(dict(zip(free, [0.6, 0.4], strict=False)), rel=1e-7)
    assert fit.predict.stages[0].model_dump() == {"reduction": found[free[0]]}
    assert fit.law is None


@pytest.mark.validates(
    "fitting",
    "Intervals of {level:.0%} hold the known number of a stage that often",
    source="100 synthetic data sets",
    held_to="not fewer than a binomial does with a probability of {chance:g}",
    level=0.95,
    chance=0.001,
)
@pytest.mark.filterwarnings("ignore:outliers")  # at 1 % some of 100 sets have one
def test_intervals_hold_the_known_number_as_often_as_they_say(level: float, chance: float) -> None:
    fits, held = 100, np.zeros(2)
    for seed in range(fits):
        fit = wl.fit(SOFT, made_up(0.6, 0.03, seed), ["reduction"], starts=0, bootstrap=60, seed=seed, confidence=level)
        for number, (low, high) in enumerate((fit.intervals["reduction"], fit.covariance_intervals["reduction"])):
            held[number] += low.magnitude <= 0.6 <= high.magnitude
    assert held.min() >= stats.binom.ppf(chance, fits, level)


def test_a_stage_and_a_law_are_fitted_together(tmp_path: Path) -> None:
    usfd = wl.wear_law("usfd", fitted_for="exact")
    true = EXACT | Softer(reduction=0.6) | usfd.model_copy(update={"q_s": Q(48.0, "ug/m/mm^2")})
    conditions: Any = {"creepage": Q(CREEPAGE, "%"), "max_pressure": PRESSURE, "friction_coefficient": 0.4}
    wear = true(**conditions).wear_rate
    tests = made_up(wear_rate=wear)
    fit = wl.fit((SOFT | usfd), tests, free=["reduction", "q_s"], bootstrap=0)
    assert fit.parameters["reduction"].magnitude == pytest.approx(0.6, rel=1e-6)
    assert fit.parameters["q_s"].magnitude == pytest.approx(48.0, rel=1e-6)
    assert list(fit.residuals["observable"].unique()) == ["wear_rate [ug/m/mm^2]", "traction_coefficient"]
    again = fit.predict(**conditions)
    assert fit.residuals["predicted"].tolist() == pytest.approx(
        [*again.wear_rate.magnitude, *again.traction_coefficient.magnitude], rel=1e-9
    )
    # A law file holds the law; its record says with which stage.
    fit.to_toml(tmp_path / "law.toml")
    law = wl.read_law(tmp_path / "law.toml")
    assert law == fit.law
    reduction = fit.parameters["reduction"].magnitude
    record = tomllib.loads((tmp_path / "law.toml").read_text())["provenance"]
    assert record["stages"] == [{"model": "softer", "reduction": reduction}]
    assert law.calibration is not None
    assert law.calibration.source == f"fitted to 10 tests, with Softer(reduction={reduction})"
    assert len(fit.figure_data().panels) == 2
    assert list(fit.table()["parameter"]) == ["reduction", "q_s"]
    assert fit.correlation.shape == (2, 2)


class Choosy(Softer):
    """A stage that refuses some numbers by a rule of its own."""

    name: ClassVar[str] = "choosy"

    def model_post_init(self, _: Any) -> None:
        if self.reduction < 0.3:
            raise wl.InputError("reduction: too soft a layer")


class Balanced(wl.TwinDisc):
    """A rig whose loads follow the forces."""

    def balanced(self, problem: wl.Problem, forces: Any) -> wl.Problem:
        return problem


TWO, TWINS = EXACT | Softer() | Rubbed(), EXACT | Softer() | Softer(reduction=0.5)


@pytest.mark.parametrize(
    ("predict", "free", "bounds", "names"),
    [
        (TWO, ["reduction"], None, "free: .*'softer.reduction' or 'rubbed.reduction'"),
        (TWO, ["layers"], None, "free: .*'layers'"),
        (SOFT, ["reductio"], None, "free: .*'reduction'"),
        (SOFT, ["reduction", "softer.reduction"], None, "free: .*'softer.reduction'"),
        (SOFT, ["reduction"], {"reduction": (0.1, 2)}, "bounds: 'reduction' .*0.0 to 1.0"),
        (TWINS, ["reduction"], None, "free: .*'softer_1.reduction' or 'softer_2.reduction'"),
        (
            TWINS,
            ["softer_1.reduction", "softer_2.reduction"],
            None,
            "free: .*softer_1.reduction and softer_2.reduction",
        ),
        (EXACT | Choosy(), ["reduction"], None, ".* reduction .*bounds=(.|\\n)*too soft"),
    ],
)
def test_wrong_names_and_bounds_of_stages_are_refused(predict: Any, free: Any, bounds: Any, names: str) -> None:
    refused(f"^{names}", predict, made_up(), free, bounds=bounds)


def test_a_stage_needs_its_bounds_a_measurement_and_loads_that_stay() -> None:
    wl.fit(EXACT | Choosy(), made_up(), ["reduction"], bounds={"reduction": (0.3, 1)}, bootstrap=0)
    nothing = traction_tests(np.full(10, np.nan), CREEPAGE, friction_coefficient=0.4, wear_rate="5 ug/m/mm^2")
    refused("^tests: .*traction.* reduction", SOFT, nothing, ["reduction"])
    balanced = Balanced(**dict(RIG)) | EXACT.contact_model | Softer()
    with pytest.raises(CompositionError, match=r"^fit: rig 'twin_disc' .* reduction"):
        wl.fit(balanced, made_up(), ["reduction"])
