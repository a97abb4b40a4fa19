"""Mistakes that checkers catch before the program runs."""

# ruff: noqa: B018

from __future__ import annotations

from typing import Annotated, ClassVar, TypedDict

import wearlaw as wl
from wearlaw import Q

rig = wl.TwinDisc.suros()
model = wl.contact_model("exact")
law = wl.wear_law("usfd")
predict = rig | model | law

rig | law  # expect-error
rig | wl.patch_mean()  # expect-error
model | law  # expect-error
law | model  # expect-error
wl.patch_mean() | law  # expect-error
rig | model | model  # expect-error
rig | model | "usfd"  # expect-error
rig | wl.stage("wet") | model  # expect-error
model | wl.stage("wet")  # expect-error
predict | model  # expect-error

wl.Disc(diameter=0.047, material=wl.steel())  # expect-error
wl.Disc(diameter="47 mm")  # expect-error
wl.Disc(diameter="47 mm", material="steel")  # expect-error
wl.TwinDisc.suros(track_width=0.01)  # expect-error
wl.steel(youngs_modulus=210e9)  # expect-error
wl.steel(poison_ratio=0.3)  # expect-error
Q("47", 3)  # expect-error

predict(normal_force=Q(7, "kN"), creepage=0.01, friction_coefficient=0.4)  # expect-error
predict(normal_force=7000, creepage="1 %", friction_coefficient=0.4)  # expect-error
predict(normal_force="7 kN", friction_coefficient=0.4)  # expect-error
predict(normal_force="7 kN", creepage="1 %")  # expect-error
predict(normal_force="7 kN", creepge="1 %", friction_coefficient=0.4)  # expect-error
predict("7 kN", creepage="1 %", friction_coefficient=0.4)  # expect-error
(rig | model)(normal_force="7 kN", friction_coefficient=0.4)  # expect-error

result = predict(normal_force="7 kN", creepage="1 %", friction_coefficient=0.4)
result.wear  # expect-error
result.mass_lost(over=10, body="disc_1")  # expect-error
result.depth_per_distance()  # expect-error
result[0.5]  # expect-error
result.outcome()  # expect-error
result.outcome("rcf_damage", 1)  # expect-error
result.contact.body().material.hardness  # expect-error
wl.Outcome("rcf_damage", unit="", of="nodes")  # expect-error
wl.Outcome("rcf_damage", unit="")  # expect-error
wl.wear_coefficient(1e-4, "k", to="k/H", hardness="2.6 GPa")  # expect-error
wl.wear_coefficient(1e-4, to="k_of_3h")  # expect-error

wheel = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
on_rail = wheel | model | law
on_rail(normal_force="80 kN", creepage="1 %", friction_coefficient=0.3)  # expect-error
on_rail(normal_force="80 kN", longitudinal_creepage=0.01, friction_coefficient=0.3)  # expect-error
wl.uncertainty(on_rail, samples="many")  # expect-error


class Roller(wl.Rig):
    """A rig of one's own."""

    def problem(self, *, mass: wl.QuantityLike, creepage: wl.QuantityLike) -> wl.Problem:
        return rig.problem(max_pressure="1 GPa", creepage=creepage, friction_coefficient=0.4)


rolled = Roller() | model | law
rolled(mass=20, creepage="1 %")  # expect-error
rolled(mass="20 kg")  # expect-error
rolled(mas="20 kg", creepage="1 %")  # expect-error


class Law(wl.WearLaw):
    """A law with a wrong name of a variable."""

    monotone_in = ("wear_indx",)  # expect-error

    slope: Annotated[wl.Quantity, wl.Unit("ug/m/N")]

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return p["slope"] * contact.wear_index_density


Law(slope=6.0)  # expect-error
Law(slope="6 ug/m/N")  # expect-error


class Fatigue(wl.Law):
    """A law that returns a quantity, of an outcome that is a text."""

    outcome = "rcf_damage"  # expect-error

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Quantity:  # expect-error
        return Q(contact.wear_index, "")


class Wet(wl.Stage):
    """A stage that returns a contact where it should alter the problem, and the other way round."""

    factor: float

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Contact:  # expect-error
        return model.solve(problem)

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Problem:  # expect-error
        return inner(problem)  # expect-error


Wet(factor="half")  # expect-error
Wet(facter=0.5)  # expect-error


@wl.hookimpl  # expect-error
def wearlaw_models() -> list[wl.Stage]:
    """Return instances in place of classes."""
    return [wl.patch_mean()]


@wl.hookimpl  # expect-error
def wearlaw_named() -> list[wl.Material]:
    """Return materials without names."""
    return [wl.steel()]


@wl.hookimpl  # expect-error
def wearlaw_commands() -> int:
    """Return no commands."""
    return 3


@wl.hookimpl  # expect-error
def wearlaw_resources() -> dict[str, str]:
    """Return texts without their kind."""
    return {"my_case": "title = 'Mine'"}


class Humidity(TypedDict):
    """Humidity of the air."""

    relative_humidity: Annotated[wl.QuantityLike, wl.Unit("%")]


class Moist(wl.Stage):
    """A stage with a condition of its own."""

    name: ClassVar[str] = "wet"
    source: ClassVar[str] = "made up"
    conditions: ClassVar = Humidity


rig | Moist()  # expect-error
predict(normal_force="7 kN", creepage="1 %", friction_coefficient=0.4, relative_humidity="4 %")  # expect-error
