"""Writing results: the contents of the files."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import xarray
from matplotlib.figure import Figure
from packaging.version import Version

import wearlaw as wl
from tests.core import cases
from tests.core.cases import case, tree
from tests.plugins.studies import report_data
from wearlaw.pipeline.variables import OF_CONTACT
from wearlaw.units.variables import UNITS
from wearlaw_studies.case import CASE_FILE, Case, load_case
from wearlaw_studies.report.main_result import main_figure, main_result
from wearlaw_studies.report.tables import tables
from wearlaw_studies.sections import Section
from wearlaw_studies.study import Study, run
from wearlaw_studies.written import CSV, RESULTS, table, write

LATTICE = {**cases.SWEEP, "friction_coefficient": [0.3, 0.4]}
MEASURED = {**cases.POINT, "traction_coefficient": [0.1, 0.2]}
RAN = case(sweeps={"creepage": cases.SWEEP, "lattice": LATTICE, "point": cases.POINT, "measured": MEASURED})


@pytest.fixture(scope="module")
def study() -> Study:
    return run(RAN)


@pytest.fixture(scope="module")
def written(study: Study, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str]]:
    """Write the results, with blank figures, whose drawing takes most of the time."""
    folder = tmp_path_factory.mktemp("results")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("wearlaw_output.files.draw", lambda _: Figure(figsize=(1.0, 1.0)))
        return folder, write(study, folder)


@pytest.fixture(scope="module")
def results(written: tuple[Path, list[str]]) -> Path:
    return written[0]


def read_exactly(path: Path, **options: Any) -> pd.DataFrame:
    """Read a table to the last bit, as pandas does unasked since version 3, which no longer takes the option."""
    exact: Any = {} if Version(pd.__version__).major >= 3 else {"float_precision": "round_trip"}
    frame: pd.DataFrame = pd.read_csv(path, **exact, **options)
    return frame


def test_the_names_returned_are_the_files_written(study: Study, written: tuple[Path, list[str]]) -> None:
    folder, names = written
    assert sorted(names) == sorted(name for name in tree(folder) if name not in ("figures", "tables"))
    assert names[:4] == ["report.html", "results.nc", "results.csv", "case.toml"]
    drawn = [name for name in names if name.startswith("figures")]
    assert main_figure(main_result(study)) in study.figures
    assert [Path(name).stem for name in drawn] == [figure.name for figure in study.figures]
    assert all((folder / name).read_bytes().startswith(b"\x89PNG") for name in drawn)
    assert [Path(name).stem for name in names if name.startswith("tables")] == [one.name for one in tables(study)]


@pytest.mark.usefixtures("blank_figures")
def test_figures_and_tables_of_sections_are_written_too(tmp_path: Path, point: Study) -> None:
    names = write(replace(point, sections=(report_data.SECTION,)), tmp_path)
    assert {"figures/odd.png", "tables/table_4.csv"} <= set(names)


MAGIC = {"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}


def test_every_figure_is_written_once_in_each_format(tmp_path: Path, point: Study) -> None:
    point.__dict__["figures"] = (report_data.ONE,)
    write(point, tmp_path, ("svg", "png", "pdf", "svg"))
    written = {path.suffix[1:]: path.read_bytes() for path in (tmp_path / "figures").iterdir()}
    assert written.keys() == MAGIC.keys()
    for extension, content in written.items():
        assert content.startswith(MAGIC[extension])
    assert b"/FontFile2" in written["pdf"], "the fonts are embedded, as Type 42"
    assert b"/Type3" not in written["pdf"]


def test_tables_are_csv_with_every_digit_and_latex_when_asked(tmp_path: Path, study: Study, results: Path) -> None:
    write(study, tmp_path, (), latex=True)
    for one in tables(study):
        text = dict.fromkeys(("value", "parameter"), str)
        for folder, latex in ((tmp_path, True), (results, False)):
            read = read_exactly(folder / "tables" / f"{one.name}.csv", dtype=text)
            pd.testing.assert_frame_equal(read, one.frame, check_dtype=False, check_exact=True)
            assert (folder / "tables" / f"{one.name}.tex").is_file() == latex


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("wear_rate_point", "output: the table 'wear_rate_point' cannot be written: there are two of that name"),
        ("../out", "output: the table '../out' cannot be written: its name must be made of letters, digits and under"),
    ],
)
def test_a_table_of_a_name_that_is_taken_or_no_file_name_is_refused(
    tmp_path: Path, point: Study, name: str, message: str
) -> None:
    section = Section("Title", "", tables={name: pd.DataFrame()})
    with pytest.raises(wl.OutputError, match=message):
        write(replace(point, sections=(section,)), tmp_path, ())


@pytest.mark.usefixtures("blank_figures")
def test_what_is_written_next_is_said(tmp_path: Path, point: Study) -> None:
    stages: list[str] = []
    write(point, tmp_path, on_stage=stages.append)
    first = main_figure(main_result(point)).name
    names = [*dict.fromkeys([first, *(figure.name for figure in point.figures)])]
    assert stages == ["writing results", *(f"drawing {name}" for name in names), "writing the report"]


@pytest.mark.usefixtures("blank_figures")
def test_a_long_table_is_written_with_progress_to_the_same_bytes(
    tmp_path: Path, study: Study, results: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stages: list[str] = []
    rows = len(table(study))
    monkeypatch.setattr("wearlaw_studies.written.CHUNK", -(-rows // 4))
    write(study, tmp_path, (), on_stage=stages.append)
    shares = [stage for stage in stages if "results.csv" in stage]
    assert [shares[0].partition(", ")[0], len(shares)] == ["writing results.csv", 3]
    assert [round(float(stage.rpartition(" ")[2].rstrip("%")) / 25.0) for stage in shares] == [1, 2, 3]
    assert (tmp_path / CSV).read_bytes() == (results / CSV).read_bytes()
    whole = tmp_path / "whole.csv"
    table(study).to_csv(whole, index=False)
    assert (tmp_path / CSV).read_bytes() == whole.read_bytes()


def test_the_netcdf_file_holds_every_dataset_whole_in_a_group(study: Study, results: Path) -> None:
    with xarray.open_datatree(results / RESULTS, engine="h5netcdf") as opened:
        groups = {node.path: node.to_dataset(inherit=False).load() for node in opened.leaves}
    datasets = {f"/sweeps/{name}": sweep for name, sweep in study.sweeps.items()}
    datasets |= {f"/profiles/{name}": profile for name, profile in study.profiles.items()}
    assert groups.keys() == datasets.keys()
    for path, dataset in datasets.items():
        xarray.testing.assert_identical(groups[path], dataset)
        assert Case(**json.loads(groups[path].attrs["provenance"])["case"]) == RAN
        for name in groups[path].data_vars:
            assert groups[path][name].attrs["units"] == UNITS[str(name)]


@pytest.mark.validates(
    "reproducibility",
    "The case file in the results runs again to the same results",
    source="the first run",
    held_to="identical datasets",
)
def test_the_case_file_in_the_results_runs_again_to_the_same_results(study: Study, results: Path) -> None:
    read = load_case(str(results / CASE_FILE))
    assert read == RAN
    again = run(read)
    assert again.notes == study.notes
    for name, sweep in study.sweeps.items():
        xarray.testing.assert_identical(again.sweeps[name], sweep)
    for name, profile in study.profiles.items():
        xarray.testing.assert_identical(again.profiles[name], profile)


def test_results_of_models_that_share_a_name_keep_their_labels_when_run_again() -> None:
    laws = ["usfd", {"model": "usfd", "fitted_for": "exact"}, {"model": "kth", "coefficient": "low"}, "kth"]
    first = run(case(wear_laws=laws, contact_models=["exact"]))
    dumped = first.case.model_dump(mode="json", by_alias=True, exclude_none=True)
    xarray.testing.assert_identical(run(Case(**dumped)).sweeps["creepage"], first.sweeps["creepage"])


def test_the_csv_has_one_row_a_pair_and_operating_point_with_units_in_its_head(results: Path) -> None:
    rows = read_exactly(results / CSV)
    # Pairs × points: 5 × 5, 5 × 10, 5 × 1, and 3 × 2 where only the global model can be used.
    assert dict(rows["sweep"].value_counts()) == {"lattice": 50, "creepage": 25, "measured": 6, "point": 5}
    units = {name: f" [{UNITS[name]}]" if UNITS[name] else "" for name in UNITS}
    expected = [
        "half_width", "max_pressure", "normal_force", "normal_force_per_width", "creepage", "friction_coefficient",
        "wear_rate", "wear_rate_error", "outside_range", "wear_rate_low", "wear_rate_high",
        "tangential_force", "traction_coefficient", "wear_index", "averaged_wear_index", "wear_index_density",
        "stick_ratio", "mean_slip", "first_yield", "shakedown_limit",
    ]  # fmt: skip
    assert list(rows.columns) == ["sweep", "contact_model", "wear_law", *(name + units[name] for name in expected)]
    assert "wear_rate [ug/m/mm^2]" in rows.columns
    assert "creepage [%]" in rows.columns
    assert not rows.isna().any().any()


@pytest.mark.parametrize("name", ["creepage", "lattice", "point", "measured"])
def test_the_csv_holds_the_numbers_of_the_datasets(study: Study, results: Path, name: str) -> None:
    sweep = study.sweeps[name]
    rows = read_exactly(results / CSV)
    rows = rows[rows["sweep"] == name].rename(columns=lambda column: column.split(" [")[0])
    axes = [str(axis) for axis in sweep.wear_rate.dims if axis != "pair"]
    for _, row in rows.iterrows():
        of_pair = sweep.sel({axis: row[axis] for axis in axes}).sel(pair=f"{row.wear_law} on {row.contact_model}")
        of_contact = of_pair.sel(contact_model=row.contact_model)
        for column in rows.columns[3:]:
            # CSV holds all digits of a float64.
            source = of_contact if column in OF_CONTACT else of_pair
            assert row[column] == source[column].item(), column


def test_the_table_is_what_the_csv_holds(study: Study, results: Path) -> None:
    pd.testing.assert_frame_equal(table(study), read_exactly(results / CSV), check_exact=True)
