"""Tests of wearlaw_apps.fits."""
