"""Fitting the parameters of wear laws to tests."""
