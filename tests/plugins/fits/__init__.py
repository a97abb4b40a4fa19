"""Tests of wearlaw_fits."""
