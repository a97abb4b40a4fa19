"""Profiles by name, and what is said of inputs that look like others."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Q

WIDTHS = {"uic60": 72.0, "rail_60e1": 72.0, "rail_60e2": 72.0, "rail_54e1": 70.0}
"""Widths of heads where the sides of 1 in 20 begin [mm] (EN 13674-1)."""

TABLE: dict[str, list[tuple[float, float]]] = {
    "rail_60e1": [(10.228, 300.0), (26.0265, 80.0)],
    "rail_60e2": [(11.889, 200.0), (24.4565, 70.0), (35.387, 16.0)],
    "rail_54e1": [(10.012, 300.0), (24.8635, 80.0)],
}
"""Ends and radii of arcs [mm]."""


@pytest.mark.parametrize("name", WIDTHS)
def test_heads_of_rails_are_as_wide_as_the_standard_says(name: str) -> None:
    # The width follows from the radii and ends of the arcs, so that a wrong digit of any shows.
    curve = wl.Profile.named(name).curve
    side = np.flatnonzero(np.abs(np.tan(curve.angle)) > 20.0 - 1e-6)
    inner = curve.y[side][curve.y[side] > 0.0].min(), -curve.y[side][curve.y[side] < 0.0].max()
    assert 2e3 * np.array(inner) == pytest.approx([WIDTHS[name]] * 2, abs=5e-3)  # of points 0.05 mm apart


@pytest.mark.parametrize("name", TABLE)
def test_heads_of_rails_have_the_radii_of_the_drawing(name: str) -> None:
    curve, begin = wl.Profile.named(name).curve, 0.0
    for end, radius in TABLE[name]:
        middle = 0.5e-3 * (begin + end)
        near = np.abs(curve.y - middle).argmin()
        assert curve.curvature[near] == pytest.approx(1e3 / radius, rel=1e-3)
        begin = end
    assert np.interp(0.0, curve.y, curve.z) == pytest.approx(0.0, abs=2e-9)  # between points of the arc
    assert wl.Profile.named(name).apparent_cant.to("rad").magnitude == pytest.approx(0.0, abs=1e-6)


def test_cones_have_their_conicity() -> None:
    for name, slope in (("cone20", 1.0 / 20.0), ("cone40", 1.0 / 40.0)):
        curve = wl.Profile.named(name).curve
        assert np.tan(curve.angle) == pytest.approx(np.full(curve.y.size, -slope), rel=1e-12)
        assert np.interp(0.0, curve.y, curve.z) == pytest.approx(0.0, abs=1e-15)


def test_names_are_listed_shown_and_suggested() -> None:
    from click.testing import CliRunner

    from wearlaw.cli import main  # private: the program itself

    listed = CliRunner().invoke(main, ["plugins"]).output
    assert all(f"profile        {name}" in listed for name in (*WIDTHS, "s1002", "cone20"))
    assert "EN 13674-1" in CliRunner().invoke(main, ["show", "rail_54e1"]).output
    for name, near in (("60E1", "rail_60e1"), ("S1002 ", "s1002"), ("uic_60", "uic60")):
        with pytest.raises(wl.InputError, match=near):
            wheelset(rail=name)


@pytest.mark.parametrize(
    ("changed", "said"),
    [({"nominal_radius": "920 mm"}, "nominal_radius"), ({"rail": "wheel as rail"}, "wheel")],
)
def test_inputs_that_look_like_others_are_doubted(changed: dict[str, Any], said: str, tmp_path: Path) -> None:
    if "rail" in changed:
        y, z = (value.magnitude for value in wl.Profile.s1002().points)
        np.savetxt(tmp_path / "mine.csv", np.column_stack([y, z]), delimiter=",")
        with pytest.warns(wl.UnusualWarning, match=said):
            wl.read_profile(tmp_path / "mine.csv", kind="rail")
        return
    with pytest.warns(wl.UnusualWarning, match=said):
        wheelset(**changed)


@pytest.mark.parametrize(("smoothing", "warns"), [("0 mm", True), ("0.02 mm", False)])
def test_a_pressure_of_single_points_is_told_from_one_of_the_shape(smoothing: str, warns: bool) -> None:
    y, z = (value.magnitude for value in wl.Profile.s1002().points)
    keep = np.unique(np.round(y / 0.25).astype(int), return_index=True)[1]
    noisy = z[keep] + np.random.default_rng(3).normal(scale=0.01, size=keep.size)
    wheel = wl.Profile.from_points(y=Q(y[keep], "mm"), z=Q(noisy, "mm"), kind="wheel", smoothing=smoothing)
    pipeline = wheelset(wheel=wheel) | wl.contact_model("fastsim")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        pipeline(lateral_displacement="2 mm", vertical_load="80 kN", friction_coefficient=0.3)
    assert any("smoothing" in str(one.message) for one in caught) == warns
