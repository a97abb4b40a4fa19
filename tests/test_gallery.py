"""The scripts of the gallery: each runs, makes its picture, and shows numbers that are right."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

DOCS = Path(__file__).parents[1] / "docs"
SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))

HALF_WIDTH, MAX_PRESSURE = 0.31467e-3, 1500e6
"""Of 47 mm discs of steel at 741.43 kN/m; both go with the root of the load."""

SATURATION = 0.46 * HALF_WIDTH / 11.75e-3
"""Creepage of full slip at that load, μa/R."""


@pytest.fixture
def script(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Run a script in an empty folder, and return its variables."""
    monkeypatch.chdir(tmp_path)
    mpl.use("agg")
    with plt.style.context("default"):
        yield runpy.run_path(str(DOCS / "gallery" / f"{request.param}.py"))
    plt.close("all")


@pytest.mark.parametrize("script", [path.stem for path in SCRIPTS], indirect=True, ids=lambda name: str(name))
@pytest.mark.usefixtures("script")
def test_each_script_makes_its_picture(request: pytest.FixtureRequest) -> None:
    name = request.node.callspec.params["script"]
    height, width, _ = plt.imread(f"{name}.png").shape
    assert width > 900
    assert height > 450
    assert np.ptp(plt.imread(f"{name}.png")) > 0.5


def test_every_script_is_on_the_page_with_its_picture() -> None:
    page = (DOCS / "gallery.md").read_text(encoding="utf-8")
    names = [path.stem for path in SCRIPTS]
    assert sorted(re.findall(r"literalinclude} gallery/(\w+)\.py", page)) == names
    assert sorted(re.findall(r"pictures/gallery_(\w+)\.png", page)) == names
    assert len(names) >= 5


@pytest.mark.parametrize("script", ["three_laws"], indirect=True)
def test_the_plateau_of_usfd_is_drawn_at_its_rate(script: Any) -> None:
    usfd, _, brr = script["axes"].get_lines()
    inside = (usfd.get_xdata() > 70.0) & (usfd.get_xdata() < 480.0)
    assert usfd.get_ydata()[inside] == pytest.approx(55.0, rel=1e-12)
    # 100 to 200 N: 25 mm³/km of section times diameter, times π and 7850 kg/m³, over 2a of the load and 10 mm.
    area = 20.0 * HALF_WIDTH * 1e3 * np.sqrt(7400.0 / 7414.3)
    flat = (brr.get_xdata() > 110.0) & (brr.get_xdata() < 190.0)
    assert brr.get_ydata()[flat] == pytest.approx(25.0 * np.pi * 7.85 / area, rel=1e-4)  # of HALF_WIDTH's digits


@pytest.mark.parametrize("script", ["own_law"], indirect=True)
def test_the_energy_law_follows_the_energy(script: Any) -> None:
    _, own = script["axes"].get_lines()
    creepage = own.get_xdata() / 100.0
    full = creepage > 1.1 * SATURATION
    mean_pressure = np.pi / 4.0 * MAX_PRESSURE * np.sqrt(7400.0 / 7414.3) * 1e-6
    due = 5.3 * 0.46 * mean_pressure * creepage[full]
    assert own.get_ydata()[full] == pytest.approx(due, rel=1e-4)  # of the 741.43 kN/m of MAX_PRESSURE


@pytest.mark.parametrize("script", ["kth_band"], indirect=True)
def test_the_middle_of_the_band_is_archards_law_in_full_slip(script: Any) -> None:
    (middle,) = script["axes"].get_lines()
    at = int(np.searchsorted(middle.get_xdata(), 5.0))
    due = 7850.0 * 5.5e-4 * (np.pi / 4.0 * MAX_PRESSURE) * middle.get_xdata()[at] / 100.0 / 2.625e9 * 1e3
    assert middle.get_ydata()[at] == pytest.approx(due, rel=1e-9)


@pytest.mark.parametrize("script", ["wear_map"], indirect=True)
def test_full_slip_begins_at_the_creepage_of_saturation(script: Any) -> None:
    stick = script["result"].stick_ratio.magnitude
    load, creepage = script["load"][None, :], script["creepage"][:, None] / 100.0
    saturation = SATURATION * np.sqrt(load / 7.4143)
    assert np.array_equal(stick == 0.0, creepage >= saturation)
    sticks = stick > 0.0
    assert stick[sticks] == pytest.approx((1.0 - creepage / saturation)[sticks], abs=1e-4)  # of HALF_WIDTH's digits


@pytest.mark.parametrize("script", ["uncertain"], indirect=True)
def test_the_shares_and_the_interval_are_those_of_a_product(script: Any) -> None:
    # At partial slip in the mild regime the rate goes with the slope, and nearly with the square of the creepage.
    shares, u = script["shares"]["first_order"], script["u"]
    assert shares.sum() == pytest.approx(1.0, abs=0.03)  # what is missing are products of relative variances of 5 %
    assert shares["load"] < shares["friction"] < shares["slope $m_m$"]
    assert script["low"] < u.median < script["high"]
