"""Frozen records of settings that are checked, written and read again, and the numbers in them."""
