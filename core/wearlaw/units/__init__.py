"""Quantities with units, as users give and read them."""
