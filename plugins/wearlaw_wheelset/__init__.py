"""Wheelsets on track: profiles of wheels and rails."""

from wearlaw_wheelset._profile import Profile, read_profile, write_profile

__all__ = ["Profile", "read_profile", "write_profile"]
