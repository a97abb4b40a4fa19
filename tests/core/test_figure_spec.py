"""Figures in a case file: what is wrong is named by its path when the case is read; the rest comes back as it was."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest

import wearlaw as wl
from tests.core import cases
from tests.core.cases import Table, case, table
from wearlaw.study.case import Case

WEAR = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate"}
PATCH = {"profile": "partial_slip", "y": "slip"}
PANELS = [{}, {"x_range": ["1 N", "70 N"]}]


@pytest.fixture
def measured(tmp_path: Path) -> Table:
    file = tmp_path / "tests.csv"
    file.write_text("creepage [%],normal_force [kN],traction_coefficient\n1,7,0.3\n", encoding="utf-8")
    return {"label": "mine", "tests": str(file)}


def refusal(spec: Any, **changes: Any) -> str:
    with pytest.raises(wl.ConfigurationError) as error:
        case(**{"figures": {"one": spec}, **changes})
    return str(error.value)


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ({**WEAR, "sweep": "crepage"}, "sweep: the case has no sweep 'crepage'; did you mean 'creepage'? There are: "),
        ({**PATCH, "profile": "partial"}, "profile: the case has no profile 'partial'; did you mean 'partial_slip'?"),
        ({**WEAR, **PATCH}, "sweep: give either sweep or profile"),
        ({"x": "creepage", "y": "wear_rate"}, "sweep: give either sweep or profile"),
        ({**WEAR, "x": "wear_indx"}, "x: 'wear_indx' cannot be shown; did you mean 'wear_index'? It can be: "),
        ({"sweep": "creepage", "y": "wear_rate"}, "x: 'x' cannot be shown"),
        ({**PATCH, "x": "creepage"}, "x: 'creepage' cannot be shown. It can be: x"),
        ({**WEAR, "x": "max_pressure"}, "x: max_pressure is the same at all points of the sweep; give creepage"),
        ({**WEAR, "y": "wear_rat"}, "y: 'wear_rat' cannot be shown; did you mean 'wear_rate'?"),
        ({**WEAR, "y": "pressure"}, "y: 'pressure' cannot be shown"),
        ({**PATCH, "y": "wear_index"}, "y: 'wear_index' cannot be shown"),
        ({**WEAR, "y": ["wear_rate", "wear_rate"]}, "y: names a variable twice"),
        ({**WEAR, "y": []}, "y: "),
        ({**PATCH, "y": ["slip", "pressure"]}, "y: one axis has one unit, but these are slip in %, pressure in MPa"),
        ({"sweep": "creepage", "x": "wear_index"}, "y: is missing"),
        ({**WEAR, "pairs": ["usfd on exat"]}, "pairs: there is no 'usfd on exat'; did you mean 'usfd on exact'?"),
        ({**WEAR, "pairs": []}, "pairs: "),
        ({**WEAR, "pairs": ["brr on exact"]}, "pairs: 'brr on exact': "),
        ({**PATCH, "y": "wear_rate", "pairs": ["usfd on global"]}, "pairs: 'usfd on global': global does not resolve"),
        ({**WEAR, "y": "mean_slip", "pairs": ["usfd on exact"]}, "pairs: the figure does not show wear_rate"),
        ({**WEAR, "contact_models": ["exact"]}, "contact_models: the figure shows only wear_rate"),
        ({**WEAR, "y": "mean_slip", "contact_models": ["exat"]}, "contact_models: there is no 'exat'; did you mean"),
        ({**PATCH, "contact_models": ["global"]}, "contact_models: there is no 'global'. There are: exact"),
        ({**WEAR, "x_range": ["0 MPa", "70 MPa"]}, "x_range: wear_index: got 0.000 MPa"),
        ({**WEAR, "x_range": [0, 70]}, "x_range: wear_index: got the bare number 0.0, which has no unit"),
        ({**WEAR, "x_range": ["70 N", "0 N"]}, "x_range: must run from the lower end to the higher one, got 70 N to 0"),
        ({**WEAR, "x_range": ["70 N", "70 N"]}, "x_range: must run from the lower end to the higher one"),
        ({**WEAR, "x_range": ["70 N"]}, "x_range"),
        ({**WEAR, "y_range": ["0 N", "70 N"]}, "y_range: wear_rate: got 0.000 N"),
        ({**WEAR, "x_range": ["0 N", "70 N"], "x_scale": "log"}, "x_range: a logarithmic axis must begin above zero"),
        ({**WEAR, "x_scale": "logarithmic"}, "x_scale: input should be 'linear' or 'log'"),
        ({**WEAR, "measured": True}, "measured: cannot show wear_index and wear_rate of the measured tests"),
        ({**PATCH, "measured": True}, "measured: tests are measured over the whole patch"),
        ({**WEAR, "panels": [{}, {"x_range": ["2 N", "1 N"]}]}, "panels.1.x_range: must run from the lower end"),
        ({**WEAR, "panels": [{"y": "slip"}]}, "panels.0.y: 'slip' cannot be shown"),
        ({**WEAR, "x_range": ["0 N", "1 N"], "panels": [{"x_scale": "log"}]}, "panels.0.x_range: a logarithmic axis"),
        ({**WEAR, "panels": [{"sweep": "creepage"}]}, "panels.0.sweep: "),
        ({**WEAR, "sweeps": "creepage"}, "sweeps: unknown field"),
        ("figure", "figures.one"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_figure_is_named_by_its_path(spec: Any, message: str) -> None:
    start = "" if message.startswith("figures") else "figures.one."
    assert f"{start}{message}" in refusal(spec)


def test_all_that_is_wrong_is_said_at_once() -> None:
    said = refusal({**WEAR, "x": "load", "y": "wear", "panels": [{}, {"y": "slip"}]})
    assert all(f"figures.one.{path}: " in said for path in ("x", "panels.0.y", "panels.1.y"))


def test_the_name_of_a_figure_is_that_of_its_file() -> None:
    with pytest.raises(wl.ConfigurationError, match=r"figures\.a/b: the name must be made of letters, digits and"):
        case(figures={"a/b": WEAR})


def test_a_pair_that_a_sweep_leaves_out_cannot_be_chosen() -> None:
    sweeps = {"creepage": {**cases.SWEEP, "traction_coefficient": 0.2}}
    message = "pairs: 'usfd on exact': exact is left out there, since it computes the traction itself"
    assert message in refusal({**WEAR, "pairs": ["usfd on exact"]}, sweeps=sweeps)


def test_a_profile_that_no_contact_model_resolves_cannot_be_shown() -> None:
    assert "figures.one.profile: global does not resolve the patch" in refusal(PATCH, contact_models=["global"])


def test_measured_tests_show_only_what_they_hold(measured: Table) -> None:
    said = refusal({**WEAR, "measured": True}, measured=measured)
    assert "figures.one.measured: cannot show wear_rate of the measured tests, which have only " in said
    case(measured=measured, figures={"one": {**WEAR, "y": "tangential_force", "measured": True}})


def test_tests_without_traction_show_no_force(tmp_path: Path) -> None:
    file = tmp_path / "tests.csv"
    file.write_text("creepage [%],normal_force [kN],wear_rate [ug/m/mm^2]\n1,7,20\n", encoding="utf-8")
    mine = {"label": "mine", "tests": str(file)}
    said = refusal({**WEAR, "y": "tangential_force", "measured": True}, measured=mine)
    assert "figures.one.measured: cannot show tangential_force and wear_index of the measured tests" in said
    case(measured=mine, figures={"one": {**WEAR, "x": "creepage", "measured": True}})


def test_composing_the_pairs_of_figures_gives_no_warning_of_its_own() -> None:
    """Warnings are errors in the tests; running the case gives those of the pairs as notes."""
    case(figures={"one": {**WEAR, "pairs": ["usfd on exact"]}})


@pytest.mark.parametrize(
    "spec",
    [WEAR, PATCH, {**WEAR, "panels": PANELS, "x_scale": "log"}, {**PATCH, "y": ["pressure", "traction"]},
     {**WEAR, "pairs": ["usfd on exact"], "title": "t", "caption": "c"},
     {**WEAR, "y": "traction_coefficient", "y_range": [0, 0.5], "contact_models": ["exact"]}],
)  # fmt: skip
def test_a_figure_written_with_its_case_reads_back_as_the_same_and_fits_the_schema(spec: Table, validator: Any) -> None:
    first = case(figures={"one": spec})
    written = first.model_dump(mode="json", by_alias=True, exclude_none=True)
    assert Case(**written) == first
    for fields in (table(figures={"one": spec}), written):
        validator.validate(fields)


@pytest.mark.parametrize(
    "changes",
    [{"x": "wear_indx"}, {"y": "wear_rat"}, {"y": []}, {"y": ["slip", 1]}, {"x_range": ["0 N"]}, {"x_scale": "lin"},
     {"panels": [{"sweep": "creepage"}]}, {"measured": "yes please"}],
)  # fmt: skip
def test_the_schema_refuses_what_the_loader_refuses(changes: Table, validator: Any) -> None:
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(table(figures={"one": {**WEAR, **changes}}))
    refusal({**WEAR, **changes})
