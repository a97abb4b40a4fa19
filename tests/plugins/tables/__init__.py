"""Tests of wearlaw_tables."""
