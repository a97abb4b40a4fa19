"""Wrong input of wheelsets."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Q
from wearlaw.errors import CompositionError
from wearlaw_models.rigs.wheelset import stand  # private: the accuracy that a search ends at

FIELDS: dict[str, Any] = {
    "wheel": wl.Profile.s1002(),
    "rail": wl.Profile.uic60(),
    "nominal_radius": "460 mm",
    "flange_back_distance": "1360 mm",
    "gauge": "1435 mm",
    "rail_cant": "1:40",
    "material": wl.steel(),
    "rolling_speed": "20 m/s",
}
GIVEN: dict[str, Any] = {"lateral_displacement": "3 mm", "vertical_load": "50 kN", "friction_coefficient": 0.3}


def pair(**changed: Any) -> wl.Wheelset:
    return wl.Wheelset(**{**FIELDS, **changed})


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"wheel": wl.Profile.uic60()}, "wheel is the profile of a rail"),
        ({"rail": wl.Profile.s1002()}, "rail is the profile of a wheel"),
        ({"left_wheel": wl.Profile.uic60()}, "left_wheel is the profile of a rail"),
        ({"gauge": "1380 mm"}, r"gauge: rails 1380 mm apart leave the flanges -\d+.* mm on either side"),
        ({"gauge": "1560 mm"}, r"gauge: .* must leave 0 to 40 mm"),
        ({"gauge": "1.435 mm"}, "gauge"),
        ({"gauge_depth": "80 mm"}, "gauge_depth: 80 mm is below the gauge side of the rail"),
        *(({"rail_cant": cant}, "rail_cant") for cant in ("1:4", "steep", "40", "1:0", "1:4.0.0")),
        *(({"rail_cant": cant}, "rail_cant.* such as '1:40'") for cant in (20, 0.025, "-1:40", " -1/40", "1:-40")),
        ({"pressure": "kpec"}, 'pressure: .* always that of half-spaces.* patch = "ellipse"'),
        ({"strips": 20}, "strips: .* leave strips out"),
        ({"patch": "carter"}, "patch"),
        ({"wheel": "s1200"}, "s1200.*did you mean 's1002'"),
    ],
)
def test_a_wheelset_that_cannot_be_is_refused(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.WearlawError, match=message):
        pair(**changed)


def test_a_cant_is_a_ratio_or_an_angle() -> None:
    for cant in ("1:40", "1/40", Q(np.arctan(1.0 / 40.0), "rad")):
        assert pair(rail_cant=cant).rail_cant.m_as("rad") == pytest.approx(np.arctan(1.0 / 40.0), rel=1e-15)


@pytest.mark.parametrize(
    ("changed", "error", "message"),
    [
        ({"lateral_displacement": 3}, wl.UnitError, "lateral_displacement: got the bare number 3"),
        ({"lateral_displacement": "3 kN"}, wl.UnitError, "lateral_displacement"),
        ({"lateral_displacement": "60 mm"}, wl.ConditionsError, "at 60 mm the left wheel does not touch its rail"),
        ({"yaw": "7 rad"}, wl.UnitError, "yaw"),
        ({"vertical_load": "-5 kN"}, wl.UnitError, "vertical_load"),
        ({"friction_coefficient": 0.0}, wl.UnitError, "friction_coefficient: must be a positive finite number"),
        ({"friction_coefficient": "rough"}, wl.UnitError, "friction_coefficient: 'rough' is not a number with a unit"),
        ({"friction_coefficient": Q(0.3, "m")}, wl.UnitError, r"friction_coefficient: got 0\.3000 m, .* not a ratio"),
        ({"friction_coefficient": True}, wl.UnitError, "friction_coefficient: True is not a real number"),
        ({"flange_friction_coefficient": np.nan}, wl.UnitError, "flange_friction_coefficient"),
        ({"flange_friction_coefficient": Q(0.3, "m")}, wl.UnitError, "flange_friction_coefficient: got .* not a ratio"),
        (
            {"lateral_displacement": Q([1.0, 2.0, 3.0], "mm"), "friction_coefficient": [0.2, 0.3]},
            wl.ConditionsError,
            r"do not broadcast: lateral_displacement \(3,\), friction_coefficient \(2,\)",
        ),
        ({"axle_torque": "20 kN*m"}, wl.ConditionsError, "axle_torque: .* is more than friction can transmit"),
        ({"axle_torque": "1 N*m", "angular_speed": "43 rad/s"}, wl.ConditionsError, "not both"),
        ({"curve_radius": "0 m"}, wl.ConditionsError, "curve_radius: must not be zero; straight track has"),
        ({"rolled_distance": "-2 km"}, wl.UnitError, "rolled_distance: must not be negative, got -2.000 km"),
        ({"displacement": "1 mm"}, wl.ConditionsError, "displacement: unknown condition"),
        ({"vertical_load": None}, wl.WearlawError, "vertical_load"),
    ],
)
def test_wrong_conditions_are_named(changed: dict[str, Any], error: type[Exception], message: str) -> None:
    predict: Any = pair() | wl.contact_model("fastsim")
    with pytest.raises(error, match=message):
        predict(**{**GIVEN, **changed})


@pytest.mark.parametrize(
    ("name", "value"),
    [("roll", Q([0.0, 1.0], "mrad")), ("within", Q([0.1, 0.2], "mm")), ("within", "-1 mm"), ("yaw", "7 rad")],
)
def test_wrong_arguments_of_the_geometry_are_named(name: str, value: Any) -> None:
    with pytest.raises(wl.UnitError, match=f"{name}: must"):
        pair().geometry(**{"lateral_displacement": "3 mm", name: value})
    with pytest.raises(wl.UnitError, match="amplitude: must be one value"):
        pair().equivalent_conicity(amplitude=Q([1.0, 2.0], "mm"))


@pytest.mark.parametrize("unit", ["mm", "m", "cm"])
def test_coordinates_of_the_geometry_are_the_values_given(unit: str) -> None:
    given = np.array([-6.5, -0.3, 0.1, 5.7]) / {"mm": 1.0, "m": 1e3, "cm": 10.0}[unit]
    data = pair().geometry(lateral_displacement=Q(given, unit), yaw="0.3 mrad").dataset
    assert [float(data.sel(lateral_displacement=one).lateral_displacement) for one in given] == given.tolist()
    assert data.lateral_displacement.units == unit
    assert (float(data.yaw), data.yaw.units) == (0.3, "mrad")


def test_contact_models_that_do_not_solve_strips_are_refused_at_once() -> None:
    with pytest.raises(CompositionError, match="'polach' solves elliptic contacts only, but a Wheelset makes patches"):
        pair() | wl.contact_model("polach")
    predict: Any = pair(patch="ellipse") | wl.contact_model("polach")
    assert np.isfinite(predict(**GIVEN).lateral_force.magnitude[:, 0]).all()


def test_positions_without_a_balance_have_no_result_and_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    predict: Any = pair() | wl.contact_model("fastsim")
    given = {**GIVEN, "lateral_displacement": Q([0.0, 6.31], "mm")}  # at a jump
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        balanced = predict(**given)
    monkeypatch.setattr(stand, "STEPS", 3)  # enough for the first position alone
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = predict(**given)
    (said,) = (text for text in (str(one.message) for one in caught) if "no result" in text)
    assert said.startswith("1 of 2 positions have no result, the first at a lateral displacement of 6.31 mm: the ")
    assert np.isfinite(found.normal_force.magnitude).any(axis=(1, 2)).tolist() == [True, False]
    assert found.normal_force.magnitude[0, :, 0] == pytest.approx(balanced.normal_force.magnitude[0, :, 0], rel=2e-3)
