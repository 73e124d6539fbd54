"""Shapes in a volume."""
