"""What a user types, and the types that checkers see."""

from __future__ import annotations

from typing import ClassVar, assert_type

import numpy as np

import wearlaw as wl
from wearlaw import Q

rig = wl.TwinDisc.suros()
assert_type(rig, wl.TwinDisc)
assert_type(wl.contact_model("fastsim", bound="elliptic"), wl.ContactModel)
assert_type(wl.wear_law("usfd", fitted_for="exact"), wl.WearLaw)
on_lines: wl.Pipeline[...] = rig | wl.contact_model("exact") | wl.patch_mean() | wl.wear_law("brr")

predict = rig | wl.contact_model("exact") | wl.wear_law("usfd")
assert_type(predict.laws, tuple[wl.WearLaw, ...])

result = predict(normal_force=Q(7.4143, "kN"), creepage=Q(1, "%"), friction_coefficient=0.46)
assert_type(result, wl.Prediction)
assert_type(result.wear_rate, wl.Quantity)
assert_type(result.tangential_force, wl.Quantity)
assert_type(result.averaged_wear_index, wl.Quantity)
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
assert_type(solved.longitudinal_force, wl.Quantity)


class Roller(wl.Rig):
    """A rig of one's own."""

    name: ClassVar[str] = "roller"
    source: ClassVar[str] = "made up"

    def problem(self, *, mass: wl.QuantityLike, creepage: wl.QuantityLike) -> wl.Problem:
        return rig.problem(max_pressure="1 GPa", creepage=creepage, friction_coefficient=0.4)


rolled = Roller() | wl.contact_model("fastsim") | wl.wear_law("kth")
assert_type(rolled(mass="20 kg", creepage="1 %"), wl.Prediction)
