wl.parse((7, ""))
