"""Tests of wearlaw_apps.sweeps."""
