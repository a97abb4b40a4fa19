"""Tests of wearlaw_apps.papers.tassini2010."""
