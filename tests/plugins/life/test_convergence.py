"""The life of a wheel converges: in its step, in the points of the profile, and in the states of the line."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.life.test_life import GIVEN, line, pipeline
from tests.plugins.wheelset.wheelsets import cone, on_round_heads
from wearlaw import Q
from wearlaw_apps.life import Life

pytestmark = pytest.mark.filterwarnings(
    "ignore::wearlaw.RangeWarning",
    "ignore::wearlaw.CalibrationWarning",
)

Y = np.linspace(-35e-3, 30e-3, 601)
"""Places across the worn part of the wheel [m]."""


def life(states: pd.DataFrame, over: str, **options: Any) -> Life:
    return wl.wear_out(pipeline(), states, over=over, **{"conicity_step": math.inf, **GIVEN, **options})


def height(profile: Any) -> np.ndarray[Any, Any]:
    curve = profile.curve
    tread = curve.y > -45e-3
    return np.asarray(np.interp(Y, curve.y[tread], curve.z[tread]))


def orders(steps: tuple[float, ...], run: Callable[[str], Life]) -> list[float]:
    """Return the order of convergence over three runs each, of steps that halve [mm]."""
    heights = [height(run(f"{step} mm").profile) for step in steps]
    changes = [np.sqrt(((one - other) ** 2).mean()) for one, other in itertools.pairwise(heights)]
    found = [math.log2(one / other) for one, other in itertools.pairwise(changes)]
    print(f"orders {np.round(found, 2)} of the step, changes {changes}")
    return found


def test_smooth_wear_converges_in_first_order_of_the_step_at_least() -> None:
    """A cone on round heads touches them once, at places that move smoothly as it wears.

    The method is of the second order, but rows of the pressure stay where they are as the wheel wears past them.
    """
    predict = on_round_heads(cone(0.05), 0.3) | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")

    def run(depth_step: str) -> Life:
        given = {
            **GIVEN,
            "smoothing": "0 mm",
            "resolution": "5 mm",
            "conicity_step": math.inf,
            "depth_step": depth_step,
        }
        return wl.wear_out(predict, line(9, 2.0), over="3000 km", **given)

    assert min(orders((0.08, 0.04, 0.02, 0.01), run)) > 1.0


def test_wear_with_jumps_converges_in_an_order_between_first_and_second() -> None:
    """On S1002 contacts jump as the profile wears: each jump leaves an error of first order, of its state's share."""
    (order,) = orders((0.04, 0.02, 0.01), lambda step: life(line(25, 2.0), "2000 km", depth_step=step))
    assert 1.0 < order < 2.2  # three runs give it to some tenths


def test_error_falls_with_the_square_of_the_spacing() -> None:
    """Cells take means, of which the error is of second order; those of 1 mm and more are not yet small to patches."""
    heights = [
        height(life(line(5), "500 km", spacing=f"{one} mm", resolution="3 mm").profile) for one in (0.8, 0.4, 0.05)
    ]
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

    few = [drawn(25).table.iloc[-1] for _ in range(8)]
    many = drawn(400).table.iloc[-1]
    for name in ("mass [kg]", "equivalent_conicity"):
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


def test_a_millimetre_of_wear_leaves_the_tread_smooth() -> None:
    """With wear that is constant during each step, which needs no extrapolation, the total variation is 200 /m.

    A depth that is clipped at zero leaves a kink at each step: 6800 /m with steps of 0.1 mm, and a factor of 0.8.
    """
    found = life(line(9), "1000000 km", until={"depth": "1 mm"}, depth_step="0.1 mm")
    curve = found.profile.curve
    tread = (curve.y > -25e-3) & (curve.y < 50e-3)
    variation = np.abs(np.diff(curve.curvature[tread])).sum()
    print(f"total variation {variation:.0f} /m, factor {found.table['factor'].min():.4f}")
    assert found.ended == "depth"
    assert variation < 300.0
    assert abs(found.table["factor"] - 1.0).max() < 0.01


def test_mass_does_not_depend_on_the_smoothing_of_dense_states() -> None:
    """A fixed kernel of 0.25 and 1 mm makes 7 % of difference."""
    narrow, wide = (life(line(33, 2.0), "1500 km", smoothing=f"{width} mm").table for width in (0.25, 1.0))
    masses = [table["mass [kg]"].iloc[-1] for table in (narrow, wide)]
    print(f"masses {masses}")
    assert masses[0] == pytest.approx(masses[1], rel=0.02)


def worn_flange(over: str, **options: Any) -> tuple[Life, wl.Quantity, np.ndarray[Any, Any]]:
    """Return the life of a state on the flange beside those of the tread, places there, and their depths [um]."""
    states = line(9)
    flange = {"lateral_displacement [mm]": [6.2], "yaw [mrad]": [3.0], "share": [0.2]}
    states["share"] *= 0.8
    states = pd.concat([states.assign(**{"yaw [mrad]": 0.0}), pd.DataFrame(flange)])
    found = life(states, over, sides="each", **options)
    at = Q(np.linspace(-60.0, -28.0, 641), "mm")
    return found, at, found.worn_profiles[0][1].depth_to(found.profile, at).m_as("um")


def test_a_flange_keeps_the_place_and_the_depth_of_its_wear() -> None:
    """In one step it wears as the state does on the new profile."""
    found, at, depth = worn_flange("3 km")
    alone = pipeline()(lateral_displacement="6.2 mm", yaw="3 mrad", **GIVEN).wear_profile("wheel", at=at)["depth"]
    direct = 0.2 * 3.0 * alone.sel(side="right").values  # um/km
    print(f"deepest {depth.max():.3g} of {direct.max():.3g} um")
    assert len(found.table) == 2
    assert depth.max() == pytest.approx(direct.max(), rel=0.1)
    assert at[depth.argmax()].m_as("mm") == pytest.approx(at[direct.argmax()].m_as("mm"), abs=0.25)


def test_smoothing_over_many_steps_does_not_flatten_a_flange() -> None:
    """The patch widens as it wears in: 60 um, not 105 um as on the new profile. Shorter steps, smoothed less, agree."""
    found = [worn_flange("40 km", resolution=f"{width} mm") for width in (0.4, 0.8)]
    found.append(worn_flange("40 km", resolution="0.2 mm", depth_step="0.02 mm"))
    depths = [depth.max() for _, _, depth in found]
    _, at, depth = found[-1]
    middles = [float((each @ at.m_as("mm")) / each.sum()) for *_, each in found]
    width = np.ptp(at.m_as("mm")[depth > 0.3 * depth.max()])
    print(f"steps {[len(worn.table) - 1 for worn, *_ in found]}, depths {depths}, middles {middles}, width {width}")
    assert len(found[1][0].table) > 4
    assert depths[:2] == pytest.approx([depths[2]] * 2, rel=0.1)
    assert middles[:2] == pytest.approx([middles[2]] * 2, abs=0.1 * width)
