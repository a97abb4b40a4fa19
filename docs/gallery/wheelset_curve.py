"""Wear across the profile of the outer wheel, on straight track and in two curves."""

import warnings

import matplotlib.pyplot as plt
import numpy as np

import wearlaw as wl
import wearlaw_wheelset as ws
from wearlaw import Q

warnings.simplefilter("ignore", wl.PlasticityWarning)  # the flange yields


@wl.as_wear_law(
    inputs={"wear_index_density": "N/mm^2"}, returns="ug/m/mm^2", breakpoints={}, source="USFD's mild regime"
)
def energy_law(wear_index_density):
    return 5.3 * wear_index_density


wheel = ws.Profile.s1002()
pair = ws.Wheelset(
    wheel=wheel, rail=ws.Profile.uic60(), nominal_radius="460 mm", flange_back_distance="1360 mm", gauge="1435 mm",
    rail_cant="1:40", material=wl.steel(), rolling_speed="20 m/s",
)  # fmt: skip
predict = pair | wl.contact_model("fastsim") | energy_law
track = {
    "straight": {"lateral_displacement": "0.8 mm"},
    "curve of 500 m": {"lateral_displacement": "5.5 mm", "yaw": "5 mrad", "curve_radius": "-500 m"},
    "curve of 200 m": {"lateral_displacement": "6.12 mm", "yaw": "20 mrad", "curve_radius": "-200 m"},
}

plt.style.use("seaborn-v0_8-colorblind")
ratios = {"height_ratios": (2, 3)}
figure, (shape, loss) = plt.subplots(2, 1, figsize=(6.4, 5.0), sharex=True, layout="constrained", gridspec_kw=ratios)
places = np.arange(-60.0, 45.0, 0.25)
y, z, _, _ = wheel.curve.at(1e-3 * places)
shape.plot(1e3 * y, 1e3 * z, color="black")
shape.invert_yaxis()
for (name, conditions), line in zip(track.items(), ("-", "--", ":"), strict=True):
    r = predict(vertical_load="60 kN", friction_coefficient=0.3, **conditions)
    depth = r.sel(side="right").wear_profile("wheel", at=Q(places, "mm")).depth
    (drawn,) = loss.plot(1e3 * y, depth.where(depth > 0.0), line, label=name)
    shape.plot(1e3 * y, np.where(depth > 0.0, 1e3 * z, np.nan), lw=6.0, alpha=0.5, color=drawn.get_color())

shape.set(ylabel="z of the wheel [mm]", aspect="equal")
loss.set(xlabel="y of the wheel [mm]", ylabel="depth lost per distance rolled [µm/km]", yscale="log", ylim=(1e-2, None))
loss.legend(title="outer wheel")
for axes in (shape, loss):
    axes.grid(alpha=0.3)
figure.savefig("wheelset_curve.png", dpi=150)
