"""`wearlaw fit` and `wearlaw compare`, as a user meets them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
import pytest
from click.testing import Result

import wearlaw as wl
from tests.core import cases
from tests.core.cases import assert_refused, files, wearlaw
from wearlaw import Q

pytestmark = pytest.mark.usefixtures("blank_figures")

CREEPAGE = [0.2, 0.5, 1.0, 2.0, 5.0, 12.0, 16.0, 18.0, 20.0]
SCATTER = [1.1, 0.9, 1.05, 0.97, 1.02, 0.93, 1.08, 0.99, 0.98]
HEAD = "creepage [%],max_pressure [MPa],friction_coefficient,wear_rate [ug/m/mm^2]"
LAW = "usfd:fitted_for=exact"
FIT = ("fit", "tests.csv", "--contact", "exact", "--law", LAW, "--free", "m_m,q_s", "--bootstrap", "0")
COMPARE = ("compare", "tests.csv", "--contacts", "global,exact", "--laws", "usfd,kth,brr")
RIG_NOTE = "note: the rig is taken to be SUROS, 47 mm steel discs and a track of 10 mm; give yours with --rig\n"


def rates(**options: Any) -> Any:
    """Return what the tests of this module would measure without scatter."""
    law = wl.wear_law("usfd", **{"fitted_for": "exact", **options})
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | law
    return predict(max_pressure="1500 MPa", creepage=Q(CREEPAGE, "%"), friction_coefficient=0.46).wear_rate.magnitude


def rows(values: Any) -> list[str]:
    return [f"{xi},1500,0.46,{rate!r}" for xi, rate in zip(CREEPAGE, np.asarray(values).tolist(), strict=True)]


def write_tests(lines: list[str], head: str = HEAD, name: str = "tests.csv") -> None:
    Path(name).write_text("\n".join([head, *lines, ""]), encoding="utf-8")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in a folder with a file of tests."""
    here = cases.spaced_folder(tmp_path, monkeypatch)
    write_tests(rows(rates() * SCATTER))
    return here


def listed(result: Result, folder: str) -> set[str]:
    """Return the files that the output lists."""
    return {line.strip() for line in result.stdout.partition(f"Results in {folder}:\n")[2].splitlines()}


# fit


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
    assert listed(result, "my fit") == files(folder) - {"tests.csv"}
    assert files(folder / "my fit") == {"law.toml", "parameters.csv", "residuals.csv", "fit.png", "fit.json"}
    assert (folder / "my fit" / "fit.png").read_bytes().startswith(b"\x89PNG")


def test_what_is_not_fitted_and_the_rig_that_is_taken_are_noted() -> None:
    notes = wearlaw(*FIT).stderr
    assert notes.startswith(RIG_NOTE)
    assert "note: fit: not fitted, m_c = 83.70 µg/m/N, tr_sc = 95.00 N/mm²\n" in notes


def test_the_files_of_a_fit_hold_what_it_found() -> None:
    assert wearlaw(*FIT, "--fixed", "tr_sc=94 N/mm^2", "--confidence", "0.8").exit_code == 0
    law: Any = wl.read_wear_law("tests-fit/law.toml")
    table = pd.read_csv("tests-fit/parameters.csv").set_index("parameter")
    record = json.loads(Path("tests-fit/fit.json").read_text(encoding="utf-8"))
    assert list(table.index) == ["m_m", "q_s"]
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


def test_a_fitted_law_is_taken_where_a_law_is_asked_for() -> None:
    assert wearlaw(*FIT).exit_code == 0
    compared = wearlaw("compare", "tests.csv", "--contacts", "exact", "--laws", "tests-fit/law.toml", "-o", "cmp")
    assert compared.exit_code == 0
    assert "\n  tests-fit/law.toml on exact " in compared.stdout
    again = wearlaw("fit", "tests.csv", "--contact", "exact", "--law", "tests-fit/law.toml", "--free", "q_s",
                    "--fixed", "m_m=6 ug/m/N", "--bootstrap", "0", "-o", "again")  # fmt: skip
    assert again.exit_code == 0
    refitted: Any = wl.read_wear_law("again/law.toml")
    assert refitted.m_m == Q(6.0, "ug/m/N")


def test_the_settings_of_a_fit_are_those_of_the_options() -> None:
    options = ("--bootstrap", "30", "--seed", "7", "--scatter", "absolute", "--latex", "--figure-format", "pdf")
    assert wearlaw(*FIT[:-2], *options).exit_code == 0
    found = json.loads(Path("tests-fit/fit.json").read_text(encoding="utf-8"))["provenance"]
    assert (found["bootstrap"], found["seed"], found["scatter"]) == (30, 7, "absolute")
    assert Path("tests-fit/parameters.tex").read_text().startswith("% \\usepackage{booktabs}")
    assert Path("tests-fit/residuals.tex").exists()
    assert Path("tests-fit/fit.pdf").read_bytes().startswith(b"%PDF")
    assert not Path("tests-fit/fit.png").exists()


