"""Rooms to walk through."""
