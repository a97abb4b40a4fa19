"""What contact models and wear laws return is checked when they run, and whatever they raise is named."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.kit.cells import Cells
from tests.plugins.kit.strips import Strips
from wearlaw import Array, Q
from wearlaw.errors import ModelError
from wearlaw.models.contact_model import QUADRATURE  # private: the bound of a quadrature
from wearlaw.numerics.solving import EVERY, Solver  # private: what the solver checks of each block

RIG = wl.TwinDisc.suros()
RAIL = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
ON_DISCS: dict[str, Any] = {"normal_force": "7 kN", "creepage": Q([1.0, 2.0], "%"), "friction_coefficient": 0.4}
ON_RAIL: dict[str, Any] = {
    "normal_force": "80 kN", "longitudinal_creepage": Q([0.2, 0.4], "%"), "spin": "0.1 1/m", "friction_coefficient": 0.3
}  # fmt: skip
EPS = float(np.finfo(np.float64).eps)

Change = Callable[[Any], Any]


class PerEnergy(wl.WearLaw):
    """Wear in proportion to what is dissipated."""

    name: ClassVar[str] = "per_energy"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return contact.wear_index_density


class ChangedCells(Cells):
    """The right contact on cells, changed."""

    name: ClassVar[str] = "changed"
    change: Any

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        changed: wl.Contact = self.change(super().solve_line(problem))
        return changed


class ChangedStrips(Strips):
    """The right contact on strips, changed."""

    name: ClassVar[str] = "changed"
    change: Any

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        changed: wl.Contact = self.change(super().solve_ellipse(problem))
        return changed


def replace(**functions: Change) -> Change:
    """Return a function that changes fields of a contact by functions of their values."""
    return lambda contact: dataclasses.replace(
        contact, **{name: function(getattr(contact, name).copy()) for name, function in functions.items()}
    )


def entry(value: float) -> Change:
    """Return what sets one entry of the second operating point."""

    def changed(array: Array) -> Array:
        array[1, 3] = value
        return array

    return changed


class Ramps(PerEnergy):
    """The same above a threshold."""

    name: ClassVar[str] = "ramps"

    def ramps(self, p: wl.Numbers) -> tuple[tuple[float, float], ...]:
        return ((1e5, 1.0),)


# --- A patch is as large as its nodes --------------------------------------------------------------------------------


def two_parts(contact: wl.Contact) -> wl.Contact:
    """Return a patch of two ellipses side by side, each with half of the pressure and all of the traction."""
    doubled = {
        name: np.concatenate([getattr(contact, name)] * 2, axis=-1)
        for name in (
            *("pressure", "traction", "slip", "traction_bound", "area", "x", "y"),
            *("traction_x", "traction_y", "slip_x", "slip_y", "strip_width"),
        )
    }
    doubled["pressure"] *= 0.5
    totals = {name: 2.0 * getattr(contact, name) for name in ("force_x", "force_y", "moment_z")}
    more = {name: 2.0 * getattr(contact, name) for name in ("tangential_force", "wear_index")}
    return contact.replaced(**doubled, **totals, **more)


@pytest.mark.parametrize("use_patch_mean", [False, True])
def test_the_mass_on_a_rail_is_that_of_all_parts_of_a_patch(use_patch_mean: bool) -> None:
    model = ChangedStrips(change=two_parts)
    contact = RAIL | model | wl.patch_mean() if use_patch_mean else RAIL | model
    found = (contact | PerEnergy())(**ON_RAIL)
    nodes = two_parts(Strips().solve_ellipse(RAIL.problem(**ON_RAIL)))
    seen = nodes.patch_mean() if use_patch_mean else nodes
    expected = (PerEnergy().checked_rate(seen) * seen.area).sum(axis=(-2, -1))
    assert found.mass_per_distance.m_as("kg/m") == pytest.approx(expected, rel=64 * EPS)
    assert found.mass_lost("2 km", "wheel").m_as("kg") == pytest.approx(2e3 * expected, rel=64 * EPS)
    assert found.patch_area.m_as("m^2") == pytest.approx(2.0 * found.problem.patch_area, rel=64 * EPS)
    assert contact(**ON_RAIL).patch_area.m_as("m^2") == pytest.approx(2.0 * found.problem.patch_area, rel=64 * EPS)
    density = found.wear_index.m_as("N") / found.patch_area.m_as("m^2")
    assert found.wear_index_density.m_as("N/m^2") == pytest.approx(density, rel=8 * EPS)
    assert 0.0 <= found.stick_ratio.magnitude.min() <= found.stick_ratio.magnitude.max() <= 1.0


# --- What a contact model returns ------------------------------------------------------------------------------------

BROKEN: dict[str, tuple[Change, str]] = {
    "nothing": (lambda _: None, "returned None, not a wearlaw."),
    "slip of another shape": (replace(slip=lambda s: s[..., :3]), r"gave a slip of shape \(.*\); it must be \(2, "),
    "flat pressure": (replace(pressure=np.ravel), r"gave a pressure of shape \(\d+,\); it must be \(2, nodes"),
    "total per node": (
        replace(tangential_force=lambda t: t[:, None]),
        r"gave a tangential force of shape \(2, 1\); it must be \(2,\)",
    ),
    "single precision": (
        replace(traction=lambda q: q.astype(np.float32)),
        "gave a traction of type float32; it must be a float64 array",
    ),
    "a list": (replace(slip=lambda s: s.tolist()), "gave a slip of type list"),
    "masked": (replace(slip=np.ma.array), "gave a slip of type MaskedArray"),
    "a pressure that is no number": (replace(pressure=entry(np.nan)), "gave a pressure that is not finite"),
    "an infinite slip": (replace(slip=entry(np.inf)), "gave a slip that is not finite"),
    "a traction that is no number": (replace(traction=entry(np.nan)), "gave a traction that is not finite"),
    "an infinite traction": (replace(traction=entry(np.inf)), "gave a traction that is not finite"),
    "an infinite traction at an infinite bound": (
        replace(traction=entry(np.inf), traction_bound=entry(np.inf)),
        "gave a traction that is not finite",
    ),
    "a bound that is no number": (replace(traction_bound=entry(np.nan)), "gave a traction bound that is not finite"),
    "a force that is no number": (
        replace(tangential_force=lambda force: np.nan * force),
        "gave a tangential force that is not finite",
    ),
    "a negative area": (replace(area=entry(-1e-8)), "gave a negative area"),
    "an infinite area": (replace(area=entry(np.inf)), "gave an area that is not finite"),
    "traction above its bound": (
        replace(traction=lambda q: 5.0 * q),
        r"gave a traction of .* MPa where its own bound is .* MPa",
    ),
    "a load that the pressures are not": (
        replace(pressure=lambda p: 1.1 * p),
        "gave a normal force of 7000 N, but its nodes sum to 7700 N",
    ),
}


@pytest.mark.parametrize("breach", BROKEN)
def test_a_broken_contact_on_a_line_is_named(breach: str) -> None:
    change, said = BROKEN[breach]
    predict = RIG | ChangedCells(change=change) | wl.wear_law("kth")
    with pytest.raises(ModelError, match=f"^contact model 'changed' {said}"):
        predict(**ON_DISCS)


@pytest.mark.parametrize("breach", BROKEN)
def test_a_broken_contact_on_an_ellipse_is_named(breach: str) -> None:
    change, said = BROKEN[breach]
    said = said.replace("7000", r"8\.000e\+04").replace("7700", r"8\.8\d\de\+04")
    predict = RAIL | ChangedStrips(change=change) | wl.wear_law("kth")
    with pytest.raises(ModelError, match=f"^contact model 'changed' {said}"):
        predict(**ON_RAIL)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (replace(force_x=lambda force: 1.2 * force), "gave a longitudinal force of "),
        (replace(force_y=lambda force: force + 3e3), "gave a lateral force of "),
        (replace(moment_z=lambda moment: moment + 100.0), r"gave a spin moment of .* N·m, but its nodes sum to .* N·m"),
        (replace(slip_x=entry(np.nan)), "gave a slip x that is not finite"),
        (replace(strip_width=lambda width: width[..., :3]), r"gave a strip width of shape \(2, 3\); it must be "),
    ],
)  # fmt: skip
def test_what_only_an_ellipse_has_is_checked_as_well(change: Change, said: str) -> None:
    with pytest.raises(ModelError, match=f"^contact model 'changed' {said}"):
        (RAIL | ChangedStrips(change=change) | PerEnergy())(**ON_RAIL)


def test_energy_on_a_line_is_what_is_fed_in() -> None:
    with pytest.raises(ModelError, match=r"gave a wear index of .* N, but its nodes sum to .* `accuracy`"):
        (RIG | ChangedCells(change=replace(slip=lambda s: 1.3 * s)) | PerEnergy())(**ON_DISCS)


def test_the_first_place_is_named() -> None:
    with pytest.raises(ModelError, match=r"first for node 3 at creepage 2\.000 % and maximum pressure 1457 MPa\n"):
        (RIG | ChangedCells(change=replace(slip=entry(np.nan))) | wl.wear_law("kth"))(**ON_DISCS)
    nodes = replace(slip=lambda s: np.where(np.arange(s.size).reshape(s.shape) == 35, np.nan, s))
    predict = RAIL | ChangedStrips(change=nodes) | wl.wear_law("kth")
    with pytest.raises(ModelError, match=r"first for node 1, 3 at longitudinal creepage 0\.2000 %"):
        predict(**{**ON_RAIL, "longitudinal_creepage": "0.2 %"})


class FarFromItsForce(wl.LineContactModel):
    """Carter's fields with five times the traction; closed forms and fields do not agree."""

    name: ClassVar[str] = "five_times"
    fault: str

    def slip_length(self, problem: wl.Problem) -> Array:
        length: Array = EXACT.slip_length(problem)
        return length[..., None] if self.fault == "shape of the slip length" else length

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields: wl.LineFields = EXACT.fields(problem, nodes)
        if self.fault == "traction and bound":
            fields = dataclasses.replace(
                fields, traction=5.0 * fields.traction, traction_bound=5.0 * fields.traction_bound
            )
        if self.fault == "traction":
            fields = dataclasses.replace(fields, traction=5.0 * fields.traction)
        if self.fault == "shape":
            fields = dataclasses.replace(fields, slip=fields.slip[..., :2])
        return fields

    def tangential_force_per_width(self, problem: wl.Problem) -> Array:
        force: Array = EXACT.tangential_force_per_width(problem)
        if self.fault == "no number":
            return force * np.nan
        return force[..., None] if self.fault == "shape of the force" else force

    def excess_dissipation(self, problem: wl.Problem, threshold: float | Array) -> Array | None:
        excess: Array | None = EXACT.excess_dissipation(problem, threshold)
        return excess[..., None] if self.fault == "shape of the excess" and excess is not None else excess


