"""What a study file says, checked, and who gets what of it."""
