"""T3: find one target, mark where it was."""