EXACT: Any = wl.contact_model("exact")
FAULTS = {
    "traction and bound": "gave a tangential force of 2800 N, but its nodes sum to 1\\.400e\\+04 N",
    "traction": "gave a traction of .* MPa where its own bound is",
    "shape": "failed: ValueError: ",
    "shape of the slip length": "failed: ValueError: |gave a",
    "shape of the force": r"gave a tangential force of shape \(2, 2\); it must be \(2,\)",
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_model_with_fields_in_closed_form_is_checked_on_the_nodes_of_a_law(fault: str) -> None:
    predict = RIG | FarFromItsForce(fault=fault) | wl.wear_law("kth")
    with pytest.raises(ModelError, match=re.compile(f"^contact model 'five_times' ({FAULTS[fault]})")):
        predict(**{**ON_DISCS, "creepage": Q([2.0, 4.0], "%")})


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ("shape of the force", "of shape .*; it must be "),
        ("shape of the excess", "of shape .*; it must be "),
        ("no number", "that is not finite"),
    ],
)
def test_wrong_closed_forms_are_refused(fault: str, said: str) -> None:
    predict = RIG | FarFromItsForce(fault=fault) | Ramps()
    for creepage in (Q([2.0, 4.0], "%"), Q(2.0, "%")):
        with pytest.raises(ModelError, match=f"^contact model 'five_times' gave an? .* {said}"):
            predict(**{**ON_DISCS, "creepage": creepage})


