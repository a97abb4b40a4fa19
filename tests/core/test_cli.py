"""The command line, as a user meets it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray

import wearlaw as wl
from tests.core import cases
from tests.core.cases import assert_refused, changed, files, table, wearlaw, write
from tests.core.distributions import Install
from wearlaw.case import case_schema, case_text


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return cases.spaced_folder(tmp_path, monkeypatch)


# run


@pytest.mark.usefixtures("blank_figures")
def test_a_study_is_run_and_its_files_are_listed_as_they_are(folder: Path) -> None:
    write(folder / "my case.toml", table())
    result = wearlaw("run", "my case.toml", "-o", "out folder")
    assert result.exit_code == 0
    assert f"\nComputed with wearlaw {wl.__version__}\nResults in out folder:\n" in result.stdout
    listing = result.stdout.partition("Results in out folder:\n")[2].splitlines()
    assert {line.strip() for line in listing} == files(folder) - {"my case.toml"}
    assert listing[0] == "  out folder/report.html"
    assert len(listing) == 4 + 3 + 3 + 1
    notes = result.stderr.splitlines()
    assert len(notes) == 2
    assert notes[0].startswith("note: usfd on exact: the parameters of wear law 'usfd' were fitted for patch means")
    assert notes[1].startswith("note: brr on exact is left out: ")


@pytest.mark.usefixtures("blank_figures")
def test_results_go_into_a_folder_named_after_the_case(folder: Path) -> None:
    (folder / "cases").mkdir()
    write(folder / "cases" / "mine.toml", table(wear_laws=["usfd"], contact_models=["global"], profiles={}))
    assert wearlaw("run", "cases/mine.toml").exit_code == 0
    assert (folder / "mine-results" / "results.nc").is_file()


def rows_of(printed: str) -> dict[str, list[str]]:
    """Return the cells of the printed table's rows by their heads."""
    rows = [line.rsplit(maxsplit=5) for line in printed.splitlines() if line.startswith(" ")]
    return {row[0].strip(): row[1:] for row in rows if len(row) == 6}


@pytest.mark.usefixtures("blank_figures")
def test_the_short_table_shows_the_rates_and_the_band(folder: Path) -> None:
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["usfd", "kth"], profiles={}))
    printed = wearlaw("run", "c.toml").stdout
    assert "Sweep 'creepage': wear rate [µg/m/mm²] by creepage [%]" in printed
    rows = rows_of(printed)
    csv = pd.read_csv("c-results/results.csv").groupby("wear_law")
    for head, law, column in [
        ("usfd on exact", "usfd", "wear_rate"),
        ("kth on exact", "kth", "wear_rate"),
        ("kth on exact, low end", "kth", "wear_rate_low"),
        ("kth on exact, high end", "kth", "wear_rate_high"),
    ]:
        rates = csv.get_group(law)[f"{column} [ug/m/mm^2]"]
        assert rows[head] == [f"{rate:.4g}" for rate in rates]
    assert len(rows) == 4


@pytest.mark.usefixtures("blank_figures")
def test_the_short_table_keeps_its_numbers_whole_beside_long_names(folder: Path) -> None:
    models: list[Any] = [
        {"model": "fastsim", "bound": bound, "flexibility": "kalker"} for bound in ("parabolic", "elliptic")
    ]
    models.append({"model": "global", "total_from": "fastsim"})
    models.append({"model": "global", "total_from": {"model": "fastsim", "bound": "elliptic"}})
    write(folder / "c.toml", table(contact_models=models, wear_laws=["kth"], profiles={}))
    printed = wearlaw("run", "c.toml", columns=80).stdout
    for rate in pd.read_csv("c-results/results.csv")["wear_rate [ug/m/mm^2]"]:
        assert f"{rate:.4g}" in printed
    assert "…" not in printed


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize("creepage", ["0.5 %", "0 %", ["1 %", "2 %"]])
def test_short_sweeps_have_a_short_table(folder: Path, creepage: Any) -> None:
    write(folder / "c.toml", table(sweeps={"short": {**cases.POINT, "creepage": creepage}}, wear_laws=["usfd"]))
    result = wearlaw("run", "c.toml")
    assert result.exit_code == 0
    row = next(line for line in result.stdout.splitlines() if line.startswith(" usfd on exact"))
    rates = pd.read_csv("c-results/results.csv").query("contact_model == 'exact'")["wear_rate [ug/m/mm^2]"]
    assert row.split()[3:] == [f"{rate:.4g}" for rate in rates]


@pytest.mark.usefixtures("blank_figures")
def test_progress_is_shown_on_a_terminal_and_not_elsewhere(folder: Path) -> None:
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["kth"], profiles={}))
    assert wearlaw("run", "c.toml").stderr == ""
    on_terminal = wearlaw("run", "c.toml", "--overwrite", FORCE_COLOR="1", TERM="xterm")
    assert "evaluating" in on_terminal.stderr
    assert "15/15" in on_terminal.stderr  # 5 points, and the band of KTH
    assert "writing the report" in on_terminal.stderr


