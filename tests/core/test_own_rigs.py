"""Rigs of one's own, in a script."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import pytest
from numpy.typing import ArrayLike

import wearlaw as wl
from tests.core.stages import RAILS
from wearlaw import Q
from wearlaw.errors import ModelError

SUROS = wl.TwinDisc.suros()
MODEL = wl.contact_model("exact")
KTH = wl.wear_law("kth")


class Roller(wl.Rig):
    """A roller that a weight presses on another."""

    name: ClassVar[str] = "roller"

    def problem(
        self, *, mass: wl.QuantityLike, creepage: wl.QuantityLike, friction_coefficient: ArrayLike = 0.4
    ) -> wl.Problem:
        """Return the problem of a weight."""
        load = Q(wl.Unit("kg").si(mass, "mass") * 9.81, "N")
        return SUROS.problem(normal_force=load, creepage=creepage, friction_coefficient=friction_coefficient)


class Returning(wl.Rig):
    """A rig that returns or raises a given object."""

    name: ClassVar[str] = "returning"
    what: ClassVar[Any] = None

    def problem(self, *, creepage: wl.QuantityLike) -> Any:
        """Return it."""
        if isinstance(self.what, BaseException):
            raise self.what
        return self.what


class OnRail(wl.Rig):
    """A wheel under a weight."""

    name: ClassVar[str] = "on_rail"
    creepage: ClassVar[str] = "longitudinal_creepage"

    def problem(self, *, mass: wl.QuantityLike, longitudinal_creepage: wl.QuantityLike) -> wl.Problem:
        """Return the problem of a weight."""
        load = Q(wl.Unit("kg").si(mass, "mass") * 9.81, "N")
        return RAILS.problem(normal_force=load, longitudinal_creepage=longitudinal_creepage, friction_coefficient=0.3)


def test_parameters_fitted_for_another_shape_of_patch_give_a_warning_once_the_shape_is_known() -> None:
    predict = OnRail() | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")
    for call in (
        lambda: predict(mass="8000 kg", longitudinal_creepage="0.2 %"),
        lambda: wl.sweep(predict, mass="8000 kg", longitudinal_creepage=Q([0.1, 0.2], "%")),
    ):
        with pytest.warns(wl.CalibrationWarning, match="fitted for line contacts, but are used with elliptic") as said:
            call()
        assert [Path(one.filename).name for one in said] == [Path(__file__).name]


class Delegating(wl.Rig):
    """A rig whose conditions are those of another, and which fails."""

    name: ClassVar[str] = "delegating"

    def problem(self, **conditions: Any) -> wl.Problem:
        """Fail."""
        raise KeyError(*conditions)


def test_a_rig_that_takes_any_conditions_is_blamed_for_its_failure() -> None:
    with pytest.raises(ModelError, match="rig 'delegating' failed: KeyError: 'creepage'"):
        (Delegating() | MODEL)(creepage="1 %")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"mass": "20 kg"}, "creepage: is missing; rig 'roller' takes mass, creepage, friction_coefficient"),
        ({"mas": "20 kg", "creepage": "1 %"}, "mas: unknown condition; did you mean 'mass'?"),
        ({"mass": "20 N", "creepage": "1 %"}, "mass: got 20.00 N, which does not have the dimension of 'kg'"),
    ],
)
def test_wrong_conditions_are_named(given: dict[str, Any], said: str) -> None:
    predict: Any = Roller() | MODEL | KTH
    with pytest.raises(wl.InputError, match=said):
        predict(**given)


@pytest.mark.parametrize(
    ("what", "said"),
    [
        (None, "rig 'returning' returned None, not a wearlaw.Problem"),
        (KeyError("lost"), "rig 'returning' failed: KeyError: 'lost'"),
        (SystemExit(0), "rig 'returning' failed: SystemExit: 0"),
    ],
)
def test_a_broken_rig_is_named(what: Any, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Returning, "what", what)
    with pytest.raises(ModelError, match=said):
        (Returning() | MODEL | KTH)(creepage="1 %")


def test_bodies_that_are_not_named_lose_no_mass() -> None:
    given: Any = {"mass": "20 kg", "creepage": "1 %"}
    assert (Roller() | MODEL | KTH)(**given).mass_lost(over="1 km", body="disc_1").magnitude > 0.0
    r = (Roller() | MODEL | KTH).predict(Roller().problem(**given).replaced(bodies={}))
    with pytest.raises(wl.InputError, match="body: this rig has no 'disc_1'; its bodies are not named"):
        r.mass_lost(over="1 km", body="disc_1")