def test_profile_and_own_nodes_are_checked_too() -> None:
    contact = (RIG | FarFromItsForce(fault="traction"))(**ON_DISCS)
    for read in ("profile", "contact", "stick_ratio"):
        with pytest.raises(ModelError, match="where its own bound is"):
            getattr(contact, read)
    on_rail = (RAIL | ChangedStrips(change=replace(traction=lambda q: 5.0 * q)))(**ON_RAIL)
    for read in ("contact", "stick_ratio"):
        with pytest.raises(ModelError, match="where its own bound is"):
            getattr(on_rail, read)


def test_sums_are_compared_in_the_first_block_and_then_in_every_64th() -> None:
    solver = Solver(EXACT)
    summed = [number for number in range(200) if solver.block_is_summed()]
    assert summed == [0, 64, 128, 192]
    assert EVERY == 64


def test_models_of_few_cells_are_held_to_what_they_declare() -> None:
    class Undeclared(Cells):
        """Cells that claim the accuracy of quadrature."""

        name: ClassVar[str] = "undeclared"

        @property
        def accuracy(self) -> float:
            return QUADRATURE

    with pytest.raises(ModelError, match=r"'undeclared' gave a normal force .* twice its `accuracy`, 5e-08 "):
        (RIG | Undeclared(cells=20) | PerEnergy())(**ON_DISCS)
    assert (RIG | Cells(cells=20) | PerEnergy())(**ON_DISCS).wear_rate.magnitude.min() > 0.0


