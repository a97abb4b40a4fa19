"""Tests of wearlaw_show."""
