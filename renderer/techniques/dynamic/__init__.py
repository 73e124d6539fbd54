"""Dynamic transparency."""
