"""A wear law of one's own, written as one function, beside USFD on the exact contact."""

import matplotlib.pyplot as plt
import numpy as np

import wearlaw as wl
from wearlaw import Q


@wl.as_wear_law(
    inputs={"wear_index_density": "N/mm^2"},
    returns="ug/m/mm^2",
    breakpoints={},
    parameters={"per_energy": "ug/m/N"},
    source="wear in proportion to the dissipated energy, with the slope of USFD's mild regime",
)
def energy_law(wear_index_density, *, per_energy=5.3):
    return per_energy * wear_index_density


solve = wl.TwinDisc.suros() | wl.contact_model("exact")
creepage = Q(np.geomspace(0.1, 20, 400), "%")

figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
for law, line, name in ((wl.wear_law("usfd", fitted_for="exact"), "-", "USFD"), (energy_law, "--", "energy law")):
    result = (solve | law)(normal_force=Q(7.4, "kN"), creepage=creepage, friction_coefficient=0.46)
    axes.plot(creepage.m, result.wear_rate.m_as("ug/m/mm^2"), line, label=name)

axes.set(xscale="log", yscale="log", xlabel="creepage [%]", ylabel="wear rate [µg/m/mm²]")
axes.xaxis.set_major_formatter("{x:g}")
axes.legend()
figure.savefig("own_law.png", dpi=150)
