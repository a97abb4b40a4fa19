"""Tests of wearlaw_sheffield."""
