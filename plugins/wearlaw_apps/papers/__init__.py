"""Studies of published papers."""
