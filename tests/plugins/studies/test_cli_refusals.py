"""What the command line refuses to run or to show, and that nothing is written then."""

from __future__ import annotations

import warnings
from pathlib import Path

import pandas as pd
import pytest

import wearlaw as wl
from tests import cases
from tests.cases import assert_refused, changed, files, table, wearlaw, write
from tests.core.distributions import Install

pytestmark = pytest.mark.usefixtures("folder")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (changed("rig.diameter", 47), "rig.diameter: got the bare number 47, which has no unit; give it in mm"),
        (changed("contact_models", ["exat"]), "contact_models.0: no contact model is called 'exat'; did you mean"),
        (changed("sweeps.creepage.creepage", 1), "creepage: got the bare number 1.0, which has no unit"),
        (changed("sweeps.creepage.normal_force", "1 N"), "give exactly one of normal_force, normal_force_per_width"),
        (changed("sweep", {}), "sweep: unknown field; did you mean 'sweeps'?"),
        (table(contact_models=["exact"], wear_laws=["brr"]), "no contact model can be used with any of"),
        (
            changed("sweeps.creepage.traction_coefficient", 0.1, table(contact_models=["exact"])),
            "sweep 'creepage': no contact model of the case can use a traction_coefficient",
        ),
    ],
)
def test_a_wrong_case_is_one_clear_error_and_nothing_is_written(
    folder: Path, content: cases.Table, message: str
) -> None:
    write(folder / "c.toml", content)
    assert_refused(wearlaw("run", "c.toml", "-o", "new/deep/out"), message)
    assert [path.name for path in folder.iterdir()] == ["c.toml"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "tasini2010"], "there is no case file 'tasini2010'; did you mean 'tassini2010'?"),
        (["run", "."], "cannot read the case file '.'"),
        (["run", "taken.txt"], "case 'taken.txt' is not valid TOML"),
        (["run", "c.toml", "-o", "taken.txt"], "output: 'taken.txt' is a file, not a folder; choose another with -o"),
        (["run", "c.toml", "-o", "taken.txt/out"], "output: cannot write to 'taken.txt/out'"),
        (["run", "c.toml", "-o", "/proc/out"], "output: cannot write to '/proc/out'"),
        (["run", "c.toml", "-o", "full"], "output: 'full' does not hold results of wearlaw"),
        (["run", "c.toml", "-o", "full", "--overwrite"], "output: 'full' does not hold results of wearlaw"),
        (["run", "c.toml", "-o", "."], "output: '.' does not hold results of wearlaw"),
        (["case", "tassini2011"], "there is no case file 'tassini2011'; did you mean 'tassini2010'?"),
        (["show", "usdf"], "no model, material, case, test set or section is called 'usdf'; did you mean 'usfd'?"),
        (
            ["show", "polack"],
            "no model, material, case, test set or section is called 'polack'; did you mean 'polach'?",
        ),
    ],
)
def test_a_wrong_argument_is_one_clear_error_and_nothing_is_written(
    folder: Path, arguments: list[str], message: str
) -> None:
    write(folder / "c.toml", table())
    (folder / "taken.txt").write_text("not TOML")
    (folder / "full").mkdir()
    (folder / "full" / "thesis.tex").write_text("years of work")
    before = files(folder)
    assert_refused(wearlaw(*arguments), message)
    assert files(folder) == before


@pytest.mark.usefixtures("blank_figures")
def test_earlier_results_are_only_replaced_when_asked(folder: Path) -> None:
    write(folder / "c.toml", table(profiles={}))
    assert wearlaw("run", "c.toml").exit_code == 0
    before = {name: (folder / name).stat().st_mtime_ns for name in files(folder)}
    assert_refused(wearlaw("run", "c.toml"), "'c-results' is not empty; choose another folder with -o, or add --over")
    assert {name: (folder / name).stat().st_mtime_ns for name in files(folder)} == before
    write(folder / "c.toml", table(contact_models=["global"], profiles={}))
    assert wearlaw("run", "c.toml", "--overwrite").exit_code == 0
    assert set(pd.read_csv("c-results/results.csv")["contact_model"]) == {"global"}


def test_a_plugin_that_was_left_out_is_named_where_its_model_is_missed(install: Install, folder: Path) -> None:
    install("crumbling", "raise RuntimeError('no licence found')\n", "1.2.3")
    write(folder / "c.toml", table(wear_laws=["crumbling"]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.PluginWarning)
        assert_refused(wearlaw("run", "c.toml"), "left out: crumbling 1.2.3 (plugin 'crumbling'): RuntimeError: no lic")
        assert_refused(wearlaw("show", "crumbling"), "left out: crumbling 1.2.3 (plugin 'crumbling')")
