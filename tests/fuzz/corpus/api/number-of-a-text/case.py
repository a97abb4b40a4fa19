wl.scalar_si("", "")
