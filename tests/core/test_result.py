"""What a prediction returns, each value against a computation of the test's own."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q

RIG = wl.TwinDisc.suros(
    disc_2=wl.Disc(diameter="60 mm", material=wl.steel(density="7000 kg/m^3", youngs_modulus="190 GPa")),
    track_width="8 mm",
)
LAW = wl.wear_law("usfd", fitted_for="exact")
PREDICT = RIG | wl.contact_model("exact") | LAW
FORCE, FRICTION = 6000.0, 0.4
CONDITIONS: Any = {"normal_force": Q(FORCE, "N"), "friction_coefficient": FRICTION}

# The rig again, by hand.
WIDTH, DIAMETERS, DENSITIES = 8e-3, {"disc_1": 47e-3, "disc_2": 60e-3}, {"disc_1": 7850.0, "disc_2": 7000.0}
RADIUS = 23.5e-3 * 30e-3 / 53.5e-3
MODULUS = 1.0 / ((1 - 0.28**2) / 206.47742e9 + (1 - 0.28**2) / 190e9)
HALF_WIDTH = np.sqrt(4 * FORCE / WIDTH * RADIUS / (np.pi * MODULUS))
MAX_PRESSURE = 2 * FORCE / WIDTH / (np.pi * HALF_WIDTH)
SATURATION = FRICTION * HALF_WIDTH / RADIUS


def slip_at(x: float, creepage: float) -> float:
    """Return Johnson's slip of a rolling cylinder (Contact Mechanics, section 8.3), zero in stick."""
    k = FRICTION / RADIUS
    stick = max(HALF_WIDTH - creepage / k, 0.0)  # half its length
    if stick == 0.0:
        return creepage + k * x
    if x <= -HALF_WIDTH + 2 * stick:
        return 0.0
    return float(k * np.sqrt(max((x + HALF_WIDTH - stick) ** 2 - stick**2, 0.0)))


def bound_at(x: float) -> float:
    return float(FRICTION * MAX_PRESSURE * np.sqrt(max(1 - (x / HALF_WIDTH) ** 2, 0.0)))


def carter(creepage: float) -> float:
    """Return T [N] of Carter's theory."""
    return float(FRICTION * FORCE * (1 - max(1 - creepage / SATURATION, 0.0) ** 2))


def mean_over_slip_zone(function: Any, creepage: float) -> float:
    """Return the integral of a function over the slip zone, divided by the length of the whole patch."""
    start = max(HALF_WIDTH - 2 * creepage / (FRICTION / RADIUS), -HALF_WIDTH)
    return float(quad(function, start, HALF_WIDTH, limit=400, epsabs=0, epsrel=1e-10)[0] / (2 * HALF_WIDTH))


def usfd(density: float) -> float:
    """Return the rate [kg/m³] of Table 4 of Tassini et al. (2010), exact, against q·s in N/mm²."""
    if density < 55 / 5.3:
        return 5.3e-3 * density
    return 55e-3 if density < 95 else 55e-3 + 83.7e-3 * (density - 95)


@pytest.mark.parametrize("creepage", [1e-4, 0.004, 0.02])
def test_every_property_has_its_unit_and_value(creepage: float) -> None:
    result = PREDICT(creepage=Q(creepage, ""), **CONDITIONS)
    force = carter(creepage)
    slip_share = min(creepage / SATURATION, 1.0)
    mean_slip = mean_over_slip_zone(lambda x: slip_at(x, creepage), creepage)
    area = 2 * HALF_WIDTH * WIDTH
    expected = {
        "normal_force": (FORCE, "N", "N"),
        "normal_force_per_width": (FORCE / WIDTH, "N/m", "kN/m"),
        "max_pressure": (MAX_PRESSURE, "Pa", "MPa"),
        "half_width": (HALF_WIDTH, "m", "mm"),
        "patch_area": (area, "m^2", "mm^2"),
        "creepage": (creepage, "", "%"),
        "friction_coefficient": (FRICTION, "", ""),
        "tangential_force": (force, "N", "N"),
        "traction_coefficient": (force / FORCE, "", ""),
        "wear_index": (force * creepage, "N", "N"),
        "wear_index_density": (force * creepage / area, "N/m^2", "N/mm^2"),
        "stick_ratio": (1 - slip_share, "", ""),
        "mean_slip": (mean_slip, "", "%"),
        "averaged_wear_index": (mean_slip / slip_share * force, "N", "N"),
        "wear_rate": (
            mean_over_slip_zone(lambda x: usfd(bound_at(x) * slip_at(x, creepage) * 1e-6), creepage),
            "kg/m^3",
            "ug/m/mm^2",
        ),
    }
    properties = {name for name in dir(type(result)) if isinstance(getattr(type(result), name), property)}
    assert properties - {"wear_rate_error"} == set(expected)
    for name, (value, si, shown) in expected.items():
        quantity = getattr(result, name)
        assert quantity.units == Q(1, shown).units, name
        # `quad` was asked for 1e-10; the kink of the law makes it miss by a little more.
        assert quantity.to(si).magnitude == pytest.approx(value, rel=1e-8), name
        assert isinstance(quantity.magnitude, float), name


