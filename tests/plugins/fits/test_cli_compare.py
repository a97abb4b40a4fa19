"""`wearlaw compare`, as a user meets it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.cases import files, wearlaw
from tests.plugins.fits.cli_data import COMPARE, LAW, listed, rates

pytestmark = pytest.mark.usefixtures("blank_figures", "folder_with_tests")


def test_predictors_are_ranked_and_the_files_are_listed_as_they_are(folder: Path) -> None:
    result = wearlaw(*COMPARE, "-o", "cmp", "--latex")
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
        "ranking.csv", "ranking.tex", "predictions.csv", "predictions.tex", "measured_against_predicted.png",
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
