"""What a prediction returns, each value against a computation of the test's own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.discs import (
    CONDITIONS,
    FORCE,
    FRICTION,
    HALF_WIDTH,
    MAX_PRESSURE,
    PREDICT,
    RIG,
    SATURATION,
    WIDTH,
    bound_at,
    carter,
    mean_over_slip_zone,
    slip_at,
    usfd,
)
from wearlaw import Q
from wearlaw.errors import CompositionError

OF_ELLIPSES = {"semi_axis_a", "semi_axis_b"}
LIMITS = {"first_yield", "shakedown_limit", "outside_range"}
"""Properties with a file of their own, `test_marks.py`."""


OTHERS = {"contact", "contact_model", "profile", "scale", "wear_rate_error"}


def public_properties() -> set[str]:
    """Return the properties of a prediction of a line, without its limits."""
    names = {name for name, value in vars(wl.Prediction).items() if isinstance(value, property)}
    return {name for name in names if not name.startswith("_")} - OF_ELLIPSES - LIMITS - OTHERS


def test_properties_of_ellipses_say_so_on_a_line() -> None:
    result = PREDICT(creepage="1 %", **CONDITIONS)
    for name in OF_ELLIPSES:
        with pytest.raises(CompositionError, match="belongs to elliptic contacts, not to line contacts"):
            getattr(result, name)


@pytest.mark.parametrize("creepage", [1e-4, 0.004, 0.02])
def test_every_property_has_its_unit_and_value(creepage: float) -> None:
    result = PREDICT(creepage=Q(creepage, ""), **CONDITIONS)
    force = carter(creepage)
    slip_share = min(creepage / SATURATION, 1.0)
    mean_slip = mean_over_slip_zone(lambda x: slip_at(x, creepage), creepage)
    area = 2 * HALF_WIDTH * WIDTH
    wear_rate = mean_over_slip_zone(lambda x: usfd(bound_at(x) * slip_at(x, creepage) * 1e-6), creepage)
    expected = {
        "normal_force": (FORCE, "N", "kN"),
        "normal_force_per_width": (FORCE / WIDTH, "N/m", "kN/m"),
        "max_pressure": (MAX_PRESSURE, "Pa", "MPa"),
        "half_width": (HALF_WIDTH, "m", "mm"),
        "patch_area": (area, "m^2", "mm^2"),
        "creepage": (creepage, "", "%"),
        "lateral_creepage": (0.0, "", "%"),
        "spin": (0.0, "1/m", "1/m"),
        "contact_angle": (0.0, "rad", "deg"),
        "friction_coefficient": (FRICTION, "", ""),
        "tangential_force": (force, "N", "N"),
        "traction_coefficient": (force / FORCE, "", ""),
        "wear_index": (force * creepage, "N", "N"),
        "wear_index_density": (force * creepage / area, "N/m^2", "N/mm^2"),
        "stick_ratio": (1 - slip_share, "", ""),
        "mean_slip": (mean_slip, "", "%"),
        "cell_wear_index": (force * creepage, "N", "N"),
        "longitudinal_force": (force, "N", "N"),
        "lateral_force": (0.0, "N", "N"),
        "spin_moment": (0.0, "N*m", "N*m"),
        "mass_per_distance": (wear_rate * area, "kg/m", "ug/m"),
        "wear_rate": (wear_rate, "kg/m^3", "ug/m/mm^2"),
    }
    assert public_properties() == set(expected)
    for name, (value, si, shown) in expected.items():
        quantity = getattr(result, name)
        assert quantity.units == Q(1, shown).units, name
        # `quad` was asked for 1e-10; the kink of the law makes it miss by a little more.
        assert quantity.to(si).magnitude == pytest.approx(value, rel=1e-8), name
        assert isinstance(quantity.magnitude, float), name


@pytest.mark.parametrize(
    ("creepage", "friction", "shape"),
    [
        (0.01, 0.4, ()),
        ([0.01], 0.4, (1,)),
        ([0.01, 0.02, 0.0], 0.4, (3,)),
        ([0.01, 0.02, -0.1], [[0.3], [0.4]], (2, 3)),
    ],
)
def test_every_value_has_the_shape_of_the_broadcast_conditions(creepage: Any, friction: Any, shape: Any) -> None:
    result = PREDICT(creepage=Q(creepage, ""), normal_force="6 kN", friction_coefficient=friction)
    values = {name: getattr(result, name) for name in public_properties()}
    for convert in (result.depth_per_distance, result.profile_area_rate, result.mass_per_cycle):
        values[convert.__name__] = convert("disc_1")
    for name, value in values.items():
        assert np.shape(value.magnitude) == shape, name
    singles = [
        PREDICT(creepage=Q(float(c), ""), normal_force="6 kN", friction_coefficient=float(m)).wear_rate.magnitude
        for c, m in np.broadcast(creepage, friction)
    ]
    # Sums of the same terms may be ordered differently.
    np.testing.assert_allclose(np.ravel(result.wear_rate.magnitude), singles, rtol=1e-12)


def test_the_repr_of_one_point_shows_values_and_of_many_their_ranges() -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    one = predict(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46)
    assert repr(one) == (
        "Prediction of 1 operating point\n"
        "  wear_rate            27.70 µg/m/mm²\n"
        "  tangential_force     3290 N\n"
        "  wear_index           32.90 N\n"
        "  half_width           0.3147 mm\n"
        "  max_pressure         1500 MPa\n"
        "  stick_ratio          0.000\n"
        "  mean_slip            1.000 %"
    )
    many = predict(max_pressure="1500 MPa", creepage=Q([0.5, 1.0], "%"), friction_coefficient=0.46)
    assert repr(many).splitlines()[:2] == [
        "Prediction of 2 operating points",
        "  wear_rate            9.292 µg/m/mm² to 27.70 µg/m/mm²",
    ]
    alone = (RIG | wl.contact_model("exact"))(creepage="1 %", **CONDITIONS)
    assert repr(alone).startswith("Prediction of 1 operating point\n  tangential_force ")
