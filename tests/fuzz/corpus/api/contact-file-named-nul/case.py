wl.read_contact("\0")
