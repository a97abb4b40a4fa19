"""Tests of wearlaw_apps.output."""
