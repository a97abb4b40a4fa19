"""Tests of wearlaw_output."""
