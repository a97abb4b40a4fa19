"""Rigs whose bodies touch in several places, and rigs that balance their loads around the contact."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Array, Q
from wearlaw.numerics import integrate

RADIUS, CONICITY, FLANGE = 0.46, 0.05, 6e-3
WHEEL = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
PATCHES: Mapping[str, tuple[str | int, ...]] = {"side": ("left", "right"), "patch": (1, 2)}
CREEP: Any = {"longitudinal_creepage": "0.2 %", "spin": "0.3 1/m", "friction_coefficient": 0.3}
GIVEN: Any = {"load": "80 kN", "displacement": Q([0.0, 5.0, 7.0], "mm"), **CREEP}
EXISTS = np.array([[[1, 0], [1, 0]], [[1, 0], [1, 0]], [[1, 0], [1, 1]]], dtype=bool)
SHARE = 0.25


class Axle(wl.Rig):
    """Two wheels; beyond a displacement of 6 mm the right one also touches with its flange, which takes a quarter."""

    name: ClassVar[str] = "axle"
    source: ClassVar[str] = "a test"
    creepage: ClassVar[str] = "longitudinal_creepage"
    dims: ClassVar[Mapping[str, tuple[str | int, ...]]] = PATCHES

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """Those of one wheel."""
        return WHEEL.bodies

    def problem(self, *, load: wl.QuantityLike, displacement: wl.QuantityLike, **creepages: Any) -> wl.Problem:
        """Return the problem of four patches, of which there are two or three."""
        place = wl.Unit("mm", positive=False).si(displacement, "displacement")[..., None, None]
        flange, right = np.array([0.0, 1.0]), np.array([[-1.0], [1.0]])
        exists = (flange == 0.0) | ((place > FLANGE) & (right > 0.0))
        two = (right > 0.0) & (place > FLANGE)
        share = np.where(two, np.where(flange > 0.0, SHARE, 1.0 - SHARE), 1.0)
        found = WHEEL.problem(normal_force=Q(share * wl.Unit("N").si(load, "load"), "N"), **creepages)
        radius = np.broadcast_to(RADIUS + CONICITY * right * place, exists.shape)
        bodies = {"wheel": wl.Body(WHEEL.material, radius), "rail": found.bodies["rail"]}
        return found.replaced(dims=self.dims, exists=exists, bodies=bodies)


KTH = wl.wear_law("kth")
PREDICT: Any = Axle() | wl.contact_model("fastsim") | KTH
ALONE: Any = WHEEL | wl.contact_model("fastsim") | KTH


class Cut(Axle):
    """The patches of the axle cut into strips."""

    name: ClassVar[str] = "cut"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with strips at even angles, with Hertz's pressure in their middles."""
        found = super().problem(**conditions)
        angle = np.pi / (STRIPS + 1) * np.arange(STRIPS, 0, -1)
        root = np.sin(angle)
        strips = wl.Strips(
            y=found.b[..., None] * np.cos(angle),
            width=found.b[..., None] * np.pi / (STRIPS + 1) * root,
            half_length=found.a[..., None] * root,
            max_pressure=found.max_pressure[..., None] * root,
        )
        return found.replaced(geometry="strips", strips=strips, normal_force=strips.normal_force.sum(axis=-1))


