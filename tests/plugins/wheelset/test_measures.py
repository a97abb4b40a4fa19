"""Measures of worn profiles: those of a wheel's flange and tread, and the depth between two profiles."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import cone, through
from wearlaw import Q


def test_s1002_has_the_dimensions_of_its_name() -> None:
    """EN 13715 names it S1002/h28/e32,5/6,7%: height, thickness and the slope of its field side.

    The top, of radius 12 mm, lies between points 0.05 mm apart: it may be too low by 0.025²/24 mm.
    """
    found = {name: value.m_as("mm") for name, value in wl.Profile.s1002().measures().items()}
    assert (found["flange_height"], found["flange_thickness"]) == pytest.approx((28.0, 32.5), abs=2.7e-5)
    # On the printed arcs: of 13 mm at 10 mm above the datum, of 20 mm at 2 mm below the top.
    flank = -26.210665 - np.sqrt(13.0**2 - (16.446 - 10.0) ** 2)
    top = -58.558326413 + np.sqrt(20.0**2 - (26.0 - 8.834924130) ** 2)
    assert found["flange_gradient"] == pytest.approx(flank - top, abs=1e-3)
    assert found["hollow"] == 0.0


def test_wheel_with_its_origin_elsewhere_has_the_same_measures() -> None:
    there = wl.Profile.s1002().shifted(y="5 mm", z="-1 mm").measures("-65 mm")
    for name, value in wl.Profile.s1002().measures().items():
        assert there[name].m_as("mm") == pytest.approx(value.m_as("mm"), abs=1e-9)


def test_wheel_without_a_flange_has_no_flange_measures_and_a_rail_none_alone() -> None:
    *flange, hollow = (value.magnitude for value in cone(0.05).measures().values())
    assert np.isnan(flange).all()
    assert hollow == 0.0
    assert wl.Profile.uic60().measures() == {}


def test_hollow_is_the_rise_of_the_radius_outwards() -> None:
    y = np.linspace(-50e-3, 50e-3, 1001)
    z = -0.05 * y - 1e-3 * np.exp(-((y / 10e-3) ** 2))
    rise = max((z[k:].max() - z[k]) for k in range(z.size))
    assert through(y, z, "wheel").measures()["hollow"].m_as("m") == pytest.approx(rise, abs=1e-8)


@pytest.mark.parametrize("profile", [wl.Profile.s1002(), wl.Profile.uic60()])
def test_depth_along_the_normal_is_that_removed(profile: wl.Profile) -> None:
    s = profile.curve.s
    depth = 0.08 * np.exp(-0.5 * ((s + 20e-3) / 6e-3) ** 2)
    worn = profile.worn(Q(1e3 * s, "mm"), Q(depth, "mm"))
    inner = slice(100, -100, 50)
    found = profile.depth_to(worn, Q(1e3 * s[inner], "mm"))
    assert found.m_as("mm") == pytest.approx(depth[inner], abs=1e-6)


def cut_rail(vertical: float, side: float) -> tuple[wl.Profile, wl.Profile]:
    """Return a rail, and the same one cut by a level plane and by an upright one on its gauge side [m]."""
    new = wl.Profile.uic60()
    y, z = new.curve.y, new.curve.z
    gauge = np.interp(z.min() + 14e-3, z[y < -20e-3][::-1], y[y < -20e-3][::-1])
    worn = np.maximum(y, gauge + side if side else -np.inf), np.maximum(z, z.min() + vertical)
    moved = np.append(True, np.hypot(np.diff(worn[0]), np.diff(worn[1])) > 1e-9)
    return new, through(worn[0][moved], worn[1][moved], "rail")


@pytest.mark.parametrize(("vertical", "side"), [(0.0, 0.0), (1.5, 0.0), (0.8, 3.0)])
def test_vertical_and_side_wear_of_a_rail_are_what_was_cut_off(vertical: float, side: float) -> None:
    new, worn = cut_rail(1e-3 * vertical, 1e-3 * side)
    found = worn.measures(new=new)
    # The corners of the cuts lie more than 100 points of the spline away, which halves its ripple at each.
    assert found["vertical_wear"].m_as("mm") == pytest.approx(vertical, abs=1e-6)
    # The level lies between places 0.05 mm apart, where the side has a radius of 13 mm: 0.05²/(8*13) mm.
    assert found["side_wear"].m_as("mm") == pytest.approx(side, abs=2.5e-5)
    lower = worn.shifted(z="0.5 mm").measures(new=new.shifted(z="0.5 mm"))
    assert lower["side_wear"].m_as("mm") == pytest.approx(side, abs=2.5e-5)


def test_the_plot_has_the_measures_and_the_depth_beside_a_new_profile() -> None:
    new, worn = cut_rail(1.5e-3, 0.0)
    figure = worn.plot(new=new).get_figure()
    assert figure is not None
    upper, lower = figure.axes
    assert "vertical wear 1.50 mm" in upper.texts[0].get_text()
    y, depth = (np.asarray(values, np.float64) for values in lower.get_lines()[0].get_data())
    assert np.interp(0.0, y, depth) == pytest.approx(1.5, abs=1e-6)
    assert "flange height 28.00 mm" in wl.Profile.s1002().plot().texts[0].get_text()
    worn.plot(upper, new=new)
    assert len(figure.axes) == 2


def test_a_rail_is_not_compared_with_a_wheel() -> None:
    rail, wheel = wl.Profile.uic60(), wl.Profile.s1002()
    for compared in (
        lambda: rail.measures(new=wheel),
        lambda: wheel.plot(new=rail),
        lambda: rail.depth_to(wheel, Q(0, "mm")),
    ):
        with pytest.raises(wl.InputError, match="a worn wheel needs a new wheel to be compared with"):
            compared()
