"""Masks, drawn."""
