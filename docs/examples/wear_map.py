"""A map of load, creepage and friction on two processes, kept on disk: 10⁷ points, or as many as are asked for."""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import wearlaw as wl
from wearlaw import Q

loads, creepages, frictions = map(int, sys.argv[1:] or (200, 500, 100))
predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
wear_map = wl.sweep(
    predict,
    friction_coefficient=np.linspace(0.1, 0.6, frictions),
    normal_force=Q(np.linspace(1, 9, loads), "kN"),
    creepage=Q(np.geomspace(0.1, 13, creepages), "%"),
    outputs=["wear_rate", "tangential_force"],
    workers=2,
    store="map.zarr",
    resume=True,  # if it was interrupted
    progress=True,
)

figure, row = plt.subplots(1, 3, figsize=(9, 3.6), sharey=True, layout="constrained")
for axes, friction in zip(row, (0.2, 0.4, 0.6), strict=True):
    rate = wear_map.wear_rate.sel(friction_coefficient=friction, method="nearest")  # read from disk here
    mesh = axes.pcolormesh(rate.normal_force, rate.creepage, rate.T, norm=LogNorm(0.1, 1000), rasterized=True)
    axes.set(yscale="log", xlabel="normal force [kN]", title=f"friction coefficient {rate.friction_coefficient:.2f}")
row[0].set_ylabel("creepage [%]")
row[0].yaxis.set_major_formatter("{x:g}")
figure.colorbar(mesh, label="wear rate [µg/m/mm²]", ax=row)
figure.savefig("map.png", dpi=110, metadata={"Software": None})
