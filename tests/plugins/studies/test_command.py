"""`wearlaw run`, as a user meets it: what is printed, and the contents of the files."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray

import wearlaw as wl
from tests import cases
from tests.cases import assert_refused, files, table, wearlaw, write
from tests.core.distributions import Install
from wearlaw.errors import PluginWarning
from wearlaw_apps.studies import Case

LATTICE = {**cases.SWEEP, "friction_coefficient": [0.3, 0.4]}
MEASURED = {**cases.POINT, "traction_coefficient": [0.1, 0.2]}
RAN = table(sweeps={"creepage": cases.SWEEP, "lattice": LATTICE, "point": cases.POINT, "measured": MEASURED})
EXACTLY: Any = {} if pd.__version__ >= "3" else {"float_precision": "round_trip"}
SMALL = table(contact_models=["exact"], wear_laws=["kth"], profiles={})


@pytest.fixture(scope="module")
def study() -> wl.Study:
    return wl.run(Case(**RAN))


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    write(folder / "ran.toml", RAN)
    done = wearlaw("run", str(folder / "ran.toml"), "-o", str(folder / "out"))
    assert done.exit_code == 0, done.output
    return folder / "out"


@pytest.mark.usefixtures("blank_figures")
def test_a_study_is_run_and_its_files_are_listed_as_they_are(folder: Path) -> None:
    write(folder / "my case.toml", table())
    result = wearlaw("run", "my case.toml", "-o", "out folder")
    assert result.exit_code == 0
    listing = result.stdout.partition("Results in out folder:\n")[2].splitlines()
    assert {line.strip() for line in listing} == files(folder) - {"my case.toml", "out folder/.wearlaw-files"}
    assert listing[0] == "  out folder/report.html"
    notes = [line for line in result.stderr.splitlines() if line.startswith("note: ")]
    subjects = ["usfd on exact", "brr on exact is left out", "sweep 'creepage'"]
    assert [note.split(": ")[1] for note in notes] == subjects
    assert max(map(len, notes)) <= 120
    whole = wearlaw("run", "my case.toml", "-o", "again", "--verbose").stderr.splitlines()
    assert [line.split(": ")[1] for line in whole] == subjects
    assert whole[2].endswith(" more with other numbers, profile 'partial_slip')")
    assert whole[1].endswith('write stages = ["patch_mean"] in the case, or use the contact model "global"')


@pytest.mark.usefixtures("blank_figures")
def test_json_has_the_numbers_of_the_table_with_units_and_quiet_prints_the_table_alone(folder: Path) -> None:
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["usfd"], profiles={}))
    asked = wearlaw("run", "c.toml", "--json")
    assert (asked.exit_code, asked.stderr) == (0, "")
    record = json.loads(asked.stdout)
    rates = record["tables"]["wear_rate_creepage"]
    csv = pd.read_csv("c-results/results.csv")
    assert rates["creepage"] == {"unit": "%", "values": csv["creepage [%]"].tolist()}
    assert rates["usfd on exact"]["values"] == csv["wear_rate [ug/m/mm^2]"].tolist()
    assert rates["usfd on exact"]["unit"] == "ug/m/mm^2", "as files and fits spell it"
    assert any("beyond the shakedown limit" in note for note in record["notes"])
    assert "c-results/report.html" in record["files"]
    quiet = wearlaw("run", "c.toml", "--overwrite", "--quiet")
    assert quiet.stderr == ""
    assert quiet.stdout.startswith("Sweep 'creepage': wear rate")
    assert "report.html" not in quiet.stdout


@pytest.mark.usefixtures("blank_figures")
def test_the_short_table_shows_the_rates_and_the_band(folder: Path) -> None:
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["usfd", "kth"], profiles={}))
    printed = wearlaw("run", "c.toml").stdout
    assert "Sweep 'creepage': wear rate [µg/m/mm²] by creepage [%]" in printed
    cells = [line.rsplit(maxsplit=5) for line in printed.splitlines()]
    rows = {row[0].strip(): row[1:] for row in cells if row and " on " in row[0]}
    csv = pd.read_csv("c-results/results.csv").groupby("wear_law")
    due = {"usfd on exact": ("usfd", "wear_rate"), "kth on exact": ("kth", "wear_rate")}
    due |= {f"kth on exact, {end} end": ("kth", f"wear_rate_{end}") for end in ("low", "high")}
    for head, (law, column) in due.items():
        rates = csv.get_group(law)[f"{column} [ug/m/mm^2]"]
        assert rows[head] == [f"{rate:.4g}" for rate in rates]
    assert len(rows) == 4


@pytest.mark.usefixtures("blank_figures")
def test_progress_is_shown_on_a_terminal_and_not_elsewhere(folder: Path) -> None:
    write(folder / "c.toml", SMALL)
    assert "evaluating" not in wearlaw("run", "c.toml").stderr
    on_terminal = wearlaw("run", "c.toml", "--overwrite", FORCE_COLOR="1", TERM="xterm").stderr
    assert "15/15" in on_terminal  # 5 points, and the band of KTH
    assert "writing the report" in on_terminal


def test_figures_are_written_in_the_formats_that_are_asked_for_and_tables_as_csv(folder: Path, results: Path) -> None:
    magic = {"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}
    write(folder / "c.toml", SMALL)
    assert wearlaw("run", "c.toml", *(f"--figure-format={one}" for one in magic)).exit_code == 0
    written = {path.suffix[1:]: path.read_bytes() for path in Path("c-results/figures").iterdir()}
    assert written.keys() == magic.keys()
    for extension, content in written.items():
        assert content.startswith(magic[extension])
    assert b"/FontFile2" in written["pdf"], "the fonts are embedded, as Type 42"
    tables = [path.stem for path in (results / "tables").glob("*.csv")]
    assert {"main", "models", "parameters", "wear_rate_creepage", "wear_rate_point"} <= {*tables}


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize(
    ("most", "option", "left_out"), [(4, [], True), (4, ["--csv"], False), (5, ["--no-csv"], True)]
)
def test_a_table_that_excel_cannot_read_is_left_out_unless_asked_for(
    folder: Path, monkeypatch: pytest.MonkeyPatch, most: int, option: list[str], left_out: bool
) -> None:
    monkeypatch.setattr("wearlaw_apps.studies.written.MOST_ROWS", most)  # private: less than a million rows
    write(folder / "c.toml", SMALL)
    result = wearlaw("run", "c.toml", "-o", "out", *option)
    assert (folder / "out" / "results.csv").exists() != left_out
    assert ("results.csv is left out" in result.stderr) == left_out
    assert (folder / "out" / "results.nc").is_file()


def test_the_netcdf_file_holds_every_dataset_whole_in_a_group(study: wl.Study, results: Path) -> None:
    with xarray.open_datatree(results / "results.nc", engine="h5netcdf") as opened:
        groups = {node.path: node.to_dataset(inherit=False).load() for node in opened.leaves}
        assert opened.attrs == {"Conventions": "CF-1.8", "title": study.case.title}
    datasets = {f"/sweeps/{name}": sweep for name, sweep in study.sweeps.items()}
    datasets |= {f"/profiles/{name}": profile for name, profile in study.profiles.items()}
    assert groups.keys() == datasets.keys()
    for path, dataset in datasets.items():
        xarray.testing.assert_identical(groups[path], dataset)
        assert Case(**json.loads(groups[path].attrs["provenance"])["case"]) == study.case
        for values in groups[path].variables.values():
            assert values.attrs["long_name"]
            assert ("units" in values.attrs) == (values.dtype == np.float64)
        assert "wear_rate" not in groups[path] or groups[path].wear_rate.attrs["long_name"] == "wear rate"


@pytest.mark.validates(
    "reproducibility",
    "The case file in the results runs again to the same results",
    source="the first run",
    held_to="identical datasets",
)
def test_the_case_file_in_the_results_runs_again_to_the_same_results(study: wl.Study, results: Path) -> None:
    read = wl.load_case(str(results / "case.toml"))
    assert read == study.case
    again = wl.run(read)
    assert again.notes == study.notes
    for name, sweep in study.sweeps.items():
        xarray.testing.assert_identical(again.sweeps[name], sweep)
    for name, profile in study.profiles.items():
        xarray.testing.assert_identical(again.profiles[name], profile)


def test_the_csv_has_one_row_a_pair_and_operating_point_with_units_in_its_head(results: Path) -> None:
    rows = pd.read_csv(results / "results.csv", **EXACTLY)
    # Pairs × points: 5 × 5, 5 × 10, 5 × 1, and 3 × 2 where only the global model can be used.
    assert dict(rows["sweep"].value_counts()) == {"lattice": 50, "creepage": 25, "measured": 6, "point": 5}
    assert list(rows.columns) == [
        "sweep", "contact_model", "wear_law", "half_width [mm]", "max_pressure [MPa]", "normal_force [kN]",
        "normal_force_per_width [kN/m]", "creepage [%]", "friction_coefficient", "wear_rate [ug/m/mm^2]",
        "wear_rate_error [ug/m/mm^2]", "outside_range", "wear_rate_low [ug/m/mm^2]", "wear_rate_high [ug/m/mm^2]",
        "tangential_force [N]", "traction_coefficient", "wear_index [N]",
        "wear_index_density [N/mm^2]", "stick_ratio", "mean_slip [%]", "first_yield [MPa]", "shakedown_limit [MPa]",
    ]  # fmt: skip
    assert not rows.isna().any().any()


@pytest.mark.parametrize("name", ["creepage", "lattice", "point", "measured"])
def test_the_csv_holds_the_numbers_of_the_datasets(study: wl.Study, results: Path, name: str) -> None:
    sweep = study.sweeps[name]
    rows = pd.read_csv(results / "results.csv", **EXACTLY)
    rows = rows[rows["sweep"] == name].rename(columns=lambda column: column.split(" [")[0])
    axes = [str(axis) for axis in sweep.wear_rate.dims if axis != "pair"]
    for _, row in rows.iterrows():
        here = sweep.sel({axis: row[axis] for axis in axes})
        here = here.sel(pair=f"{row.wear_law} on {row.contact_model}", contact_model=row.contact_model)
        for column in rows.columns[3:]:
            assert row[column] == here[column].item(), column  # CSV holds all digits of a float64


@pytest.mark.usefixtures("blank_figures")
def test_the_shipped_study_and_a_copy_of_its_file_give_equal_results(folder: Path) -> None:
    (folder / "my case.toml").write_bytes(wearlaw("case", "tassini2010").stdout_bytes)
    shipped, copied = wearlaw("run", "tassini2010"), wearlaw("run", "my case.toml", "-o", "copy")
    assert shipped.exit_code == 0
    assert shipped.stdout.replace("tassini2010-results", "copy").split() == copied.stdout.split()
    assert shipped.stderr == copied.stderr
    assert files(folder / "tassini2010-results") == files(folder / "copy")
    for name in ("results.csv", "case.toml"):
        assert (folder / "copy" / name).read_bytes() == (folder / "tassini2010-results" / name).read_bytes()
    ours = xarray.open_datatree("tassini2010-results/results.nc", engine="h5netcdf")
    theirs = xarray.open_datatree("copy/results.nc", engine="h5netcdf")
    with ours, theirs:
        xarray.testing.assert_equal(ours, theirs)
        sweep = ours["sweeps/creepage"].to_dataset()
        said, copy = (json.loads(tree["sweeps/creepage"].attrs["provenance"])["cases"] for tree in (ours, theirs))
        assert (said, copy) == ({"tassini2010": f"wearlaw {wl.__version__}"}, {})
        rates = sweep.wear_rate.sel(creepage=25.0, method="nearest")
        # Half a digit of the converged integrals that tests/test_numbers.py computes anew.
        for pair, rate in {"usfd on global": 3658.9, "usfd on exact": 3825.0, "usfd on fastsim": 4148.6}.items():
            np.testing.assert_allclose(rates.sel(pair=pair), rate, rtol=0, atol=0.05)
        assert dict(sweep.sizes) == {"pair": 10, "contact_model": 3, "creepage": 600}


# What is refused


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["tasini2010"], "there is no case file 'tasini2010'; did you mean 'tassini2010'?"),
        (["."], "cannot read the case file '.'"),
        (["taken.txt"], "case 'taken.txt' is not valid TOML"),
        (["wrong.toml"], "contact_models.0: no contact model is called 'exat'; did you mean"),
        (["no_pair.toml"], "no contact model can be used with any of"),
        (["c.toml", "-o", "full", "--overwrite"], "output: 'full' does not hold results of wearlaw"),
        (["c.toml", "-o", "earlier"], "output: 'earlier' is not empty; choose another folder with -o, or add --over"),
    ],
)
def test_what_cannot_be_run_is_one_clear_error_and_nothing_is_written(
    folder: Path, arguments: list[str], message: str
) -> None:
    write(folder / "c.toml", table())
    write(folder / "wrong.toml", table(contact_models=["exat"]))
    write(folder / "no_pair.toml", table(contact_models=["exact"], wear_laws=["brr"]))
    (folder / "taken.txt").write_text("not TOML")
    (folder / "full").mkdir()
    (folder / "full" / "thesis.tex").write_text("years of work")
    (folder / "earlier").mkdir()
    (folder / "earlier" / ".wearlaw-files").write_text("results.nc\n")
    before = files(folder)
    assert_refused(wearlaw("run", *arguments), message)
    assert files(folder) == before


def test_a_plugin_that_was_left_out_is_named_where_its_model_is_missed(install: Install, folder: Path) -> None:
    install("crumbling", "raise RuntimeError('no licence found')\n", "1.2.3")
    write(folder / "c.toml", table(wear_laws=["crumbling"]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PluginWarning)
        assert_refused(wearlaw("run", "c.toml"), "left out: crumbling 1.2.3 (plugin 'crumbling'): RuntimeError: no lic")
        assert_refused(wearlaw("show", "crumbling"), "left out: crumbling 1.2.3 (plugin 'crumbling')")
