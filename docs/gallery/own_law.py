"""A wear law of one's own, beside USFD on the exact contact."""

import matplotlib.pyplot as plt
import numpy as np

import wearlaw as wl
from wearlaw import Q


class EnergyLaw(wl.WearLaw):
    """Wear in proportion to the dissipated energy."""

    name = "energy law"
    source = "the slope of USFD's mild regime"

    def rate(self, contact, p):
        return 5.3e-9 * contact.wear_index_density  # [kg/m/N] times [N/m²]

    def breakpoints(self, p):
        return {}


solve = wl.TwinDisc.suros() | wl.contact_model("exact")
creepage = Q(np.geomspace(0.1, 20, 400), "%")

plt.style.use("wearlaw_apps.output.wearlaw")
figure, axes = plt.subplots()
for law, line, name in ((wl.wear_law("usfd", fitted_for="exact"), "-", "USFD"), (EnergyLaw(), "--", "energy law")):
    result = (solve | law)(normal_force=Q(7.4, "kN"), creepage=creepage, friction_coefficient=0.46)
    axes.plot(creepage.m, result.wear_rate.m_as("ug/m/mm^2"), line, label=name)

axes.set(xscale="log", yscale="log", xlabel="creepage [%]", ylabel="wear rate [µg/m/mm²]")
axes.xaxis.set_major_formatter("{x:g}")
axes.legend()
figure.savefig("own_law.png", dpi=150)
