"""Figures in a case file: what is wrong is named by its path when the case is read; the rest comes back as it was."""

from __future__ import annotations

from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest

import wearlaw as wl
from tests.core import cases
from tests.core.cases import Table, case, table
from tests.plugins.studies.test_case_rigs import ON_RAIL
from wearlaw_studies.case import Case

WEAR = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate"}
PATCH = {"profile": "partial_slip", "y": "slip"}
ACROSS = {"profile": "curve", "x": "y", "y": "depth"}
BY_LOAD = {"sweep": "braking", "x": "normal_force", "y": "wear_rate"}
MAP = {"sweep": "both", "x": "max_pressure", "y": "creepage", "map": "wear_rate"}
BOTH = {"both": {**cases.SWEEP, "max_pressure": ["1 GPa", "2 GPa"]}, "creepage": cases.SWEEP}
DAMAGE = {
    "model": "wlrm",
    "threshold": "5 N",
    "peak": "50 N",
    "balance": "175 N",
    "peak_damage": 1e-5,
    "beyond": "zero",
}

ON_DISCS: list[tuple[Any, str]] = [
    ({**WEAR, "sweep": "crepage"}, "sweep: .*did you mean 'creepage'"),
    ({**PATCH, "profile": "partial"}, "profile: .*did you mean 'partial_slip'"),
    ({**WEAR, **PATCH}, "sweep: "),
    ({"x": "creepage", "y": "wear_rate"}, "sweep: "),
    ({**WEAR, "x": "wear_indx"}, "x: .*did you mean 'wear_index'"),
    ({"sweep": "creepage", "y": "wear_rate"}, "x: "),
    ({**PATCH, "x": "creepage"}, "x: "),
    ({**WEAR, "x": "max_pressure"}, "x: max_pressure is the same at all points"),
    ({**WEAR, "y": "wear_rat"}, "y: .*did you mean 'wear_rate'"),
    ({**WEAR, "y": "pressure"}, "y: "),
    ({**PATCH, "y": "wear_index"}, "y: "),
    ({**PATCH, "y": "rcf_damage"}, "y: "),
    ({**WEAR, "y": []}, "y: "),
    ({"sweep": "creepage", "x": "wear_index"}, "y: is missing"),
    ({**PATCH, "y": ["slip", "pressure"]}, "y: one axis has one unit"),
    ({**WEAR, "y": ["wear_rate", "rcf_damage"]}, "y: one axis has one unit"),
    ({**WEAR, "pairs": ["usfd on exat"]}, "pairs: .*did you mean 'usfd on exact'"),
    ({**WEAR, "pairs": []}, "pairs: "),
    ({**WEAR, "pairs": ["brr on exact"]}, "pairs: "),
    ({**WEAR, "y": "rcf_damage", "pairs": ["kth on exact"]}, "pairs: none of the pairs predicts rcf_damage"),
    ({**PATCH, "y": "wear_rate", "pairs": ["usfd on global"]}, "pairs: "),
    ({**WEAR, "contact_models": ["exat"]}, "contact_models: .*did you mean 'exact'"),
    ({**PATCH, "contact_models": ["global"]}, "contact_models: .*There are: exact"),
    ({**WEAR, "x_range": ["0 MPa", "70 MPa"]}, "x_range: "),
    ({**WEAR, "x_range": [0, 70]}, "x_range: .*no unit"),
    ({**WEAR, "x_range": ["70 N", "0 N"]}, "x_range: "),
    ({**WEAR, "x_range": ["70 N"]}, "x_range"),
    ({**WEAR, "x_range": ["0 N", "70 N"], "x_scale": "log"}, "x_range: "),
    ({**WEAR, "y_range": ["0 N", "70 N"]}, "y_range: "),
    ({**WEAR, "x_scale": "logarithmic"}, "x_scale: "),
    ({**WEAR, "measured": True}, "measured: 'wear_index' is not known"),
    ({**WEAR, "x": "creepage", "y": "rcf_damage", "measured": True}, "measured: 'rcf_damage' is not known"),
    ({**PATCH, "measured": True}, "measured: "),
    ({**WEAR, "body": "rial"}, "body: "),
    ({**WEAR, "patches": {"side": "left"}}, "patches: "),
    ({**WEAR, "panels": [{}, {"x_range": ["2 N", "1 N"]}]}, r"panels\.1\.x_range: "),
    ({**WEAR, "panels": [{"y": "slip"}]}, r"panels\.0\.y: "),
    ({**WEAR, "panels": [{"sweep": "creepage"}]}, r"panels\.0\.sweep: "),
    ({**WEAR, "sweeps": "creepage"}, "sweeps: unknown field"),
    ({**MAP, "y": "friction_coefficient"}, "y: 'friction_coefficient' is not an axis"),
    ({**MAP, "x": "wear_index"}, "x: 'wear_index' is not an axis"),
    ({**MAP, "y": "max_pressure"}, "y: "),
    ({**MAP, "map": "waer_rate"}, "map: .*did you mean 'wear_rate'"),
    ({**MAP, "panels": [{}]}, "panels: "),
    ({**MAP, "measured": True}, "measured: "),
    ({**MAP, "pairs": ["brr on exact"]}, "pairs: "),
]
ON_A_RAIL: list[tuple[Any, str]] = [
    ({**BY_LOAD, "x": "half_width"}, "x: "),
    ({**BY_LOAD, "x": "creepage"}, "x: .*did you mean 'longitudinal_creepage'"),
    ({**BY_LOAD, "x": "friction_coefficient"}, "x: friction_coefficient is the same at all points"),
    ({**BY_LOAD, "y": "averaged_wear_index"}, "y: .*did you mean"),
    ({**ACROSS, "y": "pressure"}, "y: .*There are: depth, sliding_distance"),
    ({**ACROSS, "x": "creepage"}, "x: "),
    ({**ACROSS, "body": "rial"}, "body: .*did you mean 'rail'"),
    ({**ACROSS, "body": "rail", "y_range": ["0 um/km", "1 um/km"]}, "y_range: "),
    ({**ACROSS, "y": ["depth", "sliding_distance"]}, "y: one axis has one unit"),
    ({**ACROSS, "pairs": ["kth on polach"]}, "pairs: "),
]


