"""`wearlaw run`, as a user meets it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray
from click.testing import Result

import wearlaw as wl
import wearlaw_studies.written as output
from tests.core import cases
from tests.core.cases import assert_refused, files, table, wearlaw, write

pytestmark = pytest.mark.usefixtures("blank_figures")


def test_a_study_is_run_and_its_files_are_listed_as_they_are(folder: Path) -> None:
    write(folder / "my case.toml", table())
    result = wearlaw("run", "my case.toml", "-o", "out folder")
    assert result.exit_code == 0
    assert f"\nComputed with wearlaw {wl.__version__}\nResults in out folder:\n" in result.stdout
    listing = result.stdout.partition("Results in out folder:\n")[2].splitlines()
    assert {line.strip() for line in listing} == files(folder) - {"my case.toml", "out folder/.wearlaw-files"}
    assert listing[0] == "  out folder/report.html"
    assert len(listing) == 4 + 3 + 3 + 1
    notes = result.stderr.splitlines()
    assert len(notes) == 4
    assert notes[0].startswith("note: usfd on exact: the parameters of wear law 'usfd' were fitted for patch means")
    assert notes[1].startswith("note: brr on exact is left out: ")
    assert notes[2].startswith("note: sweep 'creepage': the maximum pressure of 1500 MPa at T/N = 0.46 is beyond")
    assert notes[3].startswith("note: profile 'partial_slip': the maximum pressure of 1500 MPa at T/N = 0.298 is")


def test_results_go_into_a_folder_named_after_the_case(folder: Path) -> None:
    (folder / "cases").mkdir()
    write(folder / "cases" / "mine.toml", table(wear_laws=["usfd"], contact_models=["global"], profiles={}))
    assert wearlaw("run", "cases/mine.toml").exit_code == 0
    assert (folder / "mine-results" / "results.nc").is_file()


def rows_of(printed: str) -> dict[str, list[str]]:
    """Return the cells of the printed table's rows by their heads."""
    rows = [line.rsplit(maxsplit=5) for line in printed.splitlines() if line.startswith(" ")]
    return {row[0].strip(): row[1:] for row in rows if len(row) == 6}


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


@pytest.mark.parametrize("creepage", ["0.5 %", "0 %", ["1 %", "2 %"]])
def test_short_sweeps_have_a_short_table(folder: Path, creepage: Any) -> None:
    write(folder / "c.toml", table(sweeps={"short": {**cases.POINT, "creepage": creepage}}, wear_laws=["usfd"]))
    result = wearlaw("run", "c.toml")
    assert result.exit_code == 0
    row = next(line for line in result.stdout.splitlines() if line.startswith(" usfd on exact"))
    rates = pd.read_csv("c-results/results.csv").query("contact_model == 'exact'")["wear_rate [ug/m/mm^2]"]
    assert row.split()[3:] == [f"{rate:.4g}" for rate in rates]


def test_progress_is_shown_on_a_terminal_and_not_elsewhere(folder: Path) -> None:
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["kth"], profiles={}))
    elsewhere = wearlaw("run", "c.toml").stderr
    assert elsewhere.count("\n") == 1
    assert elsewhere.startswith("note: sweep 'creepage': ")
    on_terminal = wearlaw("run", "c.toml", "--overwrite", FORCE_COLOR="1", TERM="xterm")
    assert "evaluating" in on_terminal.stderr
    assert "15/15" in on_terminal.stderr  # 5 points, and the band of KTH
    assert "writing the report" in on_terminal.stderr


