"""Fitting laws of any outcome, several of them, and laws of one body, to made-up tests of known numbers."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.core.distributions import RUBBED_AND_TIRED, Install
from tests.core.outcome_laws import CONDITIONS, MIXED, Damage, Heat, Volume
from tests.plugins.fits.fits import EXACT, refused, sloping
from wearlaw import Q
from wearlaw.errors import DataError, FitError
from wearlaw_apps.fits import WearTests

TRUE_HEAT, TRUE_DAMAGE = Heat(share=0.3), Damage(threshold=Q(40.0, "N"), slope=Q(2e-6, "1/N"))
SLOPING = sloping.model_copy(update={"offset": Q(0.0, "ug/m/mm^2")})
FASTSIM = wl.contact_model("fastsim")


def outcomes_of(*laws: wl.Law, scatter: float = 0.0, seed: int = 0, contact: Any = EXACT, **given: Any) -> Any:
    """Return the outcomes of laws by name, with lognormal scatter."""
    predict = contact.with_law(*laws)
    found = predict(**(given or CONDITIONS))
    generator = np.random.default_rng(seed)
    names = [law.outcome.name for law in laws]
    return {name: found[name] * np.exp(scatter * generator.standard_normal(found[name].shape)) for name in names}


def measured_tests(outcomes: Any, **more: Any) -> WearTests:
    return WearTests.from_arrays(**CONDITIONS, outcomes=outcomes, **more)


@pytest.mark.parametrize(
    ("start", "true", "free"),
    [
        (Heat(), TRUE_HEAT, "share"),
        (SLOPING, SLOPING.model_copy(update={"slope": Q(3.0, "ug/m/N")}), "slope"),
        (wl.wear_law("kth"), wl.wear_law("kth", hardness=Q(3.0, "GPa")), "hardness"),
    ],
)
def test_a_fitted_law_of_any_author_records_its_contact_and_warns_beyond_its_tests(
    start: wl.Law, true: wl.Law, free: str
) -> None:
    outcomes = outcomes_of(true)
    tests = measured_tests(outcomes) if start.kind == "law" else WearTests.from_arrays(**CONDITIONS, **outcomes)
    law = wl.fit(EXACT | start, tests, free=[free], bootstrap=0).law
    assert law is not None
    assert law.calibration is not None
    assert (law.calibration.contact_model, law.calibration.scale) == ("exact", "cells")
    assert law.calibration.source == f"fitted to {len(tests)} tests"
    assert pickle.loads(pickle.dumps(law)) == law
    with pytest.warns(wl.CalibrationWarning, match="were fitted for the cells of contact_model..exact"):
        _ = EXACT.rig | wl.contact_model("fastsim") | law
    with pytest.warns(wl.RangeWarning, match=r"has a known range of mean .* \(fitted to 7 tests\)"):
        (EXACT | law)(**{**CONDITIONS, "normal_force": Q(5.0, "kN")})


def test_the_fit_of_a_linear_damage_is_that_of_linear_regression() -> None:
    """Damage = slope · Tγ - slope · threshold, negative below the threshold."""
    index = EXACT(**CONDITIONS).wear_index.m_as("N")
    damage = 2e-6 * (index - 40.0) + 1e-5 * np.random.default_rng(1).standard_normal(index.size)
    assert (damage < 0.0).any()
    tests = measured_tests({"rcf_damage": damage})
    fit = wl.fit(EXACT | Damage(), tests, ["threshold", "slope"], scatter="absolute", bootstrap=0)
    line: Any = stats.linregress(index, damage)
    assert fit.parameters["slope"].m_as("1/N") == pytest.approx(line.slope, rel=1e-6)
    assert fit.parameters["threshold"].m_as("N") == pytest.approx(-line.intercept / line.slope, rel=1e-6)
    assert fit.standard_errors["slope"].m_as("1/N") == pytest.approx(line.stderr, rel=1e-6)
    assert fit.rms.m_as("") == pytest.approx(np.sqrt(np.mean((damage - line.intercept - line.slope * index) ** 2)))
    refused("^rcf_damage: ", EXACT | Damage(), tests, ["slope"])


def test_several_laws_are_fitted_together_as_each_alone() -> None:
    """No number is shared, so each fit ends where it does alone, but for the tolerance of the search."""
    usfd = wl.wear_law("usfd", fitted_for="exact")
    measured = outcomes_of(TRUE_HEAT, TRUE_DAMAGE, usfd, scatter=0.05)
    wear = measured.pop("wear_rate")
    tests = measured_tests(measured, wear_rate=wear)
    predict = EXACT.with_law(usfd, Heat(), Damage())
    free = ["m_m", "heat.share", "slope"]
    fit = wl.fit(predict, tests[3:], free, scatter="absolute", bootstrap=0)
    assert [one.observable for one in fit.observations] == ["wear_rate", "heat_flux", "rcf_damage"]
    for name, law in zip(free, (usfd, Heat(), Damage()), strict=True):
        alone = wl.fit(EXACT.with_law(law), tests[3:], [name.removeprefix("heat.")], scatter="absolute", bootstrap=0)
        (value,) = alone.parameters.values()
        assert fit.parameters[name].magnitude == pytest.approx(value.magnitude, rel=1e-6)
    assert fit.law is None
    assert fit.predict.laws[1].numbers == {"share": fit.parameters["heat.share"].magnitude}
    assert fit.provenance["laws"].keys() == {"usfd", "heat", "damage"}
    with pytest.raises(FitError, match=r"one law, .* has 3"):
        fit.to_toml("nowhere.toml")


def test_wear_of_one_body_is_fitted_by_its_law() -> None:
    pipeline = MIXED | FASTSIM
    both = pipeline.with_law(Volume(body="disc_1", factor=2.0), Volume(body="disc_2", factor=3.0))(**CONDITIONS)
    scatter = np.exp(0.05 * np.random.default_rng(3).standard_normal((2, 7)))
    names = ("wear_rate_disc_1", "wear_rate_disc_2")
    measured = {name: both[name] * factor for name, factor in zip(names, scatter, strict=True)}
    predict = pipeline.with_law(Volume(body="disc_1"), Volume(body="disc_2"))
    fit = wl.fit(predict, measured_tests(measured), ["volume_disc_1.factor", "volume_disc_2.factor"], bootstrap=0)
    # With scatter by a factor, a law of one factor is fitted by the geometric mean.
    assert [value.magnitude for value in fit.parameters.values()] == pytest.approx(
        [2.0, 3.0] * stats.gmean(scatter, axis=1), rel=1e-7
    )
    # With one law, the measured wear rate is that of the body of the law.
    tests = WearTests.from_arrays(**CONDITIONS, wear_rate=both["wear_rate_disc_2"])
    alone = wl.fit(pipeline.with_law(Volume(body="disc_2")), tests, ["factor"], bootstrap=0)
    assert alone.parameters["factor"].magnitude == pytest.approx(3.0, rel=1e-7)
    refused("write 'volume_disc_1.factor' or 'volume_disc_2.factor'", predict, tests, ["factor"])
    refused("has a wear rate disc 1, which is fitted", predict, tests, ["volume_disc_1.factor"])


def test_outcomes_without_measurements_and_wrong_units_are_refused() -> None:
    tests = measured_tests(outcomes_of(TRUE_HEAT))
    refused("none of the 7 tests has a rcf damage, which is fitted", EXACT | Heat() | Damage(), tests, ["slope"])
    refused("^free: .*'sope'.* share, threshold, slope", EXACT | Heat() | Damage(), tests, ["sope"])
    wrong = measured_tests({"heat_flux": Q(np.ones(7), "kN")})
    with pytest.raises(DataError, match="heat_flux"):
        wl.fit(EXACT | Heat(), wrong, ["share"])
    with pytest.raises(DataError, match="rcf_damage"):
        wl.fit(EXACT | Damage(), measured_tests({"rcf_damage": Q(np.ones(7), "kN")}), ["slope"])


class Cracks(Damage):
    """The same, of an outcome that no installed law has."""

    name: ClassVar[str] = "cracks"
    outcome = wl.Outcome("crack_growth", unit="", of="patch", sign="any")


CSV = """# source: made up
creepage [%],normal_force [kN],friction_coefficient,heat_flux [kW/mm^2],crack_growth [-]
0.5,7.4,0.4,0.002,-1e-5
1,7.4,0.4,{},2e-5
2,7.4,0.4,0.008,9e-5
"""


def read(folder: Path, text: str, **more: Any) -> WearTests:
    path = folder / "tests.csv"
    path.write_text(text)
    return wl.read_tests(path, **more)


@pytest.mark.filterwarnings("ignore:outliers")  # of three tests, two of which are alike
def test_columns_of_outcomes_are_read_where_a_law_predicts_them(tmp_path: Path) -> None:
    tests = read(tmp_path, CSV.format("0.004"))
    fit = wl.fit(EXACT | Heat(), tests.measuring(["crack_growth"]), ["share"], bootstrap=0)
    assert fit.residuals["measured"].tolist() == pytest.approx([2.0, 4.0, 8.0])
    both = wl.fit(EXACT | Heat() | Cracks(), tests, ["share", "slope"], scatter="absolute", bootstrap=0)
    assert both.residuals["measured"].tolist() == pytest.approx([2.0, 4.0, 8.0, -1e-5, 2e-5, 9e-5])
    with pytest.raises(wl.ConditionsError, match="crack_growth: unknown condition"):
        wl.fit(EXACT | Heat(), tests, ["share"], bootstrap=0)


def test_outcomes_of_plugins_are_known_when_tests_are_read(install: Install, tmp_path: Path) -> None:
    install("own", RUBBED_AND_TIRED)
    text = "creepage [%],normal_force [kN],friction_coefficient,damage\n1,7.4,0.4,2\n2,7.4,0.4,\n"
    tests = read(tmp_path, text)
    assert tests.outcomes.keys() == {"damage"}
    with pytest.raises(DataError, match="give exactly one load"):
        read(tmp_path, "creepage [%],damage\n1,2\n")


def test_the_wear_rate_of_a_body_is_no_misspelt_column(tmp_path: Path) -> None:
    text = "creepage [%],normal_force [kN],friction_coefficient,{} [ug/m/mm^2]\n1,7.4,0.4,2\n"
    assert read(tmp_path, text.format("wear_rate_disc_1")).other_conditions.keys() == {"wear_rate_disc_1"}
    with pytest.raises(DataError, match="unknown column; did you mean 'wear_rate'"):
        read(tmp_path, text.format("wear_rat"))
    with pytest.raises(DataError, match="unknown column; did you mean 'wear_rate_uncertainty'"):
        read(tmp_path, text.format("wear_rate_uncertaint"))
