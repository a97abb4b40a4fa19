"""Uncertainties of predictions."""
