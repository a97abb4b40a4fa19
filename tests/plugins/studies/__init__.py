"""Tests of wearlaw_apps.studies."""
