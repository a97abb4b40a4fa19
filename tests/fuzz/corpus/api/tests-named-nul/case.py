wl.read_tests("\0")
