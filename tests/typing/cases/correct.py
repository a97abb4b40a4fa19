"""What a user types, and the types that checkers see."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, TypedDict, assert_type

import numpy as np

import wearlaw as wl
from wearlaw import Q
from wearlaw.models.law import LocalOutcome  # private: what `contact | law` returns

rig = wl.TwinDisc.suros()
assert_type(rig, wl.TwinDisc)
assert_type(wl.contact_model("fastsim", bound="elliptic"), wl.ContactModel)
assert_type(wl.wear_law("usfd", fitted_for="exact"), wl.WearLaw)
on_lines: wl.Pipeline[...] = rig | wl.contact_model("exact") | wl.patch_mean() | wl.wear_law("brr")

predict = rig | wl.contact_model("exact") | wl.wear_law("usfd")
assert_type(predict.laws, tuple[wl.Law, ...])

result = predict(normal_force=Q(7.4143, "kN"), creepage=Q(1, "%"), friction_coefficient=0.46)
assert_type(result, wl.Prediction)
assert_type(result[0], wl.Prediction)
assert_type(result.wear_rate, wl.Quantity)
assert_type(result.tangential_force, wl.Quantity)
assert_type(result.contact, wl.Contact)
assert_type(result.contact.pressure, wl.Array)
assert_type(result.depth_per_distance("disc_1"), wl.Quantity)
assert_type(result.mass_lost(over=Q(10, "km"), body="disc_1"), wl.Quantity)
assert_type(result.mass_lost(over="10 km", body="disc_1"), wl.Quantity)
assert_type(result.profile_area_rate("disc_1"), wl.Quantity)

predict(max_pressure=Q(1500, "MPa"), creepage=Q(np.geomspace(1e-5, 0.25, 500), ""), friction_coefficient=0.46)
predict(normal_force_per_width="741 kN/m", creepage="1 %", friction_coefficient=np.array([0.3, 0.4]))
predict(normal_force="7 kN", creepage="1 %", friction_coefficient=[0.3, 0.4], traction_coefficient=0.45)

contact = rig | wl.contact_model("exact")
assert_type(contact(normal_force="7 kN", creepage="1 %", friction_coefficient=0.4), wl.Prediction)

wl.TwinDisc(
    disc_1=wl.Disc(diameter=Q(47, "mm"), material=wl.steel()),
    disc_2=wl.Disc(diameter="47 mm", material=wl.steel(poisson_ratio=0.3, youngs_modulus="210 GPa")),
    track_width=Q(10, "mm"),
    rolling_speed=Q(1, "m/s"),
)
wl.TwinDisc.suros(diameter="50 mm", track_width=Q(8, "mm"), rotational_speed="300 rpm")
assert_type(wl.parse("47 mm"), wl.Quantity)

wheel = wl.WheelRail(wheel_radius="460 mm", rail_head_radius=Q(300, "mm"), material=wl.steel(), rolling_speed="30 m/s")
on_rail = wheel | wl.contact_model("fastsim") | wl.wear_law("usfd")
on_ellipses: wl.Pipeline[...] = on_rail
worn = on_rail(normal_force="80 kN", longitudinal_creepage="0.2 %", spin="0.3 1/m", friction_coefficient=0.3)
assert_type(worn, wl.Prediction)
assert_type(worn.spin_moment, wl.Quantity)
falling = wl.FallingFriction(static_coefficient=0.4, limit_ratio=0.5, decay="0.6 s/m")
(wheel | wl.contact_model("polach"))(max_pressure="1 GPa", longitudinal_creepage="1 %", friction_coefficient=falling)
ellipse = wl.Problem.ellipse(
    a=Q(6, "mm"),
    b=Q(6, "mm"),
    normal_force=Q(100, "kN"),
    shear_modulus=Q(82, "GPa"),
    poisson_ratio=0.28,
    friction_coefficient=0.3,
    longitudinal_creepage=Q(0.1, "%"),
    lateral_creepage=Q(0, "%"),
    spin=Q(0, "1/mm"),
)
solved = wl.contact_model("fastsim", bound="elliptic").solve(ellipse)
assert_type(solved, wl.Contact)
assert_type(solved.force_x, wl.Array)
across = wl.hertz_ellipse.curvature(0.46, 0.3)
assert_type(across, float)
along = wl.hertz_ellipse.curvature(np.array([0.45, 0.46]), np.inf)
assert_type(along, wl.Array)
axes = wl.hertz_ellipse.semi_axes(80e3, along, across, 115e9)
assert_type(wl.hertz_ellipse.max_pressure(80e3, *axes), wl.Array)


class Roller(wl.Rig):
    """A rig of one's own."""

    name: ClassVar[str] = "roller"

    def problem(self, *, mass: wl.QuantityLike, creepage: wl.QuantityLike) -> wl.Problem:
        return rig.problem(max_pressure="1 GPa", creepage=creepage, friction_coefficient=0.4)


rolled = Roller() | wl.contact_model("exact") | wl.wear_law("kth")
assert_type(rolled(mass="20 kg", creepage="1 %"), wl.Prediction)


class Patch(wl.WearLaw):
    """A law of the whole patch."""

    scale: ClassVar[Literal["patch", "any"]] = "patch"
    monotone_in = ("wear_index",)

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return p["slope"] * contact.wear_index_density

    slope: Annotated[wl.Quantity, wl.Unit("ug/m/N")] = Q(6, "ug/m/N")
    """A quantity in Python, so that a default or an argument is one, not a text."""


