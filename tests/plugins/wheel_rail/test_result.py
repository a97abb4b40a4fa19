"""What a pipeline of a wheel on a rail predicts: forces, wear, and where across the patch it is lost."""

from __future__ import annotations

import warnings
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.kit.strips import Strips
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import CompositionError, ModelError
from wearlaw.numerics import integrate  # private: integrals at the size of blocks
from wearlaw.units.variables import VARIABLES  # private: the list of variables and their units

RIG = wl.WheelRail(
    wheel_radius=Q(460, "mm"), rail_head_radius=Q(300, "mm"), material=wl.steel(), rolling_speed=Q(30, "m/s")
)
CONDITIONS: dict[str, Any] = {
    "normal_force": Q(80, "kN"),
    "friction_coefficient": 0.3,
    "longitudinal_creepage": Q(0.2, "%"),
    "lateral_creepage": Q(0.1, "%"),
    "spin": Q(0.3, "1/m"),
}
FASTSIM = wl.contact_model("fastsim")


PER_ENERGY = wl.wear_law("energy", mass_per_energy="0.001 ug/J")


def test_the_pipeline_gives_what_the_model_solves() -> None:
    result = (RIG | FASTSIM)(**CONDITIONS)
    contact = FASTSIM.solve(RIG.problem(**CONDITIONS))
    assert result.longitudinal_force == Q(contact.force_x, "N")
    assert result.lateral_force == Q(contact.force_y, "N")
    assert result.spin_moment == Q(contact.moment_z, "N*m")
    assert result.wear_index.to("N").magnitude == contact.wear_index
    power: Any = 2e-3 * result.longitudinal_force + 1e-3 * result.lateral_force + Q(0.3, "1/m") * result.spin_moment
    assert result.wear_index.magnitude == pytest.approx(power.to("N").magnitude, rel=8 * EPS)
    assert result.tangential_force.magnitude == pytest.approx(np.hypot(contact.force_x, contact.force_y), rel=4 * EPS)
    assert result.traction_coefficient.magnitude == pytest.approx(result.tangential_force.magnitude / 8e4, rel=4 * EPS)


@pytest.mark.validates(
    "limits",
    "With spin FASTSIM's cells do not dissipate Tγ; scaled, they do",
    source="conservation of energy",
    held_to="more than {apart:g} apart; scaled to {roundings} ε",
    apart=0.01,
    roundings=64,
)
def test_with_slip_scaled_it_wears_by_what_the_creepages_feed_in(apart: float, roundings: int) -> None:
    scaled = RIG | wl.contact_model("fastsim", slip="scaled") | PER_ENERGY
    result = scaled(**CONDITIONS)
    assert result.cell_wear_index.magnitude == pytest.approx(result.wear_index.magnitude, rel=roundings * EPS)
    plain = (RIG | FASTSIM)(**CONDITIONS)
    assert result.wear_index == plain.wear_index
    assert abs(plain.cell_wear_index / plain.wear_index - 1) > apart  # with spin the two differ


@pytest.mark.validates(
    "wear-laws",
    "The wear profile over a wheel's tread sums to the mass that it loses",
    source="depth × width × circumference × density, by the trapezoidal rule",
    held_to="{within:g}, relative (the profile's strips)",
    within=0.002,
)
def test_the_profile_of_the_wheel_sums_to_the_mass_it_loses(within: float) -> None:
    result = (RIG | FASTSIM | PER_ENERGY)(**CONDITIONS)
    profile = result.wear_profile("wheel", strips=101)
    assert profile.depth.attrs["units"] == "um/km"
    assert profile.depth.attrs["long_name"] == "depth per metre rolled"
    assert profile.y.attrs["long_name"] == VARIABLES["y"].long_name
    # Depth × width × circumference × density is the mass lost per metre. The profile has strips of equal width, whose
    # midpoint rule is off by O(strips^-3/2) next to the ends, where the depth goes to zero like (1 - |y|/b)^(1/2) or
    # faster: 101^-1.5 = 1e-3.
    lost = 1e-9 * np.trapezoid(profile.depth, 1e-3 * profile.y) * 2 * np.pi * 0.46 * 7850
    assert lost == pytest.approx(result.mass_per_distance.to("kg/m").magnitude, rel=within)


