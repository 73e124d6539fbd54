"""Furniture, vehicles, animals: built from code."""