def test_the_error_estimate_bounds_the_true_error() -> None:
    result = PREDICT(creepage="0.4 %", **CONDITIONS)
    true = mean_over_slip_zone(lambda x: usfd(bound_at(x) * slip_at(x, 0.004) * 1e-6), 0.004)
    assert result.wear_rate_error.units == result.wear_rate.units
    assert 0 < result.wear_rate_error.to("kg/m^3").magnitude < 1e-8 * true


@settings(deadline=None)  # the time of the first call is that of the imports
@given(creepage=st.floats(0.0, 1.0), friction=st.floats(0.01, 2.0))
def test_the_stick_ratio_lies_between_nothing_and_the_whole_patch(creepage: float, friction: float) -> None:
    result = (RIG | wl.contact_model("exact"))(
        creepage=Q(creepage, ""), normal_force="6 kN", friction_coefficient=friction
    )
    # The sum of some hundred areas, each rounded.
    assert -100 * EPS <= result.stick_ratio.magnitude <= 1.0


def test_the_averaged_wear_index_equals_the_wear_index_in_full_slip_and_exceeds_it_before() -> None:
    contact = RIG | wl.contact_model("exact")
    full = contact(creepage=Q(2 * SATURATION, ""), **CONDITIONS)
    # In full slip the mean slip is the creepage.
    assert full.averaged_wear_index.magnitude == pytest.approx(full.wear_index.magnitude, rel=1e-13)
    partial = contact(creepage=Q(0.3 * SATURATION, ""), **CONDITIONS)
    assert partial.averaged_wear_index > 1.5 * partial.wear_index
    assert contact(creepage="0 %", **CONDITIONS).averaged_wear_index.magnitude == 0.0


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


@pytest.mark.validates(
    "wear-laws",
    "A point of a disc is in contact for 2a of each πD, so its surface loses 235 times less than the contact",
    source="π · 47 mm/(2 · 0.31467 mm)",
    held_to="{within:g}, relative (five digits of a)",
    within=2e-05,
)
def test_a_surface_loses_235_times_less_than_what_the_contact_loses(within: float) -> None:
    # π · 47 mm / (2 · 0.31467 mm) = 234.6 on the discs of Tassini et al. (2010) at 1500 MPa.
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    result = predict(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46)
    in_contact = result.wear_rate / Q(7850, "kg/m^3")
    ratio = (in_contact / result.depth_per_distance("disc_1")).to("").magnitude
    assert round(ratio) == 235
    assert ratio == pytest.approx(np.pi * 47 / (2 * 0.31467), rel=within)  # a printed to 5 digits


@pytest.mark.parametrize("creepage", [0.01, 0.15])
def test_the_profile_area_rate_of_disc_1_gives_back_the_published_brr(creepage: float) -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("brr")
    result = predict(max_pressure="1500 MPa", creepage=Q(creepage, ""), friction_coefficient=0.46)
    index, diameter = result.wear_index.to("N").magnitude, 47.0
    # Table 1 of Tassini et al. (2010), mm² per km with D in mm.
    published = 0.25 * index / diameter if index < 100 else (1.19 * index - 154) / diameter
    assert index < 100 or index >= 200
    assert result.profile_area_rate("disc_1").to("mm^2/km").magnitude == pytest.approx(published, rel=32 * EPS)


def test_a_flat_body_makes_no_revolutions() -> None:
    flat = wl.TwinDisc.suros(disc_2=wl.Disc(diameter="inf mm", material=wl.steel()))
    result = (flat | wl.contact_model("global") | wl.wear_law("usfd"))(creepage="1 %", **CONDITIONS)
    assert result.mass_lost(over="1 km", body="disc_2") == result.mass_lost(over="1 km", body="disc_1")
    for convert in (result.depth_per_distance, result.profile_area_rate, result.mass_per_cycle):
        assert convert("disc_1").magnitude > 0
        with pytest.raises(wl.InputError, match="body: disc_2 is flat and makes no revolutions; name the other body"):
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
        with pytest.raises(wl.UnitError, match=r'^over: .* such as Q\(1\.0, "km"\) or "1.0 km"$'):
            result.mass_lost(over=wrong, body="disc_1")  # type: ignore[arg-type]


def test_a_distance_may_be_an_array() -> None:
    result = PREDICT(creepage=Q([1.0, 2.0], "%"), **CONDITIONS)
    lost = result.mass_lost(over=Q([1.0, 10.0], "km"), body="disc_1")
    each = result.mass_lost(over="1 km", body="disc_1")
    np.testing.assert_allclose(lost.magnitude, each.magnitude * [1.0, 10.0], rtol=4 * EPS)


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
    names = [name for name in dir(type(result)) if isinstance(getattr(type(result), name), property)]
    values = {name: getattr(result, name) for name in names}
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