@pytest.mark.parametrize(
    ("fields", "spec", "said"),
    [
        *((table(sweeps=BOTH, laws=[DAMAGE]), *one) for one in ON_DISCS),
        *((ON_RAIL, *one) for one in ON_A_RAIL),
        (table(sweeps={"creepage": {**cases.SWEEP, "traction_coefficient": 0.2}}), {**WEAR, "pairs": ["usfd on exact"]},
         "pairs: "),
        (table(contact_models=["global"]), PATCH, "profile: "),
        (table(), "figure", ""),
        (table(measured={"label": "m", "tests": "lewis2004"}), {**WEAR, "y": "stick_ratio", "measured": True},
         "measured"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_figure_is_named_by_its_path(fields: Any, spec: Any, said: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=rf"figures\.one[.:]? ?{said}"):
        Case(**{**fields, "figures": {"one": spec}})


def test_all_that_is_wrong_is_said_at_once() -> None:
    panels = [{}, {"y": "slip"}]
    with pytest.raises(wl.ConfigurationError) as error:
        case(figures={"one": {**WEAR, "x": "load", "y": "wear", "panels": panels}, "a/b": WEAR})
    paths = {problem.path[1:] for problem in error.value.problems}
    assert paths == {("one", "x"), ("one", "panels", "0", "y"), ("one", "panels", "1", "y"), ("a/b",)}


GOOD = [
    WEAR, PATCH, {**WEAR, "panels": [{}, {"x_range": ["1 N", "70 N"]}], "x_scale": "log"},
    {**PATCH, "y": ["pressure", "traction"]}, {**WEAR, "pairs": ["usfd on exact"], "title": "t", "caption": "c"},
    {**WEAR, "y": "traction_coefficient", "y_range": [0, 0.5], "contact_models": ["exact"]},
]  # fmt: skip


@pytest.mark.parametrize("spec", GOOD)
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