def test_files_of_others_survive_a_second_run_into_the_same_folder(folder: Path) -> None:
    write(folder / "c.toml", table(contact_models=["global"], wear_laws=["usfd"], profiles={}))
    assert wearlaw("run", "c.toml", "-o", "out").exit_code == 0
    ours = files(folder / "out")
    for name in ("thesis.tex", "figures/mine.png"):
        (folder / "out" / name).write_text("years of work")
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["kth"], profiles={}))
    assert wearlaw("run", "c.toml", "-o", "out", "--overwrite", "--figure-format", "svg").exit_code == 0
    assert (folder / "out" / "thesis.tex").read_text() == "years of work"
    assert (folder / "out" / "figures" / "mine.png").read_text() == "years of work"
    assert [name for name in files(folder / "out") & ours if name.endswith(".png")] == []
    assert "kth on exact" in (folder / "out" / "report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("overwrite", [False, True])
def test_of_two_runs_into_one_folder_the_second_to_end_replaces_the_first_only_when_asked(
    folder: Path, overwrite: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second begins and ends while the first writes."""
    for name in ("usfd", "kth"):
        write(folder / f"{name}.toml", table(contact_models=["global"], wear_laws=[name], profiles={}))
    if overwrite:
        assert wearlaw("run", "usfd.toml", "-o", "out").exit_code == 0
    options = ["-o", "out", "--figure-format", "svg", *(["--overwrite"] if overwrite else [])]
    write_results = output.write
    winners: list[Result] = []

    def late(*arguments: Any) -> list[str]:
        monkeypatch.setattr("wearlaw_studies.commands.write", write_results)
        winners.append(wearlaw("run", "kth.toml", *options))
        return write_results(*arguments)

    monkeypatch.setattr("wearlaw_studies.commands.write", late)
    last = wearlaw("run", "usfd.toml", *options)
    assert [first.exit_code for first in winners] == [0]
    if not overwrite:
        assert_refused(last, "Error: output: 'out' is not empty")
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    assert ("usfd on global" in page, "kth on global" in page) == (overwrite, not overwrite)


def test_units_that_look_like_markup_are_printed(folder: Path) -> None:
    load = {"normal_force_per_width": ["700 kN/m", "800 kN/m"], "creepage": "1 %", "friction_coefficient": 0.4}
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["kth"], profiles={}, sweeps={"load": load}))
    assert "by normal force per width [kN/m]" in " ".join(wearlaw("run", "c.toml").stdout.split())


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
    ("options", "most", "is_written", "note"),
    [
        ([], 10, True, None),  # 2 models, 5 points
        (
            [],
            9,
            False,
            "results.csv is left out, since it would have up to 10 rows, and Excel reads 9; results.nc holds",
        ),
        (["--csv"], 9, True, None),
        (["--no-csv"], 10, False, "results.csv is left out, as --no-csv asks; results.nc holds all numbers"),
    ],
)
def test_a_long_table_is_left_out_and_it_is_said(
    folder: Path, monkeypatch: pytest.MonkeyPatch, options: list[str], most: int, is_written: bool, note: str | None
) -> None:
    monkeypatch.setattr(output, "MOST_ROWS", most)
    write(folder / "c.toml", table(contact_models=["exact", "fastsim"], wear_laws=["kth"], profiles={}))
    result = wearlaw("run", "c.toml", "-o", "out", *options)
    assert result.exit_code == 0
    assert (folder / "out" / "results.csv").is_file() == is_written
    assert ("results.csv" in result.stdout) == is_written
    assert (folder / "out" / "results.nc").is_file()
    report = (folder / "out" / "report.html").read_text(encoding="utf-8")
    if note is None:
        assert "is left out" not in result.stderr
    else:
        assert f"note: {note}" in result.stderr
        assert note in report
    assert wearlaw("run", "c.toml", "-o", "out", "--overwrite", "--no-csv").exit_code == 0
    assert not (folder / "out" / "results.csv").exists(), "the one of the earlier run would be another's"


def test_a_table_that_is_left_out_needs_no_room(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(output, "ROW_IN_MEMORY", 2**60)
    write(folder / "c.toml", table(contact_models=["exact"], wear_laws=["kth"], profiles={}))
    assert_refused(wearlaw("run", "c.toml", "-o", "out"), "GiB of memory")
    assert wearlaw("run", "c.toml", "-o", "out", "--no-csv").exit_code == 0
