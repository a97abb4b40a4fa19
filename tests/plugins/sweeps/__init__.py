"""Tests of wearlaw_sweeps."""
