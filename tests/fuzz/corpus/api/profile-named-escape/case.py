ws.read_profile("\1", kind="")
