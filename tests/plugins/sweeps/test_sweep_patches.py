"""Sweeps of rigs with several patches: in memory, on disk, on several processes, in tables, with balanced loads."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.core.axles import CREEP, GIVEN, KTH, Axle, Warns, Worn, lifted, of
from tests.plugins.sweeps.sweeps import told
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import ModelError

pytestmark = pytest.mark.usefixtures("small_blocks")

FASTSIM = wl.contact_model("fastsim")
PLACES = np.array([-7.0, 0.0, 5.0, 6.5, 8.0])
FRICTION = np.linspace(0.1, 0.5, 4)
AXES: Any = {
    "load": Q([60.0, 90.0], "kN"),
    "displacement": Q(PLACES, "mm"),
    **CREEP,
    "friction_coefficient": FRICTION,
}
"""40 operating points."""
OUTPUTS = ["wear_rate", "lateral_force", "max_pressure", "mean_slip"]
DIMS = ("load", "displacement", "friction_coefficient", "side", "patch")


def pipeline(hertzian: bool = True) -> Any:
    return Worn(hertzian=hertzian) | FASTSIM | KTH


def at_once(predict: Any) -> wl.Prediction:
    """Return one prediction at all points of `AXES`."""
    load, place, friction = np.meshgrid([60.0, 90.0], PLACES, FRICTION, indexing="ij")
    given = {**CREEP, "load": Q(load, "kN"), "displacement": Q(place, "mm"), "friction_coefficient": friction}
    return predict(**given)  # type: ignore[no-any-return]


@pytest.mark.parametrize("hertzian", [True, False])
def test_a_sweep_has_the_axes_of_the_patches_after_its_own(hertzian: bool) -> None:
    predict = pipeline(hertzian)
    swept, found = wl.sweep(predict, **AXES, outputs=OUTPUTS), at_once(predict)
    assert swept.sizes == {"load": 2, "displacement": 5, "friction_coefficient": 4, "side": 2, "patch": 2}
    assert swept.side.values.tolist() == ["left", "right"]
    assert swept.patch.values.tolist() == [1, 2]
    for name in OUTPUTS:
        assert swept[name].dims == DIMS
        expected = found[name].to(swept[name].attrs["units"]).magnitude
        np.testing.assert_allclose(swept[name].values, expected, rtol=64 * EPS, err_msg=name)
        assert (np.isnan(swept[name].values) == ~np.asarray(found.problem.exists)).all()
    flange = swept.wear_rate.sel(side="right", patch=2)
    assert (np.isfinite(flange).values == (PLACES > 6.0)[:, None]).all()


@pytest.mark.parametrize("workers", [1, 2])
def test_progress_counts_operating_points(workers: int, monkeypatch: pytest.MonkeyPatch) -> None:
    points = told(monkeypatch)
    wl.sweep(pipeline(), **AXES, workers=workers)
    assert sum(points) == 40
    assert len([some for some in points if some]) > 5


class Lifting(Axle):
    """An axle that touches nowhere beyond 10 mm."""

    name: ClassVar[str] = "lifting"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem, with patches that exist up to 10 mm."""
        found = super().problem(**conditions)
        near = np.abs(lifted("mm", conditions["displacement"], "displacement")) <= 10e-3
        return found.replaced(exists=np.logical_and(found.exists, near))  # type: ignore[arg-type]


@pytest.mark.parametrize("stored", [True, False])
def test_blocks_without_any_patch_are_nan(stored: bool, tmp_path: Path) -> None:
    places = np.linspace(-30.0, 30.0, 61)
    store = tmp_path / "map.zarr" if stored else None
    swept = wl.sweep(Lifting() | FASTSIM | KTH, **{**GIVEN, "displacement": Q(places, "mm")}, store=store)
    assert (np.isfinite(swept.wear_rate.values[:, :, 0]) == (np.abs(places) <= 10.0)[:, None]).all()
    assert swept.wear_rate.dims == ("displacement", "side", "patch")
    if store is not None:  # zarr reads missing chunks as NaN too
        wl.sweep(Lifting() | FASTSIM | KTH, **{**GIVEN, "displacement": Q(places, "mm")}, store=store, resume=True)


