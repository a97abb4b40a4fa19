"""Quantities of another registry of pint, and an application registry that is changed or not made yet."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pint
import pytest

import wearlaw as wl
from tests.core.units import LENGTH
from wearlaw import Q
from wearlaw.units.quantities import from_si  # private: texts and floats at the rim


@pytest.fixture
def original_registry() -> Iterator[None]:
    registry = pint.application_registry.get()  # type: ignore[no-untyped-call]
    yield
    pint.set_application_registry(registry)  # type: ignore[no-untyped-call]


def test_quantities_of_another_registry_are_brought_home() -> None:
    foreign: Any = pint.UnitRegistry()
    assert LENGTH.si(foreign.Quantity(47.0, "mm"), "x") == pytest.approx(0.047, rel=1e-15)
    foreign.define("railgauge = 1435 mm")
    assert LENGTH.si(foreign.Quantity(2.0, "railgauge"), "x") == pytest.approx(2.87, rel=1e-15)
    disc = wl.Disc(diameter=foreign.Quantity(47.0, "mm"), material=wl.steel())
    assert disc == wl.Disc(diameter=Q(47.0, "mm"), material=wl.steel())
    with pytest.raises(wl.UnitError, match=r"x: got 1\.000 kN, which does not have the dimension of 'mm'"):
        LENGTH.si(foreign.Quantity(1.0, "kN"), "x")


@pytest.mark.usefixtures("original_registry")
def test_the_application_registry_may_be_changed_at_any_time() -> None:
    before = Q(47.0, "mm")
    registry: pint.UnitRegistry[Any] = pint.UnitRegistry()
    registry.define("railgauge = 1435 mm")
    pint.set_application_registry(registry)  # type: ignore[no-untyped-call]
    assert wl.Unit("mm").si(Q(2.0, "railgauge"), "x") == pytest.approx(2.87, rel=1e-15)
    assert wl.Unit("mm").si(before, "x") == pytest.approx(0.047, rel=1e-15)
    assert from_si(2.87, "railgauge").magnitude == pytest.approx(2.0, rel=1e-15)


@pytest.mark.usefixtures("original_registry")
@pytest.mark.parametrize("system", ["cgs", "imperial", "US"])
def test_a_registry_with_another_default_system_still_gives_si(system: str) -> None:
    pint.set_application_registry(pint.UnitRegistry(system=system))  # type: ignore[no-untyped-call]
    assert wl.Unit("kN").si("1 kN", "x") == pytest.approx(1e3, rel=1e-15)
    assert wl.Unit("kg/m^3").si("7850 kg/m^3", "x") == pytest.approx(7850.0, rel=1e-15)
    assert wl.scalar_si(Q(206.0, "GPa"), "Pa") == pytest.approx(206e9, rel=1e-15)
    predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
    result = predict(normal_force="7.4143 kN", creepage="1 %", friction_coefficient=0.46)
    assert repr(result.wear_rate) == "27.70 µg/m/mm²"
