"""Comparing predictions with tests."""
