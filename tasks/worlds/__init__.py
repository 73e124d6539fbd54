"""The places that tasks live in."""
