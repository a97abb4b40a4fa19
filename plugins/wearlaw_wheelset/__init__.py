"""Wheelsets on track: profiles of wheels and rails."""

from wearlaw_wheelset._profile import Profile

__all__ = ["Profile"]
