"""States that follow from the profiles: a line that is a function of the rig at each step."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.life.test_life import GIVEN, last, line, pipeline
from wearlaw.errors import OutputError

pytestmark = pytest.mark.filterwarnings(
    "ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning", "ignore::wearlaw.errors.ResumeWarning"
)


def narrowing(rig: Any) -> pd.DataFrame:
    """Return states whose displacements shrink with the conicity, as free motion does not."""
    table = line(3)
    table.iloc[:, 0] *= float(rig.equivalent_conicity(amplitude="3 mm").m_as("")) / 0.2
    return table


def test_a_function_that_returns_one_table_is_that_line() -> None:
    function, table = (wl.wear_out(pipeline(), states, over="800 km", **GIVEN) for states in (lambda _: line(), line()))
    assert function.table.equals(table.table)


def test_a_function_takes_the_worn_rig_of_each_step() -> None:
    rigs: list[Any] = []

    def states(rig: Any) -> pd.DataFrame:
        rigs.append(rig)
        return narrowing(rig)

    found = wl.wear_out(pipeline(), states, over="800 km", **GIVEN)
    assert [rig.wheel for rig in rigs] == [profile for (profile,) in found.worn_profiles[:-1]]
    held = wl.wear_out(pipeline(), narrowing(rigs[0]), over="800 km", **GIVEN)
    assert last(found, "mass [kg]") != pytest.approx(last(held, "mass [kg]"), rel=1e-4)


def test_mirrored_states_wear_the_mirror_image() -> None:
    """Rounding moves contact points by up to 2e-9 m (`wheelset/test_positions`)."""
    states = line(3).assign(**{"yaw [mrad]": [1.0, 0.0, 2.0], "lateral_displacement [mm]": [-1.0, 1.0, 3.0]})
    mirrored = states.assign(**{name: -states[name] for name in ("yaw [mrad]", "lateral_displacement [mm]")})
    right, left = (wl.wear_out(pipeline(), each, over="300 km", sides="each", **GIVEN) for each in (states, mirrored))
    assert last(right, "mass_right [kg]") > 1.1 * last(right, "mass_left [kg]")
    for column in right.table:
        side = str(column)
        other = side.replace("_left", "_right") if "_left" in side else side.replace("_right", "_left")
        assert left.table[other].to_numpy() == pytest.approx(right.table[column].to_numpy(), rel=1e-6, abs=1e-6)
    ends = [[profile.points[1].magnitude for profile in life.worn_profiles[-1]] for life in (right, left)]
    for here, there in zip(ends[0], reversed(ends[1]), strict=True):
        assert here == pytest.approx(there, abs=1e-6)


def test_a_stored_life_keeps_the_states_of_each_step_and_compares_them(tmp_path: Path) -> None:
    path = tmp_path / "life.zarr"
    first = wl.wear_out(pipeline(), narrowing, over="800 km", store=path, **GIVEN)
    again = wl.wear_out(pipeline(), narrowing, over="800 km", store=path, resume=True, **GIVEN)
    assert again.table.equals(first.table)
    import zarr

    step = len(first.table) - 2
    part: Any = zarr.open_group(str(path), path=f"part_{step:06d}", mode="r")
    last_rig = wl.Wheelset(**{**dict(first.pipeline.rig), "wheel": first.worn_profiles[-2][0]})
    expected = narrowing(last_rig)["lateral_displacement [mm]"].to_numpy()
    assert part["line_lateral_displacement"][...] == pytest.approx(expected, abs=1e-12)

    def forgetful(rig: Any) -> pd.DataFrame:
        table = narrowing(rig)
        worn = rig.wheel != first.worn_profiles[0][0]
        return table.assign(share=[0.2, 0.5, 0.3]) if worn else table

    with pytest.raises(OutputError, match=r"(?s)holds another life .* step 2\.share: was 3 values"):
        wl.wear_out(pipeline(), forgetful, over="800 km", store=path, resume=True, **GIVEN)


@pytest.mark.parametrize(
    ("returned", "named"),
    [
        (None, "must return a pandas.DataFrame or an xarray.Dataset, got None"),
        (line(3).drop(columns="share"), "share"),
        (line(3).assign(share=0.2), "add up to 0.6"),
        (line(3).rename(columns={"lateral_displacement [mm]": "lateral_displacement [kN]"}), "lateral_displacement"),
    ],
)
def test_a_return_that_is_no_table_of_states_names_step_and_column(returned: Any, named: str) -> None:
    with pytest.raises(wl.InputError, match=rf"(?s)^step 1: .*{named}"):
        wl.wear_out(pipeline(), lambda _: returned, over="800 km", **GIVEN)
    answers = iter([line(3), returned])
    with pytest.raises(wl.InputError, match=rf"(?s)^step 2, after .* km: .*{named}"):
        wl.wear_out(pipeline(), lambda _: next(answers), over="800 km", **GIVEN)