def test_the_profile_of_the_rail_is_one_passage() -> None:
    result = (RIG | FASTSIM | PER_ENERGY)(**CONDITIONS)
    wheel, rail = result.wear_profile("wheel"), result.wear_profile("rail")
    assert rail.depth.attrs == {"units": "nm", "long_name": "depth per passage of a wheel"}
    once = 2 * np.pi * 0.46
    assert 1e-9 * rail.depth.values == pytest.approx(1e-9 * wheel.depth.values * once, rel=8 * EPS)
    assert 1e-6 * rail.sliding_distance.values == pytest.approx(
        1e-3 * wheel.sliding_distance.values * once, rel=8 * EPS
    )


@pytest.mark.validates(
    "wear-laws",
    "In full slip each point of the rail slides by the creepage times the length of its strip",
    source="geometry of the ellipse",
    held_to="{within:g}, relative",
    within=1e-09,
)
def test_in_full_slip_without_spin_each_point_slides_by_the_creepage(within: float) -> None:
    # The mean slip over a strip in full slip is the creepage, so a point slides ν × the length of its strip.
    conditions = {**CONDITIONS, "longitudinal_creepage": Q(50, "%"), "lateral_creepage": Q(0, ""), "spin": Q(0, "1/m")}
    result = (RIG | FASTSIM | PER_ENERGY)(**conditions)
    profile = result.wear_profile("rail", strips=101)
    b, a = result.semi_axis_b.magnitude, result.semi_axis_a.magnitude
    due = 0.5 * 2.0 * a * np.sqrt(1.0 - (profile.y.values / b) ** 2)
    assert 1e-3 * profile.sliding_distance.values == pytest.approx(due, rel=within)


def test_strips_of_a_profile_must_be_a_number_of_them() -> None:
    result = (RIG | FASTSIM | PER_ENERGY)(**CONDITIONS)
    for strips in (1, 0, True, 10.0):
        with pytest.raises(wl.InputError, match="strips: must be a whole number from 2"):
            result.wear_profile("wheel", strips=strips)  # type: ignore[arg-type]


@pytest.mark.parametrize("points", [None, 3])
def test_the_strips_of_the_contact_sum_to_the_mass_of_the_wheel(points: int | None) -> None:
    load = Q(80.0, "kN") if points is None else Q(np.linspace(40.0, 90.0, points), "kN")
    result = (RIG | FASTSIM | PER_ENERGY)(**{**CONDITIONS, "normal_force": load})
    profile = result.wear_profile("wheel")
    contact: Any = result.contact
    lost = 1e-9 * (profile.depth.values * contact.strip_width).sum(axis=-1) * 2 * np.pi * 0.46 * 7850
    assert lost == pytest.approx(result.mass_per_distance.to("kg/m").magnitude, rel=64 * EPS)


def test_profiles_of_many_points_are_kept_from_the_prediction(monkeypatch: pytest.MonkeyPatch) -> None:
    conditions = {**CONDITIONS, "normal_force": Q(np.linspace(40.0, 90.0, 1200), "kN")}  # three blocks of 468 points
    Counted.solved.clear()
    result = (RIG | Counted() | PER_ENERGY)(**conditions)
    solved = list(Counted.solved)
    kept, part = result.wear_profile("wheel"), result.isel(point_0=slice(900, None)).wear_profile("wheel")
    assert Counted.solved == solved
    monkeypatch.setattr(integrate, "KEPT_STRIPS", 0)
    again = (RIG | FASTSIM | PER_ENERGY)(**conditions).wear_profile("wheel")
    for name in ("y", "depth", "sliding_distance"):
        np.testing.assert_allclose(kept[name].values, again[name].values, rtol=64 * EPS)
        np.testing.assert_array_equal(part[name].values, kept[name].values[900:])


