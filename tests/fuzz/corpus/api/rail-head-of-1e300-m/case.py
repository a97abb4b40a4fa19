rig = wl.WheelRail(wheel_radius=Q(9, "m"), rail_head_radius=Q(1e300, "m"), material=wl.steel(), rolling_speed="4m/s")
predict = rig | wl.contact_model("fastsim") | wl.wear_law("energy", mass_per_energy="6g/J")
given = dict(
    normal_force=Q(6, "N"),
    longitudinal_creepage="0%",
    rolled_distance=Q(2, "m"),
    lateral_creepage=Q(0.9, ""),
    contact_angle="4deg",
    friction_coefficient=5,
)
d = predict(**given)
o