def test_the_friction_coefficient_is_fitted_to_traction_without_a_law() -> None:
    result = wearlaw("fit", "lewis2004", "--contact", "exact", "--free", "friction_coefficient", "--bootstrap", "0")
    assert result.exit_code == 0
    assert "friction_coefficient" in result.stdout
    assert files(Path("lewis2004-fit")) == {"parameters.csv", "residuals.csv", "fit.png", "fit.json"}
    record = json.loads(Path("lewis2004-fit/fit.json").read_text(encoding="utf-8"))
    assert "rig" in record["predict"]


def test_friction_and_rig_can_be_given() -> None:
    write_tests([row.replace(",0.46", "") for row in rows(rates())], HEAD.replace(",friction_coefficient", ""))
    Path("rig.toml").write_text('title = "whatever"\n[rig]\npreset = "suros"\ntrack_width = "8 mm"\n')
    result = wearlaw(*FIT, "--friction", "0.45", "--rig", "rig.toml")
    assert result.exit_code == 0, result.stderr
    assert "SUROS" not in result.stderr
    record = json.loads(Path("tests-fit/fit.json").read_text(encoding="utf-8"))
    assert record["predict"]["contact"]["rig"]["track_width"] == "8.0 mm"
    assert wearlaw(*FIT, "--friction", "0.46", "-o", "other").exit_code == 0
    assert wl.read_wear_law("other/law.toml") != wl.read_wear_law("tests-fit/law.toml")


def test_a_friction_coefficient_that_the_tests_hold_too_is_noted_and_not_used() -> None:
    assert (
        "note: --friction 0.3 is not used, since the tests have a column" in wearlaw(*FIT, "--friction", "0.3").stderr
    )
    assert wearlaw(*FIT, "-o", "without").exit_code == 0
    assert wl.read_wear_law("without/law.toml") == wl.read_wear_law("tests-fit/law.toml")


def test_progress_of_the_bootstrap_is_shown_on_a_terminal_and_not_elsewhere() -> None:
    arguments = [*FIT[:-2], "--bootstrap", "20"]
    assert "fitting" not in wearlaw(*arguments).stderr
    on_terminal = wearlaw(*arguments, "--overwrite", FORCE_COLOR="1", TERM="xterm")
    assert "fitting" in on_terminal.stderr
    assert "20/20" in on_terminal.stderr