class Counted(type(wl.contact_model("fastsim"))):  # type: ignore[misc]
    """FASTSIM that counts how often it solves."""

    solved: ClassVar[list[int]] = []

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        self.solved.append(problem.size)
        found: wl.Contact = super().solve_ellipse(problem)
        return found


def test_the_slip_of_many_ellipses_is_kept_though_their_contacts_are_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wearlaw.numerics.integrate.ELLIPSE_NODES", 2 * 140)  # private: blocks of two
    creepage = np.linspace(0.01, 1.0, 11)
    conditions = {**CONDITIONS, "longitudinal_creepage": Q(creepage, "%")}
    Counted.solved.clear()
    result = (RIG | Counted() | PER_ENERGY)(**conditions)
    found = {name: getattr(result, name).magnitude for name in ("mean_slip", "stick_ratio", "cell_wear_index")}
    assert Counted.solved == [1, 2, 2, 2, 2, 2, 1]  # the first counts the nodes
    for i in range(11):
        alone = (RIG | Counted() | PER_ENERGY)(**{**CONDITIONS, "longitudinal_creepage": Q(creepage[i], "%")})
        for name, values in found.items():
            assert values[i] == pytest.approx(getattr(alone, name).magnitude, rel=64 * EPS), name


def test_means_of_the_patch_have_no_profile() -> None:
    result = (RIG | FASTSIM | wl.patch_mean() | PER_ENERGY)(**CONDITIONS)
    with pytest.raises(CompositionError, match="gives means of the whole patch"):
        result.wear_profile("wheel")
    assert result.wear_rate.to("kg/m^3").magnitude == pytest.approx(
        1e-12 * result.wear_index_density.to("N/m^2").magnitude, rel=8 * EPS
    )


@pytest.mark.parametrize("fitted_for", ["global", "exact", "fastsim"])
def test_parameters_of_line_contact_warn_on_an_ellipse(fitted_for: str) -> None:
    law = wl.wear_law("usfd", fitted_for=fitted_for)
    with pytest.warns(wl.CalibrationWarning, match="fitted for line contacts, but are used with elliptic") as caught:
        RIG | FASTSIM | law
    assert "4/π or 3/2 times its mean on a line" in str(caught[0].message)
    assert caught[0].filename == __file__


class ShownByItsProblems(wl.WheelRail):
    """A rig that does not say beforehand what shape its patch has."""

    patch_geometry: ClassVar[wl.Geometry | None] = None


def test_parameters_of_an_ellipse_do_not_warn_there_but_on_a_line() -> None:
    own = wl.Calibration(
        contact_model="fastsim", scale="cells", geometry="ellipse", materials="made up", source="made up"
    )
    law = wl.wear_law("usfd", fitted_for=own, m_m="5 ug/m/N", q_s="55 ug/m/mm^2", m_c="60 ug/m/N", tr_sc="80 N/mm^2")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        RIG | FASTSIM | law
        ShownByItsProblems(**dict(RIG)) | FASTSIM | law
    with pytest.warns(wl.CalibrationWarning, match="fitted for elliptic contacts, but are used with line contacts"):
        wl.TwinDisc.suros() | FASTSIM | law


@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # 400 kN
def test_the_elastic_limit_and_the_range_of_the_law_are_watched() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        predict = RIG | FASTSIM | wl.wear_law("usfd")
    with pytest.warns(wl.RangeWarning) as caught:
        predict(**{**CONDITIONS, "normal_force": Q(400, "kN"), "longitudinal_creepage": Q([1, 60], "%")})
    messages = [str(warning.message) for warning in caught]
    assert any("beyond the shakedown limit" in message for message in messages)
    assert any("1 of 2 operating points lies outside" in message for message in messages)
    assert {warning.filename for warning in caught} == {__file__}


