"""Laws of one's own: under their label in results, and from their files wherever a law can stand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.cases import POINT, files, table, wearlaw, write
from tests.plugins.fits.fits import EXACT, made_up, usfd
from wearlaw_apps.studies.case import case_schema  # private: the schema of cases has no public name

pytestmark = pytest.mark.usefixtures("folder_with_tests", "blank_figures")
UNIT = "ug/m/mm^2"
FIT = ("fit", "tests.csv", "--contact", "exact", "--law", "usfd:fitted_for=exact", "--free", "q_s", "--bootstrap", "0")


@pytest.fixture
def law() -> Any:
    """Fit a law on the command line and return it."""
    result = wearlaw(*FIT, "--friction", "0.46", "--label", "our tests", "-o", "fit")
    assert result.exit_code == 0, result.output
    return wl.read_law("fit/law.toml")


def test_a_fitted_law_is_compared_under_its_label_and_still_knows_its_tests(law: Any) -> None:
    assert law.label == "our tests"
    laws = "usfd,fit/law.toml,fit/law.toml:label=again"
    result = wearlaw("compare", "tests.csv", "--contacts", "exact", "--laws", laws, "--friction", "0.46", "-o", "cmp")
    assert result.exit_code == 0, result.output
    assert "note: fitted to these tests, which flatters their rank: our tests on exact (9 of 9)" in result.stderr
    ranking = pd.read_csv("cmp/ranking.csv").set_index("predictor")
    assert ranking.in_sample.to_dict() == {"usfd on exact": 0, "our tests on exact": 9, "again on exact": 9}


def test_a_case_takes_a_law_file_beside_it_and_its_results_need_the_file_no_more(law: Any) -> None:
    Path("cases").mkdir()
    Path("fit").rename("cases/fit")
    own = ["fit/law.toml", {"model": "fit/law.toml", "label": "half", "q_s": f"{law.q_s.m_as(UNIT) / 2!r} {UNIT}"}]
    case = table(contact_models=["exact"], wear_laws=[*own, "usfd"], sweeps={"point": POINT}, profiles={})
    jsonschema.Draft202012Validator(case_schema()).validate(case)
    write(Path("cases/case.toml"), case)
    assert wearlaw("run", "cases/case.toml", "-o", "out").exit_code == 0
    found = pd.read_csv("out/results.csv").set_index("wear_law")["wear_rate [ug/m/mm^2]"]
    assert list(found.index) == ["our tests", "half", "usfd"]
    given: Any = POINT
    for name, one in (("our tests", law), ("half", law.model_copy(update={"q_s": law.q_s / 2}))):
        assert found[name] == pytest.approx((EXACT | one)(**given).wear_rate.m_as("ug/m/mm^2"), rel=1e-12)
    Path("cases/fit/law.toml").unlink()
    assert wearlaw("run", "out/case.toml", "-o", "again").exit_code == 0
    np.testing.assert_array_equal(found, pd.read_csv("again/results.csv")["wear_rate [ug/m/mm^2]"])


def test_a_law_file_that_is_missing_or_of_another_outcome_is_named(law: Any) -> None:  # noqa: ARG001
    write(Path("case.toml"), table(wear_laws=["fitt/law.toml"]))
    result = wearlaw("run", "case.toml")
    assert result.exit_code != 0
    assert "wear_laws.0" in result.output
    assert "fitt/law.toml" in result.output
    write(Path("case.toml"), table(wear_laws=["usfd"], laws=["fit/law.toml"]))
    assert "laws.0" in wearlaw("run", "case.toml").output
    assert "case-results" not in files(Path())


def test_labels_name_laws_in_comparisons_and_uncertainties_and_must_differ() -> None:
    tests = made_up(usfd("exact"), 0.1)
    one, two = (wl.wear_law("usfd", fitted_for="exact", label=label) for label in ("first", "second"))
    names = [each.names.label for each in wl.compare([EXACT | one, EXACT | two], tests).compared]
    assert names == ["first on exact", "second on exact"]
    fit = wl.fit(EXACT | one, tests, ["q_s"], bootstrap=50)
    assert fit.law is not None
    assert fit.law.label == "first"
    u = wl.uncertainty(fit, max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46, samples=8)
    assert "first" in u.figure_data().title
    assert "label='first'" in repr(one)
    assert "label" not in repr(wl.wear_law("usfd"))
    with pytest.raises(wl.InputError, match="first"):
        wl.compare([EXACT | one, EXACT | one.model_copy(update={"q_s": "50 ug/m/mm^2"})], tests)