@pytest.mark.usefixtures("blank_figures")
def test_units_that_look_like_markup_are_printed(folder: Path) -> None:
    load = {"normal_force_per_width": ["700 kN/m", "800 kN/m"], "creepage": "1 %", "friction_coefficient": 0.4}
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["kth"], profiles={}, sweeps={"load": load}))
    assert "by normal force per width [kN/m]" in " ".join(wearlaw("run", "c.toml").stdout.split())


@pytest.mark.usefixtures("blank_figures")
def test_figures_and_tables_are_written_in_the_formats_that_are_asked_for(folder: Path) -> None:
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["usfd"], profiles={}))
    result = wearlaw("run", "c.toml", "--figure-format", "svg", "--figure-format", "pdf", "--latex")
    assert result.exit_code == 0
    written = {path.removeprefix("c-results/") for path in files(folder) if path.startswith("c-results")}
    figures = {path for path in written if path.startswith("figures")}
    assert {path.partition(".")[2] for path in figures} == {"svg", "pdf"}
    assert len(figures) == 2 * 3
    tables = {path for path in written if path.startswith("tables")}
    assert {path.partition(".")[0] for path in tables} == {
        *("tables/wear_rate_creepage", "tables/parameters", "tables/models")
    }
    assert len(tables) == 2 * 3


def test_an_unknown_figure_format_is_refused_with_the_known_ones(folder: Path) -> None:
    write(folder / "c.toml", table())
    refused = wearlaw("run", "c.toml", "--figure-format", "gif")
    assert_refused(refused, "'gif' is not one of 'png', 'pdf', 'svg'", exit_code=2)


