"""Wear and fatigue damage of a rail under a driving wheel, dry and lubricated."""

import warnings

import matplotlib.pyplot as plt
import numpy as np

import wearlaw as wl
from wearlaw import Q

warnings.simplefilter("ignore", wl.CalibrationWarning)  # USFD was fitted to line contact
rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="13 m/s")
points = {"threshold": "20 N", "peak": "65 N", "balance": "175 N", "peak_damage": 1e-5}
fatigue = wl.law("wlrm", **points, beyond="falls", traction="driving")
predict = rig | wl.contact_model("strip_theory") | wl.wear_law("usfd", fitted_for="exact") | fatigue

plt.style.use("wearlaw_apps.output.wearlaw")
figure, (above, below) = plt.subplots(2, 1, figsize=(3.54, 4.0), sharex=True)
creepage = np.linspace(0.0, 1.5, 301)
for friction, line in ((0.35, "-"), (0.15, "--")):
    r = predict(normal_force="80 kN", longitudinal_creepage=Q(-creepage, "%"), friction_coefficient=friction)
    above.plot(creepage, r.wear_rate.m_as("ug/m/mm^2"), line, label=f"friction coefficient {friction}")
    below.plot(creepage, 1e6 * r["rcf_damage"].magnitude, line)

below.axhline(0.0, color="black", lw=0.8)
above.set(ylabel="wear rate [µg/m/mm²]")
below.set(xlabel="creepage of a driving wheel [%]", ylabel="damage of a million passages [-]")
above.legend()
figure.savefig("wear_and_fatigue.png", dpi=150)