class Worn(Cut):
    """The axle with patches of either shape."""

    name: ClassVar[str] = "worn"
    hertzian: bool = True

    @property
    def patch_geometry(self) -> wl.Geometry:
        """The shape that the field chooses."""
        return "ellipse" if self.hertzian else "strips"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem of ellipses or strips."""
        return (Axle() if self.hertzian else Cut()).problem(**conditions)


class Placed(Worn):
    """The axle with patches of either shape and their places on the profiles; y is to the right, arcs run outwards."""

    name: ClassVar[str] = "placed"
    flange_at: float = -30e-3
    """Position of the flange's patch along the profile of the wheel [m]."""

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with positions, of the rail 1 mm further out."""
        found = super().problem(**conditions)
        place = wl.Unit("mm", positive=False).si(conditions["displacement"], "displacement")[..., None, None]
        outwards = np.array([[-1.0], [1.0]])
        position = outwards * -0.5 * place + np.array([0.0, self.flange_at])
        bodies = {
            name: dataclasses.replace(body, profile_position=position + shift, profile_direction=outwards)
            for (name, body), shift in zip(found.bodies.items(), (0.0, 1e-3), strict=True)
        }
        return found.replaced(bodies=bodies)


STRIPS = 12
CUT: Any = Cut() | wl.contact_model("fastsim") | KTH
LOADS = Q(np.array([[[80.0, np.nan]] * 2] * 2 + [[[80.0, np.nan], [60.0, 20.0]]]), "kN")


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
        source: ClassVar[str] = "a test"

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


def test_what_warns_looks_at_patches_that_exist() -> None:
    with pytest.warns(wl.RangeWarning, match=r"the maximum pressure of 5228 MPa .* is beyond the shakedown limit"):
        PREDICT(**{**GIVEN, "load": "8000 kN"})


@pytest.mark.parametrize("exists", [np.array([1.0, 0.0]), np.array([True]), [True, False]])
def test_a_wrong_mask_is_the_rigs_fault(exists: Any) -> None:
    class Wrong(Axle):
        name: ClassVar[str] = "wrong"

        def problem(self, **conditions: Any) -> wl.Problem:
            return super().problem(**conditions).replaced(exists=exists)

    with pytest.raises(wl.ModelError, match=r"rig 'wrong' gave .* as `exists`; it must be an array of bool"):
        (Wrong() | wl.contact_model("fastsim"))(**GIVEN)


def test_applications_that_take_one_patch_say_so() -> None:
    with pytest.raises(
        wl.CompositionError, match=r"sweep: needs one patch .* 'axle' makes several, along side and patch"
    ):
        wl.sweep(PREDICT, **GIVEN)
    with pytest.raises(wl.CompositionError, match="uncertainty: needs one patch"):
        wl.uncertainty(PREDICT, **{**GIVEN, "load": wl.uniform("60 kN", "80 kN")}, samples=4).interval()
    creepages = {name: value for name, value in GIVEN.items() if name != "longitudinal_creepage"}
    with pytest.raises(wl.CompositionError, match="creepage_for: needs one patch"):
        wl.creepage_for(Axle() | wl.contact_model("fastsim"), tangential_force="1 kN", **creepages)


ANGLE = np.deg2rad(70.0)


class Flange(wl.Rig):
    """A flange at 70 degrees: what is given is the vertical load, N cos δ + Fy sin δ."""

    name: ClassVar[str] = "flange"
    source: ClassVar[str] = "a test"
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
    with pytest.raises(
        wl.CompositionError, match="rig 'flange' balances its loads, which depend on the unknown creepage"
    ):
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

    with pytest.raises(wl.ModelError, match=r"`balanced` of rig 'forgetful' returned None, not a wearlaw.Problem"):
        (Forgetful() | wl.contact_model("fastsim"))(vertical_load="20 kN", **CREEP)


@pytest.mark.parametrize("factor", [0.1, 3.0])
def test_another_normal_force_gives_the_patch_of_hertz(factor: float) -> None:
    discs: Any = {"creepage": "1 %", "friction_coefficient": 0.4}
    for rig, given in ((wl.TwinDisc.suros(), discs), (WHEEL, CREEP)):
        one, other = (rig.problem(normal_force=Q(7.0 * f, "kN"), **given) for f in (1.0, factor))
        loaded = one.with_normal_force(factor * one.normal_force)
        for name in ("a", "b", "normal_force", "max_pressure"):
            assert getattr(loaded, name) == pytest.approx(getattr(other, name), rel=16 * EPS)


@pytest.mark.parametrize("dims", [("side", "patch"), {"side": ("left",), "patch": (1, 2)}, {"patch": 2}])
def test_labels_of_axes_must_fit_the_batch(dims: Any) -> None:
    class Mislabelled(Axle):
        name: ClassVar[str] = "mislabelled"

        def problem(self, **conditions: Any) -> wl.Problem:
            return super().problem(**conditions).replaced(dims=dims)

    predict = Mislabelled() | wl.contact_model("fastsim")
    with pytest.raises(wl.ModelError, match=r"rig 'mislabelled' gave .* a batch of shape \(3, 2, 2\).*with a label"):
        predict(**GIVEN)


@pytest.mark.parametrize("hertzian", [True, False])
def test_friction_may_differ_by_patch(hertzian: bool) -> None:
    dry, greased = 0.3, 0.08

    class Lubricated(Worn):
        """The axle with a lubricated flange."""

        name: ClassVar[str] = "lubricated"

        def problem(self, **conditions: Any) -> wl.Problem:
            found = super().problem(**conditions)
            friction = np.broadcast_to(np.array([dry, greased]), found.batch_shape)
            return found.replaced(friction_coefficient=friction)

    rig = Lubricated(hertzian=hertzian)
    predict: Any = rig | wl.contact_model("fastsim") | KTH
    found = predict(**GIVEN)
    np.testing.assert_array_equal(of(found, "friction_coefficient"), np.where(EXISTS, [dry, greased], np.nan))
    for patch, friction in enumerate((dry, greased)):
        alike: Any = Worn(hertzian=hertzian) | wl.contact_model("fastsim") | KTH
        of_one = alike(**{**GIVEN, "friction_coefficient": friction})
        for name in ("wear_rate", "longitudinal_force", "spin_moment", "mean_slip", "wear_index", "first_yield"):
            np.testing.assert_allclose(
                of(found, name)[..., patch], of(of_one, name)[..., patch], rtol=64 * EPS, err_msg=name
            )
    ratio = of(found, "traction_coefficient")
    assert (ratio[EXISTS] <= np.broadcast_to([dry, greased], EXISTS.shape)[EXISTS] * (1.0 + 64 * EPS)).all()
    staged: Any = rig | wl.contact_model("fastsim") | wl.stage("third_body", reduction=0.5) | KTH
    halved = staged(**GIVEN).friction_coefficient.magnitude
    np.testing.assert_array_equal(halved, of(found, "friction_coefficient"))  # a third body changes the slope alone


# --- Some of the patches ---------------------------------------------------------------------------------------------


EVERY = (
    "wear_rate", "wear_rate_error", "longitudinal_force", "lateral_force", "spin_moment", "tangential_force",
    "traction_coefficient", "wear_index", "cell_wear_index", "averaged_wear_index", "wear_index_density",
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


def of(prediction: wl.Prediction, name: str) -> Array:
    """Return a property as an array in SI."""
    return np.asarray(getattr(prediction, name).to_base_units().magnitude)


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


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"sid": "left"}, r"sel: no labels for an axis 'sid'.* did you mean 'side'\? Axes with labels: side"
         r" \('left', 'right'\) and patch \(1, 2\)"),
        ({"point_0": 0}, r"sel: no labels for an axis 'point_0'; 'point_0' has none, so use isel\(point_0=...\)"),
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
        ({"point_0": 3}, "isel: axis 'point_0' has 3 entries, 0 to 2; there is no entry 3"),
        ({"point_0": [0, -4]}, "isel: axis 'point_0' has 3 entries, 0 to 2; there is no entry -4"),
        ({"side": "left"}, "isel: side must be an integer, a list of integers or a slice, got 'left'"),
        ({"side": [True, False]}, "isel: side must be an integer"),
    ],
)  # fmt: skip
def test_a_wrong_position_is_named_with_those_there_are(chosen: Any, said: str) -> None:
    with pytest.raises(wl.InputError, match=said):
        PREDICT(**GIVEN).isel(**chosen)


def test_one_operating_point_has_no_axes_to_select_from() -> None:
    with pytest.raises(wl.InputError, match=r"isel: no axis 'point_0'.* none at one operating point"):
        ALONE(normal_force="80 kN", **CREEP).isel(point_0=0)


# --- A field that chooses the shape ----------------------------------------------------------------------------------


def test_a_rig_may_choose_its_geometry_by_a_field() -> None:
    ellipse = (Worn() | wl.contact_model("polach"))(**GIVEN)
    assert ellipse.problem.geometry == "ellipse"
    strips: Any = Worn(hertzian=False) | wl.contact_model("fastsim") | KTH
    np.testing.assert_array_equal(of(strips(**GIVEN), "wear_rate"), of(CUT(**GIVEN), "wear_rate"))
    with pytest.raises(
        wl.CompositionError,
        match="contact model 'polach' solves elliptic contacts only, but a Worn makes patches of strips;"
        r" those that solve them: .*fastsim",
    ):
        Worn(hertzian=False) | wl.contact_model("polach")
    with pytest.raises(wl.InputError, match=r"problem: has the geometry 'ellipse', but a Worn makes .*'strips'"):
        strips.predict(ellipse.problem)


# --- Along the profile -----------------------------------------------------------------------------------------------

ARC = np.linspace(-60.0, 30.0, 271)
OUTWARDS = np.array([-1.0, 1.0])
SHAPES = pytest.mark.parametrize("hertzian", [True, False])


def placed(hertzian: bool = True, **fields: Any) -> wl.Prediction:
    """Return the prediction for patches whose places are known."""
    predict: Any = Placed(hertzian=hertzian, **fields) | wl.contact_model("fastsim") | KTH
    return predict(**GIVEN)  # type: ignore[no-any-return]


@SHAPES
def test_a_wear_profile_knows_the_place_on_the_profile(hertzian: bool) -> None:
    found = placed(hertzian)
    wheel, rail = found.wear_profile("wheel"), found.wear_profile("rail")
    middle = OUTWARDS[:, None] * -0.5 * np.array([0.0, 5.0, 7.0])[:, None, None] + np.array([0.0, -30.0])
    expected = np.where(EXISTS, middle, np.nan)[..., None] + OUTWARDS[:, None, None] * wheel.y.values
    np.testing.assert_allclose(wheel.profile_position.values, expected, rtol=0.0, atol=100.0 * EPS)
    np.testing.assert_allclose(rail.profile_position.values, expected + 1.0, rtol=0.0, atol=100.0 * EPS)
    assert wheel.profile_position.dims == wheel.depth.dims
    assert wheel.profile_position.attrs == {"units": "mm", "long_name": "position along the profile"}
    assert (np.isnan(wheel.profile_position.values).all(axis=-1) == ~EXISTS).all()
    one = found.sel(side="left", patch=1).isel(point_0=2).wear_profile("wheel")
    assert one.profile_position.dims == ("y",)
    np.testing.assert_array_equal(one.profile_position.values, wheel.profile_position.values[2, 0, 0])
    assert "profile_position" not in PREDICT(**GIVEN).wear_profile("wheel").coords


@SHAPES
@pytest.mark.parametrize("flange_at", [-30e-3, -4e-3])  # apart, and overlapping
def test_the_depth_over_a_profile_is_the_mass_lost_by_its_patches(hertzian: bool, flange_at: float) -> None:
    found = placed(hertzian, flange_at=flange_at)
    profile = found.wear_profile("wheel", at=Q(ARC, "mm"))
    assert profile.depth.dims == ("point_0", "side", "profile_position")
    assert profile.side.values.tolist() == ["left", "right"]
    assert profile.profile_position.attrs == {"units": "mm", "long_name": "position along the profile"}
    np.testing.assert_allclose(profile.profile_position.values, ARC, rtol=4 * EPS)
    radius = RADIUS + CONICITY * OUTWARDS * np.array([0.0, 5e-3, 7e-3])[:, None]
    section = np.trapezoid(1e-9 * profile.depth.values, 1e-3 * ARC, axis=-1)
    expected = np.nansum(of(found, "mass_per_distance"), axis=-1)
    # Each sum rounds once for each of its strips or positions.
    np.testing.assert_allclose(section * 7850.0 * 2.0 * np.pi * radius, expected, rtol=1e3 * EPS)
    rail = np.trapezoid(1e-9 * found.wear_profile("rail", at=Q(ARC, "mm")).depth.values, 1e-3 * ARC, axis=-1)
    np.testing.assert_allclose(rail * 7850.0, expected, rtol=1e3 * EPS)


@SHAPES
def test_the_depth_over_a_profile_is_that_of_the_strips(hertzian: bool) -> None:
    found, fine = placed(hertzian), np.linspace(-45.0, 15.0, 6001)
    over, strips = found.wear_profile("wheel", at=Q(fine, "mm")), found.wear_profile("wheel")
    for place in zip(*np.nonzero(EXISTS), strict=True):
        alone = found.isel(point_0=int(place[0]), side=int(place[1]), patch=[int(place[2])])
        of_one = alone.wear_profile("wheel", at=Q(fine, "mm"))
        at, width = strips.profile_position.values[place], 1e3 * found.contact.strip_width[place]
        for name in ("depth", "sliding_distance"):
            own, lost = of_one[name].values, strips[name].values[place] * width
            # What a strip loses lies between its edges, and a position stands for its cell.
            away = abs((fine * own).sum() / own.sum() - (at * lost).sum() / lost.sum())
            assert away < 0.5 * width.max() + (fine[1] - fine[0]), name
    np.testing.assert_array_equal(over.depth.values[0][:, (fine < -9.0)], 0.0)
    right = found.sel(side="right").isel(point_0=2)
    np.testing.assert_array_equal(right.wear_profile("wheel", at=Q(fine, "mm")).depth.values, over.depth.values[2, 1])


def test_on_the_left_the_profile_runs_against_y() -> None:
    given = {**GIVEN, "displacement": "0 mm"}
    predict: Any = Placed() | wl.contact_model("fastsim") | KTH
    depth = predict(**given).wear_profile("wheel", at=Q(np.linspace(-10.0, 10.0, 81), "mm")).depth.values
    assert not np.allclose(depth[1], depth[1][::-1], rtol=0.1)  # spin wears one side more
    np.testing.assert_allclose(depth[0], depth[1][::-1], rtol=1e3 * EPS, atol=1e3 * EPS * depth.max())


def test_the_parts_of_the_depth_add_up_too() -> None:
    angles = np.deg2rad([[3.0, 70.0]] * 2)

    class Angled(Placed):
        name: ClassVar[str] = "angled"

        def problem(self, **conditions: Any) -> wl.Problem:
            found = super().problem(**conditions)
            return found.replaced(contact_angle=np.broadcast_to(angles, found.batch_shape))

    predict: Any = Angled(flange_at=-3e-3) | wl.contact_model("fastsim") | KTH
    found = predict(**GIVEN).sel(side="right").isel(point_0=2)
    over = found.wear_profile("wheel", at=Q(ARC, "mm"))
    each = [found.sel(patch=[one]).wear_profile("wheel", at=Q(ARC, "mm")) for one in (1, 2)]
    for name in ("depth", "depth_vertical", "depth_lateral", "sliding_distance"):
        np.testing.assert_allclose(over[name].values, each[0][name].values + each[1][name].values, rtol=4 * EPS)
    rounding = 1e3 * EPS * float(each[1].depth.max())  # of the loss up to a position, of which depths are differences
    np.testing.assert_allclose(each[1].depth_lateral, each[1].depth * np.sin(angles[0, 1]), rtol=0.0, atol=rounding)


def test_a_profile_without_a_patch_loses_nothing() -> None:
    missing = placed().sel(side="left", patch=2)
    assert (missing.wear_profile("wheel", at=Q(ARC, "mm")).depth.values == 0.0).all()
    assert np.isnan(missing.wear_profile("wheel").profile_position.values).all()


@pytest.mark.parametrize("at", [Q([1.0], "mm"), Q([1.0, 1.0], "mm"), Q([2.0, 1.0], "mm"), Q([[0.0, 1.0]], "mm")])
def test_positions_must_increase(at: Any) -> None:
    with pytest.raises(wl.InputError, match="at: must be two or more increasing positions"):
        placed().wear_profile("wheel", at=at)


def test_positions_need_a_rig_that_knows_where_its_patches_lie() -> None:
    with pytest.raises(wl.InputError, match="at: the rig does not say where its patches lie on the profile"):
        PREDICT(**GIVEN).wear_profile("wheel", at=Q(ARC, "mm"))
    with pytest.raises(wl.UnitError, match="at: got the bare number"):
        placed().wear_profile("wheel", at=3.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("position", np.zeros(3), r"float64 of shape \(3,\) as `profile_position` of wheel; it must be a number or an"),
        ("position", "here", "as `profile_position` of wheel; it must be a number or an array"),
        ("direction", np.ones(3), "as `profile_direction` of wheel; it must be a number or an array"),
        ("direction", 0.5, "a `profile_direction` of wheel that is neither 1 nor -1"),
    ],
)
def test_a_wrong_place_on_a_profile_is_the_rigs_fault(field: str, value: Any, said: str) -> None:
    class Lost(Placed):
        name: ClassVar[str] = "lost"

        def problem(self, **conditions: Any) -> wl.Problem:
            found = super().problem(**conditions)
            changes: Any = {f"profile_{field}": value}
            return found.replaced(bodies={"wheel": dataclasses.replace(found.bodies["wheel"], **changes)})

    with pytest.raises(wl.ModelError, match=f"rig 'lost' gave .*{said}"):
        (Lost() | wl.contact_model("fastsim"))(**GIVEN)
