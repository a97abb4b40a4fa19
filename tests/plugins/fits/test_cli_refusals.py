"""What `wearlaw fit` and `wearlaw compare` refuse, and that all files are then as before."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import assert_refused, files, wearlaw
from tests.plugins.fits.cli_data import COMPARE, FIT, HEAD, rates, rows, write_tests

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


def test_a_fit_does_not_replace_a_comparison(folder: Path) -> None:
    assert wearlaw(*COMPARE, "-o", "out").exit_code == 0
    before = files(folder)
    assert_refused(wearlaw(*FIT, "-o", "out", "--overwrite"), "output: 'out' holds results of another command")
    assert files(folder) == before


# Tests and options


@pytest.mark.parametrize("command", [FIT, COMPARE], ids=["fit", "compare"])
@pytest.mark.parametrize(
    ("head", "lines", "message"),
    [
        (HEAD.replace(" [%]", ""), rows(rates()), "'creepage [%]'"),
        (HEAD, [], "tests.csv"),
        (HEAD.replace(",friction_coefficient", ""), [row.replace(",0.46", "") for row in rows(rates())], "friction"),
        (HEAD.replace("wear_rate [ug/m/mm^2]", "traction_coefficient"), rows([0.4] * 9), "wear rate"),
    ],
    ids=["no unit", "no tests", "no friction", "no wear rate"],
)
def test_wrong_tests_are_one_clear_error_and_nothing_is_written(
    folder: Path, command: tuple[str, ...], head: str, lines: list[str], message: str
) -> None:
    write_tests(lines, head)
    assert_refused(wearlaw(*command, "-o", "out"), message)
    assert sorted(path.name for path in folder.iterdir()) == ["tests.csv"]


FIT_START = ("fit", "tests.csv", "--contact", "exact")


@pytest.mark.parametrize(
    ("arguments", "message", "exit_code"),
    [
        (("fit", "absent.csv", *FIT[2:]), "absent.csv", 1),
        ((*FIT_START, "--law", "usdf", "--free", "q_s"), "'usfd'", 1),
        ((*FIT_START, "--law", "usfd", "--free", "q_s", "--fixed", "q_s=9 ug/m/mm^2"), "--fixed: 'q_s'", 2),
        ((*FIT_START, "--law", "usfd", "--free", ","), "--free: ", 2),
        ((*FIT_START, "--law", "usfd:exact", "--free", "q_s"), "usfd:exact", 1),
        ((*FIT_START, "--free", "friction_coefficient"), "traction", 1),
        ((*FIT, "--rig", "rig.toml"), "rig.track: ", 1),
        ((*COMPARE[:-1], ","), "--laws: ", 2),
        (("compare", "tests.csv", "--contacts", "exact", "--laws", "brr"), "brr on exact", 1),
        ((*COMPARE, "--free", "usdf=q_s"), "--free: ", 2),
        ((*COMPARE, "--free", "usfd=q_s", "--free", "usfd=m_m"), "--free: 'usfd'", 2),
    ],
)
def test_a_wrong_option_is_one_clear_error_and_nothing_is_written(
    folder: Path, arguments: tuple[str, ...], message: str, exit_code: int
) -> None:
    Path("rig.toml").write_text('[rig]\npreset = "suros"\ntrack = "8 mm"\n')
    before = files(folder)
    assert_refused(wearlaw(*arguments, "-o", "out"), message, exit_code)
    assert files(folder) == before


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
