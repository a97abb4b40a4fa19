"""The outside stage, and law of temperature, against numbers from elsewhere."""

import numpy as np
import pytest
from wearlaw_outside.contact import Rigid
from wearlaw_outside.flash import Flash
from wearlaw_outside.material import MADE_UP_STEEL
from wearlaw_outside.rig import Weighted
from wearlaw_outside.stage import Wet

import wearlaw as wl

RIG = Weighted(material=MADE_UP_STEEL)


def test_friction_is_half_as_high_at_half_speed() -> None:
    """0.4/2 · 20 kg · 9.81 m/s² = 39.24 N at 1 m/s."""
    solve = RIG | Rigid() | Wet(half_speed=wl.Q(1, "m/s"))
    force = solve(mass="20 kg", creepage="1 %", friction_coefficient=0.4).tangential_force
    assert abs(force.m_as("N") - 39.24) < 1e-12


def surface(flux: float, time: float, steel: wl.Material, conductivity: float, heat_capacity: float, n: int) -> float:
    """Return the surface temperature of a half-space under a heat flux, by finite volumes of second order."""
    capacity = heat_capacity * wl.scalar_si(steel.density, "kg/m^3")
    depth = 8.0 * np.sqrt(conductivity / capacity * time)  # where the rise is below 1e-7 of that of the surface
    size = depth / n
    steps = int(np.ceil(time / (0.25 * size**2 * capacity / conductivity)))
    heat = np.zeros(n + 1)  # of the nodes; the first one has half a cell
    for _ in range(steps):
        flow = np.concatenate([[flux], conductivity * -np.diff(heat) / size, [0.0]])
        gain = -np.diff(flow) / (capacity * size) * time / steps
        heat += gain * np.where(np.arange(n + 1) == 0, 2.0, 1.0)
    return float(heat[0])


def test_the_temperature_is_that_of_a_solution_of_the_heat_equation() -> None:
    """Of second order, the finer solution is nearer than the coarser one by more than half of their difference."""
    result = (RIG | Rigid() | Flash())(mass="20 kg", creepage="1 %", friction_coefficient=0.4)
    contact = result.contact
    flux = 0.5 * float(contact.wear_index * contact.rolling_speed / contact.patch_area)
    time = float(2.0 * contact.half_width / contact.rolling_speed)
    coarse, fine = (surface(flux, time, MADE_UP_STEEL, 50.0, 450.0, n) for n in (60, 120))
    assert abs(coarse - fine) < 0.01 * fine
    assert abs(result["flash_temperature"].m_as("K") - fine) <= abs(coarse - fine)


def test_a_material_without_a_conductivity_is_named() -> None:
    """The law says what it needs."""
    predict = Weighted(material=wl.steel()) | Rigid() | Flash()
    with pytest.raises(wl.InputError, match="needs a HeatedSteel"):
        predict(mass="20 kg", creepage="1 %", friction_coefficient=0.4)