# --- What a law returns ----------------------------------------------------------------------------------------------


class Told(wl.WearLaw):
    """Returns what it is told to."""

    name: ClassVar[str] = "told"
    change: Any

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        rate: Array = self.change(contact.wear_index_density)
        return rate


RATES: dict[str, tuple[Change, str]] = {
    "a quantity": (lambda rate: Q(rate, "ug/m/mm^2"), "returned values of type ReadableQuantity"),
    "single precision": (lambda rate: rate.astype(np.float32), "returned values of type float32"),
    "another shape": (lambda rate: rate[..., :1], r"returned values of shape \(.*\); it must return one a node"),
    "no number": (lambda rate: rate * np.nan, "returned a value that is not finite"),
    "negative": (lambda rate: -rate, "gives a negative wear rate, -"),
    "wear in stick": (lambda rate: rate + 1.0, "gives values where the bodies stick"),
    "an error": (lambda _: 1 / 0, "failed: ZeroDivisionError: division by zero"),
    "an exit": (lambda _: exit(0), "failed: SystemExit: 0"),
}


@pytest.mark.parametrize("fault", RATES)
@pytest.mark.parametrize("predict", [RIG | EXACT, RIG | Cells(), RAIL | Strips()], ids=["fields", "cells", "strips"])
def test_a_law_that_fails_or_returns_no_rates_is_named(fault: str, predict: Any) -> None:
    change, said = RATES[fault]
    conditions = ON_RAIL if predict.rig is RAIL else ON_DISCS
    with pytest.raises(ModelError, match=f"^wear law 'told' {said}"):
        (predict | Told(change=change))(**conditions)


# --- What a model raises ---------------------------------------------------------------------------------------------


def failing(error: type[BaseException]) -> Change:
    def fail(_: Any) -> Any:
        raise error

    return fail


@pytest.mark.parametrize("error", [ZeroDivisionError, SystemExit])
def test_what_a_contact_model_raises_names_it(error: type[BaseException]) -> None:
    line, ellipse = ChangedCells(change=failing(error)), ChangedStrips(change=failing(error))
    works: list[Callable[[], object]] = [
        lambda: (RIG | line)(**ON_DISCS),
        lambda: (RIG | line | PerEnergy())(**ON_DISCS),
        lambda: (RAIL | ellipse)(**ON_RAIL),
        lambda: (RAIL | ellipse | PerEnergy())(**ON_RAIL),
    ]
    for work in works:
        with pytest.raises(ModelError, match=f"^contact model 'changed' failed: {error.__name__}\n") as caught:
            work()
        assert isinstance(caught.value.__cause__, error)


def test_an_interrupt_is_a_persons_and_passes() -> None:
    with pytest.raises(KeyboardInterrupt):
        (RIG | ChangedCells(change=failing(KeyboardInterrupt)) | PerEnergy())(**ON_DISCS)


def test_what_a_law_raises_from_its_declarations_names_it() -> None:
    class Undecided(PerEnergy):
        """Declares nothing but errors."""

        name: ClassVar[str] = "undecided"
        declaration: str

        def breakpoints(self, p: wl.Numbers) -> Any:
            self._raise("breakpoints")

        def ramps(self, p: wl.Numbers) -> Any:
            self._raise("ramps")

        @property
        def valid_range(self) -> Any:
            self._raise("valid_range")
            return {}

        def _raise(self, name: str) -> None:
            if self.declaration == name:
                raise KeyError(name)

    for name in ("breakpoints", "ramps", "valid_range"):
        with pytest.raises(ModelError, match=f"^wear law 'undecided' failed: KeyError: '{name}'\n"):
            (RIG | EXACT | Undecided(declaration=name))(**ON_DISCS)