@pytest.mark.validates(
    "integration",
    "`wear_rate_error` bounds the error on an ellipse",
    source="120 strips in place of 10",
    held_to="in {honest:.0%} of the points",
    honest=0.95,
)
def test_the_error_estimate_covers_the_true_error(honest: float) -> None:
    random = np.random.default_rng(8)
    points = 200
    conditions: dict[str, Any] = {
        "normal_force": Q(10 ** random.uniform(1, 2.2, points), "kN"),
        "friction_coefficient": random.uniform(0.1, 0.5, points),
        "longitudinal_creepage": Q(10 ** random.uniform(-4, -1.5, points), ""),
        "lateral_creepage": Q(10 ** random.uniform(-4, -1.5, points), ""),
        "spin": Q(random.uniform(-1, 1, points), "1/m"),
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        law = wl.wear_law("usfd")
        predict, fine = RIG | FASTSIM | law, RIG | wl.contact_model("fastsim", strips=120) | law
        result, reference = predict(**conditions), fine(**conditions)
    true = np.abs(result.wear_rate - reference.wear_rate)
    assert np.mean(true <= result.wear_rate_error + 1e-9 * reference.wear_rate) >= honest
    assert np.median(result.wear_rate_error) < 4 * np.median(true)


def test_the_error_is_estimated_up_to_the_largest_number_of_strips() -> None:
    predict, finer = (
        RIG | wl.contact_model("strip_theory", strips=strips) | wl.wear_law("kth") for strips in (251, 500)
    )
    result = predict(**CONDITIONS)
    assert abs(result.wear_rate - finer(**CONDITIONS).wear_rate) <= result.wear_rate_error < 1e-4 * result.wear_rate
    for name in ("fastsim", "strip_theory"):
        finest = wl.contact_model(name, strips=1000)
        for strips in (2000, 4000):
            finest = finest.refined()  # type: ignore[assignment]
            assert f"strips={strips}" in repr(finest)


class Unrefined(Strips):
    """Strips that can be neither refined nor chosen."""

    name = "unrefined"

    refined = wl.ContactModel.refined  # type: ignore[assignment]
    on_strips = wl.ContactModel.on_strips


def test_in_full_slip_the_error_of_a_model_that_cannot_be_refined_covers_the_true_one_and_falls() -> None:
    conditions = {**CONDITIONS, "longitudinal_creepage": Q(np.geomspace(2.0, 20.0, 8), "%")}
    coarse, fine = ((RIG | Unrefined(cells=n, strips=n) | PER_ENERGY)(**conditions) for n in (16, 64))
    # In first order its own error is a quarter of that of 64 cells, which the estimates must leave room for.
    reference = (RIG | Strips(cells=256, strips=256) | PER_ENERGY)(**conditions).wear_rate
    for result in (coarse, fine):
        assert np.all(np.abs(result.wear_rate - reference) <= result.wear_rate_error)
    assert np.all(fine.wear_rate_error <= 0.25 * coarse.wear_rate_error)  # first order, at the least


def test_the_profile_of_a_model_whose_strips_cannot_be_chosen_is_on_its_own() -> None:
    model = Unrefined(cells=8, strips=8)
    profile = (RIG | model | PER_ENERGY)(**CONDITIONS).wear_profile("rail")
    own = 1e3 * model.solve(RIG.problem(**CONDITIONS)).y[0]
    assert profile.y.values == pytest.approx(own, rel=8 * EPS)


class Lost(Strips):
    """Strips whose spin moment is lost on the way."""

    name = "lost"

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        return super().solve_ellipse(problem).replaced(moment_z=np.full(problem.batch_shape, np.nan))


def test_a_model_of_ellipses_that_gives_no_number_is_named_with_the_creepages() -> None:
    said = "contact model 'lost' gave a spin moment that is not finite, first for longitudinal creepage 0.2000 %"
    with pytest.raises(ModelError, match=said):
        (RIG | Lost(cells=8, strips=8))(**CONDITIONS).spin_moment  # noqa: B018


def test_a_problem_without_operating_points_is_refused() -> None:
    many = RIG.problem(**{**CONDITIONS, "longitudinal_creepage": Q([0.1, 0.2], "%")})
    with pytest.raises(wl.ConditionsError, match="problem: holds no operating points"):
        (RIG | FASTSIM | PER_ENERGY).predict(many[:0])
