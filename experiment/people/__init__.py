"""Simulated participants: for planning and for tests, never evidence."""
