"""What a plugin from outside declares has its name, unit and words wherever results are shown."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import pytest

import wearlaw as wl
from tests.cases import InstallModel
from tests.environments import ROOT
from wearlaw_apps.studies import Case
from wearlaw_apps.studies.case import case_schema  # private: the schema without a process
from wearlaw_apps.studies.report.page import report  # private: the page without a process and a folder
from wearlaw_apps.studies.written import table  # private: the table that it writes

OUTSIDE = ROOT / "docs" / "examples" / "wearlaw-outside"
LOAD, FLASH = "bearing load B", "flash temperature Θ"
GIVEN: dict[str, Any] = {"mass": "20 kg", "creepage": wl.Q([1, 2, 5], "%"), "friction_coefficient": 0.4}


@pytest.fixture
def outside(monkeypatch: pytest.MonkeyPatch, install_model: InstallModel) -> Any:
    """Give the plugin from outside, with its models among those installed."""
    monkeypatch.syspath_prepend(str(OUTSIDE))
    plugin = import_module("wearlaw_outside")
    for model in plugin.wearlaw_models():
        install_model(model)
    return plugin


@pytest.fixture
def pipeline(outside: Any) -> wl.Pipeline[...]:
    made: wl.Pipeline[...] = outside.Weighted(material=outside.MADE_UP_STEEL) | outside.Rigid() | outside.Flash()
    return made


def test_a_dataset_and_a_table(pipeline: wl.Pipeline[...]) -> None:
    found = pipeline(**GIVEN)
    # Half of 20 kg · 9.81 m/s² on each bearing, to rounding.
    assert found["bearing_load"].m_as("N") == pytest.approx([98.1] * 3, rel=1e-15)
    for dataset in (found.to_dataset(), wl.sweep(pipeline, **GIVEN)):
        assert dataset["bearing_load"].attrs == {"units": "N", "long_name": LOAD}
        assert dataset["flash_temperature"].attrs == {"units": "K", "long_name": FLASH}
    table = found.to_dataframe()
    assert table["bearing_load [N]"].to_list() == found["bearing_load"].magnitude.tolist()
    assert {"flash_temperature [K]"} <= {*table.columns}


def test_the_axes_of_a_plot(pipeline: wl.Pipeline[...]) -> None:
    found = pipeline(**GIVEN)
    axes = found.plot("flash_temperature", x="bearing_load")
    assert (axes.get_ylabel(), axes.get_xlabel()) == (f"{FLASH} [K]", f"{LOAD} [N]")


def test_tables_figures_and_the_report_of_a_case(outside: Any) -> None:
    written: dict[str, Any] = {
        "title": "A bearing",
        "rig": {"type": "weighted", "material": outside.MADE_UP_STEEL},
        "contact_models": ["rigid", "exact"],
        "laws": ["flash"],
        "sweeps": {"creepage": {**GIVEN, "mass": ["10 kg", "20 kg"], "creepage": ["1 %", "2 %", "5 %"]}},
        "figures": {
            "warm": {"sweep": "creepage", "x": "creepage", "y": "flash_temperature"},
            "bearing": {"sweep": "creepage", "x": "mass", "y": "bearing_load"},
        },
    }
    study = wl.run(Case(**written))
    shown = {figure.name: figure.panels[0] for figure in study.figures}
    assert shown["warm"].y.label == f"{FLASH} [K]"
    assert shown["bearing"].y.label == f"{LOAD} [N]"
    page = report(study, "")
    assert FLASH in page
    assert f"B{LOAD[1:]} over mass" in page
    assert {"bearing_load [N]", "flash_temperature [K]"} <= {*table(study).columns}


@pytest.mark.usefixtures("outside")
def test_the_schema_of_cases_offers_them_to_figures() -> None:
    figure = case_schema()["$defs"]["FigureSpec"]["properties"]
    assert {"bearing_load", "flash_temperature", "guiding_force"} <= {*figure["x"]["enum"]}
