"""The tables of a study: what stands in them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import wearlaw as wl
from tests.core import cases
from tests.core.report_data import SECTION, TABLE
from wearlaw.report.tables import models, parameters, summaries, summary, tables
from wearlaw.study.study import Study, run


@pytest.fixture(scope="module")
def study() -> Study:
    many = {**cases.SWEEP, "creepage": {"from": "1 %", "to": "9 %", "points": 9}}
    lattice = {**many, "friction_coefficient": [0.3, 0.4]}
    return run(cases.case(wear_laws=["kth", "usfd"], sweeps={"many": many, "lattice": lattice}, profiles={}))


def test_a_summary_shows_each_pair_and_its_band_at_five_values_with_both_ends(study: Study) -> None:
    sweep = study.sweeps["many"]
    frame = summary(sweep, "creepage", "wear_rate", [str(pair) for pair in sweep.pair.values])
    assert list(frame.columns) == ["wear rate [µg/m/mm²] by creepage [%]", "1", "3", "5", "7", "9"]
    heads = frame.iloc[:, 0].tolist()
    band = ["kth on global", "kth on global, low end", "kth on global, high end"]
    assert heads == [*band, "usfd on global", *(head.replace("global", "exact") for head in band), "usfd on exact"]
    variables = ["wear_rate", "wear_rate_low", "wear_rate_high", "wear_rate"]
    for row, variable in enumerate(variables):
        pair = heads[row].partition(",")[0]
        np.testing.assert_array_equal(frame.iloc[row, 1:], sweep[variable].sel(pair=pair).values[::2])


def test_a_sweep_with_other_axes_is_shown_at_their_middle_which_the_title_says(study: Study) -> None:
    many, lattice = summaries(study)
    assert (many.name, many.title) == ("wear_rate_many", "Sweep 'many'")
    assert (lattice.name, lattice.title) == ("wear_rate_lattice", "Sweep 'lattice' at friction coefficient 0.4")
    shown = study.sweeps["lattice"].wear_rate.sel(pair="usfd on exact", friction_coefficient=0.4)
    np.testing.assert_array_equal(lattice.frame.iloc[-1, 1:], shown.values[::2])


def test_every_field_of_the_rig_and_the_models_is_a_parameter(study: Study) -> None:
    frame = parameters(study).frame
    rows = {(of, name): (value, meaning) for of, name, value, meaning in frame.astype(str).to_numpy().tolist()}
    assert len(rows) == len(frame)
    assert rows["usfd", "q_s"] == ("55 µg/m/mm²", "Wear rate of the severe regime, q_s [µg/m/mm²].")
    assert rows["rig", "disc_1.material.youngs_modulus"] == ("206.47742 GPa", "Young's modulus, E [Pa].")
    assert rows["rig", "disc_2.material.poisson_ratio"] == ("0.28", "Poisson's ratio, ν [-].")
    assert rows["global", "total_from"][0] == "exact"
    assert rows["global", "total_from.slip"] == rows["exact", "slip"]
    for label, record in (("usfd", wl.wear_law("usfd")), ("kth", wl.wear_law("kth")), ("rig", wl.TwinDisc.suros())):
        fields = {name.partition(".")[0] for of, name in rows if of == label}
        assert fields == {name for name, value in record if value is not None}


def test_models_are_given_with_where_they_come_from(study: Study) -> None:
    frame = models(study).frame
    assert frame["model"].tolist() == ["global", "exact", "kth", "usfd"]
    assert frame["kind"].tolist() == ["contact model"] * 2 + ["wear law"] * 2
    assert set(frame["provided by"]) == {f"wearlaw {wl.__version__}"}
    assert frame["source"].tolist() == [
        *(wl.contact_model(name).source for name in ("global", "exact")),
        *(wl.wear_law(name).source for name in ("kth", "usfd")),
    ]


def test_the_tables_of_sections_come_last(study: Study) -> None:
    found = tables(replace(study, sections=(SECTION,)))
    assert [one.name for one in found] == ["wear_rate_many", "wear_rate_lattice", "parameters", "models", "table_4"]
    assert found[-1].frame is TABLE
