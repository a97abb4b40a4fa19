"""Three wear laws over the wear index, on the global contact model."""

import matplotlib.pyplot as plt
import numpy as np

import wearlaw as wl
from wearlaw import Q

solve = wl.TwinDisc.suros() | wl.contact_model("global")
laws = {"USFD": wl.wear_law("usfd"), "KTH, middle of its range": wl.wear_law("kth"), "BRR": wl.wear_law("brr")}
creepage = Q(np.geomspace(0.3, 20, 2000), "%")

plt.style.use("wearlaw_apps.output.wearlaw")
figure, axes = plt.subplots()
for (name, law), line in zip(laws.items(), ("-", "--", "-."), strict=True):
    result = (solve | law)(normal_force=Q(7.4, "kN"), creepage=creepage, friction_coefficient=0.46)
    axes.plot(result.wear_index.m_as("N"), result.wear_rate.m_as("ug/m/mm^2"), line, label=name)

axes.set(xscale="log", yscale="log", xlabel="wear index Tγ [N]", ylabel="wear rate [µg/m/mm²]")
axes.legend()
figure.savefig("three_laws.png", dpi=150)
