"""Wheels and rails: where they touch, and how."""
