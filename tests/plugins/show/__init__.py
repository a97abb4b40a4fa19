"""Tests of wearlaw_apps.show."""
