"""How uncertain a prediction is, and which input is to blame."""

import matplotlib.pyplot as plt

import wearlaw as wl

predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
u = wl.uncertainty(
    predict,
    normal_force=wl.normal("7.4 kN", "0.2 kN"),
    creepage=wl.uniform("0.4 %", "0.6 %"),
    friction_coefficient=wl.normal(0.46, 0.05),
    law={"m_m": wl.lognormal("5.3 ug/m/N", 1.2)},
    samples=4096,
)
low, high = u.interval(0.95)
shares = u.sobol()["first_order"].sort_values()
names = {"normal_force": "load", "creepage": "creepage", "friction_coefficient": "friction", "m_m": "slope $m_m$"}

plt.style.use("wearlaw_apps.output.wearlaw")
figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 2.6))
left.ecdf(u.wear_rate.m)
left.axvspan(low.m, high.m, alpha=0.2)
left.set(xlabel=f"wear rate [{low.u:~P}]", ylabel="probability of less wear [-]")
left.set_title("shaded: 95 % of the samples")

bars = right.barh([names[name] for name in shares.index], 100 * shares)
right.bar_label(bars, fmt="%.1f", padding=3)
right.set(xlabel="share of the variance [%]", xlim=(0, 65), title="what it comes from")
figure.savefig("uncertain.png", dpi=150)
