"""`wearlaw fit` and `wearlaw compare`, as a user meets them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.cases import files, wearlaw
from tests.core.distributions import RUBBED_AND_TIRED, Install
from tests.plugins.fits.cli_data import COMPARE, CREEPAGE, FIT, HEAD, LAW, listed, rates, rows, write_tests
from wearlaw import Q

pytestmark = pytest.mark.usefixtures("blank_figures", "folder_with_tests")


def test_a_fit_is_printed_and_its_files_are_listed_as_they_are(folder: Path) -> None:
    result = wearlaw(*FIT, "-o", "my fit")
    assert result.exit_code == 0
    direct = wl.fit(
        wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact"),
        wl.read_tests("tests.csv"),
        ["m_m", "q_s"],
        bootstrap=0,
    )
    assert result.stdout.startswith("Fit to 9 wear rates, 7 degrees of freedom, relative scatter\n")
    for name, value in direct.parameters.items():
        assert f"  {name} " in result.stdout
        assert f"{value.magnitude:.4g}" in result.stdout
    assert listed(result, "my fit") == files(folder) - {"tests.csv", "my fit/.wearlaw-files"}
    assert files(folder / "my fit") == {
        ".wearlaw-files",
        "law.toml",
        "parameters.csv",
        "residuals.csv",
        "fit.png",
        "fit.json",
    }
    assert (folder / "my fit" / "fit.png").read_bytes().startswith(b"\x89PNG")


def test_the_files_of_a_fit_hold_what_it_found() -> None:
    assert wearlaw(*FIT, "--fixed", "tr_sc=94 N/mm^2", "--confidence", "0.8").exit_code == 0
    law: Any = wl.read_law("tests-fit/law.toml")
    table = pd.read_csv("tests-fit/parameters.csv").set_index("parameter")
    record = json.loads(Path("tests-fit/fit.json").read_text(encoding="utf-8"))
    assert list(table.index) == ["m_m", "q_s"]
    assert list(table.unit) == ["ug/m/N", "ug/m/mm^2"]
    for name in table.index:
        value = getattr(law, name)
        assert wl.parse(record["parameters"][name]) == value
        assert table.value[name] == value.magnitude
        assert table.low[name] < value.magnitude < table.high[name]
    assert law.tr_sc == Q(94.0, "N/mm^2")
    assert law.calibration is not None
    assert law.calibration.contact_model == "exact"
    assert record["provenance"]["confidence"] == 0.8
    assert wl.Pipeline.model_validate(record["predict"]).wear_law == law
    residuals = pd.read_csv("tests-fit/residuals.csv")
    np.testing.assert_allclose(residuals["creepage [%]"], CREEPAGE, rtol=1e-15)


def test_the_friction_coefficient_is_fitted_to_traction_without_a_law() -> None:
    result = wearlaw("fit", "lewis2004", "--contact", "exact", "--free", "friction_coefficient", "--bootstrap", "0")
    assert result.exit_code == 0
    assert "friction_coefficient" in result.stdout
    assert files(Path("lewis2004-fit")) == {".wearlaw-files", "parameters.csv", "residuals.csv", "fit.png", "fit.json"}
    record = json.loads(Path("lewis2004-fit/fit.json").read_text(encoding="utf-8"))
    assert "rig" in record["predict"]


def test_friction_and_rig_can_be_given() -> None:
    write_tests([row.replace(",0.46", "") for row in rows(rates())], HEAD.replace(",friction_coefficient", ""))
    Path("rig.toml").write_text('title = "whatever"\n[rig]\npreset = "suros"\ntrack_width = "8 mm"\n')
    result = wearlaw(*FIT, "--friction", "0.45", "--rig", "rig.toml")
    assert result.exit_code == 0, result.stderr
    assert "SUROS" not in result.stderr
    record = json.loads(Path("tests-fit/fit.json").read_text(encoding="utf-8"))
    assert record["predict"]["rig"]["track_width"] == "8.0 mm"
    assert wearlaw(*FIT, "--friction", "0.46", "-o", "other").exit_code == 0
    assert wl.read_law("other/law.toml") != wl.read_law("tests-fit/law.toml")


def test_a_friction_coefficient_that_the_tests_hold_too_is_noted_and_not_used() -> None:
    assert (
        "note: --friction 0.3 is not used, since the tests have a column" in wearlaw(*FIT, "--friction", "0.3").stderr
    )


def test_a_stage_and_a_law_of_another_outcome_are_fitted_from_the_command_line(install: Install) -> None:
    install("own", RUBBED_AND_TIRED)
    law = wl.law("tired")
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.stage("rubbed", factor=0.8) | law
    found = predict(max_pressure="1500 MPa", creepage=Q(CREEPAGE, "%"), friction_coefficient=0.46)
    lines = rows(found["damage"].magnitude)
    write_tests(lines, HEAD.replace("wear_rate [ug/m/mm^2]", "damage [-]"))
    result = wearlaw(
        *("fit", "tests.csv", "--contact", "exact", "--stage", "rubbed:factor=1.2", "--law", "tired"),
        *("--free", "rubbed.factor", "--bootstrap", "0"),
    )
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("Fit to 9 values of damage, 8 degrees of freedom")
    table = pd.read_csv("tests-fit/parameters.csv").set_index("parameter")
    assert table.loc["rubbed.factor", "value"] == pytest.approx(0.8, rel=1e-6)
    assert wl.read_law("tests-fit/law.toml") == law.model_copy(update={"label": "tired fitted to tests"})
    record = json.loads(Path("tests-fit/fit.json").read_text(encoding="utf-8"))
    assert record["provenance"]["stages"] == [{"model": "rubbed", "factor": table.loc["rubbed.factor", "value"]}]
    refused = wearlaw("fit", "tests.csv", "--contact", "exact", "--stage", "rubed", "--free", "factor", "-o", "other")
    assert refused.exit_code != 0
    assert "no stage is called 'rubed'; did you mean 'rubbed'" in refused.output


def test_bounds_keep_a_fit_within_them() -> None:
    """The best q_s is about 55; bounds from 20 to 40 hold it at their upper end, where a note says so."""
    free = tuple("q_s" if argument == "m_m,q_s" else argument for argument in FIT)
    done = wearlaw(*free, "--bounds", "q_s=20 ug/m/mm^2:40 ug/m/mm^2")
    assert done.exit_code == 0, done.output
    assert "the best fit lies at a bound of q_s" in done.stderr
    law: Any = wl.read_law("tests-fit/law.toml")
    assert law.q_s.m_as("ug/m/mm^2") == pytest.approx(40.0, rel=1e-6)  # as near as a fit lies at a bound
    wide = wearlaw(*free, "--bounds", "q_s=20 ug/m/mm^2:80 ug/m/mm^2", "-o", "wide")
    assert "at a bound" not in wide.stderr


def test_predictors_are_ranked_and_the_files_are_listed_as_they_are(folder: Path) -> None:
    result = wearlaw(*COMPARE, "-o", "cmp")
    assert result.exit_code == 0
    assert result.stdout.startswith("5 predictors on 9 tests, best first; rms_error in µg/m/mm²\n")
    ranking = pd.read_csv("cmp/ranking.csv")
    printed = [line.split()[:3] for line in result.stdout.splitlines()[2:7]]
    assert [" ".join(words) for words in printed] == ranking.predictor.tolist()
    assert ranking.rms_factor.is_monotonic_increasing
    assert set(ranking.predictor) == {
        "usfd on global",
        "usfd on exact",
        "kth on global",
        "kth on exact",
        "brr on global",
    }
    assert listed(result, "cmp") == files(folder) - {"tests.csv", "cmp/.wearlaw-files"}
    assert {Path(name).name for name in files(folder / "cmp")} == {
        ".wearlaw-files",
        "ranking.csv", "predictions.csv", "measured_against_predicted.png",
        "comparison.json",
    }  # fmt: skip


def test_the_ranking_is_that_of_the_same_comparison_in_python() -> None:
    assert wearlaw("compare", "tests.csv", "--contacts", "exact", "--laws", "usfd:fitted_for=exact,kth").exit_code == 0
    contact = wl.TwinDisc.suros() | wl.contact_model("exact")
    laws = [wl.wear_law("usfd", fitted_for="exact"), wl.wear_law("kth")]
    direct = wl.compare([contact | law for law in laws], wl.read_tests("tests.csv"))
    written = pd.read_csv("tests-comparison/ranking.csv")
    assert written.predictor.tolist() == ["usfd:fitted_for=exact on exact", "kth on exact"]
    expected = direct.table().drop(columns="predictor").astype(float)
    pd.testing.assert_frame_equal(written.drop(columns="predictor").astype(float), expected, rtol=1e-15)
    predictions = pd.read_csv("tests-comparison/predictions.csv")
    np.testing.assert_allclose(predictions["usfd:fitted_for=exact on exact [ug/m/mm^2]"], rates(), rtol=1e-15)


@pytest.mark.filterwarnings("ignore:outliers")  # with an absolute scatter, the largest rate
@pytest.mark.parametrize("scatter", ["relative", "absolute"])
def test_a_law_can_be_fitted_on_every_contact_before_it_is_compared(scatter: Literal["relative", "absolute"]) -> None:
    result = wearlaw(*COMPARE, "--free", "usfd=q_s,m_c", "--scatter", scatter, "-o", "cmp")
    assert result.exit_code == 0
    ranking = pd.read_csv("cmp/ranking.csv").set_index("predictor")
    fitted = ranking.loc[["usfd fitted on global", "usfd fitted on exact"]]
    assert (fitted.fitted == 2).all()
    assert fitted.aic.notna().all()
    assert ranking.drop(index=fitted.index).aic.isna().all()
    contact = wl.TwinDisc.suros() | wl.contact_model("global")
    tests = wl.read_tests("tests.csv")
    direct = wl.fit(contact | wl.wear_law("usfd"), tests, ["q_s", "m_c"], scatter=scatter, bootstrap=0)
    assert fitted.aic["usfd fitted on global"] == pytest.approx(direct.aic, rel=1e-12)


def test_cross_validation_ranks_fits_by_unseen_tests() -> None:
    command = ("compare", "tests.csv", "--contacts", "exact", "--laws", LAW, "--free", f"{LAW}=m_m,q_s")
    result = wearlaw(*command, "--cross-validate", "leave-one-out", "-o", "cv")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("2 predictors on 9 tests, best first, fits cross-validated (leave-one-out);")
    assert json.loads(Path("cv/comparison.json").read_text(encoding="utf-8"))["cross_validated"] == "leave-one-out"
    assert wearlaw(*command, "-o", "seen").exit_code == 0
    factors = [
        pd.read_csv(f"{folder}/ranking.csv").set_index("predictor").rms_factor[f"{LAW} fitted on exact"]
        for folder in ("seen", "cv")
    ]
    assert factors[0] < factors[1]


ARCHARD = "archard:coefficient=1e-4:hardness=2.6 GPa"


def test_a_law_with_options_is_freed_by_its_name_alone_within_bounds() -> None:
    command = ("compare", "tests.csv", "--contacts", "exact", "--laws", f"usfd,{ARCHARD}", "--free")
    result = wearlaw(*command, "archard=coefficient", "--bounds", "coefficient=1e-9:1e-8", "-o", "cmp")
    assert result.exit_code == 0
    assert f"{ARCHARD} fitted on exact" in pd.read_csv("cmp/ranking.csv").predictor.tolist()
    assert "the best fit lies at a bound of coefficient" in result.stderr
    twice = wearlaw(*command[:5], f"{ARCHARD},archard:coefficient=1e-3:hardness=2 GPa", "--free", "archard=coefficient")
    assert "--free: write it as LAW=FIELDS, with a LAW of archard:coefficient=1e-4" in twice.stderr
    other = wearlaw(*command, "archard=coefficient", "--bounds", "q_s=1:2")
    assert "--bounds: 'q_s' is not free" in other.stderr