@pytest.mark.usefixtures("blank_figures")
def test_the_shipped_study_and_a_copy_of_its_file_give_equal_results(folder: Path) -> None:
    """The copy is made and run as from a shell, with figures and with every warning an error."""
    program = Path(sys.executable).parent / "wearlaw"
    script = f"'{program}' case tassini2010 > 'my case.toml' && '{program}' run 'my case.toml' -o copy"
    environment = {**os.environ, "PYTHONWARNINGS": "error"}
    done = subprocess.run(script, shell=True, env=environment, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 0, done.stderr
    assert (folder / "my case.toml").read_text(encoding="utf-8") == case_text("tassini2010")
    shipped = wearlaw("run", "tassini2010")
    assert shipped.exit_code == 0
    assert shipped.stdout.replace("tassini2010-results", "copy").split() == done.stdout.split()
    assert shipped.stderr == done.stderr
    assert files(folder / "tassini2010-results") == files(folder / "copy")
    for name in ("results.csv", "case.toml"):
        assert (folder / "copy" / name).read_bytes() == (folder / "tassini2010-results" / name).read_bytes()
    ours = xarray.open_datatree("tassini2010-results/results.nc", engine="h5netcdf")
    theirs = xarray.open_datatree("copy/results.nc", engine="h5netcdf")
    with ours, theirs:
        xarray.testing.assert_equal(ours, theirs)
        for group in (group for group in ours.groups if ours[group].attrs):
            said, copied = (json.loads(tree[group].attrs["provenance"]) for tree in (ours, theirs))
            assert said.pop("cases") == {"tassini2010": f"wearlaw {wl.__version__}"}
            assert copied.pop("cases") == {}
            assert said == copied
        sweep = ours["sweeps/creepage"].to_dataset()
        rates = sweep.wear_rate.sel(creepage=25.0, method="nearest")
        # Half a digit of the converged integrals that tests/test_numbers.py computes anew.
        for pair, rate in {"usfd on global": 3658.9, "usfd on exact": 3825.0, "usfd on fastsim": 4148.6}.items():
            np.testing.assert_allclose(rates.sel(pair=pair), rate, rtol=0, atol=0.05)
        assert dict(sweep.sizes) == {"pair": 7, "contact_model": 3, "creepage": 600}
        assert ours["sweeps/load"].sizes["normal_force_per_width"] == 300


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
        (["run", "c.toml", "-o", "."], "output: '.' is the working folder"),
        (["case", "tassini2011"], "there is no case file 'tassini2011'; did you mean 'tassini2010'?"),
        (["show", "usdf"], "no model is called 'usdf'; did you mean 'usfd'?"),
        (["show", "polack"], "no model is called 'polack'; did you mean 'polach'?"),
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


@pytest.mark.parametrize("arguments", [["nonsense"], ["run"], ["run", "a", "b"], ["run", "a", "--nonsense"]])
def test_a_wrong_use_says_where_help_is(arguments: list[str]) -> None:
    result = wearlaw(*arguments)
    assert_refused(result, "Try 'main", exit_code=2)


# case, schema, show, help


@pytest.mark.parametrize("charset", ["utf-8", "cp1252", "ascii"])
def test_a_case_file_is_printed_byte_for_byte_whatever_the_terminal_speaks(folder: Path, charset: str) -> None:
    result = wearlaw("case", "tassini2010", charset=charset)
    assert result.exit_code == 0
    assert result.stdout_bytes == case_text("tassini2010").encode()
    assert not case_text("tassini2010").isascii(), "something beyond ASCII is needed here"
    (folder / "own.toml").write_bytes(result.stdout_bytes)
    assert wearlaw("case", "own.toml").stdout_bytes == result.stdout_bytes


def test_the_schema_is_printed_as_json() -> None:
    result = wearlaw("schema")
    assert result.exit_code == 0
    assert json.loads(result.stdout) == case_schema()
    assert json.loads(result.stdout)["$schema"] == "https://json-schema.org/draft/2020-12/schema"


@pytest.mark.parametrize("name", [*wl.contact_models(), *wl.wear_laws()])
@pytest.mark.parametrize("charset", ["utf-8", "cp1252"])
def test_every_model_is_explained_also_where_there_are_no_greek_letters(name: str, charset: str) -> None:
    result = wearlaw("show", name, charset=charset)
    assert result.exit_code == 0
    assert result.stdout.startswith(f"{name}: a ")
    assert "source: " in result.stdout
    assert "declares:\n  " in result.stdout


def test_the_version_is_that_of_the_package() -> None:
    assert wearlaw("--version").stdout == f"wearlaw, version {wl.__version__}\n"


@pytest.mark.parametrize("flag", ["-h", "--help"])
def test_help_says_how_to_begin_and_every_command_has_its_own(flag: str) -> None:
    result = wearlaw(flag)
    assert result.exit_code == 0
    assert "wearlaw run tassini2010 " in result.stdout
    assert "wearlaw case tassini2010 > my.toml" in result.stdout
    for command in ("run", "case", "fit", "compare", "plugins", "show", "schema", "new-plugin", "check"):
        assert f"\n  {command} " in result.stdout
        own = wearlaw(command, flag)
        assert own.exit_code == 0
        assert own.stdout.startswith(f"Usage: main {command} ")
    for option in ("-o, --output", "--overwrite"):
        assert option in wearlaw("run", flag).stdout


# plugins


def test_all_models_are_listed_with_their_distribution_and_version() -> None:
    result = wearlaw("plugins")
    assert result.exit_code == 0
    head, *rows = [line.split() for line in result.stdout.splitlines()]
    assert head == ["kind", "name", "distribution", "version"]
    ours = [row for row in rows if row[-2] == "wearlaw"]
    assert ours == [
        *(
            ["contact", "model", name, "wearlaw", wl.__version__]
            for name in ("exact", "fastsim", "global", "linear", "polach", "shen_hedrick_elkins")
        ),
        *(["wear", "law", name, "wearlaw", wl.__version__] for name in ("brr", "kth", "usfd")),
        ["material", "steel", "wearlaw", wl.__version__],
        ["case", "tassini2010", "wearlaw", wl.__version__],
        ["test", "set", "lewis2004", "wearlaw", wl.__version__],
        *(["section", f"tassini2010_{name}", "wearlaw", wl.__version__] for name in ("claims", "table_4", "tables")),
    ]
    assert result.stderr == ""


def test_what_failed_to_load_is_named_once_with_its_cause(install: Install) -> None:
    install("crumbling", "raise RuntimeError('no licence found')\n", "1.2.3")
    install("misspelt", "import wearlaw as wl\n\n@wl.hookimpl\ndef wearlaw_wear_law(): return []\n", "1.2.3")
    result = wearlaw("plugins")
    assert result.exit_code == 0
    assert "usfd" in result.stdout
    crumbling, misspelt = result.stderr.splitlines()
    assert crumbling == "left out: crumbling 1.2.3 (plugin 'crumbling'): RuntimeError: no licence found"
    assert misspelt.startswith("left out: misspelt 1.2.3 (plugin 'misspelt'): ")
    assert "wearlaw_wear_law" in misspelt


def test_a_plugin_that_was_left_out_is_named_where_its_model_is_missed(install: Install, folder: Path) -> None:
    install("crumbling", "raise RuntimeError('no licence found')\n", "1.2.3")
    write(folder / "c.toml", table(wear_laws=["crumbling"]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.PluginWarning)
        assert_refused(wearlaw("run", "c.toml"), "left out: crumbling 1.2.3 (plugin 'crumbling'): RuntimeError: no lic")
        assert_refused(wearlaw("show", "crumbling"), "left out: crumbling 1.2.3 (plugin 'crumbling')")
