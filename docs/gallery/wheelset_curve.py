"""Wear across the profile of the outer wheel, on straight track and in two curves."""

import matplotlib.pyplot as plt
import numpy as np

import wearlaw as wl
from wearlaw import Q

wheel, sizes = wl.Profile.s1002(), {"nominal_radius": "460 mm", "flange_back_distance": "1360 mm", "gauge": "1435 mm"}
sizes |= {"rail": wl.Profile.uic60(), "rail_cant": "1:40", "material": wl.steel()}
pair = wl.Wheelset(wheel=wheel, **sizes, rolling_speed="20 m/s")
predict = pair | wl.contact_model("strip_theory") | wl.wear_law("energy", mass_per_energy="5.3 ug/J")
plt.style.use("wearlaw_apps.output.wearlaw")
form = {"figsize": (5.0, 4.0), "gridspec_kw": {"height_ratios": (2, 3)}}
figure, (shape, loss) = plt.subplots(2, 1, sharex=True, **form)
places = np.arange(-60.0, 45.0, 0.25)
y, z, angle, _ = np.array(wheel.curve.at(1e-3 * places)) * np.array([[1e3], [1e3], [1.0], [1.0]])
shape.plot(y, z, color="black")
for radius, moved, yaw, line in (-np.inf, 0.8, 0, "-"), (-500, 5.5, 5, "--"), (-200, 6.12, 20, ":"):
    track = {"lateral_displacement": Q(moved, "mm"), "yaw": Q(yaw, "mrad"), "curve_radius": Q(radius, "m")}
    r = predict(**track, vertical_load="60 kN", friction_coefficient=0.3)
    depth = r.sel(side="right").wear_profile("wheel", at=Q(places, "mm")).depth
    (drawn,) = loss.plot(y, depth.where(depth > 0.0), line, label=f"{-radius} m" if radius > -np.inf else "straight")
    inwards = 4.0 * (depth / depth.max()).where(depth > 0.0)  # along the normal, 4 mm where it is deepest
    shape.plot(y + inwards * np.sin(angle), z - inwards * np.cos(angle), line, color=drawn.get_color())
shape.set(ylabel="z of the wheel [mm]", aspect="equal", ylim=shape.get_ylim()[::-1])
loss.set(xlabel="y of the wheel [mm]", ylabel="depth lost per distance [µm/km]", yscale="log", ylim=(1e-2, None))
loss.legend(title="radius of the curve")
figure.savefig("wheelset_curve.png", dpi=150)
