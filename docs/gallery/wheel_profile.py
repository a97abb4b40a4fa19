"""Wear across the tread of a wheel that slides along the rail and spins on it."""

import matplotlib.pyplot as plt

import wearlaw as wl
from wearlaw import Q

rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
predict = rig | wl.contact_model("strip_theory") | wl.wear_law("energy", mass_per_energy="5.3 ug/J")

plt.style.use("wearlaw_apps.output.wearlaw")
figure, axes = plt.subplots()
for spin, line in zip((0.0, 0.3, 0.6), ("-", "--", ":"), strict=True):
    r = predict(
        normal_force=Q(80, "kN"), friction_coefficient=0.3, longitudinal_creepage=Q(0.2, "%"), spin=Q(spin, "1/m")
    )
    profile = r.wear_profile("wheel", strips=101)
    axes.plot(profile.y, profile.depth, line, label=f"spin {spin} 1/m")

axes.set(xlabel="y [mm]", ylabel="depth lost per distance rolled [µm/km]")
axes.legend()
figure.savefig("wheel_profile.png", dpi=150)
