"""Rigs whose bodies touch in several places, and rigs that balance their loads around the contact."""

from __future__ import annotations

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
    def geometry(self) -> wl.Geometry:
        """The shape that the field chooses."""
        return "ellipse" if self.hertzian else "strips"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem of ellipses or strips."""
        return (Axle() if self.hertzian else Cut()).problem(**conditions)


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
