"""Patches of strips: creepages and places of each strip, and strips that fill up a batch."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.core import axles
from tests.strategies import EPS
from wearlaw import Array, Q
from wearlaw_apps.output.pictures import fields_of, raster  # private: pictures before they are drawn

POINTS, STRIPS = 5, 12
STRIP_THEORY, HALF_SPACE = wl.contact_model("strip_theory"), wl.contact_model("half_space", cells=16)
FASTSIM = wl.contact_model("fastsim")


def with_models(*models: wl.ContactModel) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("model", models, ids=lambda model: model.name)


def patches(slant: float = 0.0) -> wl.Problem:
    """Return patches in partial slip, with spin; the middles of their strips lie at x = `slant` × y."""
    random = np.random.default_rng(11)
    shares = (2.0 * np.arange(STRIPS) + 1.0) / STRIPS - 1.0
    root, ones = np.sqrt(1.0 - shares**2), np.ones(POINTS)
    a, b, p0 = (random.uniform(low, 3.0 * low, POINTS) for low in (2e-3, 2e-3, 0.5e9))
    y = np.outer(b, shares)
    strips = wl.Strips(
        y=y, width=np.outer(b, np.full(STRIPS, 2.0 / STRIPS)), half_length=np.outer(a, root),
        max_pressure=np.outer(p0, root), x=slant * y,
    )  # fmt: skip
    xi, eta, phi = (random.uniform(-size, size, POINTS) for size in (2e-3, 2e-3, 0.5))
    return wl.Problem.of_strips(
        strips, a=a, b=b, shear_modulus=82e9 * ones, poisson_ratio=0.28 * ones, friction_coefficient=0.3 * ones,
        longitudinal_creepage=xi, lateral_creepage=eta, spin=phi, rolling_speed=30.0 * ones, density=7850.0 * ones,
    )  # fmt: skip


def creeping(problem: wl.Problem, creepages: Any) -> wl.Problem:
    """Return the problem with creepages for each strip."""
    assert problem.strips is not None
    names = ("longitudinal_creepage", "lateral_creepage", "spin")
    return problem.replaced(strips=dataclasses.replace(problem.strips, **dict(zip(names, creepages, strict=True))))


def scattered(problem: wl.Problem, size: float) -> list[Array]:
    """Return creepages and spins that have nothing to do with each other."""
    assert problem.strips is not None
    random = np.random.default_rng(12)
    return [size * random.uniform(-1.0, 1.0, problem.strips.y.shape) for size in (size, size, size / 4e-3)]


@pytest.mark.validates(
    "elliptic-contact",
    "`strip_theory` on strips with creepages and places of their own: traction and energy of each strip",
    source="the same strip in a patch that creeps as it does all over",
    held_to="{within:g}",
    within=1e-12,
)
def test_each_strip_slips_by_its_creepages(within: float) -> None:
    problem = patches(slant=0.2)[:1]
    strips, creepages = problem.strips, scattered(problem, 2e-3)
    assert strips is not None
    contact = STRIP_THEORY.solve(creeping(problem, creepages))
    # In the patch as a whole the slip is (ξ - φy, η - φx): the strip i then has those of its middle.
    along, across, spin = (creepage[0] for creepage in creepages)
    all_over = problem[np.zeros(STRIPS, int)].with_creepages(
        along + spin * strips.y[0], across + spin * strips.x[0], spin
    )
    alone, strip = STRIP_THEORY.solve(all_over), np.arange(STRIPS)
    for name in ("traction_x", "traction_y", "x"):
        due = getattr(alone, name)[strip, :, strip].T
        assert getattr(contact, name)[0] == pytest.approx(due, abs=within * np.abs(due).max()), name
    forces, moments = (
        [],
        contact.integral(contact.x, contact.traction_y) + contact.integral(contact.y, contact.traction_x),
    )
    for traction in (contact.traction_x, contact.traction_y):
        forces.append(contact.over_strip(traction) * contact.strip_width)
    turned = contact.over_strip((contact.x - strips.x[:, None]) * contact.traction_y) * contact.strip_width
    power = (creepages[0] * forces[0] + creepages[1] * forces[1] - creepages[2] * turned).sum()
    assert contact.wear_index == pytest.approx(power, rel=within)
    assert contact.cell_wear_index == pytest.approx(power, rel=within)
    assert contact.moment_z == pytest.approx(-moments, rel=within)
    alone_forces = STRIP_THEORY.creep_forces(creeping(problem, creepages))
    assert alone_forces.power == pytest.approx(power, rel=within)


@with_models(STRIP_THEORY, HALF_SPACE)
def test_in_full_slip_each_strip_pulls_along_its_creepage(model: wl.ContactModel) -> None:
    problem = patches(slant=0.2)
    along, across, _ = scattered(problem, 1.0)
    contact = model.solve(creeping(problem, (along, across, np.zeros_like(along))))
    strips = problem.strips
    assert strips is not None
    size = np.hypot(along, across)
    bound = 0.3 * strips.normal_force / size
    # Full slip takes up some 0.5 % of the rolled way, and the creepages are 10 % and more. The load on elements of
    # half-spaces is that of the strips within some percent, strip by strip.
    within: Any = {"abs": 0.05 * 0.3 * problem.normal_force.max()} if model is HALF_SPACE else {"rel": 0.01}
    assert contact.force_x == pytest.approx((bound * along).sum(axis=-1), **within)
    assert contact.force_y == pytest.approx((bound * across).sum(axis=-1), **within)
    assert contact.wear_index == pytest.approx(
        (bound * size**2).sum(axis=-1), rel=0.05 if model is HALF_SPACE else 0.001
    )
    assert contact.cell_wear_index == pytest.approx(contact.wear_index, rel=1e-9)


@with_models(STRIP_THEORY, HALF_SPACE)
def test_a_patch_further_along_has_the_same_forces(model: wl.ContactModel) -> None:
    # By c, in the same field of slip: η - φ (x - c) needs η + φc at x = 0. The flexibility for spin of FASTSIM differs
    # from that for η, so that its patches need their origin in the middle.
    problem, c = patches(), 0.7e-3
    assert problem.strips is not None
    across, spin = problem.lateral_creepage, problem.spin
    strips = dataclasses.replace(problem.strips, x=np.full(problem.strips.y.shape, c))
    moved, here = model.solve(problem.replaced(strips=strips, lateral_creepage=across + spin * c)), model.solve(problem)
    assert moved.x == pytest.approx(here.x + c, abs=1e-12)
    for name in ("force_x", "force_y", "wear_index", "cell_wear_index"):
        assert getattr(moved, name) == pytest.approx(getattr(here, name), rel=1e-8), name
    size = 0.3 * problem.normal_force.max() * c
    assert moved.moment_z == pytest.approx(here.moment_z - c * here.force_y, abs=1e-8 * size)


def test_the_rigid_slip_is_that_of_the_strips() -> None:
    problem = patches(slant=0.3)
    assert problem.strips is not None
    strips, (along, across, spin) = problem.strips, scattered(problem, 2e-3)
    x = strips.half_length[..., None] * ((2.0 * np.arange(2000) + 1.0) / 2000 - 1.0)  # from the middles of strips
    square = along**2 + ((across[..., None] - spin[..., None] * x) ** 2).mean(axis=-1)
    due = np.sqrt((square * strips.area).sum(axis=-1) / strips.area.sum(axis=-1))
    slip = creeping(problem, (along, across, spin)).rigid_slip
    assert slip == pytest.approx(due, rel=1e-6)  # the midpoint rule is off by 1/2000² of a parabola
    still = creeping(problem, (along, across, spin)).with_creepages(along[:, 0], across[:, 0], spin[:, 0])
    assert still.strips is not None
    assert not still.strips.has_creepages


class Filled(axles.Placed):
    """The patches of strips with some that fill up the batch."""

    name: ClassVar[str] = "filled"
    hertzian: bool = False
    """They are strips."""
    place: float = 2e-3
    """Where they lie [m]; it must not matter."""

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with three more strips, without width, length and pressure."""
        posed = super().problem(**conditions)
        assert posed.strips is not None
        strips = posed.strips.mapped(np.asarray, lambda of: np.concatenate([of, 0.0 * of[..., :3]], axis=-1))
        return posed.replaced(strips=dataclasses.replace(strips, y=np.where(strips.width > 0.0, strips.y, self.place)))


