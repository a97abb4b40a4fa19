"""Tests of wearlaw_studies."""
