"""What a prediction returns, each value against a computation of the test's own, and what it is for a body."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.core.discs import (
    CONDITIONS,
    DENSITIES,
    DIAMETERS,
    FORCE,
    FRICTION,
    HALF_WIDTH,
    PREDICT,
    RIG,
    TABLE_4,
    WIDTH,
    solved,
)
from tests.reference import usfd_mean
from tests.strategies import EPS
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
    solution = solved(creepage)
    point, force = solution.point, solution.force * WIDTH
    area, wear_rate = 2 * point.half_width * WIDTH, 1e-3 * usfd_mean(solution, *TABLE_4)
    expected = {
        "normal_force": (FORCE, "N", "kN"),
        "normal_force_per_width": (FORCE / WIDTH, "N/m", "kN/m"),
        "max_pressure": (point.max_pressure, "Pa", "MPa"),
        "half_width": (point.half_width, "m", "mm"),
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
        "stick_ratio": (1 - min(creepage / point.exact_saturation, 1.0), "", ""),
        "mean_slip": (solution.mean(solution.slip), "", "%"),
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
        assert quantity.to(si).magnitude == pytest.approx(value, rel=1e-12), name
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
        "  stick_ratio          0\n"
        "  mean_slip            1.000 %"
    )
    many = predict(max_pressure="1500 MPa", creepage=Q([0.5, 1.0], "%"), friction_coefficient=0.46)
    assert repr(many).splitlines()[:2] == [
        "Prediction of 2 operating points",
        "  wear_rate            9.292 µg/m/mm² to 27.70 µg/m/mm²",
    ]
    alone = (RIG | wl.contact_model("exact"))(creepage="1 %", **CONDITIONS)
    assert repr(alone).startswith("Prediction of 1 operating point\n  tangential_force ")


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
