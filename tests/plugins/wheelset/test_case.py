"""The case that ships with wheelsets, and cases with profiles from files."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Q
from wearlaw.errors import CaseError

RIG = """
title = "A worn wheel"
contact_models = ["fastsim"]
wear_laws = ["usfd"]
sections = ["wheelset"]

[rig]
type = "wheelset"
wheel = "profiles/worn.prw"
rail = { file = "profiles/rail.prr", smoothing = "0 mm" }
nominal_radius = "460 mm"
flange_back_distance = "1360 mm"
gauge = "1435 mm"
rail_cant = "1:40"
material = "steel"
rolling_speed = "20 m/s"

[sweeps.displacement]
lateral_displacement = { from = "0 mm", to = "3 mm", points = 4 }
vertical_load = "50 kN"
friction_coefficient = 0.3

[profiles.straight]
lateral_displacement = "1 mm"
vertical_load = "50 kN"
friction_coefficient = 0.3
"""


@pytest.fixture(scope="module")
def worn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the path of a case beside a folder with the profiles that it names."""
    folder = tmp_path_factory.mktemp("wheelset") / "study" / "profiles"
    folder.mkdir(parents=True)
    wl.write_profile(folder / "worn.prw", wl.Profile.s1002())
    wl.write_profile(folder / "rail.prr", wl.Profile.uic60())
    case = folder.parent / "worn.toml"
    case.write_text(RIG, encoding="utf-8")
    return case


@pytest.fixture(scope="module")
def study(worn: Path) -> wl.Study:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return wl.run(wl.load_case(str(worn)))


def test_paths_of_profiles_are_relative_to_the_case_file(worn: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(worn.parent.parent)
    rig = wl.load_case("study/worn.toml").rig
    assert isinstance(rig, wl.Wheelset)
    formula = rig.model_copy(update={"wheel": wl.Profile.s1002(), "rail": wl.Profile.uic60()})
    at = Q(np.linspace(0.0, 5.0, 6), "mm")
    found, expected = (
        one.geometry(lateral_displacement=at).dataset["rolling_radius_difference"].values for one in (rig, formula)
    )
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-2)  # splines through points smear joints of arcs
    monkeypatch.chdir(worn.parent)
    assert wl.load_case("worn.toml").rig == rig


def test_a_missing_profile_is_looked_for_beside_the_case_file(worn: Path) -> None:
    case = worn.parent / "missing.toml"
    case.write_text(RIG.replace("worn.prw", "missing.prw"), encoding="utf-8")
    with pytest.raises(CaseError, match=r"rig\.wheel: 'profiles/missing\.prw' is neither .* nor a file in '.*study'"):
        wl.load_case(str(case))


def test_a_study_of_a_wheelset_reports_contact_points_forces_and_wear(study: wl.Study) -> None:
    (section,) = study.sections
    assert [figure.name for figure in section.figures] == [
        "rolling_radius_difference", "contact_straight", "wear_straight",
    ]  # fmt: skip
    for panel in section.figures[1].panels:  # in track axes, flanges are between the rails: near y = 0
        wheel = next(curve for curve in panel.curves if curve.label == "wheel")
        deepest = np.asarray(wheel.x)[np.nanargmax(wheel.y)]
        outwards = np.asarray(wheel.x)[np.nanargmax(np.abs(wheel.x))]
        assert np.sign(outwards) == {"left wheel": -1.0, "right wheel": 1.0}[panel.title]
        assert abs(deepest) < 717.5 < abs(outwards)
    table = section.tables["patches_of_straight"]
    assert [*table["side"]] == ["left", "right"]
    load = table["normal force [kN]"] * np.cos(np.radians(table["contact angle [deg]"]))
    load += table["lateral force [kN]"] * np.sin(np.radians(table["contact angle [deg]"]))
    # Rows that bend by 0.05 rad carry less than their sum, by half of the square of that.
    np.testing.assert_allclose(load, 50.0, rtol=0.05**2 / 2.0)


def test_wear_in_the_report_is_that_of_the_prediction(study: wl.Study) -> None:
    """The area below the curve of a wheel, times its circumference and the density, is the mass that it loses."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        (pair,) = study.pairs
        found = pair.pipeline(lateral_displacement="1 mm", vertical_load="50 kN", friction_coefficient=0.3)
    panels = {panel.title: panel for panel in study.sections[0].figures[-1].panels}
    for side in ("left", "right"):
        (curve,) = panels[f"{side} wheel"].curves
        area = np.trapezoid(curve.y, curve.x)  # µm/km mm
        one = found.sel(side=side, patch=1)
        radius = float(np.asarray(one.problem.body("wheel").rolling_radius))
        mass = Q(area, "um*mm/km") * Q(2.0 * np.pi * radius, "m") * wl.steel().density
        assert (mass / one.mass_per_distance).to("").magnitude == pytest.approx(1.0, rel=1e-12)  # rounding


def test_the_section_needs_a_wheelset() -> None:
    text = wl.load_case("wheel_on_rail")
    case = text.model_copy(update={"sections": ("wheelset",), "figures": {}})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        with pytest.raises(wl.InputError, match="the rig of the case is 'wheel_rail'"):
            wl.run(case)
