"""A map of the wear rate over load and creepage, with the line above which the whole patch slips."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import wearlaw as wl
from wearlaw import Q

predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
load = np.geomspace(1, 9, 160)  # kN
creepage = np.geomspace(0.1, 18, 400)  # %
result = predict(normal_force=Q(load, "kN"), creepage=Q(creepage[:, None], "%"), friction_coefficient=0.46)
rate = result.wear_rate.m_as("ug/m/mm^2")

plt.style.use("wearlaw_apps.output.wearlaw")
figure, axes = plt.subplots()
levels = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]
filled = axes.contourf(load, creepage, rate, levels, norm=LogNorm(), cmap="viridis", extend="both")
figure.colorbar(filled, label="wear rate [µg/m/mm²]", ticks=levels, format="{x:g}")

sticking = axes.contour(load, creepage, result.stick_ratio.m, [0.001], colors="white", linestyles="--")
axes.clabel(sticking, fmt="full slip above", manual=[(6, 1.1)])
axes.set(yscale="log", xlabel="normal force [kN]", ylabel="creepage [%]")
axes.yaxis.set_major_formatter("{x:g}")
figure.savefig("wear_map.png", dpi=150)
