g = wl.WheelRail(
    wheel_radius="\1",
    s="",
    l=wl.Material(youngs_modulus="7Pa", poisson_ratio=0.3, density=Q(4, "g/m^3")),
    d="",
    a=wl.steel(),
)
t((2, ""), t)