# compare


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
    assert listed(result, "cmp") == files(folder) - {"tests.csv"}
    assert {Path(name).name for name in files(folder / "cmp")} == {
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


def test_what_is_left_out_or_fitted_for_another_contact_is_noted_and_recorded() -> None:
    result = wearlaw(*COMPARE, "-o", "cmp")
    rig, calibration, left_out = result.stderr.splitlines()
    assert rig + "\n" == RIG_NOTE
    assert calibration.startswith("note: usfd on exact: the parameters of wear law 'usfd' were fitted for patch means")
    assert left_out.startswith("note: brr on exact is left out: ")
    record = json.loads(Path("cmp/comparison.json").read_text(encoding="utf-8"))
    assert [f"note: {note}" for note in record["notes"]] == result.stderr.splitlines()
    assert wl.Pipeline.model_validate(record["predictors"]["kth on exact"]).wear_law == wl.wear_law("kth")


def test_what_the_comparison_notes_is_printed_and_recorded() -> None:
    write_tests([*rows(rates()), "3,1500,0.46,NA"])
    result = wearlaw(*COMPARE, "-o", "cmp")
    note = "1 of 10 tests have no wear rate and are left out"
    assert f"note: {note}\n" in result.stderr
    assert note in json.loads(Path("cmp/comparison.json").read_text(encoding="utf-8"))["notes"]


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


def test_options_follow_the_name_of_a_model() -> None:
    result = wearlaw("compare", "tests.csv", "--contacts", "fastsim:bound=elliptic:flexibility=kalker", "--laws", "kth")
    assert result.exit_code == 0
    record = json.loads(Path("tests-comparison/comparison.json").read_text(encoding="utf-8"))
    (pipeline,) = record["predictors"].values()
    assert (
        pipeline["contact"]["contact_model"] | {"bound": "elliptic", "flexibility": "kalker"}
        == (pipeline["contact"]["contact_model"])
    )


def test_a_fit_that_the_tests_do_not_determine_on_one_contact_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    fit = wl.fit

    def refuse_global(predict: Any, *arguments: Any, **options: Any) -> wl.Fit:
        if predict.contact.contact_model.name == "global":
            raise wl.FitError("no test determines it")
        return fit(predict, *arguments, **options)

    monkeypatch.setattr("wearlaw.fitting.fit.fit", refuse_global)
    result = wearlaw(*COMPARE, "--free", "usfd=q_s")
    assert result.exit_code == 0
    assert "note: usfd fitted on global is left out: no test determines it\n" in result.stderr
    assert "usfd fitted on exact" in result.stdout


# Folders


@pytest.mark.parametrize("command", [FIT, COMPARE], ids=["fit", "compare"])
def test_earlier_results_are_only_replaced_where_that_is_asked_for(folder: Path, command: tuple[str, ...]) -> None:
    assert wearlaw(*command, "-o", "out").exit_code == 0
    before = {name: (folder / name).read_bytes() for name in files(folder)}
    assert_refused(wearlaw(*command, "-o", "out"), "output: 'out' is not empty; choose another folder with -o, or add")
    assert {name: (folder / name).read_bytes() for name in files(folder)} == before
    (folder / "out" / "old").write_text("")
    assert wearlaw(*command, "-o", "out", "--overwrite").exit_code == 0
    assert {name: (folder / name).read_bytes() for name in files(folder)} == before


@pytest.mark.parametrize("flag", [[], ["--overwrite"]])
@pytest.mark.parametrize("command", [FIT, COMPARE], ids=["fit", "compare"])
@pytest.mark.parametrize("other", ["mine.txt", "results.nc"])
def test_a_folder_with_other_results_is_never_touched(
    folder: Path, command: tuple[str, ...], other: str, flag: list[str]
) -> None:
    (folder / "out").mkdir()
    (folder / "out" / other).write_text("precious")
    assert_refused(wearlaw(*command, "-o", "out", *flag), "output: 'out' does not hold results of wearlaw")
    assert files(folder) == {"tests.csv", str(Path("out") / other)}
    assert (folder / "out" / other).read_text() == "precious"


@pytest.mark.parametrize("command", [FIT, COMPARE], ids=["fit", "compare"])
def test_a_full_disk_is_one_clear_error_and_leaves_earlier_results_as_they_were(
    folder: Path, monkeypatch: pytest.MonkeyPatch, command: tuple[str, ...]
) -> None:
    assert wearlaw(*command, "-o", "out").exit_code == 0
    before = {name: (folder / name).read_bytes() for name in files(folder)}

    def full(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("wearlaw.data_output.save_figure", full)  # after tables were written
    result = wearlaw(*command, "-o", "out", "--overwrite")
    assert_refused(result, "output: cannot write the results: No space left on device")
    assert {name: (folder / name).read_bytes() for name in files(folder)} == before
    assert {path.name for path in folder.iterdir()} == {"tests.csv", "out"}


def test_a_fit_does_not_replace_a_comparison(folder: Path) -> None:
    assert wearlaw(*COMPARE, "-o", "out").exit_code == 0
    before = files(folder)
    assert_refused(wearlaw(*FIT, "-o", "out", "--overwrite"), "output: 'out' does not hold results of wearlaw")
    assert files(folder) == before


# What is wrong

WRONG_TESTS = {
    "no units": (HEAD.replace(" [%]", ""), rows(rates()), "has no unit; write it as 'creepage [%]'"),
    "unknown column": (HEAD.replace("wear_rate", "wear"), rows(rates()), "did you mean 'wear_rate'?"),
    "negative wear": (HEAD, [*rows(rates())[:-1], "20,1500,0.46,-3"], "which must not be negative"),
    "creepage in the thousands": (HEAD, [*rows(rates())[:-1], "2000,1500,0.46,3"], "must not exceed 100 %"),
    "two columns of one meaning": (
        f"{HEAD},wear_rate [mg/m/mm^2]",
        [f"{row},1" for row in rows(rates())],
        "wear_rate",
    ),
    "two loads": (f"{HEAD},normal_force [kN]", [f"{row},7" for row in rows(rates())], "exactly one load"),
    "no tests": (HEAD, [], "tests.csv"),
    "no friction": (
        HEAD.replace(",friction_coefficient", ""),
        [row.replace(",0.46", "") for row in rows(rates())],
        "friction_coefficient: the tests do not hold it",
    ),
    "no wear rate": (HEAD.replace("wear_rate [ug/m/mm^2]", "traction_coefficient"), rows([0.4] * 9), "wear rate"),
}


@pytest.mark.parametrize("wrong", WRONG_TESTS)
@pytest.mark.parametrize("command", [FIT, COMPARE], ids=["fit", "compare"])
def test_wrong_tests_are_one_clear_error_and_nothing_is_written(
    folder: Path, command: tuple[str, ...], wrong: str
) -> None:
    head, lines, message = WRONG_TESTS[wrong]
    write_tests(lines, head)
    assert_refused(wearlaw(*command, "-o", "out"), message)
    assert files(folder) == {"tests.csv"}
    assert sorted(path.name for path in folder.iterdir()) == ["tests.csv"]


FIT_START = ("fit", "tests.csv", "--contact", "exact")


@pytest.mark.parametrize(
    ("arguments", "message", "exit_code"),
    [
        (("fit", "absent.csv", *FIT[2:]), "absent.csv", 1),
        ((*FIT_START, "--law", "usdf", "--free", "q_s"), "no wear law is called 'usdf'; did you mean 'usfd'?", 1),
        (("fit", "tests.csv", "--contact", "exat", *FIT[4:]), "no contact model is called 'exat'; did you mean", 1),
        ((*FIT_START, "--law", "usfd", "--free", "q_m"), "no number 'q_m'; did you mean", 1),
        ((*FIT_START, "--law", "usfd", "--free", "q_s", "--fixed", "q=1"), "usfd: q: unknown field", 1),
        ((*FIT_START, "--law", "usfd", "--free", "q_s", "--fixed", "q_s"), "--fixed: write it as FIELD=VALUE", 2),
        ((*FIT_START, "--law", "usfd", "--free", "q_s", "--fixed", "q_s=9 ug/m/mm^2"), "'q_s' is to be fitted", 2),
        ((*FIT_START, "--law", "usfd", "--free", ","), "--free: name at least one, got ','", 2),
        ((*FIT_START, "--law", "usfd:exact", "--free", "q_s"), "usfd:exact: write it as FIELD=VALUE, got 'exact'", 2),
        ((*FIT_START, "--free", "q_s"), "q_s", 1),
        ((*FIT_START, "--free", "friction_coefficient"), "the tests hold none", 1),
        ((*FIT_START, "--law", "brr", "--free", "k"), "wear law 'brr' is stated for the means of the whole patch", 1),
        ((*FIT_START, "--law", "absent.toml", "--free", "q_s"), "cannot read wear law 'absent.toml'", 1),
        ((*FIT, "--confidence", "95"), "confidence: must lie between 0 and 1", 1),
        ((*FIT, "--rig", "absent.toml"), "cannot read the rig 'absent.toml'", 1),
        ((*FIT, "--rig", "tests.csv"), "the rig 'tests.csv' is not valid TOML", 1),
        ((*FIT, "--rig", "rig.toml"), "the rig 'rig.toml' is wrong in:\n  rig.track: unknown field", 1),
        ((*FIT, "--rig", "empty.toml"), "the rig 'empty.toml' is wrong in:\n  rig: ", 1),
        ((*COMPARE[:-1], "usfd,usdf"), "no wear law is called 'usdf'; did you mean 'usfd'?", 1),
        ((*COMPARE[:-1], ","), "--laws: name at least one, got ','", 2),
        (("compare", "tests.csv", "--contacts", "exact", "--laws", "brr"), "no contact model can be used with any", 1),
        ((*COMPARE, "--free", "q_s"), "--free: write it as LAW=FIELDS, with a LAW of usfd,kth,brr, got 'q_s'", 2),
        ((*COMPARE, "--free", "usdf=q_s"), "--free: write it as LAW=FIELDS, with a LAW of usfd,kth,brr, got", 2),
        ((*COMPARE, "--free", "usfd=q_m"), "no number 'q_m'; did you mean", 1),
        ((*COMPARE, "--free", "usfd="), "--free: name at least one, got ''", 2),
    ],
)
def test_a_wrong_option_is_one_clear_error_and_nothing_is_written(
    folder: Path, arguments: tuple[str, ...], message: str, exit_code: int
) -> None:
    Path("rig.toml").write_text('[rig]\npreset = "suros"\ntrack = "8 mm"\n')
    Path("empty.toml").write_text("")
    before = files(folder)
    assert_refused(wearlaw(*arguments, "-o", "out"), message, exit_code)
    assert files(folder) == before


def test_fewer_tests_than_parameters_are_refused(folder: Path) -> None:
    write_tests(rows(rates())[:2])
    result = wearlaw(*FIT[:-3], "m_m,q_s", "-o", "out")
    assert_refused(result, "2 measurements cannot tell 2 parameters")
    assert files(folder) == {"tests.csv"}


@pytest.mark.parametrize("command", ["fit", "compare"])
def test_help_teaches_by_example(command: str) -> None:
    printed = wearlaw(command, "--help").stdout
    assert f"wearlaw {command} my-tests.csv --contact" in printed
    assert "creepage [%]" in printed
    for option in ("--friction", "--rig", "--free", "--overwrite", "-o, --output"):
        assert option in printed
