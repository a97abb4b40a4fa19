"""The band of the KTH law, whose coefficients are published as ranges, over creepage."""

import matplotlib.pyplot as plt
import numpy as np

import wearlaw as wl
from wearlaw import Q

solve = wl.TwinDisc.suros() | wl.contact_model("exact")
creepage = Q(np.geomspace(0.1, 50, 400), "%")
low, middle, high = (
    (solve | law)(max_pressure=Q(1500, "MPa"), creepage=creepage, friction_coefficient=0.46).wear_rate
    for law in wl.wear_law("kth").band()
)

plt.style.use("wearlaw_apps.output.wearlaw")
figure, axes = plt.subplots()
axes.fill_between(creepage.m, low.m, high.m, alpha=0.2, label="published range of the coefficient")
axes.plot(creepage.m, middle.m, label="middle of the range")

axes.set(xscale="log", yscale="log", xlabel="creepage [%]", ylabel=f"wear rate [{middle.u:~P}]")
axes.xaxis.set_major_formatter("{x:g}")
axes.legend(loc="upper left")
figure.savefig("kth_band.png", dpi=150)
