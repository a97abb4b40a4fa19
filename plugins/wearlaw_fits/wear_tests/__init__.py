"""Wear tests of a lab, and reading them."""