class Creeping(Filled):
    """The same with creepages for each strip, which are those of the problem."""

    name: ClassVar[str] = "creeping"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Return the problem with all arrays of its strips."""
        posed = super().problem(**conditions)
        return creeping(posed, posed.creepages_of_strips)


@with_models(STRIP_THEORY, FASTSIM, HALF_SPACE)
@pytest.mark.parametrize("rig", [Filled(), Filled(place=0.1), Creeping()], ids=["among", "beside", "creeping"])
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_strips_that_fill_up_a_batch_change_no_result(model: wl.ContactModel, rig: wl.Rig) -> None:
    here, there = ((of | model | axles.KTH)(**axles.GIVEN) for of in (axles.Placed(hertzian=False), rig))

    def assert_same(data: Any, due: Any, strips: int | None) -> None:
        for name, values in due.data_vars.items():
            if values.dtype.kind == "f":
                # A sum of as many terms as there are nodes, in another order.
                allowed = 1e4 * EPS * np.nanmax(np.abs(values.values))
                np.testing.assert_allclose(data[name].values[..., :strips], values.values, 1e-9, allowed, err_msg=name)

    assert_same(there.to_dataset(), here.to_dataset(), None)
    for name in ("wear_index", "cell_wear_index", "stick_ratio", "mean_slip"):
        np.testing.assert_allclose(axles.of(there, name), axles.of(here, name), rtol=1e-9, err_msg=name)
    profile, due = there.wear_profile("wheel"), here.wear_profile("wheel")
    assert_same(profile, due, axles.STRIPS)
    for name in ("y", "depth", "sliding_distance"):
        assert np.isnan(profile[name].values[..., axles.STRIPS :]).all(), name
    along = Q(np.linspace(-60.0, 30.0, 181), "mm")
    assert_same(there.wear_profile("wheel", at=along), here.wear_profile("wheel", at=along), None)


def test_pictures_and_temperatures_do_not_show_strips_that_fill_up_a_batch() -> None:
    thermal: Any = wl.stage("thermal", hot_ratio=0.6, temperature_range="1000 K")
    drawn, hot = [], []
    for rig in (axles.Placed(hertzian=False), Filled(), Filled(place=0.1)):
        pipeline = rig | STRIP_THEORY | thermal
        patch = pipeline(**{**axles.GIVEN, "displacement": "7 mm"}).sel(side="right", patch=1)
        drawn.append(raster(patch, fields_of(patch)["pressure"].values))
        hot.append(thermal.flash_temperature(patch.contact).magnitude)
    for other in drawn[1:]:
        for values, due in zip(other, drawn[0], strict=True):
            np.testing.assert_allclose(values, due, rtol=1e-9)
    np.testing.assert_allclose(hot, hot[0], rtol=1e-9)


def test_a_picture_shows_strips_where_they_lie() -> None:
    class Slanting(Filled):
        name: ClassVar[str] = "slanting"

        def problem(self, **conditions: Any) -> wl.Problem:
            posed = super().problem(**conditions)
            assert posed.strips is not None
            return posed.replaced(strips=dataclasses.replace(posed.strips, x=0.5 * posed.strips.y))

    patch = (Slanting() | STRIP_THEORY)(**{**axles.GIVEN, "displacement": "0 mm"}).sel(side="right", patch=1)
    x, y, inside = raster(patch, fields_of(patch)["pressure"].values)
    widest = np.isfinite(inside)
    middles = np.array([x[row].mean() for row in widest])
    assert middles == pytest.approx(0.5 * y, abs=x[1] - x[0])
