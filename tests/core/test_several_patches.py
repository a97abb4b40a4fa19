"""Rigs whose bodies touch in several places or that balance their loads, and predictions of some of the patches."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.core.axles import (
    ALONE,
    CONICITY,
    CREEP,
    CUT,
    EXISTS,
    GIVEN,
    KTH,
    LOADS,
    PATCHES,
    PREDICT,
    RADIUS,
    STRIPS,
    WHEEL,
    Axle,
    Worn,
    of,
)
from tests.strategies import EPS
from wearlaw import Array, Q
from wearlaw.errors import CompositionError, ModelError
from wearlaw.numerics import integrate  # private: integrals at the size of blocks
from wearlaw_apps.fits import WearTests


def alone(name: str) -> Array:
    """Return what single wheels give on each of the patches."""
    found = np.full(EXISTS.shape, np.nan)
    for place in zip(*np.nonzero(EXISTS), strict=True):
        found[place] = getattr(ALONE(normal_force=LOADS[place], **CREEP), name).to_base_units().magnitude
    return found


@pytest.mark.parametrize(
    "name",
    ["wear_rate", "wear_rate_error", "longitudinal_force", "spin_moment", "wear_index", "mean_slip", "stick_ratio",
     "patch_area", "max_pressure", "semi_axis_a", "mass_per_distance",
     "first_yield", "shakedown_limit", "outside_range"],
)  # fmt: skip
def test_each_patch_is_a_contact_of_its_own_and_missing_ones_are_nan(name: str) -> None:
    found = getattr(PREDICT(**GIVEN), name).to_base_units().magnitude
    assert found.shape == EXISTS.shape
    assert (np.isnan(found) == ~EXISTS).all()
    # errors of the wear rate are differences of rates, which sums in another order round
    rounding = 1e3 * EPS * np.nanmax(alone("wear_rate")) if name == "wear_rate_error" else 0.0
    np.testing.assert_allclose(found, alone(name), rtol=64 * EPS, atol=rounding)


def test_only_patches_that_exist_are_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    solved: list[int] = []
    model = type(wl.contact_model("fastsim"))
    solve = model.solve_ellipse

    def counted(self: Any, problem: wl.Problem) -> wl.Contact:
        solved.append(problem.size)
        return solve(self, problem)

    monkeypatch.setattr(model, "solve_ellipse", counted)
    found = PREDICT(**GIVEN)
    _ = found.wear_rate, found.longitudinal_force, found.contact, found.mean_slip
    assert solved == [EXISTS.sum()]


def test_the_contact_has_the_axes_of_the_patches() -> None:
    contact = PREDICT(**GIVEN).contact
    assert contact.pressure.shape[:3] == EXISTS.shape
    assert (np.isnan(contact.traction).all(axis=(-1, -2)) == ~EXISTS).all()
    assert contact.problem.dims == PATCHES


def test_each_patch_has_the_rolling_radius_of_its_place() -> None:
    found = PREDICT(**GIVEN)
    profile = found.wear_profile("wheel")
    assert profile.depth.dims == ("point_0", "side", "patch", "strip")
    radius = RADIUS + CONICITY * np.array([[0.0, 0.0], [-5e-3, 5e-3], [-7e-3, 7e-3]])[..., None]
    single = ALONE(normal_force="80 kN", **CREEP).wear_profile("wheel").depth.values
    np.testing.assert_allclose(profile.depth.values[1, 1, 0] * radius[1, 1] / RADIUS, single, rtol=64 * EPS)
    lost = found.mass_per_cycle("wheel").to("kg").magnitude
    np.testing.assert_allclose(lost, alone("mass_per_distance") * 2 * np.pi * radius, rtol=64 * EPS)


@pytest.mark.parametrize("model", ["exact", "fastsim"])
def test_patches_of_a_line_may_be_missing_too(model: str) -> None:
    class Twice(wl.Rig):
        """Two discs side by side, of which the second may be lifted off."""

        name: ClassVar[str] = "twice"

        def problem(self, *, creepage: wl.QuantityLike, lifted: bool) -> wl.Problem:
            """Return the problem of both."""
            both = Q(np.full(2, wl.Unit("", positive=False).si(creepage, "creepage")), "")
            found = discs.problem(creepage=both, max_pressure="1.5 GPa", friction_coefficient=0.46)
            return found.replaced(dims={"disc": (1, 2)}, exists=np.array([True, not lifted]))

    discs = wl.TwinDisc.suros()
    for law in ("usfd", "kth"):
        pipeline: Any = (Twice() | wl.contact_model(model)).with_law(wl.wear_law(law))
        both, one = pipeline(creepage="1 %", lifted=False), pipeline(creepage="1 %", lifted=True)
        for name in ("wear_rate", "tangential_force", "mean_slip", "half_width", "max_pressure"):
            first, second = getattr(both, name).magnitude
            assert first == second
            np.testing.assert_array_equal(getattr(one, name).magnitude, [first, np.nan])
        assert one.profile.pressure.dims == ("disc", "cell")
        assert np.isnan(one.profile.pressure.values[1]).all()


@pytest.mark.parametrize(
    ("field", "wrong"),
    [
        *(("exists", mask) for mask in (np.array([1.0, 0.0]), np.array([True]), [True, False])),
        *(("dims", labels) for labels in (("side", "patch"), {"side": ("left",), "patch": (1, 2)}, {"patch": 2})),
    ],
)
def test_a_mask_or_labels_that_do_not_fit_the_batch_are_the_rigs_fault(field: str, wrong: Any) -> None:
    class Wrong(Axle):
        name: ClassVar[str] = "wrong"

        def problem(self, **conditions: Any) -> wl.Problem:
            return super().problem(**conditions).replaced(**{field: wrong})

    with pytest.raises(ModelError, match=r"rig 'wrong' .*`exists`" if field == "exists" else "rig 'wrong' "):
        (Wrong() | wl.contact_model("fastsim"))(**GIVEN)


def test_applications_that_take_one_patch_say_so() -> None:
    with pytest.raises(
        CompositionError, match=r"uncertainty: needs one patch .* 'axle' makes several, along side and patch"
    ):
        wl.uncertainty(PREDICT, **{**GIVEN, "load": wl.uniform("60 kN", "80 kN")}, samples=4).interval()
    varied = {"displacement": Q([0.0, 1.0, 7.0], "mm"), "longitudinal_creepage": Q([0.1, 0.2, 0.3], "%")}
    tests = WearTests.from_arrays(
        friction_coefficient=0.3,
        other_conditions={"load": "80 kN", "spin": "0.3 1/m", **varied},
        wear_rate=Q([1.0, 2.0, 3.0], "ug/m/mm^2"),
    )
    with pytest.raises(CompositionError, match="compare: needs one patch"):
        wl.compare([PREDICT], tests)
    with pytest.raises(CompositionError, match="fit: needs one patch"):
        wl.fit(PREDICT, tests, free=["hardness"])
    creepages = {name: value for name, value in GIVEN.items() if name != "longitudinal_creepage"}
    with pytest.raises(CompositionError, match="creepage_for: needs one patch"):
        wl.creepage_for(Axle() | wl.contact_model("fastsim"), tangential_force="1 kN", **creepages)


ANGLE = np.deg2rad(70.0)


class Flange(wl.Rig):
    """A flange at 70 degrees: what is given is the vertical load, N cos δ + Fy sin δ."""

    name: ClassVar[str] = "flange"
    creepage: ClassVar[str] = "longitudinal_creepage"

    def problem(self, *, vertical_load: wl.QuantityLike, **creepages: Any) -> wl.Problem:
        """Return the problem under the normal force that carries the load without friction."""
        load = wl.Unit("N").si(vertical_load, "vertical_load") / np.cos(ANGLE)
        return WHEEL.problem(normal_force=Q(load, "N"), **creepages)

    def balanced(self, problem: wl.Problem, forces: Callable[[wl.Problem], wl.CreepForces]) -> wl.Problem:
        """Return the problem under the normal force that carries the load with friction."""
        load = problem.normal_force * np.cos(ANGLE)
        for _ in range(60):  # each step leaves μ tan δ / 3 of the error at the most, Fy growing no faster than N
            lateral = forces(problem).lateral
            problem = problem.with_normal_force((load - lateral * np.sin(ANGLE)) / np.cos(ANGLE))
        return problem


def test_a_rig_balances_its_loads_around_the_contact() -> None:
    creepages: Any = {"longitudinal_creepage": Q([0.1, 0.5], "%"), "lateral_creepage": "0.1 %"}
    predict: Any = Flange() | wl.contact_model("fastsim") | KTH
    found = predict(vertical_load="20 kN", friction_coefficient=0.2, **creepages)
    carried = found.normal_force * np.cos(ANGLE) + found.lateral_force * np.sin(ANGLE)
    np.testing.assert_allclose(carried.to("kN").magnitude, 20.0, rtol=1e-9)
    alone = ALONE(normal_force=found.normal_force, friction_coefficient=0.2, **creepages)
    for name in ("wear_rate", "max_pressure", "semi_axis_a", "semi_axis_b", "lateral_force"):
        np.testing.assert_allclose(getattr(found, name).magnitude, getattr(alone, name).magnitude, rtol=64 * EPS)
    swept = wl.sweep(predict, vertical_load="20 kN", friction_coefficient=0.2, **creepages)
    np.testing.assert_array_equal(swept.wear_rate.values, found.wear_rate.to(swept.wear_rate.units).magnitude)


def test_the_creepage_that_loads_depend_on_is_not_looked_for() -> None:
    with pytest.raises(CompositionError, match="rig 'flange' balances its loads, which depend on the unknown creepage"):
        wl.creepage_for(
            Flange() | wl.contact_model("fastsim"),
            tangential_force="1 kN",
            vertical_load="20 kN",
            friction_coefficient=0.2,
        )


def test_what_balances_must_return_a_problem() -> None:
    class Forgetful(Flange):
        name: ClassVar[str] = "forgetful"

        def balanced(self, problem: wl.Problem, forces: Callable[[wl.Problem], wl.CreepForces]) -> Any:
            forces(problem)

    with pytest.raises(ModelError, match=r"rig 'forgetful' .*`balanced`"):
        (Forgetful() | wl.contact_model("fastsim"))(vertical_load="20 kN", **CREEP)


@pytest.mark.parametrize("factor", [0.1, 3.0])
def test_another_normal_force_gives_the_patch_of_hertz(factor: float) -> None:
    discs: Any = {"creepage": "1 %", "friction_coefficient": 0.4}
    for rig, given in ((wl.TwinDisc.suros(), discs), (WHEEL, CREEP)):
        one, other = (rig.problem(normal_force=Q(7.0 * f, "kN"), **given) for f in (1.0, factor))
        loaded = one.with_normal_force(factor * one.normal_force)
        for name in ("a", "b", "normal_force", "max_pressure"):
            assert getattr(loaded, name) == pytest.approx(getattr(other, name), rel=16 * EPS)


@pytest.mark.parametrize("predict", [PREDICT, CUT])
def test_a_prediction_prints_the_patches_that_exist(predict: Any) -> None:
    found = predict(**GIVEN)
    first, *rows = repr(found).splitlines()
    assert first == "Prediction of 7 patches at 3 operating points"
    assert "nan" not in repr(found)
    rate = found.wear_rate[found.problem.exists]
    assert rows[0] == f"  wear_rate            {rate.min()!r} to {rate.max()!r}"
    flange = found.sel(side="right", patch=2)
    assert repr(flange).startswith("Prediction of 1 patch at 3 operating points\n")
    assert "nan" not in repr(flange)
    assert repr(flange.isel(point_0=2)).startswith("Prediction of 1 operating point\n")
    missing = repr(flange.isel(point_0=0)).splitlines()
    assert missing[0] == "Prediction of 0 patches at 1 operating point"
    assert all(row.endswith(" no patch") for row in missing[1:])


@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # 8000 kN on a patch
def test_warnings_and_limits_on_strips_look_at_patches_that_exist() -> None:
    with pytest.warns(wl.RangeWarning) as on_strips:
        found = CUT(**{**GIVEN, "load": "8000 kN"})
    with pytest.warns(wl.RangeWarning) as on_ellipses:
        PREDICT(**{**GIVEN, "load": "8000 kN"})
    said, expected = (
        [str(one.message) for one in these if issubclass(one.category, wl.RangeWarning)]
        for these in (on_strips, on_ellipses)
    )
    assert len(said) == len(expected) == 3
    assert "is beyond the shakedown limit" in said[0]
    assert "7 of 7 patches lie outside" in said[1]
    assert "patches lie more than 5 % off" in said[2]  # KTH follows p·s, and this creepage is one of partial slip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        missing = CUT(**{**GIVEN, "load": "8000 kN"}).sel(side="left", patch=2)
    for name in ("first_yield", "shakedown_limit", "outside_range"):
        assert (np.isnan(of(found, name)) == ~EXISTS).all()
        assert np.isnan(of(missing, name)).all()
    assert (of(found, "outside_range")[EXISTS] == 1.0).all()
    assert (of(found, "max_pressure") > of(found, "shakedown_limit"))[EXISTS].all()


@pytest.mark.parametrize(
    "index", [np.s_[1], np.s_[1:], np.s_[0, 1], np.s_[..., 0], np.array([2, 0]), EXISTS, np.s_[:, None]]
)
def test_strips_are_indexed_as_the_other_arrays(index: Any) -> None:
    problem = CUT.rig.problem(**GIVEN)
    found, positions = problem[index], np.arange(EXISTS.size).reshape(EXISTS.shape)[index]
    for name in ("y", "width", "half_length", "max_pressure"):
        expected = getattr(problem.strips, name).reshape(EXISTS.size, -1)[positions]
        np.testing.assert_array_equal(getattr(found.strips, name), expected)
    np.testing.assert_array_equal(found.a, problem.a.reshape(-1)[positions])
    wide = problem[0].broadcast_to((3, 2, 2))
    np.testing.assert_array_equal(wide.strips.y, np.broadcast_to(problem.strips.y[0], (3, 2, 2, 12)))


# --- A field that chooses the shape ----------------------------------------------------------------------------------


def test_a_rig_may_choose_its_geometry_by_a_field() -> None:
    ellipse = (Worn() | wl.contact_model("polach"))(**GIVEN)
    assert ellipse.problem.geometry == "ellipse"
    strips: Any = Worn(hertzian=False) | wl.contact_model("fastsim") | KTH
    np.testing.assert_array_equal(of(strips(**GIVEN), "wear_rate"), of(CUT(**GIVEN), "wear_rate"))
    with pytest.raises(
        CompositionError,
        match="contact model 'polach' solves elliptic contacts only, but a Worn makes patches of strips;"
        r" those that solve them: .*fastsim",
    ):
        Worn(hertzian=False) | wl.contact_model("polach")


EVERY = (
    "wear_rate", "wear_rate_error", "longitudinal_force", "lateral_force", "spin_moment", "tangential_force",
    "traction_coefficient", "wear_index", "cell_wear_index", "wear_index_density",
    "normal_force", "creepage", "friction_coefficient", "semi_axis_a", "semi_axis_b", "max_pressure", "first_yield",
    "shakedown_limit", "outside_range", "patch_area", "stick_ratio", "mean_slip", "mass_per_distance",
)  # fmt: skip
"""All properties of an ellipse."""

SELECTIONS: list[tuple[dict[str, Any], dict[str, Any], Any, dict[str, Any]]] = [
    ({"side": "right"}, {}, np.s_[:, 1], {"patch": (1, 2)}),
    ({"patch": 1}, {}, np.s_[:, :, 0], {"side": ("left", "right")}),
    ({"side": "right", "patch": 2}, {}, np.s_[:, 1, 1], {}),
    ({"side": ["right"]}, {}, np.s_[:, [1]], {"side": ("right",), "patch": (1, 2)}),
    ({"side": ["right", "left"], "patch": [2, 1]}, {}, np.s_[:, ::-1, ::-1],
     {"side": ("right", "left"), "patch": (2, 1)}),
    ({}, {"point_0": 2}, np.s_[2], dict(PATCHES)),
    ({}, {"point_0": -1, "side": 0}, np.s_[2, 0], {"patch": (1, 2)}),
    ({}, {"point_0": [2, 0], "patch": slice(1, None)}, np.s_[[2, 0], :, 1:],
     {"side": ("left", "right"), "patch": (2,)}),
    ({"side": "right", "patch": 2}, {"point_0": 2}, np.s_[2, 1, 1], {}),
    ({"side": "left", "patch": 2}, {}, np.s_[:, 0, 1], {}),  # which never touches
    ({"side": "left", "patch": 2}, {"point_0": 0}, np.s_[0, 0, 1], {}),
]  # fmt: skip


@pytest.mark.parametrize(("labels", "positions", "index", "dims"), SELECTIONS)
@pytest.mark.parametrize("kept", [True, False])
def test_a_prediction_of_some_patches_has_their_values(
    monkeypatch: pytest.MonkeyPatch, kept: bool, labels: Any, positions: Any, index: Any, dims: Any
) -> None:
    if not kept:  # in several blocks, whose contacts are not kept
        monkeypatch.setattr(integrate, "FEW", 2)
        monkeypatch.setattr(integrate, "ELLIPSE_NODES", 1)
    whole = PREDICT(**GIVEN)
    part = whole.sel(**labels).isel(**positions)
    assert part.problem.dims == dims
    for name in EVERY:
        np.testing.assert_array_equal(of(part, name), of(whole, name)[index], err_msg=name)
    for name in ("mass_per_cycle", "depth_per_distance", "profile_area_rate"):
        value = getattr(part, name)("wheel").magnitude
        np.testing.assert_array_equal(value, getattr(whole, name)("wheel").magnitude[index], err_msg=name)
    np.testing.assert_array_equal(part.wear_rate_of("rail").magnitude, whole.wear_rate_of("rail").magnitude[index])
    np.testing.assert_array_equal(part.contact.traction, whole.contact.traction[index])
    np.testing.assert_array_equal(part["wear_rate_error"].magnitude, whole["wear_rate_error"].magnitude[index])
    found, expected = part.wear_profile("wheel"), whole.wear_profile("wheel")
    for name in ("depth", "sliding_distance", "y"):
        np.testing.assert_array_equal(found[name].values, expected[name].values[index], err_msg=name)
    for dim, those in dims.items():
        assert found[dim].values.tolist() == list(those)
    of_101 = part.wear_profile("rail", strips=5).depth.values
    np.testing.assert_allclose(of_101, whole.wear_profile("rail", strips=5).depth.values[index], rtol=64 * EPS)


def test_selecting_solves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = PREDICT(**GIVEN)
    monkeypatch.setattr(type(wl.contact_model("fastsim")), "solve_ellipse", lambda *_: pytest.fail("solved again"))
    part = whole.sel(side="right")
    _ = part.wear_rate, part.longitudinal_force, part.contact, part.mean_slip, part.wear_profile("wheel")


def test_patches_of_strips_can_be_selected() -> None:
    whole = CUT(**GIVEN)
    part = whole.sel(side="right")
    found, expected = part.wear_profile("wheel"), whole.wear_profile("wheel")
    assert found.depth.dims == ("point_0", "patch", "strip")
    assert found.sizes["strip"] == STRIPS
    np.testing.assert_array_equal(found.depth.values, expected.depth.values[:, 1])
    np.testing.assert_array_equal(found.y.values, expected.y.values[:, 1])
    assert (np.isnan(found.depth.values).all(axis=-1) == ~EXISTS[:, 1]).all()
    missing = whole.sel(side="left", patch=2)
    assert np.isnan(missing.wear_profile("wheel").depth.values).all()
    for name in ("wear_rate", "patch_area", "max_pressure", "mean_slip", "wear_index", "first_yield", "outside_range"):
        np.testing.assert_array_equal(of(part, name), of(whole, name)[:, 1], err_msg=name)
        assert np.isnan(of(missing, name)).all()


def test_a_prediction_without_laws_can_be_selected_from() -> None:
    whole = (Axle() | wl.contact_model("fastsim"))(**GIVEN)
    part = whole.sel(side="right")
    for name in ("longitudinal_force", "mean_slip", "patch_area", "wear_index_density", "stick_ratio"):
        np.testing.assert_array_equal(of(part, name), of(whole, name)[:, 1], err_msg=name)
    np.testing.assert_array_equal(part.contact.traction, whole.contact.traction[:, 1])


@pytest.mark.parametrize("law", ["usfd", "kth"])
def test_operating_points_of_discs_are_selected_by_position(law: str) -> None:
    predict = (wl.TwinDisc.suros() | wl.contact_model("exact")).with_law(wl.wear_law(law))
    whole = predict(creepage=Q([[0.1], [1.0]], "%"), max_pressure=Q([1.0, 1.5, 2.0], "GPa"), friction_coefficient=0.4)
    part = whole.isel(point_0=1, point_1=[0, 2])
    for name in ("wear_rate", "wear_rate_error", "tangential_force", "mean_slip", "patch_area", "half_width"):
        np.testing.assert_array_equal(of(part, name), of(whole, name)[1, [0, 2]], err_msg=name)
    np.testing.assert_array_equal(part.profile.traction.values, whole.profile.traction.values[1, [0, 2]])
    assert part.profile.traction.dims == ("point_0", "cell")
    assert np.isfinite(part.isel(point_0=0).wear_rate.magnitude)
    one = predict(creepage="1 %", max_pressure="1 GPa", friction_coefficient=0.4)
    np.testing.assert_array_equal(one.isel().contact.traction, one.contact.traction)


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"sid": "left"}, r"sel: no labels for an axis 'sid'.* did you mean 'side'\? Axes with labels: side"
         r" \('left', 'right'\) and patch \(1, 2\)"),
        ({"point_0": 0}, r"sel: no labels for an axis 'point_0'.* isel takes"),
        ({"side": "top"}, r"sel: axis 'side' has no label 'top', only \('left', 'right'\)"),
        ({"patch": [1, 3]}, r"sel: axis 'patch' has no label 3, only \(1, 2\)"),
    ],
)  # fmt: skip
def test_a_wrong_label_is_named_with_those_there_are(chosen: Any, said: str) -> None:
    with pytest.raises(wl.InputError, match=said):
        PREDICT(**GIVEN).sel(**chosen)


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"point_1": 0}, r"isel: no axis 'point_1'.* Axes \(with sizes\): point_0 \(3\), side \(2\), patch \(2\)"),
        ({"point_0": 3}, "isel: axis 'point_0' has 3 entries, 0 to 2; give an integer, .* or a slice, got 3"),
        ({"point_0": [0, -4]}, r"isel: axis 'point_0' has 3 entries, 0 to 2; .* got \[0, -4\]"),
        ({"side": "left"}, "isel: axis 'side' has 2 entries, 0 to 1; .* got 'left'"),
        ({"side": [0.5]}, r"isel: axis 'side' has .* got \[0.5\]"),
    ],
)  # fmt: skip
def test_a_wrong_position_is_named_with_those_there_are(chosen: Any, said: str) -> None:
    with pytest.raises(wl.InputError, match=said):
        PREDICT(**GIVEN).isel(**chosen)


def test_one_operating_point_has_no_axes_to_select_from() -> None:
    with pytest.raises(wl.InputError, match=r"isel: no axis 'point_0'.* none at one operating point"):
        ALONE(normal_force="80 kN", **CREEP).isel(point_0=0)
