"""Pixels sorted by themselves."""
