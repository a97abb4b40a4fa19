rig = wl.TwinDisc(
    disc_1=wl.Disc(diameter=Q(1, "m"), material=wl.steel()),
    disc_2=wl.Disc(diameter=Q(7, "m"), material=wl.steel()),
    track_width=Q(1, "m"),
    rolling_speed="5m/s",
    speed_of="disc_1",
)
predict = rig | wl.contact_model("global")
given = dict(max_pressure="1e308MPa", e=([], ""), t=[9])
d = predict(**given)()
