rig = wl.WheelRail(
    wheel_radius="5m",
    rail_head_radius="7m",
    material=wl.Material(youngs_modulus="8Pa", poisson_ratio=0.5, density="7g/m^3"),
    rolling_speed="9m/s",
)
dict = (
    rig | wl.contact_model("shen_hedrick_elkins") | wl.patch_mean() | wl.wear_law("energy", mass_per_energy=Q(7, "g/J"))
)
n = dict(normal_force="x" * 5186)
d()
("")