def test_bodies_that_touch_nowhere_are_named() -> None:
    given = {**GIVEN, "displacement": Q([20.0, 30.0], "mm")}
    for call in (Lifting() | FASTSIM | KTH, lambda **given: wl.sweep(Lifting() | FASTSIM | KTH, **given)):
        with pytest.raises(wl.ConditionsError, match="rig 'lifting': the bodies touch nowhere"):
            call(**given)


class Rocking(Axle):
    """An axle whose lateral forces move load between the patches of a wheel, until the flange lifts off."""

    name: ClassVar[str] = "rocking"
    back: ClassVar[Any] = None
    """What `balanced` returns instead."""

    def balanced(self, problem: wl.Problem, forces: Callable[[wl.Problem], wl.CreepForces]) -> wl.Problem:
        """Return the problem with the lateral force of the tread taken from the load of the flange."""
        if self.back is not None:
            return type(self).back(problem)  # type: ignore[no-any-return]
        assert problem.exists is not None
        lateral = np.nan_to_num(forces(problem).lateral)
        load = problem.normal_force - np.stack([np.zeros_like(lateral[..., 0]), 4.0 * lateral[..., 0]], axis=-1)
        there = problem.exists & (np.nan_to_num(load) > 0.0)
        loaded = problem.with_normal_force(np.where(there, load, 1.0))
        return loaded.replaced(exists=there)


def test_a_rig_balances_block_by_block_and_patches_may_lift_off() -> None:
    predict: Any = Rocking() | FASTSIM | KTH
    swept, found = wl.sweep(predict, **AXES, outputs=["wear_rate", "normal_force"]), at_once(predict)
    unbalanced = at_once(Axle() | FASTSIM | KTH)
    there, before = (np.isfinite(of(one, "normal_force")) for one in (found, unbalanced))
    assert (there <= before).all()
    assert 0 < there[..., 1, 1].sum() < before[..., 1, 1].sum()
    assert (np.isfinite(of(found, "max_pressure")) == there).all()
    for name in ("wear_rate", "normal_force"):
        expected = found[name].to(swept[name].attrs["units"]).magnitude
        np.testing.assert_allclose(swept[name].values, expected, rtol=64 * EPS, err_msg=name)
    tread, of_axle = of(found, "lateral_force")[..., 0], of(unbalanced, "lateral_force")[..., 0]
    np.testing.assert_allclose(tread, of_axle, rtol=64 * EPS)
    lost = of(unbalanced, "normal_force")[..., 1] - of(found, "normal_force")[..., 1]
    kept = np.isfinite(lost)
    np.testing.assert_allclose(lost[kept], 4.0 * tread[kept], rtol=1e3 * EPS)


class Forgetful(Axle):
    """An axle whose rig forgets the axes of its patches in some of the conditions."""

    name: ClassVar[str] = "forgetful"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem of the first points only."""
        found = super().problem(**conditions)
        return found[:2] if found.batch_shape[0] > 2 else found


def test_a_batch_of_another_shape_is_the_rigs_fault() -> None:
    axes = {**GIVEN, "displacement": Q([0.0, 7.0], "mm"), "friction_coefficient": [0.2, 0.3]}
    with pytest.raises(
        ModelError,
        match=r"rig 'forgetful' gave a batch of shape \(2, 2, 2\) .* for 4 operating points",
    ):
        wl.sweep(Forgetful() | FASTSIM | KTH, **axes)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_sweep_repeats_the_first_warning_of_its_rig(workers: int, tmp_path: Path) -> None:
    predict: Any = Warns() | wl.contact_model("fastsim") | KTH
    given: Any = {**CREEP, "load": "80 kN", "displacement": Q([0.0, 5.0, 7.0], "mm")}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = wl.sweep(predict, workers=workers, store=tmp_path / "map.zarr", **given)
    said = [str(one.message) for one in caught if "climbs" in str(one.message)]
    assert [text.count("the wheel climbs at 7 mm") for text in said] == [1]  # beside the notes of other models
    assert "the wheel climbs at 7 mm" in found.attrs["notes"]
