"""Turning worn wheels: the cut in closed form, and a life with cuts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.life.test_life import GIVEN, last, line, pipeline
from tests.plugins.wheelset.wheelsets import R0, cone
from wearlaw.errors import OutputError, ResumeWarning
from wearlaw_apps.life import Life
from wearlaw_apps.life.removal import between, even, positions, removed, swept  # private: wear in closed form
from wearlaw_apps.life.turning import least_cut  # private: the depth of a cut alone

FLANGES = pd.DataFrame({"lateral_displacement [mm]": [-6.2, 6.2], "share": 0.5})
LIMITS: dict[str, Any] = {"turn": {"flange_thickness": "32.48 mm"}, "least_diameter": "919.3 mm"}
LONG_STEPS: dict[str, Any] = {"depth_step": "0.1 mm", "conicity_step": 1.0, **GIVEN}

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("turning") / "life"


@pytest.fixture(scope="module")
def turned(store: Path) -> Life:
    return wl.wear_out(pipeline(), FLANGES, over="100000 km", store=store, **LIMITS, **LONG_STEPS)


def test_cut_of_a_cone_is_the_depth_over_the_cosine() -> None:
    start = even(cone(0.05))
    worn = removed(start, np.full(start.curve.s.size, 0.3e-3))
    assert least_cut(start, worn) == pytest.approx(0.3e-3 * np.sqrt(1.0 + 0.05**2), rel=1e-6)


def test_cut_of_a_worn_flank_is_the_depth_over_the_cosine_of_its_angle() -> None:
    """S1002 is straight at atan 2.747 from y = -39.8 to -38.4 mm: the wear is even there, and less elsewhere."""
    start = even(wl.Profile.s1002())
    at = positions([start], 4000)
    y = np.interp(at, start.curve.s, start.curve.y)
    depth = 0.2e-3 * np.exp(-0.5 * (np.maximum(np.abs(y + 39.1e-3) - 0.7e-3, 0.0) / 1e-3) ** 2)
    cut = least_cut(start, removed(start, between(start, at, depth)))
    assert cut == pytest.approx(0.2e-3 * np.sqrt(1.0 + 2.747477419**2), rel=1e-4)  # linear between points, R = 13 mm


def test_each_cut_restores_the_profile_inside_the_worn_one(turned: Life) -> None:
    """The depth of the restored profile along the normals of the worn one is independent of the cut's formula."""
    table, cuts = turned.table, turned.cuts
    assert turned.ended == "diameter"
    assert len(cuts) >= 2
    radius = 920.0
    for cut in cuts.itertuples():
        before, after = np.flatnonzero(table["distance [km]"] == cut[1])
        assert table["flange_thickness [mm]"][before] == pytest.approx(32.48, abs=1e-6)
        same = [
            "depth [mm]",
            "worn_area [mm^2]",
            *(str(name) for name in table if "flange" in str(name)),
            "hollow [mm]",
        ]
        assert table.loc[after, same].to_numpy() == pytest.approx(table.loc[0, same].to_numpy(), abs=1e-9)
        worn, new = turned.worn_profiles[before][0], turned.worn_profiles[after][0]
        shift = 0.5 * (radius - table["diameter [mm]"][after])
        restored = new.shifted(z=wl.Q(-shift, "mm"))
        s = worn.curve.s[(worn.curve.y > -54e-3) & (worn.curve.y < 55e-3)]
        depth = worn.depth_to(restored, wl.Q(1e3 * s, "mm")).m_as("mm")
        # Points of both profiles are 0.05 mm apart: chords of h²/(8 R) each.
        between = 2.0 * 0.05**2 / 8.0 * 1e-3 * np.abs(worn.curve.curvature).max()
        assert depth.min() == pytest.approx(0.0, abs=between)
        radius = table["diameter [mm]"][after]
    assert cuts["since_last [km]"].sum() == pytest.approx(cuts["distance [km]"].iloc[-1])
    assert cuts["diameter_lost [mm]"].sum() == pytest.approx(920.0 - cuts["diameter [mm]"].iloc[-1])
    rig: Any = turned.pipeline.rig
    assert 2.0 * rig.nominal_radius.m_as("mm") == pytest.approx(cuts["diameter [mm]"].iloc[-1])