def test_the_profile_of_one_point_is_labelled_by_x_with_units() -> None:
    creepage = 0.004
    profile = PREDICT(creepage=Q(creepage, ""), **CONDITIONS).profile
    assert profile.sizes == {"x": 200}
    assert {name: profile[name].attrs["units"] for name in profile.variables} == {
        "x": "mm",
        "pressure": "MPa",
        "traction": "MPa",
        "traction_bound": "MPa",
        "slip": "%",
        "wear_rate": "ug/m/mm^2",
    }
    x = profile["x"].values * 1e-3
    # Centres of 200 equal cells from the leading to the trailing edge.
    np.testing.assert_allclose(x, HALF_WIDTH * (np.arange(200) - 99.5) / 100.0, rtol=1e-12)
    bound = np.array([bound_at(at) for at in x]) * 1e-6
    slip = np.array([slip_at(at, creepage) for at in x])
    np.testing.assert_allclose(profile["traction_bound"], bound, rtol=1e-10)
    np.testing.assert_allclose(profile["pressure"], bound / FRICTION, rtol=1e-10)
    np.testing.assert_allclose(profile["slip"], 100 * slip, rtol=1e-10)
    slipping = slip > 0
    np.testing.assert_allclose(profile["traction"][slipping], bound[slipping], rtol=1e-10)
    assert (profile["traction"][~slipping] < bound[~slipping]).all()
    rates = [1e3 * usfd(q * s) for q, s in zip(bound, slip, strict=True)]
    np.testing.assert_allclose(profile["wear_rate"], rates, rtol=1e-10)


def test_the_profile_of_a_batch_has_an_axis_a_condition_axis() -> None:
    result = PREDICT(
        creepage=Q([0.004, 0.01, 0.02], ""), normal_force=Q([[5.0], [6.0]], "kN"), friction_coefficient=0.4
    )
    profile = result.profile
    assert profile.sizes == {"point_0": 2, "point_1": 3, "cell": 200}
    assert set(profile.coords) == {"x"}
    assert set(profile.data_vars) == {"pressure", "traction", "traction_bound", "slip", "wear_rate"}
    one = PREDICT(creepage="0.4 %", **CONDITIONS).profile
    for name in one.data_vars:
        np.testing.assert_allclose(profile[name][1, 0], one[name], rtol=1e-12)
    np.testing.assert_allclose(profile["x"][1, 0], one["x"], rtol=1e-12)


def test_the_profile_of_a_contact_alone_has_no_wear_and_that_of_patch_means_one_cell() -> None:
    contact = RIG | wl.contact_model("fastsim")
    assert "wear_rate" not in contact(creepage="1 %", **CONDITIONS).profile
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.CalibrationWarning)
        means = (contact | wl.patch_mean() | LAW)(creepage="1 %", **CONDITIONS)
    assert means.profile.sizes == {"x": 1}
    assert float(means.profile["wear_rate"][0]) == pytest.approx(means.wear_rate.magnitude, rel=4 * EPS)


@pytest.mark.parametrize("model", ["exact", "fastsim", "global"])
def test_the_profile_writes_to_netcdf_and_back(model: str, tmp_path: Path) -> None:
    profile = (RIG | wl.contact_model(model))(creepage=Q([1.0, 2.0], "%"), **CONDITIONS).profile
    profile.to_netcdf(tmp_path / "profile.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "profile.nc", engine="h5netcdf") as read:
        xarray.testing.assert_identical(read.load(), profile)


@pytest.mark.parametrize("shape", [(), (3,), (2, 3)])
def test_the_contact_holds_si_arrays_whose_rate_averages_to_the_wear_rate(shape: tuple[int, ...]) -> None:
    result = PREDICT(creepage=Q(np.full(shape, 0.01), ""), **CONDITIONS)
    contact = result.contact
    assert contact.pressure.shape[:-1] == shape
    assert contact.tangential_force.shape == shape
    np.testing.assert_allclose(contact.mean(LAW.rate(contact)), result.wear_rate.to("kg/m^3").magnitude, rtol=16 * EPS)
    np.testing.assert_allclose(contact.patch_area, 2 * HALF_WIDTH * WIDTH, rtol=1e-13)
    # T is the integral of the tractions.
    np.testing.assert_allclose(contact.sum_over_nodes(contact.traction * contact.area), carter(0.01), rtol=1e-10)


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
    assert repr(alone).startswith("ContactSolution of 1 operating point\n  tangential_force ")


@pytest.mark.parametrize("model", ["exact", "global", "fastsim"])
def test_a_problem_without_operating_points_is_refused(model: str) -> None:
    many = RIG.problem(**CONDITIONS, creepage=Q([0.1, 0.2], "%"))
    with pytest.raises(wl.ConditionsError, match="problem: holds no operating points"):
        (RIG | wl.contact_model(model) | wl.wear_law("kth")).predict(many[:0])
