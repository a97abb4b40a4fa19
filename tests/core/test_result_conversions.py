"""What a wear rate is for a body: mass, depth and area of the profile, over a distance or a revolution."""

from __future__ import annotations

import numpy as np
import pytest

import wearlaw as wl
from tests.core.discs import CONDITIONS, DENSITIES, DIAMETERS, HALF_WIDTH, PREDICT, WIDTH
from tests.strategies import EPS
from wearlaw import Q


@pytest.mark.filterwarnings("ignore:.* are used for the wear of 'disc_2'")
@pytest.mark.parametrize("body", ["disc_1", "disc_2"])
def test_conversions_follow_from_the_mass_and_the_body(body: str) -> None:
    result = PREDICT(creepage="1 %", **CONDITIONS)
    mass_per_metre = result.wear_rate.to("kg/m^3").magnitude * 2 * HALF_WIDTH * WIDTH
    circumference = np.pi * DIAMETERS[body]
    # Volume that a metre of rolling takes off, spread over the running surface that carries it.
    depth = mass_per_metre / DENSITIES[body] / (circumference * WIDTH)
    few = pytest.approx
    assert result.mass_lost(over="10 km", body=body).to("kg").magnitude == few(mass_per_metre * 1e4, rel=16 * EPS)
    assert result.mass_per_cycle(body).to("kg").magnitude == few(mass_per_metre * circumference, rel=16 * EPS)
    assert result.depth_per_distance(body).to("m/m").magnitude == few(depth, rel=16 * EPS)
    assert result.profile_area_rate(body).to("m^2/m").magnitude == few(depth * WIDTH, rel=16 * EPS)
    shown = {
        "mg": result.mass_lost(over="10 km", body=body),
        "ug": result.mass_per_cycle(body),
        "um/km": result.depth_per_distance(body),
        "mm^2/km": result.profile_area_rate(body),
    }
    for unit, quantity in shown.items():
        assert quantity.units == Q(1, unit).units


@pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning")  # USFD is for disc_1
def test_a_flat_body_makes_no_revolutions() -> None:
    flat = wl.TwinDisc.suros(disc_2=wl.Disc(diameter="inf mm", material=wl.steel()))
    result = (flat | wl.contact_model("global") | wl.wear_law("usfd"))(creepage="1 %", **CONDITIONS)
    assert result.mass_lost(over="1 km", body="disc_2") == result.mass_lost(over="1 km", body="disc_1")
    for convert in (result.depth_per_distance, result.profile_area_rate, result.mass_per_cycle):
        assert convert("disc_1").magnitude > 0
        with pytest.raises(wl.InputError, match="body: disc_2 makes no revolutions; name the other body"):
            convert("disc_2")


def test_conversions_refuse_a_wrong_body_or_distance() -> None:
    result = PREDICT(creepage="1 %", **CONDITIONS)
    for call in (
        result.depth_per_distance,
        result.profile_area_rate,
        result.mass_per_cycle,
        lambda body: result.mass_lost("1 km", body),
    ):
        with pytest.raises(wl.InputError, match="this rig has no 'wheel'; its bodies are 'disc_1' and 'disc_2'"):
            call("wheel")
    for wrong in (10, "10", "10 kg", "-1 km", "0 km"):
        with pytest.raises(wl.UnitError, match=r'^over: .* such as "1.0 km"$'):
            result.mass_lost(over=wrong, body="disc_1")  # type: ignore[arg-type]
