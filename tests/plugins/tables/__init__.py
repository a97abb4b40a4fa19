"""Tests of wearlaw_apps.tables."""
