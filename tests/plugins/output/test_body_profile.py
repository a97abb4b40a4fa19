"""Depths over the profile of a body, on which several patches may lie."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.core.axles import CONICITY, EXISTS, GIVEN, KTH, PREDICT, RADIUS, Placed, of
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import ModelError

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
    ("field", "value"),
    [("position", np.zeros(3)), ("position", "here"), ("direction", np.ones(3)), ("direction", 0.5)],
)
def test_a_wrong_place_on_a_profile_is_the_rigs_fault(field: str, value: Any) -> None:
    class Lost(Placed):
        name: ClassVar[str] = "lost"

        def problem(self, **conditions: Any) -> wl.Problem:
            found = super().problem(**conditions)
            changes: Any = {f"profile_{field}": value}
            return found.replaced(bodies={"wheel": dataclasses.replace(found.bodies["wheel"], **changes)})

    with pytest.raises(ModelError, match=f"rig 'lost' .*`profile_{field}`.* of wheel"):
        (Lost() | wl.contact_model("fastsim"))(**GIVEN)
