"""The feudal priority order."""
