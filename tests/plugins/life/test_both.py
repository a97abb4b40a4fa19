"""A wheel and a rail in one life: its limits, the mass of both, its store and its mistakes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.life.test_life import GIVEN, last, line, pipeline
from wearlaw import Q
from wearlaw.errors import ResumeWarning
from wearlaw_apps.life import Life
from wearlaw_apps.life.line import Line  # private: the pipelines of the steps
from wearlaw_apps.life.removal import even, swept  # private: the section between two profiles

PER_KM = 20.0

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")


def both(predict: wl.Pipeline[...] | None = None, **changed: Any) -> Life:
    return wl.wear_out(predict or pipeline(), line(3), **{"over": "1000 km", "body": "both", **GIVEN, **changed})


def test_without_passages_it_is_the_life_of_a_wheel() -> None:
    found, alone = both(passages_per_km=0.0), both(pipeline(rail=even(wl.Profile.uic60())), body="wheel")
    assert len(alone.table) > 3
    assert found.table[alone.table.columns].to_numpy() == pytest.approx(alone.table.to_numpy(), rel=1e-12)
    assert last(found, "rail_mass [kg]") == last(found, "rail_depth [mm]") == 0.0


def test_with_many_passages_it_is_the_life_of_a_rail() -> None:
    """The wheel runs 3 m while 300 000 wheels pass. Its own wear stands for a few millionths of the rail's."""
    found = both(over="3 m", passages_per_km=1e8)
    alone = both(pipeline(wheel=even(wl.Profile.s1002())), over=3e5, body="rail")
    assert len(found.table) == len(alone.table) > 3
    share = last(found, "depth [mm]") / last(alone, "depth [mm]")
    assert share < 5e-6
    for column in ("mass [kg]", "depth [mm]", "worn_area [mm^2]", "vertical_wear [mm]"):
        # What the wheel wears moves the contact as the same depth of the rail does.
        expected = pytest.approx(alone.table[column].to_numpy(), rel=10.0 * share)
        assert found.table[f"rail_{column}"].to_numpy() == expected


def test_each_step_wears_both_by_predictions_on_both_worn_profiles(monkeypatch: pytest.MonkeyPatch) -> None:
    steps: list[tuple[Any, list[wl.Array]]] = []

    def recorded(self: Line, step: int, predict: wl.Pipeline[...], at: Any, failures: Any) -> Any:
        wears, notes = wear(self, step, predict, at, failures)
        steps.append((predict, [of_body.mass for of_body in wears]))
        return wears, notes

    wear = Line.wear
    monkeypatch.setattr(Line, "wear", recorded)
    found = both(passages_per_km=PER_KM)
    table, states = found.table, line(3)
    assert len(steps) == len(table) - 1 > 3
    position = Q(states.iloc[:, 0].to_numpy(), "mm")
    for predict, masses in steps:
        r = predict(lateral_displacement=position, **GIVEN)
        for body, mass in zip(("wheel", "rail"), masses, strict=True):
            lost = np.nansum(r.mass_lost("1 m", body).m_as("kg"), axis=-1)
            assert mass == pytest.approx(states["share"].to_numpy() @ lost, rel=1e-9)
    # The first step has nothing to extrapolate from.
    (wheel, rail), distance = steps[0][1], 1e3 * table["distance [km]"].iloc[1]
    assert table["rail_passages"].to_numpy() == pytest.approx(PER_KM * table["distance [km]"].to_numpy(), rel=1e-12)
    assert table["mass [kg]"].iloc[1] == pytest.approx(distance * wheel.mean(), rel=1e-9)
    assert table["rail_mass [kg]"].iloc[1] == pytest.approx(1e-3 * PER_KM * distance * rail.mean(), rel=1e-9)
    first, worn = steps[0][0].rig.rail, found.pipeline.rig.rail  # type: ignore[attr-defined]
    assert last(found, "rail_mass [kg]") == pytest.approx(7850.0 * swept(first, worn), rel=1e-9)
    deepest = [first.depth_to(predict.rig.rail, Q(1e3 * first.curve.s, "mm")).m_as("mm").max() for predict, _ in steps]
    assert deepest[1:] == pytest.approx(table["rail_depth [mm]"].iloc[1:-1].to_numpy(), rel=1e-12)
    depth = found.profiles["depth"].isel(side=0)
    for body, column in (("wheel", "depth [mm]"), ("rail", "rail_depth [mm]")):
        shown = depth.sel(body=body).max("place").values  # at 601 places, 0.3 mm apart
        assert shown == pytest.approx(table[column].to_numpy(), rel=1e-3, abs=1e-12)
    measures, *of_bodies = found.figure().panels
    assert [panel.title.split(",")[0] for panel in of_bodies] == ["wheel", "wheel", "rail", "rail"]
    assert "rail depth" in [curve.label for curve in measures.curves]


def test_limits_of_the_rail_end_the_life() -> None:
    found = both(passages_per_km=20.0 * PER_KM, until={"rail_depth": "0.01 mm"}, over="100000 km")
    assert found.ended == "rail_depth"
    assert last(found, "rail_depth [mm]") == pytest.approx(0.01, rel=1e-5)


def test_cuts_restore_the_wheel_and_leave_the_rail() -> None:
    found = both(passages_per_km=PER_KM, turn={"depth": "0.03 mm"}, over="1500 km")
    cut = int(np.flatnonzero(np.diff(found.table["distance [km]"]) == 0.0)[0])
    before, after = found.table.iloc[cut], found.table.iloc[cut + 1]
    assert after["depth [mm]"] == pytest.approx(0.0, abs=1e-9)
    assert after["rail_depth [mm]"] == before["rail_depth [mm]"] > 0.0
    assert found.table["rail_depth [mm]"].is_monotonic_increasing


def test_each_side_has_its_own_wheel_and_rail_and_resumes(tmp_path: Path) -> None:
    given: dict[str, Any] = {"passages_per_km": PER_KM, "sides": "each", "store": tmp_path / "life"}
    found = both(**given, over="500 km")
    masses = [last(found, f"rail_mass_{side} [kg]") for side in ("left", "right")]
    assert masses[0] == pytest.approx(masses[1], rel=1e-6)  # as the wheels' of a line that is symmetric
    with pytest.warns(ResumeWarning):
        again = both(**given, over="500 km", resume=True)
    assert again.table.equals(found.table)


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({}, "passages_per_km"),
        ({"passages_per_km": -1.0}, "passages_per_km"),
        ({"passages_per_km": 1.0, "body": "wheel"}, "passages_per_km"),
    ],
)
def test_mistakes_say_what_is_missing(changed: dict[str, Any], named: str) -> None:
    with pytest.raises(wl.InputError, match=named):
        both(**changed)


def test_a_roller_is_no_rail() -> None:
    predict = pipeline(roller_radius="350 mm")
    with pytest.raises(wl.InputError, match="roller"):
        wl.wear_out(predict, line(3), over="1 km", body="both", passages_per_km=1.0, **GIVEN)