Patch(slope=Q(7, "ug/m/N"))
Patch(slope=wl.parse("7 ug/m/N"))


class Half(wl.WearLaw):
    """A law around another one, whose scale it has."""

    monotone_in: ClassVar[tuple[wl.LawVariable, ...]] = ("wear_index", "slip")

    inner: wl.WearLawField

    @property
    def scale(self) -> Literal["patch", "any"]:
        return "patch" if self.inner.scale == "patch" else "any"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 0.5 * self.inner.rate(contact, self.inner.numbers)


class RailSteel(wl.Material):
    """A material with a property of its own; text for its quantities is accepted as the signature says."""

    hardness: Annotated[wl.Quantity, wl.Unit("GPa")]

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            youngs_modulus: wl.QuantityLike,
            poisson_ratio: float,
            density: wl.QuantityLike,
            shear_yield_stress: wl.QuantityLike | None = None,
            hardness: wl.QuantityLike,
        ) -> None: ...


hard = RailSteel(youngs_modulus="210 GPa", poisson_ratio=0.3, density="7800 kg/m^3", hardness="3.5 GPa")
assert_type(hard.hardness, wl.Quantity)
assert_type(contact(normal_force="7 kN", creepage="1 %", friction_coefficient=0.4).contact.body().material, wl.Material)
assert_type(wl.material("steel", density="7800 kg/m^3"), wl.Material)
assert_type(wl.wear_coefficient(7e-3, "k_of_3h", to="k"), float)
assert_type(wl.wear_coefficient("5 ug/J", "mass_per_energy", to="volume_per_energy", density="7 g/cm^3"), wl.Quantity)


class Fatigue(wl.Law):
    """A law of another outcome, for one body."""

    outcome: ClassVar[wl.Outcome] = wl.Outcome("rcf_damage", unit="", of="patch", sign="any")

    threshold: Annotated[wl.Quantity, wl.Unit("N")]

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 1e-6 * (contact.wear_index - p["threshold"])

    @property
    def own_variables(self) -> Mapping[wl.Variable, Callable[[wl.Contact], wl.Array]]:
        return {wl.Variable("pv", unit="W/mm^2"): lambda contact: contact.pressure * contact.slip_speed}


class Flash(Fatigue):
    """A law that reads the material, the size and the history of the contact; its outcome without an annotation."""

    outcome = wl.Outcome("flash_temperature", unit="K", of="patch")
    example_material = hard

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        material = contact.body("rail").material
        if not isinstance(material, RailSteel):
            raise wl.InputError("material: must be a RailSteel")
        assert_type(contact.half_width, wl.Array)
        return contact.wear_index * wl.scalar_si(material.hardness, "Pa") * contact.half_width


staged = Roller() | wl.contact_model("exact") | wl.stage("lubricated", factor=0.5) | wl.patch_mean()
several = staged | wl.wear_law("usfd") | Fatigue(threshold=Q(15, "N"), body="rail") | wl.law("flash", threshold="1 N")
assert_type(several.stages, tuple[wl.Stage, ...])
assert_type(several.laws, tuple[wl.Law, ...])
assert_type(wl.law("fatigue", body="rail"), wl.Law)
predicted = several(mass="20 kg", creepage="1 %")
assert_type(predicted, wl.Prediction)
assert_type(predicted["rcf_damage"], wl.Quantity)
assert_type(predicted.outcome("rcf_damage", "rail"), wl.Quantity)
assert_type(predicted.outcome("flash_temperature"), wl.Quantity)
assert_type(predicted.wear_rate_of("rail"), wl.Quantity)
assert_type(predicted.laws, tuple[wl.Law, ...])
assert_type(predicted.contact | Fatigue(threshold=Q(15, "N")), LocalOutcome)
assert_type(predicted.contact | wl.wear_law("usfd"), LocalOutcome)
assert_type((predicted.contact | Fatigue(threshold=Q(15, "N"))).value, wl.Quantity)


@wl.hookimpl(specname="wearlaw_models")
def rigs() -> Iterable[type[wl.Rig]]:
    """Return rigs."""
    return [Roller]


@wl.hookimpl(optionalhook=True)
def wearlaw_of_tomorrow() -> int:
    """Return what a later version of wearlaw asks for."""
    return 3


class Humidity(TypedDict):
    """Humidity of the air."""

    relative_humidity: Annotated[wl.QuantityLike, wl.Unit("%")]


class Humid(wl.WearLaw):
    """A law with a condition of its own."""

    conditions: ClassVar = Humidity

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return contact.per_node(contact.conditions["relative_humidity"])


class HumidModel(wl.ContactModel):
    """A contact model with a condition of its own."""

    conditions: ClassVar = Humidity

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        return solved


class Wet(wl.Stage):
    """A stage with a condition of its own."""

    conditions: ClassVar = Humidity


test = {"creepage": "1 %"}
humid = rig | wl.contact_model("exact") | Humid()
humid(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.4, relative_humidity="40 %")
(rig | wl.contact_model("exact") | wl.wear_law("usfd") | Humid())(relative_humidity="40 %", **test)
(rig | wl.contact_model("exact") | Wet() | wl.wear_law("usfd"))(relative_humidity="40 %", **test)
(wheel | HumidModel() | wl.wear_law("usfd"))(relative_humidity="40 %", **test)
assert_type(humid(relative_humidity="40 %", **test), wl.Prediction)
