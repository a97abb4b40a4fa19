"""Models in notebooks: the fields of each, a drawing of a rig to scale, and the curve of a law."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import wearlaw as wl

UNLIKE = wl.TwinDisc.suros(disc_2=wl.Disc(diameter="94 mm", material=wl.steel()))


def shown(model: Any) -> str:
    text: str = model._repr_html_()
    return text


def test_a_rig_is_drawn_to_scale_with_its_fields() -> None:
    radii = [float(one) for one in re.findall(r' r="([\d.]+)"', shown(UNLIKE))]
    assert radii[1] / radii[0] == pytest.approx(2.0, rel=1e-3)
    middles = [float(one) for one in re.findall(r'cy="([\d.]+)"', shown(UNLIKE))]
    assert middles[1] - middles[0] == pytest.approx(sum(radii), rel=1e-2), "they touch"
    assert "<code>track_width</code></td><td>10.00 mm" in shown(UNLIKE)
    wheel = wl.rig("wheel_rail", wheel_radius="460 mm", rail_head_radius="300 mm", material="steel",
                   rolling_speed="30 m/s")  # fmt: skip
    assert shown(wheel).count("<circle") == shown(wheel).count("<line") == 1


@pytest.mark.parametrize("name", ["usfd", "kth", "brr"])
def test_the_curve_of_a_law_rises_with_the_wear_index(name: str) -> None:
    (points,) = re.findall(r'points="([^"]+)"', shown(wl.wear_law(name)))
    x, y = np.array([point.split(",") for point in points.split()], dtype=float).T
    assert (np.diff(x) > 0.0).all()
    assert (np.diff(y) <= 0.0).all(), "y of a drawing runs downwards"
    assert "µg/m/mm²" in shown(wl.wear_law(name))


def test_texts_stay_texts_and_a_law_without_a_curve_has_its_fields() -> None:
    law = wl.wear_law("archard", coefficient=1e-4)
    assert "<polyline" not in shown(law)
    assert "<code>coefficient</code>" in shown(law)
    assert "slip" in shown(wl.contact_model("exact"))
