"""What `wearlaw fit` and `wearlaw compare` refuse, and that all files are then as before."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.core.cases import assert_refused, files, full_disk, wearlaw
from tests.core.cli_data import COMPARE, FIT, HEAD, rates, rows, write_tests

pytestmark = pytest.mark.usefixtures("blank_figures", "folder_with_tests")


# Folders


@pytest.mark.parametrize("command", [FIT, COMPARE], ids=["fit", "compare"])
def test_earlier_results_are_only_replaced_where_that_is_asked_for(folder: Path, command: tuple[str, ...]) -> None:
    assert wearlaw(*command, "-o", "out").exit_code == 0
    before = {name: (folder / name).read_bytes() for name in files(folder)}
    assert_refused(wearlaw(*command, "-o", "out"), "output: 'out' is not empty; choose another folder with -o, or add")
    assert {name: (folder / name).read_bytes() for name in files(folder)} == before
    (folder / "out" / "mine").write_text("precious")
    assert wearlaw(*command, "-o", "out", "--overwrite").exit_code == 0
    after = {name: (folder / name).read_bytes() for name in files(folder)}
    assert after == {**before, str(Path("out") / "mine"): b"precious"}


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
    monkeypatch.setattr("wearlaw.output.analyses.save_figure", full_disk)  # after tables were written
    result = wearlaw(*command, "-o", "out", "--overwrite")
    assert_refused(result, "output: cannot write the results: No space left on device")
    assert {name: (folder / name).read_bytes() for name in files(folder)} == before
    assert {path.name for path in folder.iterdir()} == {"tests.csv", "out"}


def test_a_fit_does_not_replace_a_comparison(folder: Path) -> None:
    assert wearlaw(*COMPARE, "-o", "out").exit_code == 0
    before = files(folder)
    assert_refused(wearlaw(*FIT, "-o", "out", "--overwrite"), "output: 'out' holds results of another command")
    assert files(folder) == before


# Tests and options


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
        ((*FIT, "--confidence", "95"), "confidence: must be a number between 0 and 1", 1),
        ((*FIT, "--seed", "-1"), "seed: must be a whole number that is not negative, got -1", 1),
        ((*FIT[:-1], "1"), "bootstrap: must be at least 40", 1),
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
        (
            (*COMPARE, "--free", "usfd=q_s", "--free", "usfd=m_m"),
            "--free: 'usfd' is given twice; write all its fields",
            2,
        ),
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


@pytest.mark.parametrize(
    ("law", "form"),
    [
        ("archard", 'archard:coefficient=1e-4:hardness="2.6 GPa"'),
        ("archard:hardness=3 GPa", 'archard:coefficient=1e-4:hardness="3 GPa"'),
        ("energy", 'energy:mass_per_energy="1 ug/J"'),
    ],
)
def test_a_missing_field_of_a_law_shows_the_form_of_the_command_line(law: str, form: str) -> None:
    result = wearlaw("compare", "tests.csv", "--contacts", "exact", "--laws", law, "-o", "out")
    assert_refused(result, f"is missing; write the law as {form}")