def test_mass_worn_between_cuts_is_that_of_wheels_of_the_diameters_left(turned: Life) -> None:
    table, volume, radius, begun = turned.table, 0.0, R0, 0
    for diameter, distance in zip(turned.cuts["diameter [mm]"], turned.cuts["distance [km]"], strict=True):
        before = int(np.flatnonzero(table["distance [km]"] == distance)[0])
        volume += swept(turned.worn_profiles[begun][0], turned.worn_profiles[before][0], radius)
        radius, begun = 0.5e-3 * diameter, before + 1
    volume += swept(turned.worn_profiles[begun][0], turned.profile, radius)
    assert last(turned, "mass [kg]") == pytest.approx(7850.0 * volume, rel=1e-9)


def test_rates_are_those_up_to_the_first_cut(turned: Life) -> None:
    distance = turned.cuts["distance [km]"][0]
    worn = 32.48 - turned.table["flange_thickness [mm]"][0]
    assert turned.rates["flange_thickness"] * distance / 1e3 == pytest.approx(worn, abs=1e-6)
    before = np.flatnonzero(turned.table["distance [km]"] == distance)[0]
    worn = turned.table["diameter [mm]"][before] - 920.0
    assert turned.rates["diameter"] * distance / 1e3 == pytest.approx(worn, rel=1e-9)
    assert "mass" not in turned.rates


def test_repr_and_figure_say_which_limit_governs(turned: Life) -> None:
    text = repr(turned)
    assert f"cuts: {len(turned.cuts)} at the limit of flange thickness" in text
    assert "to the limit of diameter" in text
    *_, measures = turned.figure().panels
    labels = [curve.label for curve in measures.curves]
    assert labels == ["flange thickness, 32.5 to 32.48 mm", "diameter, 920 to 919.3 mm"]


def test_both_sides_are_turned_to_one_diameter() -> None:
    """The right wheel alone touches its flange: the cut is its own, and the left wheel pays for it."""
    one_sided = FLANGES.assign(share=[0.0, 1.0])
    found = wl.wear_out(pipeline(), one_sided, over="25 km", sides="each", turn=LIMITS["turn"], **LONG_STEPS)
    (cut,) = found.cuts.to_dict("records")
    assert cut["limit"] == "flange_thickness_right"
    assert cut["diameter_left [mm]"] == cut["diameter_right [mm]"]
    assert cut["diameter_lost_left [mm]"] == pytest.approx(cut["diameter_lost_right [mm]"])


def test_interrupted_life_with_cuts_goes_on(store: Path, turned: Life) -> None:
    with pytest.warns(ResumeWarning):
        again = wl.wear_out(pipeline(), FLANGES, over="100000 km", store=store, resume=True, **LIMITS, **LONG_STEPS)
    assert again.table.equals(turned.table)
    assert again.cuts.equals(turned.cuts)
    ending = {"until": LIMITS["turn"], "least_diameter": LIMITS["least_diameter"]}
    with pytest.raises(OutputError, match="turn"):
        wl.wear_out(pipeline(), FLANGES, over="100000 km", store=store, resume=True, **ending, **LONG_STEPS)


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"body": "rail", "over": 10.0, "turn": {"side_wear": "1 mm"}}, "turn: the rail"),
        ({"turn": {"depth": "1 mm"}, "until": {"depth": "2 mm"}}, "turn: depth is also"),
        ({"turn": {"flange": "28 mm"}}, "has no 'flange'"),
        ({"turn": {"flange_thickness": "33 mm"}}, "must lie below"),
        ({"least_diameter": "925 mm"}, "limit of diameter: must lie below"),
    ],
)
def test_mistakes(options: dict[str, Any], named: str) -> None:
    with pytest.raises(wl.InputError, match=named):
        wl.wear_out(pipeline(), line(3), **{"over": "10 km", **GIVEN, **options})
