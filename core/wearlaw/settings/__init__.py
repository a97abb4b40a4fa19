"""Frozen, checked records of settings, written to files and read again, and the numbers in them."""
