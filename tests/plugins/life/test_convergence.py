"""The life of a wheel converges: in its step, in the points of the profile, and in the states of the line."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.life.test_life import GIVEN, line, pipeline
from wearlaw_life import Life
from wearlaw_life._removal import Profile

pytestmark = pytest.mark.filterwarnings(
    "ignore::wearlaw.RangeWarning",
    "ignore::wearlaw.CalibrationWarning",
)

Y = np.linspace(-35e-3, 30e-3, 601)
"""Places across the worn part of the wheel [m]."""


def life(states: pd.DataFrame, over: str, **options: Any) -> Life:
    return wl.wear_out(pipeline(), states, over=over, **{"conicity_step": math.inf, **GIVEN, **options})


def height(profile: Profile) -> np.ndarray[Any, Any]:
    curve = profile.curve
    tread = curve.y > -45e-3
    return np.asarray(np.interp(Y, curve.y[tread], curve.z[tread]))


def test_error_falls_with_the_square_of_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half the step leaves a quarter of the error, or a third where contacts jump; one of first order leaves half."""
    monkeypatch.setattr("wearlaw_life._wear_out.CORRECTION", math.inf)  # the depth alone sets the steps
    steps = (0.02, 0.01, 0.0025)
    heights = [height(life(line(25, 2.0), "2000 km", depth_step=f"{step} mm").profile) for step in steps]
    errors = [np.sqrt(((one - heights[-1]) ** 2).mean()) for one in heights[:-1]]
    order = math.log2(errors[0] / errors[1])
    print(f"order in the step {order:.2f}, errors {errors}")
    assert order > 1.6


def test_error_falls_with_the_square_of_the_spacing() -> None:
    """Cells take means, of which the error is of second order."""
    heights = [height(life(line(5), "500 km", spacing=f"{one} mm").profile) for one in (1.6, 0.8, 0.05)]
    errors = [np.sqrt(((one - heights[-1]) ** 2).mean()) for one in heights[:-1]]
    order = math.log2(errors[0] / errors[1])
    print(f"order in the spacing {order:.2f}, errors {errors}")
    assert order > 1.6


def test_no_ridges_on_a_tangent_track() -> None:
    """The conicity changes from step to step by no more than 0.005, and does not zigzag: it rises once, then falls."""
    found = life(line(25, 1.5), "6000 km", conicity_step=0.005)
    change = found.table["equivalent_conicity"].diff().iloc[1:].to_numpy()
    print(f"conicity {found}, largest change {abs(change).max():.4f}")
    assert abs(change).max() <= 0.005
    assert np.count_nonzero(np.diff(np.sign(change))) <= 1


def test_25_and_400_drawn_states_end_within_the_sampling_error() -> None:
    """States of equal shares drawn from one distribution: mass and conicity of 400 lie among those of 25."""
    random = np.random.default_rng(42)

    def drawn(count: int) -> Life:
        displacement = np.clip(random.normal(0.0, 1.5, count), -5.0, 5.0)
        return life(pd.DataFrame({"lateral_displacement [mm]": displacement, "share": 1.0 / count}), "1500 km")

    few = [drawn(25).rows[-1] for _ in range(8)]
    many = drawn(400).rows[-1]
    for name in ("mass", "equivalent_conicity"):
        values = np.array([one[name] for one in few])
        spread = values.std(ddof=1)
        print(f"{name}: 25 states {values.mean():.5g} ± {spread:.2g}, 400 states {many[name]:.5g}")
        # A draw of 25 beside one of 400: their variances add up, and three standard deviations hold nearly always.
        assert abs(values.mean() - many[name]) < 3.0 * spread * math.sqrt(1.0 + 25.0 / 400.0)


def test_contacts_that_come_and_go_leave_no_ridges() -> None:
    """A line with curves wears two places by turns; too long a step wears one too deep, then the other.

    Extrapolated depths would then be negative, of which the removal cannot conserve the mass within a thousandth.
    """
    y = np.array([*np.linspace(-3.0, 3.0, 13), *np.linspace(3.5, 5.8, 6), *-np.linspace(3.5, 5.8, 6)])
    curved = np.abs(y) > 3.0
    table = {
        "lateral_displacement [mm]": y,
        "yaw [mrad]": np.where(curved, 3.0 * np.sign(y), 0.0),
        "curve_radius [m]": np.where(curved, -800.0 * np.sign(y), np.inf),
        "share": np.where(curved, 0.25 / 12.0, 0.75 * np.exp(-0.5 * (y / 1.5) ** 2)),
    }
    states = pd.DataFrame(table)
    states["share"] /= states["share"].sum()
    found = life(states, "9000 km").table
    print(f"factor {abs(found['factor'] - 1.0).max():.2g} from one at most")
    assert abs(found["factor"] - 1.0).max() < 1e-3
    assert (found["depth [mm]"].diff().iloc[1:] > 0.0).all()
